/* Actuators with stages around the hysteresis, for microcontrollers:
 *
 *   drive -> body -> temperature -> load, registration, spacing -> operators -> stages behind -> output
 *
 * Body: first-order heating and cooling. Load: curves over the load that shift and scale the axis
 * of the operators and change stroke and offset. Registration: at which temperature rising and
 * falling input pass each threshold. Spacing: unequal distances of the levels. What stands behind the
 * operators is in hysteron_mcu_behind.h. Each of the stages may be missing. The inverse is exact for
 * the sample.
 *
 * The sample time is fixed when the model is exported: the factors e^(-dt/tau) are constants. So
 * this needs no library either, and what hysteron_mcu.h says of compilers, errors and threads holds
 * here too. The results have the same bits as those of the library at this sample time.
 *
 * Worst case of one call with K levels and n loads:
 *   hys_actuator_step          two bisections, of at most log2(n) + 1 and log2(K) + 2 halvings for
 *                              each curve and the spacing, one for each curve of a registration, then
 *                              one hys_step
 *   hys_actuator_inverse_step  one hys_inverse_step, these bisections, one hys_actuator_step
 *   hys_actuator_start         one hys_step for each turning point of the model's start
 * Where weights depend on the load, a step at another load than the one before first makes the table
 * of that load: n products for each of its (K + 1)(K + 2)/2 entries, for n parts; then one
 * hys_rebase. */
#ifndef HYSTERON_MCU_STAGES_H
#define HYSTERON_MCU_STAGES_H

#include "hysteron_mcu.h"

/* Layout of hys_actuator. Models that were exported for another layout do not compile. */
#define HYS_STAGES_LAYOUT 6

#define HYS_MOST_PARTS 8

/* The stages that the code has, a bit for each: all of them, or those of one model where flash is
 * scarce. */
#define HYS_STAGES 255u

/* Stages behind the operators: how many there are, numbers that they remember, and factors. */
#define HYS_BEHIND 4
#define HYS_BEHIND_MEMORY 8
#define HYS_BEHIND_FACTORS 8

/* Numbers that hys_actuator_save writes. */
#define HYS_STAGE_NUMBERS (2 + HYS_BEHIND_MEMORY)

#ifdef __cplusplus
extern "C" {
#endif

/* One more error code: the load is NaN or infinite. */
enum { HYS_LOAD = 13 };

/* One more status: the actuator can give the target, but not in this sample. The drive goes as far
 * as it can. */
enum { HYS_LIMITED = 3 };

/* Weights that depend on the load: sums of parts, whose factors are the Bernstein polynomials of
 * the load. */
typedef struct {
    const hys_real *tables;      /* Everett tables of the parts, one after the other */
    const hys_real *offsets;     /* output of each part where its sum is zero */
    size_t count;                /* number of parts */
    hys_real min, max;           /* the range of the loads */
} hys_parts;

/* The operators at one load. It is the caller's memory; only these functions may use its members.
 * The function is called through a pointer, so that programs without such a model do not hold it.
 */
typedef struct hys_mixed {
    hys_model model;
    hys_real *table;
    int (*place)(struct hys_mixed *mixed, const hys_parts *parts, hys_state *operators,
                 hys_real load);
    hys_real load, offset;
} hys_mixed;

/* A constant of a stage: a list of numbers; null and 0 where there is no such stage. */
typedef struct {
    const hys_real *numbers;
    size_t count;
} hys_list;

/* An actuator. Written by `hysteron export c`; do not change it. */
typedef struct {
    const hys_model *operators;  /* without offset and sign, which are below */
    hys_list loads;              /* loads at which the curves are known, ascending */
    hys_list shifts, scales, gains, offsets; /* the curves at these loads */
    hys_list knots;              /* registration: positions on the axis, ascending */
    hys_list rising, falling;    /* temperatures at the knots, up and down: a row for each load */
    hys_list spacing;            /* the K + 1 corners of the grid, ascending */
    hys_list curve_sums, curve_outputs; /* knots of the output curve, ascending */
    hys_list creep;              /* the share of the sum that creeps, of each term */
    hys_list ring_damping;       /* the damping ratio of a ring */
    hys_list start;              /* turning points that the model starts with */
    const hys_parts *parts;      /* weights that depend on the load; null without */
    unsigned there;              /* a bit for each stage behind the operators, in their order */
    hys_real start_input;        /* the operators' input at the start */
    hys_real steepest;           /* steepest slope of registration and spacing; 1 without them */
    hys_real ambient, gain;      /* body: temperature at rest without drive, and per unit of it */
    hys_real heating, cooling;   /* body: e^(-dt/tau) */
    hys_real latent;             /* degrees that the heat of a whole stroke is; 0 for none */
    hys_real factors[HYS_BEHIND_FACTORS]; /* of a sample, of the stages behind the operators */
    hys_real slopes[HYS_BEHIND]; /* the steepest slope at rest of each of them */
    hys_real steepest_behind;    /* and of all of them */
    hys_real size_behind;        /* the size of the numbers that they add to the output's */
    hys_real offset;             /* output where the operators' sum is zero */
    hys_real drive_min, drive_max; /* range of the drive, where it is limited */
    unsigned char body;          /* 1 with a body */
    unsigned char falls;         /* 1 where the output falls as the operators switch on */
    unsigned char limited;       /* 1 with a range of the drive */
} hys_actuator;

/* The state of an actuator. Only these functions may change its members; `temperature` may be
 * read. */
typedef struct {
    hys_state operators;
    const hys_actuator *actuator;
    hys_mixed *mixed;            /* null where the weights do not depend on the load */
    int started;                 /* 0 before the first sample: all stages are at rest */
    hys_real temperature;        /* after the last sample; the input itself without a body */
    hys_real behind[HYS_BEHIND_MEMORY]; /* what the stages behind the operators remember */
} hys_actuator_state;

/* Starts a state where the model starts. Arguments and errors as for hys_start. A model whose
 * weights depend on the load needs hys_actuator_start_mixed: HYS_MEMORY_TOO_SMALL. */
int hys_actuator_start(const hys_actuator *actuator, hys_actuator_state *state, hys_turn *turns,
                       size_t count);

/* The same for any model. The state uses `mixed` and the `entries` elements of `table`, at least
 * (K + 1)(K + 2)/2 (NAME_TABLE), from now on, if its weights depend on the load. */
int hys_actuator_start_mixed(const hys_actuator *actuator, hys_actuator_state *state,
                             hys_turn *turns, size_t count, hys_mixed *mixed, hys_real *table,
                             size_t entries);

/* Moves by one sample time, in which `drive` was held, and writes the output at its end. At the
 * first sample all stages are at rest. A load beyond the outermost ones acts as the
 * nearest one; a model without a load ignores it. Errors: HYS_INPUT_NOT_FINITE, HYS_LOAD. */
int hys_actuator_step(hys_actuator_state *state, hys_real drive, hys_real load, hys_real *output);

/* Finds the drive that gives `target` at the end of one sample time, within the range of the drive,
 * moves there and writes it. Heading and tolerance as for hys_inverse_step.
 *
 * `*status` becomes HYS_REACHED if the output is the target, up to tolerance and rounding. The
 * model's header says what rounding may amount to in the unit of the output: at most a thousandth
 * of the range of outputs. It becomes HYS_LOW or HYS_HIGH for a target below or above every output
 * at rest, HYS_PASSED as for hys_inverse_step, and else HYS_LIMITED.
 *
 * Errors: HYS_VALUE, HYS_NEGATIVE_WEIGHTS, HYS_INPUT_NOT_FINITE, HYS_LOAD. */
int hys_actuator_inverse_step(hys_actuator_state *state, hys_real target, int heading,
                              hys_real tolerance, hys_real load, hys_real *drive, int *status);

/* Writes what the stages remember into HYS_STAGE_NUMBERS numbers. With hys_save of
 * `operators` it is the whole state. */
int hys_actuator_save(const hys_actuator_state *state, hys_real *numbers);

/* Restores, bit for bit, what hys_actuator_save wrote. hys_restore of `operators` restores the
 * rest. Error: HYS_INPUT_NOT_FINITE. */
int hys_actuator_restore(hys_actuator_state *state, const hys_real *numbers);

#ifdef __cplusplus
}
#endif

#endif

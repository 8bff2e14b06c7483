/* Weights that follow the plant while an exported model runs.
 *
 * There are three learners. Each has a dead zone, leakage, a gate, a watch for channels that stand
 * still, and a trial against the last good parameters. The results have the same bits as those of
 * the library's `Estimator`.
 *   HYS_INCREMENTS     all weights, by the normalised gradient on increments of the output (Tan &
 *                      Baras 2005): needs no knowledge of the noise, and suits many levels
 *   HYS_DRIFT          a few coefficients: the exported weights, shifted along the plane, by
 *                      recursive least squares
 *   HYS_LEAST_SQUARES  all weights, by recursive least squares: for few levels
 *
 *     static hys_real memory[SPRING_INCREMENTS_NUMBERS];
 *     static hys_turn turns[SPRING_TURNS];
 *     static hys_adaptive adaptive;
 *     hys_adapt_start(&adaptive, &spring, spring_weights, spring.offset, &spring_increments, memory,
 *                     SPRING_INCREMENTS_NUMBERS, turns, SPRING_TURNS);
 *     hys_adapt_step(&adaptive, temperature, displacement, &expected, &outcome);   each sample
 *
 * With `spring_drift`, spring_drift_basis.coefficients takes the place of the weights. These options
 * are the library's defaults for the model. To change one, copy them.
 *
 * For a compensator, start a second state of `&adaptive.model` and call hys_rebase before each of
 * its inverse steps. A hys_adaptive must not be copied or moved, because states point into it.
 *
 * Worst case of hys_adapt_step, with N = K(K + 1)/2 operators and n parameters: a hys_step, a
 * hys_rebase, and at the end of a trial and of a stretch of the watch two copies of n numbers each.
 * Beside that HYS_INCREMENTS needs four passes over the operators and writes one row of a table.
 * Least squares need passes over a triangle of n(n + 1)/2 numbers: two, and one for each four
 * parameters; with HYS_DRIFT also one over the turning points, and one over n tables. Where others
 * moved the state in between, one more pass over the operators for each turning point, at most
 * 4K + 3; none with HYS_DRIFT. */
#ifndef HYSTERON_MCU_ADAPT_H
#define HYSTERON_MCU_ADAPT_H

#include "hysteron_mcu.h"

#if HYS_LAYOUT != 3
#error "hysteron_mcu_adapt: export the model again: hysteron_mcu.h is of another version"
#endif
#if defined(__AVR__) && !defined(HYS_TABLES_IN_RAM)
#error "hysteron_mcu_adapt: a model that learns has its table in RAM: define HYS_TABLES_IN_RAM"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What learns. */
enum { HYS_INCREMENTS = 1, HYS_LEAST_SQUARES = 2, HYS_DRIFT = 3 };

/* Sets of weights whose sum, each times its coefficient, are the weights. Written by `hysteron
 * export c`. */
typedef struct {
    const hys_real *tables;         /* their Everett tables, one after the other */
    const hys_real *coefficients;   /* those of the exported model */
    size_t count;                   /* how many sets there are */
    size_t length;                  /* numbers of a table */
} hys_adapt_basis;

/* Options, each with its range. `hysteron export c` writes those of each learner. */
typedef struct {
    const hys_adapt_basis *basis;   /* HYS_DRIFT alone */
    int learner;            /* HYS_INCREMENTS, HYS_LEAST_SQUARES or HYS_DRIFT */
    uint32_t trial;         /* from 1: samples until parameters are compared with the good ones */
    uint32_t burst;         /* from 1: so many refused readings in a row that agree are a jump */
    hys_real gain;          /* increments: above 0, below 2: 1 removes nearly the whole error */
    hys_real span;          /* increments: 1/8 to 8 levels from the start of one to its end */
    hys_real forgetting;    /* the others: above 0, up to 1: 1 forgets nothing */
    hys_real noise;         /* the others: above 0: standard deviation of a reading's error */
    hys_real spread;        /* the others: above 0: standard deviation of a parameter */
    hys_real correlation;   /* least squares: from 0, in levels; 0 with HYS_DRIFT */
    hys_real offset_share;  /* from 0: how freely the offset moves, relative to one parameter */
    hys_real dead_zone;     /* from 0: errors up to this are noise, in the output's unit */
    hys_real leakage;       /* 0 to 1: fraction of the way back to the parameters at the start */
    hys_real movement;      /* from 0: levels between two samples that are learned from */
    hys_real gate;          /* 0 or from 2: surprises above so many usual ones are refused; with 0
                             * no channel is watched either */
} hys_adapt_options;

/* Outcome of a sample. */
enum {
    HYS_LEARNED = 0,        /* the parameters moved */
    HYS_WAITING = 1,        /* the error lies within the dead zone, or an increment is not finished */
    HYS_AT_REST = 2,        /* the input did not move */
    HYS_FROZEN = 3,         /* the weights are frozen */
    HYS_ROLLED_BACK = 4,    /* the last good weights are back: the present ones were far worse */
    HYS_REJECTED = 5,       /* the reading is taken as an outlier */
    HYS_OUTPUT_STUCK = 6,   /* the output stands still while the input moves: what was learned since
                             * is undone */
    HYS_INPUT_STUCK = 7     /* the input stands still while the output moves: as well */
};

/* What the gate knows of the prediction errors. */
typedef struct {
    hys_real range;     /* range of the model's output at the start */
    hys_real scale;     /* usual size of a surprise: an error less the one left before */
    hys_real left;      /* error left after the last accepted reading */
    hys_real last;      /* surprise of the last refused reading */
    uint32_t refused, agreeing; /* readings in a row */
} hys_gate;

/* The lowest and the highest of some readings. */
typedef struct {
    hys_real low, high;
} hys_span;

/* The span of a channel over its way lately: of the present stretch and of the one before. */
typedef struct {
    hys_span spans[2];
    hys_real travel;
} hys_lately;

/* A stretch over which one channel stayed within a band. A reading is the channel that moves, the
 * one that may be still, and the position. */
typedef struct {
    hys_span spans[3];
    hys_real travel;        /* of the moving channel */
    hys_real first[2], last[3];
    /* Sums, but for a count, over the way of the moving channel: of 1, of both channels, of their
     * squares and of their product. All counted from the first reading. */
    hys_real way, count, sums[2], squares[2], product;
    uint32_t readings;
} hys_run;

/* A stretch over which the moving channel travelled half of the range. */
typedef struct {
    hys_span spans[3];
    hys_real travel;
    uint32_t readings;
} hys_piece;

/* What is known of one channel that may stand still, and of the other one, which moves. */
typedef struct {
    hys_real anchor;        /* where the travel was last counted */
    hys_real longest;       /* travel in the longest run that ended with a move */
    hys_lately lately;
    hys_run run;
    hys_piece piece;
    unsigned char begun;    /* 0 before the first reading, and then no other member counts */
    unsigned char follows;  /* the one followed the other in the run before */
} hys_trail;

/* What the watch knows of both channels. */
typedef struct {
    hys_real range, width;  /* of the output, and of the plane in levels */
    hys_trail output, input;
    hys_real last;          /* the last reading */
    int stuck;              /* HYS_OUTPUT_STUCK, HYS_INPUT_STUCK or 0 */
} hys_watch;

/* Sums of squared errors over a trial. */
typedef struct {
    hys_real now, candidate, good, rounding;
    uint32_t samples;
} hys_trial;

/* A model that learns. Applications may use `model`, the model as it is now, and `state`. Only
 * these functions may use the other members. */
typedef struct {
    hys_model model;
    hys_state state;
    hys_adapt_options options;
    hys_trial trial, level;     /* `level`: that of the offset alone, for increments */
    hys_gate gate;
    hys_watch watch;
    const hys_adapt_basis *basis;   /* NULL where the parameters are the weights */
    const hys_real *offline;        /* the parameters at the start */
    /* n parameters each. The last one is the deviation of the offset, in units of offset_share. */
    hys_real *theta, *good, *candidate;
    hys_real *trusted;          /* from before the last stretch in which the output moved */
    hys_real *pending;          /* from before the present stretch */
    hys_real *table, *other;    /* the model's table; that which is written row by row */
    hys_real *gamma, *anchor;   /* N operator states: now, and at the start of the increment */
    /* Of least squares: regressor, parameters at the start, covariance now and at the start, it
     * times the regressor, and the parameters before negative ones are set to zero. */
    hys_real *phi, *initial, *covariance, *start, *step, *estimate;
    size_t parameters;          /* n, with the offset */
    size_t seen_top, seen_cell;
    size_t renewed, rows_due;   /* next row of the other table; rows that are still to be written */
    /* The position and branch of the state that the operators' states belong to. */
    hys_real seen_x, seen_end, seen_part;
    hys_real offset;            /* off-line, without sign */
    hys_real learned;           /* position of the last sample learned from */
    hys_real expected;          /* output expected by the off-line weights, but for a constant */
    /* The increment: measured output and position at its start, lowest and highest position since. */
    hys_real at_start, began, low, high;
    unsigned char aligned, frozen;
    unsigned char under_way;    /* an increment has begun */
    unsigned char undone;       /* the watch took back what the table still has */
} hys_adaptive;

/* Starts with every operator off, from `parameters` (N weights, row by row, or the coefficients of the
 * basis) and `offset`: those exported, or those learned before. `model`, `parameters` and the basis
 * are not changed, and have to stay in memory. `memory` has `numbers` elements, at least
 * NAME_INCREMENTS_NUMBERS of the model, or NAME_LEAST_SQUARES_NUMBERS, or NAME_DRIFT_NUMBERS.
 * `turns` has `count` elements, as for hys_start. Errors: HYS_NULL, HYS_MEMORY_TOO_SMALL, HYS_ADAPTATION, HYS_NEGATIVE_WEIGHTS,
 * HYS_WEIGHT_NOT_FINITE, HYS_INPUT_NOT_FINITE (the offset). */
int hys_adapt_start(hys_adaptive *adaptive, const hys_model *model, const hys_real *parameters,
                    hys_real offset, const hys_adapt_options *options, hys_real *memory,
                    size_t numbers, hys_turn *turns, size_t count);

/* Moves `adaptive->state` to `input`, writes the output predicted there, and learns from the output
 * `measured`. `*outcome` becomes one of HYS_LEARNED to HYS_INPUT_STUCK. Error: HYS_INPUT_NOT_FINITE.
 */
int hys_adapt_step(hys_adaptive *adaptive, hys_real input, hys_real measured, hys_real *output,
                   int *outcome);

/* The present N weights, row by row, or the coefficients of the basis; NULL before hys_adapt_start.
 * adaptive->model.offset is the offset. */
const hys_real *hys_adapt_parameters(const hys_adaptive *adaptive);

/* Stops learning (`frozen` not 0), or resumes it (0). A frozen model still predicts. */
int hys_adapt_freeze(hys_adaptive *adaptive, int frozen);

/* Takes the present parameters as the last good ones. */
int hys_adapt_keep(hys_adaptive *adaptive);

/* Returns to the last good parameters. */
int hys_adapt_roll_back(hys_adaptive *adaptive);

/* Call it after hys_reset_off, hys_reset_on or hys_restore of `adaptive->state`. */
int hys_adapt_realign(hys_adaptive *adaptive);

#ifdef __cplusplus
}
#endif

#endif

/* A model and its inverse in a control loop, with PID feedback, for microcontrollers.
 *
 * At each sample: read the output, call hys_controller_step, write the drive. The inverse gives the
 * drive for the output that is due when the drive is seen to act; the feedback corrects what is
 * left.
 *
 *   - The integral stands still while the drive is at a limit, and the derivative is that of the
 *     measured output, so that a step of the reference gives no kick.
 *   - hys_controller_go_on_from takes over from another drive without a bump.
 *   - A missing reading is NaN. The inverse then goes on, and the feedback keeps its integral.
 *     Its other terms fade with the integral time. Without an integral term, and while the inverse
 *     asks for a limit, all is held.
 *   - A reading that stands still to the last bit where it has to move is taken as missing.
 *   - After a time without a reading, or with one that stands still, the drive is the safe one; so it
 *     is where the reading stands still but for its noise while the drive is at a limit.
 *
 *   - Where they were asked for: a gate, after which a spike is a missing reading until two more
 *     agree with it; a low-pass filter, which the reference has as well; the measured time of a
 *     sample.
 *
 * The results have the bits of the library's controller with a fixed model, without an inner loop,
 * in the same number type. What hysteron_mcu.h says of compilers and errors holds here.
 *
 * Worst case of one call of hys_controller_step: two steps and one inverse step of the model, and
 * at the first sample one copy of at most 4K + 8 turning points. A gate sorts 15 numbers, a filter
 * computes three exponentials, and measured time one for each time constant of the model. */
#ifndef HYSTERON_MCU_CONTROL_H
#define HYSTERON_MCU_CONTROL_H

#include "hysteron_mcu.h"

/* The parts that the code has, a bit for each: those that were asked for. */
#define HYS_LOOP 7u
#define HYS_HAS_GATE 1u
#define HYS_HAS_FILTER 2u
#define HYS_HAS_TIME 4u

#ifdef __cplusplus
extern "C" {
#endif

/* How the loop steps a model. A state with stages goes by its operators, its first member. */
typedef struct {
    int (*step)(hys_state *state, hys_real drive, hys_real *output);
    int (*invert)(hys_state *state, hys_real target, int heading, hys_real tolerance,
                  hys_real *drive, int *status);
    void (*copy)(hys_state *to, const hys_state *from);
} hys_in_loop;

extern const hys_in_loop hys_plain_in_loop, hys_staged_in_loop;

#if (HYS_LOOP & HYS_HAS_TIME) != 0u
/* What makes the constants of a model for a measured time (hysteron_mcu_clock.h). */
typedef struct hys_clock {
    int (*pass)(const struct hys_clock *self, hys_state *wanted, hys_state *followed, hys_real dt);
} hys_clock;
#endif

/* The settings of a loop. Written by `hysteron export c --controller`; a program may copy and
 * change them. Times in seconds. */
typedef struct {
    const hys_in_loop *model;
    size_t late;                       /* samples by which the output answers a drive too late */
    hys_real dt;                       /* between samples */
    hys_real gain, integral_s, derivative_s; /* of the PID; a time of 0 for no such term */
    hys_real tolerance;                /* reversals of the reference up to this are noise */
    hys_real drive_min, drive_max, safe;
    hys_real slew;                     /* of the drive, per second; 0 for no limit */
    hys_real range;                    /* of the model's output */
    hys_real repeats_s;                /* equal readings for so long are no readings; 0 where they
                                          are normal, as those of a coarse converter */
    hys_real lost_s, stuck_s;          /* until the drive is the safe one; 0 for never */
    unsigned char feedback;            /* 0 for the inverse alone */
    unsigned char falls;               /* 1 where the output falls as the drive rises */
#if HYS_LOOP != 0u
    unsigned char has;                 /* which of its parts this loop has */
#endif
#if (HYS_LOOP & HYS_HAS_GATE) != 0u
    hys_real gate;                     /* what deviates by less is never held back */
#endif
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    hys_real filter_s;                 /* time constant of the filter */
#endif
#if (HYS_LOOP & HYS_HAS_TIME) != 0u
    const hys_clock *clock;            /* null where the model does not depend on time */
#endif
} hys_control;

#if (HYS_LOOP & HYS_HAS_GATE) != 0u
#define HYS_REMEMBERED 15u /* deviations that the usual one is taken from */

/* What a gate remembers: the last reading that it believed, the change that led there, the samples
 * since, and the sizes of the last deviations. */
typedef struct {
    hys_real believed, slope, steps, deviations[HYS_REMEMBERED];
    unsigned char known, next;
    signed char beyond;                /* readings beyond it in a row; negative below it */
} hys_spikes;

/* Whether a finite reading is believed. `expected` is by how much the model's output changed, and a
 * deviation up to `least` is never held back. */
int hys_gate_passes(hys_spikes *self, hys_real least, hys_real reading, hys_real expected);
#endif


/* What a controller remembers. Only these functions may use its members. */
typedef struct {
    const hys_control *control;
    hys_state *wanted, *followed;
    hys_real *under_way;
    size_t place;
    hys_real from, fade, drive, acting, prediction; /* NaN where there is none */
    hys_real integral, measured, slope, correction; /* of the PID */
    hys_real low, high;                /* of the reference, since it turned */
    hys_real last, gap, silent;        /* reading; s without one */
    hys_real since_reading, since_expected, since_drive, still_s; /* since it stands still */
    hys_real near_reading, near_expected; /* the same but for its noise */
    unsigned char still, news;
    signed char branch;                /* of the reference */
    unsigned char left;
    unsigned aimed : 1, begun : 1, held_low : 1, held_high : 1, repeats : 1, is_safe : 1;
#if (HYS_LOOP & HYS_HAS_GATE) != 0u
    hys_spikes gate;
#endif
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    hys_real seen, given, asked;       /* reading, drive and reference behind the filter */
#endif
#if (HYS_LOOP & HYS_HAS_TIME) != 0u
    hys_real dt;                       /* of this sample */
#endif
} hys_controller;

/* Flags of a sample. */
enum {
    HYS_AT_LIMIT = 1,      /* the drive is at a limit, or as fast as it may change */
    HYS_OUT_OF_REACH = 2,  /* no input gives the reference: the nearest one was taken */
    HYS_NO_READING = 4,    /* the reading was missing or held back; the loop went on without it */
    HYS_STUCK = 8,         /* the reading stands still where it has to move */
    HYS_SAFE = 16,         /* the loop is given up: the drive is the safe one */
    HYS_OUTLIER = 64       /* the gate held the reading back */
};

typedef struct {
    hys_real drive;        /* to write */
    hys_real prediction;   /* the output that the model expected; NaN where none follows */
    unsigned char status;
} hys_action;

/* Starts a controller in front of an actuator at rest. `wanted` and `followed` are two started
 * states of the model: that of the inverse, and one that follows the drive and says what to expect.
 * With a null pointer for `followed` nobody knows whether a reading that stands still has to move,
 * and it is believed: other limits then have to keep the actuator whole. `under_way` has `count`
 * elements, at least `control->late`. Errors: HYS_NULL, HYS_MEMORY_TOO_SMALL,
 * HYS_STATE_MISMATCH. */
int hys_controller_start(hys_controller *self, const hys_control *control, hys_state *wanted,
                         hys_state *followed, hys_real *under_way, size_t count);

/* Goes on from `drive` at the next sample without a bump, also out of the safe state. Error:
 * HYS_INPUT_NOT_FINITE. */
int hys_controller_go_on_from(hys_controller *self, hys_real drive);

/* One sample: `reference` is wanted now, `ahead` when the drive is seen to act, `late` + 1 samples
 * later (the same as `reference` where that is not known). `heading` is the direction that `ahead`
 * takes next, as for hys_inverse_step, or HYS_HOLD. The drive is within its limits, whatever the
 * reading is. Errors: HYS_INPUT_NOT_FINITE for a reference that is not finite, and nothing is
 * changed then; those of the model's inverse. */
int hys_controller_step(hys_controller *self, hys_real reference, hys_real ahead, int heading,
                        hys_real reading, hys_action *action);

#if (HYS_LOOP & HYS_HAS_TIME) != 0u
/* The same, `dt` s after the sample before. Nothing is changed by these errors: HYS_VALUE for a `dt`
 * that is not finite and above zero, or another than that of a loop that was exported without
 * measured time; HYS_STATE_MISMATCH for states of another model. */
int hys_controller_step_after(hys_controller *self, hys_real dt, hys_real reference,
                              hys_real ahead, int heading, hys_real reading, hys_action *action);
#endif

#ifdef __cplusplus
}
#endif

#endif

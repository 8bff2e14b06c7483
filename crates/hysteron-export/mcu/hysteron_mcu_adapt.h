/* Weights that follow the plant while an exported model runs: the normalised gradient (Goodwin & Sin 1984, section 3.3) over
 * all weights and the offset, with dead zone, leakage, a gate and a trial against the last good weights. The digits of the library's
 * `Estimator` with `Method::Gradient`. Its other methods stay on the host: the gradient needs one table, tells its worst case
 * without a look at the input, and knows nothing of the noise.
 *
 *     static hys_real memory[SPRING_ADAPT_NUMBERS];
 *     static hys_turn turns[SPRING_TURNS];
 *     static hys_adaptive adaptive;
 *     hys_adapt_options options;
 *     hys_adapt_defaults(&options);
 *     hys_adapt_start(&adaptive, &spring, spring_weights, spring.offset, &options, memory, SPRING_ADAPT_NUMBERS,
 *                     turns, SPRING_TURNS);
 *     hys_adapt_step(&adaptive, temperature, displacement, &expected, &outcome);      each sample
 *
 * For a compensator start a second state over `&adaptive.model`, and before each of its inverse steps call hys_rebase.
 * A hys_adaptive must not be copied or moved: states point into it.
 *
 * Worst case of hys_adapt_step, N = K(K + 1)/2 operators: a hys_step, five passes over the N operators and one over the
 * table, a hys_rebase; at the end of a trial two copies of N + 1 numbers. Where others moved the state in between, one more
 * pass over the operators for each of its turning points, at most 4K + 3. */
#ifndef HYSTERON_MCU_ADAPT_H
#define HYSTERON_MCU_ADAPT_H

#include "hysteron_mcu.h"

#if HYS_LAYOUT != 2
#error "hysteron_mcu_adapt: export the model again: hysteron_mcu.h is of another version"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The default of each, and its range. */
typedef struct {
    hys_real gain;          /* 0.3, above 0 and below 2: 1 takes nearly the whole error of a sample away */
    hys_real offset_share;  /* 1, from 0: how freely the offset moves, beside one weight */
    hys_real dead_zone;     /* 0, from 0: errors up to this are noise, in the output's unit */
    hys_real leakage;       /* 0, 0 to 1: share by which weights return to the off-line ones with each update */
    hys_real movement;      /* 0.05, from 0: levels between two samples that are learned from */
    hys_real gate;          /* 12, 0 or from 2: surprises above so many usual ones teach nothing; 0: all do */
    uint32_t trial;         /* 256, from 1: samples on which weights are judged against the last good ones */
    uint32_t burst;         /* 8, from 1: readings in a row beyond the gate, that agree, are a jump */
} hys_adapt_options;

/* What was done with a sample. */
enum {
    HYS_LEARNED = 0,        /* the weights moved */
    HYS_WAITING = 1,        /* the error was within the dead zone */
    HYS_AT_REST = 2,        /* the input did not move */
    HYS_FROZEN = 3,
    HYS_ROLLED_BACK = 4,    /* the weights did far worse than the last good ones, or overflowed: these are back */
    HYS_REJECTED = 5        /* the reading is too far from what was expected, and not for long */
};

/* What has been seen of the errors of predictions. */
typedef struct {
    hys_real range;     /* of the model's output at the start */
    hys_real scale;     /* usual size of a surprise: an error less the one left before */
    hys_real left;      /* after the last reading believed */
    hys_real last;      /* surprise of the last reading refused */
    uint32_t refused, agreeing; /* in a row */
} hys_gate;

/* To be read by these functions alone, but for `model`, which is the model as it is now, and `state`. */
typedef struct {
    hys_model model;
    hys_state state;
    hys_adapt_options options;
    hys_real seen_x, seen_end, seen_part; /* of the state, where the operators stand */
    size_t seen_top, seen_cell;
    const hys_real *offline;    /* N weights */
    hys_real *theta, *good, *candidate; /* N weights and the offset's deviation in units of its share, each */
    hys_real *table;
    hys_real *gamma;            /* N operator states */
    hys_real offset;            /* off-line, without sign */
    hys_real floor;
    hys_real learned;           /* position last learned from */
    hys_real now_squares, candidate_squares, good_squares, rounding_squares; /* of the trial */
    hys_gate gate;
    uint32_t samples;           /* of the trial */
    unsigned char aligned, frozen;
} hys_adaptive;

void hys_adapt_defaults(hys_adapt_options *options);

/* Starts with every operator off, from `weights` (N, row by row) and `offset`: those exported, or what was learned before.
 * `model` and `weights` are not changed and have to stay; `memory` has `numbers` elements, NAME_ADAPT_NUMBERS of the model at
 * least, `turns` has `count`, as for hys_start. HYS_NULL, HYS_MEMORY_TOO_SMALL, HYS_ADAPTATION, HYS_NEGATIVE_WEIGHTS,
 * HYS_WEIGHT_NOT_FINITE, HYS_INPUT_NOT_FINITE (the offset). */
int hys_adapt_start(hys_adaptive *adaptive, const hys_model *model, const hys_real *weights, hys_real offset,
                    const hys_adapt_options *options, hys_real *memory, size_t numbers, hys_turn *turns, size_t count);

/* Moves `adaptive->state` to `input`, writes the output expected there, and learns from the one `measured`. `*outcome` is
 * one of HYS_LEARNED to HYS_REJECTED. HYS_INPUT_NOT_FINITE. */
int hys_adapt_step(hys_adaptive *adaptive, hys_real input, hys_real measured, hys_real *output, int *outcome);

/* The weights as they are now, N; the offset is adaptive->model.offset. */
const hys_real *hys_adapt_weights(const hys_adaptive *adaptive);

/* While frozen (not 0), steps predict and nothing is learned. */
int hys_adapt_freeze(hys_adaptive *adaptive, int frozen);

/* Takes the present weights as the last good ones. */
int hys_adapt_keep(hys_adaptive *adaptive);

/* Goes back to the last good weights. */
int hys_adapt_roll_back(hys_adaptive *adaptive);

/* To be called after hys_reset_off, hys_reset_on or hys_restore of `adaptive->state`. */
int hys_adapt_realign(hys_adaptive *adaptive);

#ifdef __cplusplus
}
#endif

#endif

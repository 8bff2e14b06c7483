/* Weights that follow the plant while an exported model runs.
 *
 * The method is the normalised gradient (Goodwin & Sin 1984, section 3.3) for all weights and the
 * offset, with dead zone, leakage, a gate, a watch for channels that stand still, and a trial
 * against the last good weights. The results
 * have the same bits as those of the library's `Estimator` with `Method::Gradient`. The other
 * methods of the library run on a host only: the gradient needs one table and no knowledge of the
 * noise, and its worst case does not depend on the input.
 *
 *     static hys_real memory[SPRING_ADAPT_NUMBERS];
 *     static hys_turn turns[SPRING_TURNS];
 *     static hys_adaptive adaptive;
 *     hys_adapt_options options;
 *     hys_adapt_defaults(&options);
 *     hys_adapt_start(&adaptive, &spring, spring_weights, spring.offset, &options, memory,
 *                     SPRING_ADAPT_NUMBERS, turns, SPRING_TURNS);
 *     hys_adapt_step(&adaptive, temperature, displacement, &expected, &outcome);   each sample
 *
 * For a compensator, start a second state of `&adaptive.model` and call hys_rebase before each of
 * its inverse steps. A hys_adaptive must not be copied or moved, because states point into it.
 *
 * Worst case of hys_adapt_step, with N = K(K + 1)/2 operators: a hys_step, five passes over the
 * operators, one over the table, a hys_rebase, and at the end of a trial and of a stretch of the
 * watch two copies of N + 1 numbers each. Where others moved the state in between, one more pass over the operators for each
 * turning point, at most 4K + 3. */
#ifndef HYSTERON_MCU_ADAPT_H
#define HYSTERON_MCU_ADAPT_H

#include "hysteron_mcu.h"

#if HYS_LAYOUT != 2
#error "hysteron_mcu_adapt: export the model again: hysteron_mcu.h is of another version"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Options, each with its default and its range. */
typedef struct {
    hys_real gain;          /* 0.3, above 0, below 2: 1 removes nearly the whole error of a sample */
    hys_real offset_share;  /* 1, from 0: how freely the offset moves, relative to one weight */
    hys_real dead_zone;     /* 0, from 0: errors up to this are noise, in the output's unit */
    hys_real leakage;       /* 0, 0 to 1: fraction of the way back to the off-line weights */
    hys_real movement;      /* 0.05, from 0: levels between two samples that are learned from */
    hys_real gate;          /* 12, 0 or from 2: surprises above so many usual ones are refused; with
                             * 0 no channel is watched either */
    uint32_t trial;         /* 256, from 1: samples until weights are compared with the good ones */
    uint32_t burst;         /* 8, from 1: so many refused readings in a row that agree are a jump */
} hys_adapt_options;

/* Outcome of a sample. */
enum {
    HYS_LEARNED = 0,        /* the weights moved */
    HYS_WAITING = 1,        /* the error lies within the dead zone */
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

/* A stretch in which a channel travelled half of the range: lowest and highest values of this
 * channel, of the one it is compared with, and of the position. */
typedef struct {
    hys_real low[3], high[3], travel;
    uint32_t readings;      /* 0 before the first */
    unsigned char begun;
} hys_piece;

/* The last stretches of a channel, the present one first. */
typedef struct {
    hys_piece pieces[4];
    hys_real anchor;        /* where the travel was last counted */
} hys_trail;

/* What the watch knows of both channels. */
typedef struct {
    hys_real range, width;  /* of the output, and of the plane in levels */
    hys_trail output, input;
    hys_real last;          /* the last reading */
    int stuck;              /* HYS_OUTPUT_STUCK, HYS_INPUT_STUCK or 0 */
} hys_watch;

/* A model that learns. Applications may use `model`, the model as it is now, and `state`. Only
 * these functions may use the other members. */
typedef struct {
    hys_model model;
    hys_state state;
    hys_adapt_options options;
    /* The position and branch of the state that the operators' states belong to. */
    hys_real seen_x, seen_end, seen_part;
    size_t seen_top, seen_cell;
    const hys_real *offline;    /* N weights */
    /* Each has N weights, and the deviation of the offset in units of offset_share. */
    hys_real *theta, *good, *candidate;
    hys_real *trusted;          /* from before the last stretch in which the output moved */
    hys_real *pending;          /* from before the present stretch */
    hys_real *table;
    hys_real *gamma;            /* N operator states */
    hys_real offset;            /* off-line, without sign */
    hys_real floor;
    hys_real learned;           /* position of the last sample learned from */
    /* Sums of squared errors over the trial. */
    hys_real now_squares, candidate_squares, good_squares, rounding_squares;
    hys_gate gate;
    hys_watch watch;
    hys_real expected;          /* output expected by the off-line weights, but for a constant */
    uint32_t samples;           /* samples in the trial */
    unsigned char aligned, frozen;
    unsigned char undone;       /* the watch took back what the table still has */
} hys_adaptive;

/* Writes the default options. */
void hys_adapt_defaults(hys_adapt_options *options);

/* Starts with every operator off, from `weights` (N, row by row) and `offset`: those exported, or
 * those learned before. `model` and `weights` are not changed, and have to stay in memory. `memory`
 * has `numbers` elements, at least NAME_ADAPT_NUMBERS of the model. `turns` has `count` elements,
 * as for hys_start. Errors: HYS_NULL, HYS_MEMORY_TOO_SMALL, HYS_ADAPTATION, HYS_NEGATIVE_WEIGHTS,
 * HYS_WEIGHT_NOT_FINITE, HYS_INPUT_NOT_FINITE (the offset). */
int hys_adapt_start(hys_adaptive *adaptive, const hys_model *model, const hys_real *weights,
                    hys_real offset, const hys_adapt_options *options, hys_real *memory,
                    size_t numbers, hys_turn *turns, size_t count);

/* Moves `adaptive->state` to `input`, writes the output predicted there, and learns from the output
 * `measured`. `*outcome` becomes one of HYS_LEARNED to HYS_INPUT_STUCK. Error: HYS_INPUT_NOT_FINITE.
 */
int hys_adapt_step(hys_adaptive *adaptive, hys_real input, hys_real measured, hys_real *output,
                   int *outcome);

/* The present N weights, row by row; NULL before hys_adapt_start. adaptive->model.offset is the
 * offset. */
const hys_real *hys_adapt_weights(const hys_adaptive *adaptive);

/* Stops learning (`frozen` not 0), or resumes it (0). A frozen model still predicts. */
int hys_adapt_freeze(hys_adaptive *adaptive, int frozen);

/* Takes the present weights as the last good ones. */
int hys_adapt_keep(hys_adaptive *adaptive);

/* Returns to the last good weights. */
int hys_adapt_roll_back(hys_adaptive *adaptive);

/* Call it after hys_reset_off, hys_reset_on or hys_restore of `adaptive->state`. */
int hys_adapt_realign(hys_adaptive *adaptive);

#ifdef __cplusplus
}
#endif

#endif

/* Hysteresis models of actuators (MKP, KP, Preisach relay) and their exact inverse, for microcontrollers.
 *
 * C99, freestanding: no heap, no library, no recursion, no global that changes. A model is constant and may lie in flash. A
 * state is one struct and one array of the caller; each actuator needs its own, and several threads need a state each.
 *
 * Same digits as the library on a host. That asks of the compiler what C99's Annex F asks:
 *   - no fused multiply-add. The source forbids it by pragma. GCC obeys under every flag, Clang under every one but
 *     -ffp-contract=fast, which nothing in the source can tell; elsewhere use the flag that does what
 *     -ffp-contract=off does there,
 *   - no -ffast-math or what else reorders sums,
 *   - results rounded to their type (FLT_EVAL_METHOD 0; on 32-bit x86: -msse2 -mfpmath=sse),
 *   - rounding to nearest, and subnormal numbers kept (both are so after the reset of a Cortex-M).
 * Where the compiler tells of another choice, compilation stops.
 *
 * Worst case of one call, K levels:
 *   hys_step           passes at most 2K turning points, in a loop of at most 2K + 3 iterations
 *   hys_inverse_step   two bisections of at most log2(2K + 1) + 1 and log2(K) + 1 halvings, then one hys_step
 *   hys_reset_on       one hys_step;  hys_start, hys_reset_off: none of these loops
 *   hys_save, hys_rebase   one pass over at most 4K + 3 points
 *   hys_restore        one hys_step for each point
 *
 * Every function returns HYS_OK or why it refused; then state and results are as they were. */
#ifndef HYSTERON_MCU_H
#define HYSTERON_MCU_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error "hysteron_mcu: compile without -ffast-math: NaN has to be told and sums have to keep their order"
#endif
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1
#error "hysteron_mcu: results must be rounded to their type (FLT_EVAL_METHOD 0); on 32-bit x86: -msse2 -mfpmath=sse"
#endif

/* Models that were exported for another layout do not compile. */
#define HYS_LAYOUT 2

#ifdef __cplusplus
extern "C" {
#endif

typedef float hys_real;

/* Status codes: the numbers of the library's errors. */
enum {
    HYS_OK = 0,
    HYS_WEIGHT_NOT_FINITE = 4,  /* a weight, or the weights' sum, is not finite (adaptation) */
    HYS_NEGATIVE_WEIGHTS = 5,   /* the model has weights below zero: there is no inverse */
    HYS_MEMORY_TOO_SMALL = 6,   /* too few turning points, or too small an array */
    HYS_INPUT_NOT_FINITE = 7,   /* input or target is NaN or infinite, or the target overflows */
    HYS_TURNING_POINTS = 8,     /* points to restore do not nest */
    HYS_STATE_MISMATCH = 9,     /* the state was never started */
    HYS_ADAPTATION = 11,        /* an option of the adaptation is out of its range */
    HYS_NULL = 100,             /* a null pointer */
    HYS_VALUE = 103             /* not one of the values allowed */
};

/* What an inverse step says of a target. HYS_PASSED: it lies inside a jump of a relay model, and the output lies beyond it. */
enum { HYS_LOW = -1, HYS_REACHED = 0, HYS_HIGH = 1, HYS_PASSED = 2 };

/* Where a target goes next; any but HYS_HOLD crosses the dead band at once. */
enum { HYS_FALLING = -1, HYS_HOLD = 0, HYS_RISING = 1 };

/* A turning point: the normalised position 0 <= x <= K, and the sum of weights times states there. */
typedef struct {
    hys_real x, y;
} hys_turn;

/* A model: written by `hysteron export c`, and not to be changed. */
typedef struct {
    const hys_real *table;  /* Everett table C[p][q], 0 <= q <= p <= K, row by row */
    size_t levels;          /* K */
    hys_real top;           /* K as a number */
    hys_real min, max;      /* lowest and highest level */
    hys_real bottom;        /* one step below the lowest level */
    hys_real step;          /* distance between levels */
    hys_real per_unit;      /* 1/step, rounded up */
    hys_real nudge;         /* the least move that is one */
    hys_real total;         /* sum of all weights */
    hys_real rounding;         /* outputs closer than this are equal */
    hys_real offset;        /* output with a sum of zero */
    unsigned char kind;     /* operators: 0 MKP, 1 KP, 2 relay */
    unsigned char falls;    /* 1 where the output falls as the operators switch on */
    unsigned char inverse;  /* 1 where no weight is below zero */
} hys_model;

/* What a model remembers of its input. To be read by these functions alone; a copy shares the turning points. */
typedef struct {
    const hys_model *model;
    hys_turn *turns;
    size_t top;             /* turning point at which the branch being travelled began; odd: a minimum */
    size_t began_cell;      /* that turning point's grid cell and the part of it, */
    hys_real began_part;
    hys_real began_y;       /* and the sum there */
    hys_real end;           /* position of the extreme that ends the branch */
    hys_real x, y;          /* present position, and the sum there */
    hys_real input;         /* last input, as given */
} hys_state;

/* Starts a state with every operator off. `turns` has `count` elements, at least 4K + 8 (NAME_TURNS of the model), and is
 * the state's from now on. HYS_NULL, HYS_MEMORY_TOO_SMALL. */
int hys_start(const hys_model *model, hys_state *state, hys_turn *turns, size_t count);

/* Every operator off, the input one step below the lowest level. */
int hys_reset_off(hys_state *state);

/* Every operator on, the input at the highest level. */
int hys_reset_on(hys_state *state);

/* Moves to `input` and writes the output. Inputs beyond the plane act as its ends. HYS_INPUT_NOT_FINITE. */
int hys_step(hys_state *state, hys_real input, hys_real *output);

/* Finds the input that gives `target`, moves there and writes it. `heading` says where the target goes next: HYS_HOLD (the
 * input stands still with the target), HYS_RISING or HYS_FALLING. A target that goes back by up to `tolerance`, in the
 * output's unit, stands still too; below zero it is zero. `*status` is HYS_REACHED where the output is the target, up to
 * the tolerance; HYS_LOW or HYS_HIGH for a target that lies below or above every output: the input is then that end of
 * the plane; HYS_PASSED for a target that the output jumps past. HYS_VALUE, HYS_NEGATIVE_WEIGHTS,
 * HYS_INPUT_NOT_FINITE. */
int hys_inverse_step(hys_state *state, hys_real target, int heading, hys_real tolerance, hys_real *input, int *status);

/* Writes what hys_restore needs: the turning points as positions in [0, K] and the last input. `*count` is how many
 * points there are, at most 4K + 3, also where `capacity` is too small for them: HYS_MEMORY_TOO_SMALL. */
int hys_save(const hys_state *state, hys_real *points, size_t capacity, size_t *count, hys_real *input);

/* Works out the sums of a state anew after the weights of its model changed; the operators stay as they are. Only models
 * that learn (hysteron_mcu_adapt.h) do so. One pass over at most 4K + 3 points. */
int hys_rebase(hys_state *state);

/* Puts a started state of the same model back to what was saved, bit for bit. HYS_TURNING_POINTS, HYS_INPUT_NOT_FINITE. */
int hys_restore(hys_state *state, const hys_real *points, size_t count, hys_real input);

#ifdef __cplusplus
}
#endif

#endif

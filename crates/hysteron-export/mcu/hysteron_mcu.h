/* Hysteresis models of actuators (MKP, KP, Preisach relay) and their exact inverse, for
 * microcontrollers.
 *
 * C99, freestanding: no heap, no library, no recursion, no global variables. A model is constant
 * and may lie in flash. A state is one struct and one array of the caller. Each actuator needs a
 * state of its own. Several threads need a state each.
 *
 * The results have the same bits as those of the library on a host. The compiler has to follow
 * Annex F of C99 for this:
 *   - No fused multiply-add. The source forbids it by pragma. GCC obeys the pragma with all flags,
 *     Clang with all but -ffp-contract=fast, which the source cannot detect. For other compilers
 *     use the flag that corresponds to -ffp-contract=off.
 *   - No -ffast-math, and no other option that reorders sums.
 *   - Results are rounded to their type (FLT_EVAL_METHOD 0; on 32-bit x86: -msse2 -mfpmath=sse).
 *   - Rounding to nearest, and subnormal numbers are kept. Both hold after the reset of a Cortex-M.
 * Compilation stops where the compiler reports another choice.
 *
 * Worst case of one call with K levels:
 *   hys_step               passes at most 2K corners, in a loop of at most 2K + 3 iterations
 *   hys_inverse_step       two bisections, of at most log2(2K + 1) + 1 and log2(K) + 1 halvings,
 *                          then one hys_step
 *   hys_reset_on           one hys_step
 *   hys_start, hys_reset_off   none of these loops
 *   hys_save, hys_rebase   one pass over at most 4K + 3 points
 *   hys_restore            one hys_step for each point
 *
 * Every function returns HYS_OK or an error code. After an error, state and results stay as they
 * are. */
#ifndef HYSTERON_MCU_H
#define HYSTERON_MCU_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error "hysteron_mcu: compile without -ffast-math: NaN has to be detected and sums have to keep their order"
#endif
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1
#error "hysteron_mcu: results must be rounded to their type (FLT_EVAL_METHOD 0); on 32-bit x86: -msse2 -mfpmath=sse"
#endif

/* Layout of hys_model. Models that were exported for another layout do not compile. */
#define HYS_LAYOUT 3

/* Tables are the most of a model. An AVR copies constants into its RAM unless they are told to stay
 * in flash, which it reads with instructions of its own. Tables that are made on the target are in
 * RAM: programs with weights that learn or depend on the load define HYS_TABLES_IN_RAM for all
 * files. */
#if defined(__AVR__) && !defined(HYS_TABLES_IN_RAM)
#include <avr/pgmspace.h>
#define HYS_IN_FLASH PROGMEM
#define HYS_READ(number) pgm_read_float(number)
#else
#define HYS_IN_FLASH
#define HYS_READ(number) (*(number))
#endif

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
    HYS_NULL = 100,             /* a pointer is null */
    HYS_VALUE = 103             /* a value is not one of those allowed */
};

/* Status of an inverse step. HYS_PASSED: the target lies inside a jump of a relay model, and the
 * output lies beyond it. */
enum { HYS_LOW = -1, HYS_REACHED = 0, HYS_HIGH = 1, HYS_PASSED = 2 };

/* Where a target goes next. With HYS_RISING and HYS_FALLING the input crosses a dead band at once.
 */
enum { HYS_FALLING = -1, HYS_HOLD = 0, HYS_RISING = 1 };

/* A turning point: the normalised position 0 <= x <= K, and the sum of weights times operator
 * states there. */
typedef struct {
    hys_real x, y;
} hys_turn;

/* A model. Written by `hysteron export c`; do not change it. Levels are in the input's unit, sums
 * and offset in the output's unit. */
typedef struct {
    const hys_real *table;  /* Everett table C[p][q], 0 <= q <= p <= K, row by row; HYS_READ */
    size_t levels;          /* K */
    hys_real top;           /* K as a number */
    hys_real min, max;      /* lowest and highest level */
    hys_real bottom;        /* one step below the lowest level */
    hys_real step;          /* distance between levels */
    hys_real per_unit;      /* 1/step, rounded up */
    hys_real nudge;         /* least change of the input that a relay sees */
    hys_real total;         /* sum of all weights */
    hys_real rounding;         /* outputs closer than this are taken as equal */
    hys_real offset;        /* output where the sum is zero */
    unsigned char kind;     /* operators: 0 MKP, 1 KP, 2 relay */
    unsigned char falls;    /* 1 where the output falls as the operators switch on */
    unsigned char inverse;  /* 1 where no weight is below zero */
} hys_model;

/* The state of a model. Only these functions may use its members. A copy has the same array of
 * turning points, so it is no independent state. */
typedef struct {
    const hys_model *model;
    hys_turn *turns;
    size_t top;             /* turning point at which the present branch began; odd: a minimum */
    size_t began_cell;      /* grid cell of that turning point */
    hys_real began_part;    /* fraction of that cell */
    hys_real began_y;       /* sum there */
    hys_real end;           /* position of the extreme that ends the branch */
    hys_real x, y;          /* present position, and the sum there */
    hys_real input;         /* last input, as given */
} hys_state;

/* Starts a state with every operator off. `turns` has `count` elements, at least 4K + 8 (NAME_TURNS
 * of the model). The state uses this array from now on. Errors: HYS_NULL, HYS_MEMORY_TOO_SMALL. */
int hys_start(const hys_model *model, hys_state *state, hys_turn *turns, size_t count);

/* Switches every operator off. The input is then one step below the lowest level. */
int hys_reset_off(hys_state *state);

/* Switches every operator on. The input is then the highest level. */
int hys_reset_on(hys_state *state);

/* Moves to `input` and writes the output. Inputs beyond the plane act as its ends. Error:
 * HYS_INPUT_NOT_FINITE. */
int hys_step(hys_state *state, hys_real input, hys_real *output);

/* Finds the input that gives `target`, moves there and writes it.
 *
 * `heading` is HYS_HOLD to hold the target: the input stands still while the target does. To
 * anticipate the target it is the direction in which the target goes next, HYS_RISING or
 * HYS_FALLING. A target that goes back by up to `tolerance`, in the output's unit, is held. A
 * tolerance below zero counts as zero.
 *
 * `*status` becomes HYS_REACHED if the output is the target, up to the tolerance. It becomes
 * HYS_LOW or HYS_HIGH for a target below or above every output; the input is then that end of the
 * plane. It becomes HYS_PASSED for a target that the output jumps past.
 *
 * Errors: HYS_VALUE, HYS_NEGATIVE_WEIGHTS, HYS_INPUT_NOT_FINITE. */
int hys_inverse_step(hys_state *state, hys_real target, int heading, hys_real tolerance,
                     hys_real *input, int *status);

/* Writes what hys_restore needs: the turning points as positions in [0, K], and the last input.
 * `*count` becomes the number of points, at most 4K + 3, also if `capacity` is too small for them:
 * HYS_MEMORY_TOO_SMALL. */
int hys_save(const hys_state *state, hys_real *points, size_t capacity, size_t *count, hys_real *input);

/* Computes the sums of a state again after the weights of its model changed. The operators stay as
 * they are. Only models that learn need it (hysteron_mcu_adapt.h). One pass over at most 4K + 3
 * points. */
int hys_rebase(hys_state *state);

/* Restores, bit for bit, what hys_save wrote, in a started state of the same model. Errors:
 * HYS_TURNING_POINTS, HYS_INPUT_NOT_FINITE. */
int hys_restore(hys_state *state, const hys_real *points, size_t count, hys_real input);

#ifdef __cplusplus
}
#endif

#endif

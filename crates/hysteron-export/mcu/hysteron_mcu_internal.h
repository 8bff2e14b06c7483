/* Declarations that the source files share. Not for applications. */
#ifndef HYSTERON_MCU_INTERNAL_H
#define HYSTERON_MCU_INTERNAL_H

#include "hysteron_mcu.h"

/* No product may be fused with a sum. GCC does not know the pragma of the standard. It may also
 * replace loops that copy by calls of memcpy, which a target without a C library does not have. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("fp-contract=off", "no-tree-loop-distribute-patterns")
#else
#pragma STDC FP_CONTRACT OFF
#endif

/* float also needs sums in float. FLT_EVAL_METHOD 1 would compute them in double. */
#ifdef FLT_EVAL_METHOD
typedef char hys_float_is_float[FLT_EVAL_METHOD == 0 || sizeof(hys_real) == sizeof(double) ? 1 : -1];
#endif

#define ZERO ((hys_real)0)
#define ONE ((hys_real)1)
#define HALF ((hys_real)0.5)

/* Index of the first turning point of every history: the input at the bottom of the plane. It is a
 * minimum, as are all turning points with an odd index. The elements before it are sentinels with
 * infinite positions. There are enough of them that merging can look two corners back without a
 * special case. */
#define LOOK 4u
#define START (LOOK + 1u)

enum { MKP = 0, RELAY = 2 };

static inline int is_finite(hys_real x)
{
    return x - x == ZERO;
}

/* Prefixed, because many platforms define max and min as macros. The second number where they are
 * equal or one is NaN. */
static inline hys_real hys_max(hys_real a, hys_real b)
{
    return a > b ? a : b;
}

static inline hys_real hys_min(hys_real a, hys_real b)
{
    return a < b ? a : b;
}

static inline hys_real hys_clamp(hys_real x, hys_real low, hys_real high)
{
    return hys_min(hys_max(x, low), high);
}

/* K and positions fit int32_t. Its conversions are one instruction on most targets. */
static inline hys_real number(size_t n)
{
    return (hys_real)(int32_t)n;
}

static inline size_t whole(hys_real x)
{
    return (size_t)(int32_t)x;
}

/* The input at a normalised position. */
static inline hys_real denormalise(const hys_model *model, hys_real x)
{
    return x >= model->top ? model->max : model->min + (x - ONE) * model->step;
}

static inline hys_real level(const hys_model *model, size_t k)
{
    return denormalise(model, number(k));
}

/* The normalised position of an input: k at level k, 0 at one step below the lowest level. */
static inline hys_real normalise(const hys_model *model, hys_real input)
{
    return hys_clamp((input - model->min) * model->per_unit + ONE, ZERO, model->top);
}

/* A normalised position as its grid cell and the fraction of that cell, 0 <= part <= 1. */
typedef struct {
    size_t cell;
    hys_real part;
} split;

/* A position on a grid line belongs to the even one of its two cells, or to the last cell at the
 * end of the plane. The Everett function is continuous, but its rounding differs between the cells.
 * The library takes the same cell. */
static inline split split_of(const hys_model *model, hys_real x)
{
    split at;
    at.cell = whole(x);
    at.part = x - number(at.cell);
    if (at.part == ZERO && ((at.cell & 1u) != 0u || at.cell == model->levels)) {
        at.cell -= 1u;
        at.part = ONE;
    }
    return at;
}

/* Index of C[p][q]. */
static inline size_t table_index(size_t p, size_t q)
{
    return p * (p + 1u) / 2u + q;
}

/* The Everett function: by how much the output falls when the input falls from a maximum to a
 * minimum, min <= max. It is linear on each of the two triangles of a grid cell. */
static inline hys_real everett(const hys_model *model, split max, split min)
{
    const hys_real *row = model->table + table_index(max.cell, min.cell);
    hys_real near = HYS_READ(row);
    hys_real far = HYS_READ(row + (max.cell + 2u));
    if (max.part > min.part) {
        hys_real mid = HYS_READ(row + (max.cell + 1u));
        return near + max.part * (mid - near) + min.part * (far - mid);
    } else {
        hys_real mid = HYS_READ(row + 1);
        return near + min.part * (mid - near) + max.part * (far - mid);
    }
}

/* The sum of the operators' outputs, from that of weights times states in [0, 1]. Outputs of KP and
 * relay operators are from -1 to 1. */
static inline hys_real own_sum(const hys_model *model, hys_real sum)
{
    return model->kind == MKP ? sum : sum + sum - model->total;
}

static inline int is_rising(const hys_state *state)
{
    return (state->top & 1u) == (START & 1u);
}

static inline int usable_state(const hys_state *state)
{
    if (state == NULL) {
        return HYS_NULL;
    }
    return state->model == NULL || state->turns == NULL ? HYS_STATE_MISMATCH : HYS_OK;
}

#endif

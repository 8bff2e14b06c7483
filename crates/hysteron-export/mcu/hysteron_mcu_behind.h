/* The stages behind the operators, which forward step and inverse share. Not for applications.
 *
 * Each follows its file in the core, operation by operation. `memory` and `factors` are those of
 * the stage alone. At rest, at the first sample, nothing of a past is left: factors are zero. */
#ifndef HYSTERON_MCU_BEHIND_H
#define HYSTERON_MCU_BEHIND_H

#include "hysteron_mcu_internal.h"
#include "hysteron_mcu_stages.h"

/* The stages by their numbers, and where their memory and factors begin. */
enum { CURVE = 0, CREEP = 1, LAG = 2, RING = 3 };
enum { CREEP_MEMORY = 0, LAG_MEMORY = 4, RING_MEMORY = 5 };
enum { CREEP_FACTORS = 0, LAG_FACTORS = 4, RING_FACTORS = 5 };
enum { MOST_CREEP = 4 };

/* From what to what the exact inverse of a ring may alternate, as a part of the range of sums. */
#define LITTLE ((hys_real)1 / (hys_real)128)

/* Whether the code has a stage; those around the axis have the numbers behind these. */
enum { LOAD = 4, REGISTRATION = 5, SPACING = 6, LATENT = 7 };
#define HAS(stage) ((HYS_STAGES >> (stage) & 1u) != 0u)

/* And whether an actuator has it: a macro, so that compilers for size leave out the others too. */
#define is_there(actuator, stage) (HAS(stage) && ((actuator)->there >> (stage) & 1u) != 0u)

/* The linear piece for x: between knots k and k + 1. Beyond the ends it is the outermost one. */
static inline size_t piece(const hys_real *knots, size_t count, hys_real x)
{
    size_t low = 0u, high = count;
    while (low < high) { /* at most log2(count) + 1 iterations */
        size_t middle = low + (high - low) / 2u;
        if (knots[middle] <= x) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    if (low == 0u) {
        return 0u;
    }
    return low == count ? count - 2u : low - 1u;
}

/* The line between two knots. At a knot it is exact. */
static inline hys_real line(hys_real x, hys_real x0, hys_real x1, hys_real y0, hys_real y1)
{
    hys_real slope;
    if (x == x1) {
        return y1;
    }
    slope = (y1 - y0) / (x1 - x0);
    return y0 + (x - x0) * slope;
}

/* A line through knots at x. */
static inline hys_real between(const hys_list *x, const hys_list *y, hys_real at)
{
    size_t k = piece(x->numbers, x->count, at);
    return line(at, x->numbers[k], x->numbers[k + 1u], y->numbers[k], y->numbers[k + 1u]);
}

/* Creep: h and a share of each of its lags. */
static inline hys_real creep_forward(const hys_actuator *actuator, hys_real *memory, int rests,
                                     hys_real h)
{
    const hys_real *fade = actuator->factors + CREEP_FACTORS;
    hys_real sum = h, *crept = memory + CREEP_MEMORY;
    size_t k;
    for (k = 0u; rests && k < MOST_CREEP; k++) {
        crept[k] = h;
    }
    for (k = 0u; k < actuator->creep.count; k++) { /* at most MOST_CREEP iterations */
        crept[k] = h + (crept[k] - h) * (rests ? ZERO : fade[k]);
        sum = sum + actuator->creep.numbers[k] * crept[k];
    }
    return sum;
}

static inline hys_real creep_steepest(const hys_actuator *actuator, int rests)
{
    const hys_real *fade = actuator->factors + CREEP_FACTORS;
    hys_real gain = ONE;
    size_t k;
    if (rests) {
        return actuator->slopes[CREEP];
    }
    for (k = 0u; k < actuator->creep.count; k++) { /* at most MOST_CREEP iterations */
        gain = gain + actuator->creep.numbers[k] * (ONE - fade[k]);
    }
    return gain;
}

static inline hys_real creep_inverse(const hys_actuator *actuator, const hys_real *memory,
                                     int rests, hys_real sum)
{
    const hys_real *fade = actuator->factors + CREEP_FACTORS;
    hys_real base = ZERO;
    size_t k;
    for (k = 0u; !rests && k < actuator->creep.count; k++) { /* at most MOST_CREEP iterations */
        base = base + actuator->creep.numbers[k] * fade[k] * memory[CREEP_MEMORY + k];
    }
    return (sum - base) / creep_steepest(actuator, rests);
}

/* A lag of the whole. */
static inline hys_real lag_forward(const hys_actuator *actuator, hys_real *memory, int rests,
                                   hys_real sum)
{
    hys_real *lagged = memory + LAG_MEMORY;
    *lagged = sum + ((rests ? sum : *lagged) - sum) * (rests ? ZERO : actuator->factors[LAG_FACTORS]);
    return *lagged;
}

static inline hys_real lag_inverse(const hys_actuator *actuator, const hys_real *memory, int rests,
                                   hys_real output)
{
    hys_real fade = actuator->factors[LAG_FACTORS];
    return rests ? output : (output - memory[LAG_MEMORY] * fade) / (ONE - fade);
}

/* A ring: output, velocity and the output last wanted; 1 - a, b, d of a sample. */
static inline hys_real ring_forward(const hys_actuator *actuator, hys_real *memory, int rests,
                                    hys_real x)
{
    const hys_real *factor = actuator->factors + RING_FACTORS;
    hys_real *ring = memory + RING_MEMORY;
    hys_real gain = rests ? ZERO : factor[0], b = rests ? ZERO : factor[1];
    hys_real d = rests ? ZERO : factor[2], at = rests ? x : ring[0], v = rests ? ZERO : ring[1];
    hys_real gap = x - at;
    ring[0] = at + (gain * gap + b * v);
    ring[1] = b * gap + d * v;
    ring[2] = ring[0];
    return ring[0];
}

/* The sums that may be wanted: exact, soft, calm, and the two between which the exact inverse would
 * alternate afterwards. */
typedef struct {
    hys_real exact, soft, calm, low, high;
} ring_aims;

static inline ring_aims aims_of_ring(const hys_actuator *actuator, const hys_real *memory,
                                     int rests, hys_real y)
{
    const hys_real *factor = actuator->factors + RING_FACTORS, *ring = memory + RING_MEMORY;
    hys_real gain = factor[0], b = factor[1], d = factor[2];
    hys_real at = ring[0], v = ring[1], wanted = ring[2], zeta;
    hys_real rise, still, all, rate, half, follow, off, swing, least, most, loss, damp;
    ring_aims aims;
    if (rests) {
        aims.exact = aims.soft = aims.calm = aims.low = aims.high = y;
        return aims;
    }
    zeta = actuator->ring_damping.numbers[0];
    aims.exact = at + (y - at - b * v) / gain;
    /* What a sampled ramp of this slope has: its velocity at the samples, and its input. */
    rise = y - wanted;
    still = ONE - d;
    all = gain * still + b * b;
    rate = rise * b / all;
    follow = wanted + rise * still / all;
    half = (hys_real)0.5 * b;
    aims.soft = at + (y - at - b * v + half * (rate - d * v)) / (gain + half * b);
    off = b / gain * (b * (aims.exact - at) + d * v - rate);
    swing = hys_max(off, -off);
    least = at + (gain * (y - at - b * v) + b * (rate - d * v)) / (gain * gain + b * b);
    most = least - follow;
    loss = ONE - zeta;
    damp = (loss + loss) * (rate - v);
    aims.calm = follow + hys_clamp(damp, hys_min(most, ZERO), hys_max(most, ZERO));
    aims.low = follow - swing;
    aims.high = follow + swing;
    return aims;
}

/* The output for the operators' sum. */
static inline hys_real behind_forward(hys_actuator_state *state, hys_real x)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started;
    if (is_there(actuator, CURVE)) {
        x = between(&actuator->curve_sums, &actuator->curve_outputs, x);
    }
    if (is_there(actuator, CREEP)) {
        x = creep_forward(actuator, state->behind, rests, x);
    }
    if (is_there(actuator, LAG)) {
        x = lag_forward(actuator, state->behind, rests, x);
    }
    if (is_there(actuator, RING)) {
        x = ring_forward(actuator, state->behind, rests, x);
    }
    return x;
}

/* The operators' sum for an output of the stages before the ring, from the last to the first. */
static inline hys_real before_ring_inverse(const hys_actuator_state *state, hys_real y)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started;
    if (is_there(actuator, LAG)) {
        y = lag_inverse(actuator, state->behind, rests, y);
    }
    if (is_there(actuator, CREEP)) {
        y = creep_inverse(actuator, state->behind, rests, y);
    }
    if (is_there(actuator, CURVE)) {
        y = between(&actuator->curve_outputs, &actuator->curve_sums, y);
    }
    return y;
}

/* The operators' sum that is wanted for an output in this sample, where sums reach from `low` to
 * `high`. Where the exact inverse of a ring would alternate by more than a little, it is led there
 * softly, and calmly where that would go beyond the range of sums. */
static inline hys_real behind_inverse(const hys_actuator_state *state, hys_real y, hys_real low,
                                      hys_real high)
{
    const hys_actuator *actuator = state->actuator;
    ring_aims aims;
    hys_real exact, from, to, alternates;
    if (!is_there(actuator, RING)) {
        return before_ring_inverse(state, y);
    }
    aims = aims_of_ring(actuator, state->behind, !state->started, y);
    exact = before_ring_inverse(state, aims.exact);
    from = before_ring_inverse(state, aims.low);
    to = before_ring_inverse(state, aims.high);
    if (low <= exact && exact <= high && low <= from && from <= high && low <= to && to <= high) {
        alternates = hys_max(to - from, from - to);
        return alternates <= (high - low) * LITTLE ? exact : before_ring_inverse(state, aims.soft);
    }
    return is_finite(exact) ? before_ring_inverse(state, aims.calm) : exact;
}

/* Keeps the output that was wanted, from which the next inverse knows how fast the target moves. */
static inline void keep_wanted(hys_actuator_state *state, hys_real y)
{
    if (is_there(state->actuator, RING)) {
        state->behind[RING_MEMORY + 2] = y;
    }
}

/* The steepest slope of the output over the operators' sum in this sample. */
static inline hys_real behind_steepest(const hys_actuator_state *state)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started;
    hys_real slope = is_there(actuator, CURVE) ? actuator->slopes[CURVE] : ONE;
    if (is_there(actuator, CREEP)) {
        slope = slope * creep_steepest(actuator, rests);
    }
    if (is_there(actuator, LAG) && !rests) {
        slope = slope * (ONE - actuator->factors[LAG_FACTORS]);
    }
    if (is_there(actuator, RING) && !rests) {
        slope = slope * actuator->factors[RING_FACTORS];
    }
    return slope;
}

/* The output at rest, where the operators' sum has always been x. */
static inline hys_real behind_settled(const hys_actuator *actuator, hys_real x)
{
    if (is_there(actuator, CURVE)) {
        x = between(&actuator->curve_sums, &actuator->curve_outputs, x);
    }
    return is_there(actuator, CREEP) ? actuator->slopes[CREEP] * x : x;
}

#endif

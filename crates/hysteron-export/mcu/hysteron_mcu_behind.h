/* The stages behind the operators, which forward step and inverse share. Not for applications.
 *
 * Each follows its file in the core, operation by operation. `memory` and `factors` are those of
 * the stage alone. At rest, at the first sample, nothing of a past is left: factors are zero. */
#ifndef HYSTERON_MCU_BEHIND_H
#define HYSTERON_MCU_BEHIND_H

#include "hysteron_mcu_internal.h"
#include "hysteron_mcu_stages.h"

/* The stages by their numbers, and where their memory and factors begin. */
enum { CREEP = 0, LAG = 1 };
enum { CREEP_MEMORY = 0, LAG_MEMORY = 4 };
enum { CREEP_FACTORS = 0, LAG_FACTORS = 4 };
enum { MOST_CREEP = 4 };

static inline int is_there(const hys_actuator *actuator, unsigned stage)
{
    return (actuator->there >> stage & 1u) != 0u;
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

/* The output for the operators' sum. */
static inline hys_real behind_forward(hys_actuator_state *state, hys_real x)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started;
    if (is_there(actuator, CREEP)) {
        x = creep_forward(actuator, state->behind, rests, x);
    }
    if (is_there(actuator, LAG)) {
        x = lag_forward(actuator, state->behind, rests, x);
    }
    return x;
}

/* The operators' sum for an output, from the last stage to the first. */
static inline hys_real behind_inverse(const hys_actuator_state *state, hys_real y)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started;
    if (is_there(actuator, LAG)) {
        y = lag_inverse(actuator, state->behind, rests, y);
    }
    if (is_there(actuator, CREEP)) {
        y = creep_inverse(actuator, state->behind, rests, y);
    }
    return y;
}

/* The steepest slope of the output over the operators' sum in this sample. */
static inline hys_real behind_steepest(const hys_actuator_state *state)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started;
    hys_real slope = ONE;
    if (is_there(actuator, CREEP)) {
        slope = creep_steepest(actuator, rests);
    }
    if (is_there(actuator, LAG) && !rests) {
        slope = slope * (ONE - actuator->factors[LAG_FACTORS]);
    }
    return slope;
}

/* The output at rest, where the operators' sum has always been x. */
static inline hys_real behind_settled(const hys_actuator *actuator, hys_real x)
{
    return is_there(actuator, CREEP) ? actuator->slopes[CREEP] * x : x;
}

#endif

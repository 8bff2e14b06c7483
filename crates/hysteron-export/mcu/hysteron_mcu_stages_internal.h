/* Load and spacing, which forward step and inverse share. Not for applications. */
#ifndef HYSTERON_MCU_STAGES_INTERNAL_H
#define HYSTERON_MCU_STAGES_INTERNAL_H

#include "hysteron_mcu_behind.h"

/* The distance from one to the next larger number. */
#define HYS_EPSILON \
    (sizeof(hys_real) == sizeof(double) ? (hys_real)DBL_EPSILON : (hys_real)FLT_EPSILON)

/* The values of all curves at one load. */
typedef struct {
    hys_real scale, shift, gain, offset;
} loaded_axis;

static inline int usable_actuator(const hys_actuator_state *state)
{
    if (state == NULL) {
        return HYS_NULL;
    }
    return state->actuator == NULL ? HYS_STATE_MISMATCH : usable_state(&state->operators);
}

/* Brings the operators to a load, where their weights depend on it. They stay as they are. */
static inline int place(hys_actuator_state *state, hys_real load)
{
    hys_mixed *mixed = state->mixed;
    if (mixed == NULL || load == mixed->load) {
        return HYS_OK;
    }
    return mixed->place(mixed, state->actuator->parts, &state->operators, load);
}

/* The output where the operators' sum is zero. */
static inline hys_real offset_of(const hys_actuator_state *state)
{
    return state->mixed == NULL ? state->actuator->offset : state->mixed->offset;
}

/* A curve at a load within the range, or `none` without the curve. */
static inline hys_real curve(const hys_list *loads, const hys_list *values, hys_real none,
                             hys_real load)
{
    const hys_real *x = loads->numbers, *y = values->numbers;
    size_t k;
    if (y == NULL) {
        return none;
    }
    if (loads->count == 1u) {
        return y[0];
    }
    k = piece(x, loads->count, load);
    return line(load, x[k], x[k + 1u], y[k], y[k + 1u]);
}

static inline int curves_at(const hys_actuator *actuator, hys_real load, loaded_axis *at)
{
    const hys_list *loads = &actuator->loads;
    at->scale = ONE;
    at->shift = ZERO;
    at->gain = ONE;
    at->offset = ZERO;
    if (loads->numbers == NULL) {
        return HYS_OK;
    }
    if (!is_finite(load)) {
        return HYS_LOAD;
    }
    load = hys_clamp(load, loads->numbers[0], loads->numbers[loads->count - 1u]);
    at->scale = curve(loads, &actuator->scales, ONE, load);
    at->shift = curve(loads, &actuator->shifts, ZERO, load);
    at->gain = curve(loads, &actuator->gains, ONE, load);
    at->offset = curve(loads, &actuator->offsets, ZERO, load);
    return HYS_OK;
}

/* The temperature after a sample time in which `drive` was held. It moves towards its value at rest
 * and never beyond it, so one time constant holds for all of the sample time. */
static inline hys_real heated(const hys_actuator_state *state, hys_real drive)
{
    const hys_actuator *actuator = state->actuator;
    hys_real rest, factor;
    if (!actuator->body) {
        return drive;
    }
    rest = actuator->ambient + actuator->gain * drive;
    if (!state->started) {
        return rest;
    }
    factor = rest > state->temperature ? actuator->heating : actuator->cooling;
    return rest + (state->temperature - rest) * factor;
}

/* The operators' input at a temperature. */
static inline hys_real seen_at(const hys_actuator *actuator, const loaded_axis *at,
                               hys_real temperature)
{
    const hys_model *model = actuator->operators;
    const hys_real *corners = actuator->spacing.numbers;
    hys_real effective = at->scale * temperature - at->shift;
    size_t k;
    if (corners == NULL) {
        return effective;
    }
    k = piece(corners, model->levels + 1u, effective);
    return line(effective, corners[k], corners[k + 1u], level(model, k), level(model, k + 1u));
}

#endif

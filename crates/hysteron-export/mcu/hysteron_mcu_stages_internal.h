/* Load, registration and spacing, which forward step and inverse share. Not for applications. */
#ifndef HYSTERON_MCU_STAGES_INTERNAL_H
#define HYSTERON_MCU_STAGES_INTERNAL_H

#include "hysteron_mcu_behind.h"

/* The distance from one to the next larger number. */
#define HYS_EPSILON \
    (sizeof(hys_real) == sizeof(double) ? (hys_real)DBL_EPSILON : (hys_real)FLT_EPSILON)

/* The values of all curves at one load. */
typedef struct {
    hys_real scale, shift, gain, offset;
    /* The row of the registration at the load below, and how far it is on the way to the next. */
    size_t row;
    hys_real part;
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
    size_t row = 0u, end;
    at->row = 0u;
    at->part = ZERO;
    at->scale = ONE;
    at->shift = ZERO;
    at->gain = ONE;
    at->offset = ZERO;
    if (!HAS(LOAD) || loads->numbers == NULL) {
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
    end = loads->count;
    while (row + 1u < end) { /* at most log2(n) + 1 iterations */
        size_t middle = row + (end - row) / 2u;
        if (loads->numbers[middle] <= load) {
            row = middle;
        } else {
            end = middle;
        }
    }
    at->row = row;
    if (row + 1u < loads->count) {
        at->part = (load - loads->numbers[row]) / (loads->numbers[row + 1u] - loads->numbers[row]);
    }
    return HYS_OK;
}

/* The rows of a registration for rising or for falling input, from that of the load on. */
static inline const hys_real *rows_of(const hys_actuator *actuator, const loaded_axis *at,
                                      int rising)
{
    const hys_real *falling = actuator->falling.numbers;
    const hys_real *rows = rising || falling == NULL ? actuator->rising.numbers : falling;
    return rows + at->row * actuator->knots.count;
}

/* The temperature at knot m. */
static inline hys_real at_knot(const hys_actuator *actuator, const loaded_axis *at,
                               const hys_real *rows, size_t m)
{
    hys_real low = rows[m];
    return at->part == ZERO ? low : low + at->part * (rows[actuator->knots.count + m] - low);
}

/* From a temperature to the position on the axis, or back: linear between the knots, and of slope
 * one beyond them. */
static inline hys_real registered(const hys_actuator *actuator, const loaded_axis *at, int rising,
                                  int back, hys_real value)
{
    const hys_real *knots = actuator->knots.numbers;
    const hys_real *rows = rows_of(actuator, at, rising);
    size_t low = 0u, high = actuator->knots.count - 1u;
    hys_real x = back ? knots[low] : at_knot(actuator, at, rows, low);
    hys_real y = back ? at_knot(actuator, at, rows, low) : knots[low];
    hys_real next_x, next_y, slope;
    if (value <= x) {
        return y + (value - x);
    }
    x = back ? knots[high] : at_knot(actuator, at, rows, high);
    y = back ? at_knot(actuator, at, rows, high) : knots[high];
    if (value >= x) {
        return y + (value - x);
    }
    while (low + 1u < high) { /* at most log2 of the number of knots, and 1 more, iterations */
        size_t middle = low + (high - low) / 2u;
        x = back ? knots[middle] : at_knot(actuator, at, rows, middle);
        if (x <= value) {
            low = middle;
        } else {
            high = middle;
        }
    }
    x = back ? knots[low] : at_knot(actuator, at, rows, low);
    y = back ? at_knot(actuator, at, rows, low) : knots[low];
    next_x = back ? knots[high] : at_knot(actuator, at, rows, high);
    next_y = back ? at_knot(actuator, at, rows, high) : knots[high];
    slope = (next_y - y) / (next_x - x);
    return y + (value - x) * slope;
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

/* The operators' input at a position on the axis. */
static inline hys_real placed(const hys_actuator *actuator, hys_real position)
{
    const hys_model *model = actuator->operators;
    const hys_real *corners = HAS(SPACING) ? actuator->spacing.numbers : NULL;
    size_t k;
    if (corners == NULL) {
        return position;
    }
    k = piece(corners, model->levels + 1u, position);
    return line(position, corners[k], corners[k + 1u], level(model, k), level(model, k + 1u));
}

/* The operators' input to which a temperature leads them from below, or from above. */
static inline hys_real led_to(const hys_actuator *actuator, const loaded_axis *at, int rising,
                              hys_real temperature)
{
    hys_real effective = at->scale * temperature - at->shift;
    if (HAS(REGISTRATION) && actuator->knots.numbers != NULL) {
        effective = registered(actuator, at, rising, 0, effective);
    }
    return placed(actuator, effective);
}

/* The operators' input at a temperature, where it was `held` before. */
static inline hys_real seen_at(const hys_actuator *actuator, const loaded_axis *at, hys_real held,
                               hys_real temperature)
{
    hys_real least = led_to(actuator, at, 1, temperature);
    if (!HAS(REGISTRATION) || actuator->falling.numbers == NULL) {
        return least;
    }
    return hys_max(least, hys_min(held, led_to(actuator, at, 0, temperature)));
}

/* The temperature that leads the operators to an input, from below or from above. */
static inline hys_real leading_to(const hys_actuator *actuator, const loaded_axis *at, int rising,
                                  hys_real input)
{
    const hys_model *model = actuator->operators;
    const hys_real *corners = HAS(SPACING) ? actuator->spacing.numbers : NULL;
    hys_real effective = input;
    if (corners != NULL) {
        size_t k = 0u, end = model->levels - 1u;
        hys_real from, to;
        while (k < end) { /* at most log2(K) + 1 iterations */
            size_t middle = k + (end - k + 1u) / 2u;
            if (level(model, middle) <= input) {
                k = middle;
            } else {
                end = middle - 1u;
            }
        }
        from = level(model, k);
        to = level(model, k + 1u);
        effective = input == to
            ? corners[k + 1u]
            : corners[k] + (input - from) * ((corners[k + 1u] - corners[k]) / (to - from));
    }
    if (HAS(REGISTRATION) && actuator->knots.numbers != NULL) {
        effective = registered(actuator, at, rising, 1, effective);
    }
    return (effective + at->shift) / at->scale;
}

#endif

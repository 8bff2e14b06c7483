/* Heat that the operators bind while they switch on, and give back: forward step and inverse share it.
 * Not for applications. */
#ifndef HYSTERON_MCU_LATENT_H
#define HYSTERON_MCU_LATENT_H

#include "hysteron_mcu_stages_internal.h"

/* A way of the operators in one direction, on which a body would come to the temperature `unbound`
 * if nothing were bound. */
typedef struct {
    const hys_actuator_state *state;
    const loaded_axis *at;
    hys_real unbound;
    hys_turn began; /* the turning point at which the branch began */
    int rising;
} heat_way;

/* The heat that is bound where the weighted sum of the states is `sum`, in degrees. */
static inline hys_real taken(const hys_actuator_state *state, hys_real sum)
{
    return state->actuator->latent * ((sum - state->operators.y) / state->operators.model->total);
}

/* The weighted sum of the states at a position, on the branch that began at a turning point. */
static inline hys_real along_branch(const hys_model *model, hys_turn began, hys_real x)
{
    split here = split_of(model, began.x), there = split_of(model, x);
    return x > began.x ? began.y + everett(model, there, here)
                       : began.y - everett(model, here, there);
}

static inline hys_real sum_at(const heat_way *way, hys_real x)
{
    return along_branch(way->state->operators.model, way->began, x);
}

/* The temperature at a position of the operators. */
static inline hys_real degrees_at(const heat_way *way, hys_real x)
{
    const hys_actuator *actuator = way->state->actuator;
    return leading_to(actuator, way->at, way->rising, denormalise(actuator->operators, x));
}

/* What the temperature there would be if nothing were bound. */
static inline hys_real heat_at(const heat_way *way, hys_real x, hys_real sum)
{
    return degrees_at(way, x) + taken(way->state, sum);
}

static inline int is_above(const heat_way *way, hys_real x)
{
    return heat_at(way, x, sum_at(way, x)) >= way->unbound;
}

/* The innermost branch whose end the way does not pass. Returns where the branch ends, and writes
 * where the way enters it. With `to` the way goes to that position, else as far as the heat does. */
static inline hys_real find_branch(heat_way *way, const hys_real *to, hys_real *start)
{
    const hys_state *state = &way->state->operators;
    const hys_turn *turns = state->turns + (START - 1u);
    size_t kind = way->rising ? 0u : 1u;
    size_t last = state->top - START + 1u; /* of the turns; after it comes the present position */
    size_t low = 1u, high = (last - kind) / 2u + 1u, end;
    while (low < high) { /* at most log2(2K + 1) + 1 iterations */
        size_t middle = low + (high - low) / 2u;
        hys_turn turn = turns[2u * middle + kind];
        int met;
        if (to != NULL) {
            met = way->rising ? turn.x >= *to : turn.x <= *to;
        } else {
            met = (heat_at(way, turn.x, turn.y) >= way->unbound) == way->rising;
        }
        if (met) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    end = 2u * (low - 1u) + kind;
    if (end < last) {
        way->began = turns[end + 1u];
    } else {
        way->began.x = state->x;
        way->began.y = state->y;
    }
    *start = end + 1u < last ? turns[end + 2u].x : state->x;
    return turns[end].x;
}

/* Makes the piece shorter where x lies in it, so that what is above is still at its end and not at
 * its start. Returns whether x is at the end or beyond it. */
static inline int cut_at(const heat_way *way, hys_real *piece_of, hys_real x)
{
    if (x >= piece_of[1] || (piece_of[0] < x && is_above(way, x))) {
        piece_of[1] = hys_min(piece_of[1], x);
        return 1;
    }
    piece_of[0] = hys_max(piece_of[0], x);
    return 0;
}

/* Cuts the piece at the grid lines, or at the knots of the registration. */
static inline void cut_at_all(const heat_way *way, hys_real *piece_of, const hys_list *knots)
{
    const hys_actuator *actuator = way->state->actuator;
    const hys_model *model = actuator->operators;
    size_t low = 0u, high = knots == NULL ? model->levels + 1u : knots->count;
    while (low < high) { /* at most log2(count) + 1 iterations */
        size_t middle = low + (high - low) / 2u;
        hys_real x = knots == NULL
            ? number(middle)
            : normalise(model, placed(actuator, knots->numbers[middle]));
        if (cut_at(way, piece_of, x)) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
}

/* Whether heat is bound on the way to a temperature, and which way it is. */
static inline int binds(const hys_actuator_state *state, const loaded_axis *at,
                        hys_real temperature, heat_way *way, hys_real *to)
{
    const hys_actuator *actuator = state->actuator;
    if (!HAS(LATENT) || actuator->latent == ZERO || !state->started
        || state->operators.model->total == ZERO) {
        return 0;
    }
    *to = normalise(actuator->operators, seen_at(actuator, at, state->operators.input, temperature));
    way->state = state;
    way->at = at;
    way->unbound = temperature;
    way->rising = *to > state->operators.x;
    return *to != state->operators.x;
}

/* The temperature of a body that would come to `temperature` if nothing were bound. Between turning
 * points, grid lines and knots what it binds is straight over the position. */
static inline hys_real bound(const hys_actuator_state *state, const loaded_axis *at,
                             hys_real temperature)
{
    const hys_actuator *actuator = state->actuator;
    const hys_model *model = actuator->operators;
    heat_way way;
    hys_real piece_of[2], end, start, middle, from, to, low, high;
    if (!binds(state, at, temperature, &way, &to)) {
        return temperature;
    }
    end = hys_min(find_branch(&way, NULL, &start), model->top);
    if (is_above(&way, end) != way.rising) {
        /* Beyond the plane nothing more is bound. */
        return temperature - taken(state, sum_at(&way, end));
    }
    piece_of[0] = way.rising ? start : end;
    piece_of[1] = way.rising ? end : start;
    cut_at_all(&way, piece_of, NULL);
    /* The two triangles of a cell meet where both positions have the same part. */
    middle = HALF * piece_of[0] + HALF * piece_of[1];
    middle = number(split_of(model, middle).cell) + split_of(model, way.began.x).part;
    cut_at(&way, piece_of, middle);
    if (HAS(REGISTRATION)) {
        cut_at_all(&way, piece_of, &actuator->knots);
    }
    from = degrees_at(&way, piece_of[0]);
    to = degrees_at(&way, piece_of[1]);
    low = heat_at(&way, piece_of[0], sum_at(&way, piece_of[0]));
    high = heat_at(&way, piece_of[1], sum_at(&way, piece_of[1]));
    return high > low
        ? hys_clamp(from + (temperature - low) * ((to - from) / (high - low)), from, to)
        : from;
}

/* The temperature that a body would have if nothing were bound on the way to `temperature`. */
static inline hys_real unbound(const hys_actuator_state *state, const loaded_axis *at,
                               hys_real temperature)
{
    heat_way way;
    hys_real to, start;
    if (!binds(state, at, temperature, &way, &to)) {
        return temperature;
    }
    find_branch(&way, &to, &start);
    return temperature + taken(state, sum_at(&way, to));
}

#endif

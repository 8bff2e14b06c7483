/* The inverse step. Applications that only run models forward do not need this file. */
#include "hysteron_mcu_internal.h"

/* A goal for the output on a way: to reach `value`, or with `beyond` to go beyond it. `limit` is
 * the value with the rounding error allowed. */
typedef struct {
    hys_real value, limit;
    int beyond;
} goal;

static int met_rising(goal to, hys_real output)
{
    return to.beyond ? output > to.limit : output >= to.limit;
}

static int met_falling(goal to, hys_real output)
{
    return to.beyond ? output < to.limit : output <= to.limit;
}

/* The goal for a way up to `value`. */
static goal upward(hys_real value, int beyond, hys_real rounding)
{
    goal to;
    to.value = value;
    to.limit = beyond ? value + rounding : value - rounding;
    to.beyond = beyond;
    return to;
}

static int within(hys_real a, hys_real b, hys_real distance)
{
    return a - b <= distance && b - a <= distance;
}

/* The distance, from 0 to `length`, at which a linear piece with this `slope` has risen by `rise`.
 */
static hys_real along(hys_real rise, hys_real slope, hys_real length)
{
    if (rise <= ZERO) {
        return ZERO;
    }
    return slope * length > rise ? rise / slope : length;
}

/* The section of a branch on which a goal is met: the turning point at which the branch began, and
 * the positions at which the input enters the branch and at which the branch ends. */
typedef struct {
    hys_turn began;
    hys_real start, end;
} branch;

/* Finds the branch that ends at the innermost extreme whose output meets the goal. Extremes of one
 * kind (0: maxima, 1: minima) are nested. The end of the plane counts as met. */
static branch find(const hys_state *state, size_t kind, goal to)
{
    const hys_turn *turns = state->turns + (START - 1u);
    size_t last = state->top - START + 1u; /* of the turns; after it comes the present position */
    size_t low = 1u, high = (last - kind) / 2u + 1u;
    size_t end;
    branch found;
    while (low < high) { /* at most log2(2K + 1) + 1 iterations */
        size_t middle = low + (high - low) / 2u;
        hys_real output = turns[2u * middle + kind].y;
        if (kind == 0u ? met_rising(to, output) : met_falling(to, output)) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    end = 2u * (low - 1u) + kind;
    if (end < last) {
        found.began = turns[end + 1u];
    } else {
        found.began.x = state->x;
        found.began.y = state->y;
    }
    found.start = end + 1u < last ? turns[end + 2u].x : state->x;
    found.end = turns[end].x;
    return found;
}

/* e(p, min) on the grid line p, from column q of the table, the column of the minimum. */
static hys_real on_row(const hys_model *model, size_t p, split min)
{
    const hys_real *row = model->table + table_index(p, min.cell);
    hys_real first = HYS_READ(row);
    return p > min.cell ? first + min.part * (HYS_READ(row + 1) - first) : ZERO;
}

/* The first x from `from` up at which e(x, min) meets the goal; K if there is none. */
static hys_real climb(const hys_model *model, hys_real min_x, hys_real from, goal to)
{
    split min = split_of(model, min_x);
    /* The first grid line beyond `from` that meets the goal: the crossing is in the cell before it.
 */
    size_t low = split_of(model, from).cell + 1u, high = model->levels + 1u, p;
    const hys_real *near, *below;
    hys_real knot = ZERO, slope = ZERO, u;
    int off_diagonal;
    while (low < high) { /* at most log2(K) + 1 iterations */
        size_t middle = low + (high - low) / 2u;
        if (met_rising(to, on_row(model, middle, min))) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    if (low > model->levels) {
        return model->top;
    }
    p = low - 1u;
    near = model->table + table_index(p, min.cell);
    below = near + (p + 1u);
    off_diagonal = p > min.cell;
    /* The two linear pieces, u <= v and u >= v, meet on the diagonal of the cell. u is the part of
     * x, v that of min. */
    if (off_diagonal) {
        knot = HYS_READ(near) + min.part * (HYS_READ(below + 1) - HYS_READ(near));
    }
    if (met_rising(to, knot)) {
        /* In a cell on the plane's diagonal this piece is zero and never has the crossing. */
        if (off_diagonal) {
            slope = HYS_READ(below + 1) - HYS_READ(near + 1);
        }
        u = along(to.value - on_row(model, p, min), slope, min.part);
    } else {
        u = min.part + along(to.value - knot, HYS_READ(below) - HYS_READ(near), ONE - min.part);
    }
    return number(p) + u;
}

/* e(max, q) on the grid line q, from rows p and p + 1 of the table, between which the maximum lies.
 */
static hys_real on_column(const hys_model *model, split max, size_t q)
{
    const hys_real *near = model->table + table_index(max.cell, q);
    hys_real first = HYS_READ(near);
    return first + max.part * (HYS_READ(near + (max.cell + 1u)) - first);
}

/* The first x from `from` down at which e(max, x) meets the goal; 0 if there is none. */
static hys_real descend(const hys_model *model, hys_real max_x, hys_real from, goal to)
{
    split max = split_of(model, max_x);
    size_t last = split_of(model, from).cell;
    size_t low = 0u, high = last + 1u, q;
    const hys_real *near, *below;
    hys_real knot = ZERO, slope = ZERO, v;
    int off_diagonal;
    /* The first grid line from `last` down to 0 that meets the goal. */
    while (low < high) { /* at most log2(K) + 1 iterations */
        size_t middle = low + (high - low) / 2u;
        if (met_rising(to, on_column(model, max, last - middle))) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    if (low > last) {
        return ZERO;
    }
    q = last - low;
    near = model->table + table_index(max.cell, q);
    below = near + (max.cell + 1u);
    off_diagonal = max.cell > q;
    if (off_diagonal) {
        knot = HYS_READ(near) + max.part * (HYS_READ(below + 1) - HYS_READ(near));
    }
    if (met_rising(to, knot)) {
        /* From v = 1, where the input enters the cell, back to the diagonal. */
        if (off_diagonal) {
            slope = HYS_READ(near) - HYS_READ(near + 1);
        }
        v = max.part + along(knot - to.value, slope, ONE - max.part);
    } else {
        v = along(on_column(model, max, q) - to.value, HYS_READ(below) - HYS_READ(below + 1), max.part);
    }
    return number(q) + v;
}

/* Where a way ends: the input, and the sum there. */
typedef struct {
    hys_real input, output;
} landing;

static hys_real lost(const hys_model *model, hys_real max, hys_real min)
{
    return everett(model, split_of(model, max), split_of(model, min));
}

/* The input that takes a relay model up to position `up`. It is the last input where the position
 * is there already or above. A relay switches on only where the input rises, so the input moves
 * even if it is the level already. */
static hys_real relay_up(const hys_state *state, size_t up)
{
    const hys_model *model = state->model;
    if (state->x >= number(up)) {
        return state->input;
    }
    return hys_max(level(model, up), state->input + model->nudge);
}

/* The input that takes a relay model down to position `down`, or the last input. The relays of the
 * level above `down` have to switch off for it. */
static hys_real relay_down(const hys_state *state, size_t down)
{
    const hys_model *model = state->model;
    if (state->x <= number(down)) {
        return state->input;
    }
    return hys_min(level(model, down + 1u), state->input - model->nudge);
}

/* The smallest whole number at or above a position in [0, K]. */
static size_t whole_above(const hys_model *model, hys_real x)
{
    size_t below = whole(x);
    return number(below) < x && below < model->levels ? below + 1u : below;
}

/* The first input on the way up at which the sum reaches `value`, or with `beyond` the last input
 * before the sum exceeds it. */
static landing rising_to(const hys_state *state, hys_real value, int beyond)
{
    const hys_model *model = state->model;
    branch on = find(state, 0u, upward(value, beyond, model->rounding));
    hys_real x = climb(model, on.began.x, on.start, upward(value - on.began.y, beyond, model->rounding));
    landing there;
    x = hys_clamp(x, on.start, on.end);
    if (model->kind == RELAY) {
        size_t up = beyond ? whole(x) : whole_above(model, x);
        there.input = relay_up(state, up);
        there.output = on.began.y + lost(model, number(up), on.began.x);
    } else {
        there.input = denormalise(model, x);
        there.output = value;
    }
    return there;
}

/* The same on the way down. */
static landing falling_to(const hys_state *state, hys_real value, int beyond)
{
    const hys_model *model = state->model;
    goal to;
    branch on;
    hys_real x;
    landing there;
    to.value = value;
    to.limit = beyond ? value - model->rounding : value + model->rounding;
    to.beyond = beyond;
    on = find(state, 1u, to);
    /* What the output lost since the branch began rises on the way down. */
    x = descend(model, on.began.x, on.start, upward(on.began.y - value, beyond, model->rounding));
    x = hys_clamp(x, on.end, on.start);
    if (model->kind == RELAY) {
        size_t down = beyond ? whole_above(model, x) : whole(x);
        there.input = relay_down(state, down);
        there.output = on.began.y - lost(model, on.began.x, number(down));
    } else {
        there.input = denormalise(model, x);
        there.output = value;
    }
    return there;
}

/* The edge of the dead band, upwards or downwards, if `wanted` rests in that dead band. It does
 * where it is near the sum at which the branch of that direction began and the sum has not moved
 * away from it. Returns whether it does. */
static int edge(const hys_state *state, int up, hys_real wanted, hys_real tolerance, hys_real reach, hys_real *input)
{
    hys_real rest = is_rising(state) == up ? state->began_y : state->y;
    if (!within(wanted, rest, reach)) {
        return 0;
    }
    /* No more than `tolerance` beyond the target and beyond the sum that it rests at. */
    if (up && state->y - wanted <= reach) {
        *input = rising_to(state, hys_min(wanted, rest) + tolerance, 1).input;
        return 1;
    }
    if (!up && wanted - state->y <= reach) {
        *input = falling_to(state, hys_max(wanted, rest) - tolerance, 1).input;
        return 1;
    }
    return 0;
}

/* The input for a target of the sum of the operators' outputs. `heading` and `status` refer to that
 * sum, too. */
static hys_real solve(const hys_state *state, hys_real target, int heading, hys_real tolerance, int *status)
{
    const hys_model *model = state->model;
    int relay = model->kind == RELAY, back;
    hys_real wanted = target, reach, nearest, input;
    landing there;
    tolerance = hys_max(tolerance, ZERO); /* NaN too */
    if (model->kind != MKP) {
        wanted = HALF * target + HALF * model->total;
        tolerance = HALF * tolerance;
    }
    reach = hys_max(tolerance, model->rounding);
    if (wanted - model->total > reach) {
        *status = HYS_HIGH;
        /* Relays that fell to the highest level need an input above it to switch on again. */
        return relay ? relay_up(state, model->levels) : model->max;
    }
    if (-wanted > reach) {
        *status = HYS_LOW;
        return model->bottom;
    }
    *status = HYS_REACHED;
    /* Tolerances count from the target itself, not from the nearest end of the range. */
    nearest = hys_clamp(wanted, ZERO, model->total);
    if (heading != HYS_HOLD && edge(state, heading == HYS_RISING, wanted, tolerance, reach, &input)) {
        return input;
    }
    back = (wanted > state->y) != is_rising(state);
    if (within(nearest, state->y, model->rounding) || (back && within(wanted, state->y, tolerance))) {
        /* An input beyond the plane is given as the nearest end, except for relays: on the way back
         * a relay switches at that end. */
        return relay ? state->input : hys_clamp(state->input, model->bottom, model->max);
    }
    there = nearest > state->y ? rising_to(state, nearest, 0) : falling_to(state, nearest, 0);
    if (relay && !within(there.output, wanted, reach + model->rounding)) {
        *status = HYS_PASSED;
    }
    return there.input;
}

int hys_inverse_step(hys_state *state, hys_real target, int heading, hys_real tolerance, hys_real *input, int *status)
{
    int found;
    hys_real to, output;
    int code = usable_state(state);
    if (code != HYS_OK) {
        return code;
    }
    if (input == NULL || status == NULL) {
        return HYS_NULL;
    }
    if (heading != HYS_HOLD && heading != HYS_RISING && heading != HYS_FALLING) {
        return HYS_VALUE;
    }
    if (!state->model->inverse) {
        return HYS_NEGATIVE_WEIGHTS;
    }
    target -= state->model->offset;
    if (!is_finite(target)) {
        return HYS_INPUT_NOT_FINITE;
    }
    if (state->model->falls) {
        target = -target;
        heading = -heading;
    }
    to = solve(state, target, heading, tolerance, &found);
    (void)hys_step(state, to, &output);
    *input = to;
    *status = state->model->falls && found != HYS_PASSED ? -found : found;
    return HYS_OK;
}

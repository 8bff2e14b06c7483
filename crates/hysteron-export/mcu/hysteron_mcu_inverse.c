/* The inverse step; whoever only runs models forward leaves this file out. */
#include "hysteron_mcu_internal.h"

#define HALF ((hys_real)0.5)

/* What an output on the way has to do: come to `value`, where the rounding makes `limit` enough, or, `beyond`, exceed it by
 * more than the rounding. */
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

/* The goal for a way up to `value`, of an output that is measured from where the branch began. */
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

/* How far along a linear piece of length `length` a rise of `rise` is reached. */
static hys_real along(hys_real rise, hys_real slope, hys_real length)
{
    if (rise <= ZERO) {
        return ZERO;
    }
    return slope * length > rise ? rise / slope : length;
}

/* The part of a branch that a goal is met on, once the turning points before it are passed. */
typedef struct {
    hys_turn began;
    hys_real start, end;
} branch;

/* Of the nested extremes of one kind (0: maxima, 1: minima), the innermost whose output meets the goal; the end of the
 * plane counts as met. */
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

/* e(p, min) on the grid line p: along column q of the table, v the part of the minimum. */
static hys_real on_row(const hys_model *model, size_t p, split min)
{
    const hys_real *row = model->table + table_index(p, min.cell);
    return p > min.cell ? row[0] + min.part * (row[1] - row[0]) : ZERO;
}

/* The first x from `from` up at which e(x, min) meets the goal. */
static hys_real climb(const hys_model *model, hys_real min_x, hys_real from, goal to)
{
    split min = split_of(model, min_x);
    /* Grid lines beyond `from`: first one that meets the goal, the crossing is in the cell before it. */
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
    /* The two pieces, u <= v and u >= v, meet where the diagonal of the cell is crossed. */
    if (off_diagonal) {
        knot = near[0] + min.part * (below[1] - near[0]);
    }
    if (met_rising(to, knot)) {
        /* On the diagonal cell this piece is zero and never holds the crossing. */
        if (off_diagonal) {
            slope = below[1] - near[1];
        }
        u = along(to.value - on_row(model, p, min), slope, min.part);
    } else {
        u = min.part + along(to.value - knot, below[0] - near[0], ONE - min.part);
    }
    return number(p) + u;
}

/* e(max, q) on the grid line q: between rows p and p + 1 of the table, u the part of the maximum. */
static hys_real on_column(const hys_model *model, split max, size_t q)
{
    const hys_real *near = model->table + table_index(max.cell, q);
    return near[0] + max.part * (near[max.cell + 1u] - near[0]);
}

/* The first x from `from` down at which e(max, x) meets the goal. */
static hys_real descend(const hys_model *model, hys_real max_x, hys_real from, goal to)
{
    split max = split_of(model, max_x);
    size_t last = split_of(model, from).cell;
    size_t low = 0u, high = last + 1u, q;
    const hys_real *near, *below;
    hys_real knot = ZERO, slope = ZERO, v;
    int off_diagonal;
    /* Columns from `last` down to 0: the first whose grid line meets the goal. */
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
        knot = near[0] + max.part * (below[1] - near[0]);
    }
    if (met_rising(to, knot)) {
        /* From v = 1, where the cell is entered, back to the diagonal. */
        if (off_diagonal) {
            slope = near[0] - near[1];
        }
        v = max.part + along(knot - to.value, slope, ONE - max.part);
    } else {
        v = along(on_column(model, max, q) - to.value, below[0] - below[1], max.part);
    }
    return number(q) + v;
}

/* Where a way along a branch ends: the input, and the sum there. */
typedef struct {
    hys_real input, output;
} landing;

static hys_real lost(const hys_model *model, hys_real max, hys_real min)
{
    return everett(model, split_of(model, max), split_of(model, min));
}

/* The input that takes a relay up to position `up`; the last input, where it is there or above. A relay switches on only
 * where the input rises, so the input moves even if the level is the last input. */
static hys_real relay_up(const hys_state *state, size_t up)
{
    const hys_model *model = state->model;
    if (state->x >= number(up)) {
        return state->input;
    }
    return hys_max(level(model, up), state->input + model->nudge);
}

/* The input that takes a relay down to position `down`, where the level above it switches off. */
static hys_real relay_down(const hys_state *state, size_t down)
{
    const hys_model *model = state->model;
    if (state->x <= number(down)) {
        return state->input;
    }
    return hys_min(level(model, down + 1u), state->input - model->nudge);
}

/* The whole number at or above a position. */
static size_t whole_above(const hys_model *model, hys_real x)
{
    size_t below = whole(x);
    return number(below) < x && below < model->levels ? below + 1u : below;
}

/* The first input on the way up at which the sum comes to `value`, or the last one before it goes `beyond` it. */
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
    /* What the output lost since the branch began rises. */
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

/* The edge of the dead band towards `up` or down, if `wanted` rests there: it is near the sum at which the branch of that
 * direction began, and the sum has not moved away from there. */
static int edge(const hys_state *state, int up, hys_real wanted, hys_real tolerance, hys_real reach, hys_real *input)
{
    hys_real rest = is_rising(state) == up ? state->began_y : state->y;
    if (!within(wanted, rest, reach)) {
        return 0;
    }
    /* No further than `tolerance` beyond the target, nor beyond the sum that it rests at. */
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

/* The input for a target of the operators' own sum; `heading` and `status` are of that, too. */
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
        /* For a relay that fell to the highest level, this level no longer switches it on. */
        return relay ? relay_up(state, model->levels) : model->max;
    }
    if (-wanted > reach) {
        *status = HYS_LOW;
        return model->bottom;
    }
    *status = HYS_REACHED;
    /* Tolerances count from the target itself, not from the end of the range that is nearest to it. */
    nearest = hys_clamp(wanted, ZERO, model->total);
    if (heading != HYS_HOLD && edge(state, heading == HYS_RISING, wanted, tolerance, reach, &input)) {
        return input;
    }
    back = (wanted > state->y) != is_rising(state);
    if (within(nearest, state->y, model->rounding) || (back && within(wanted, state->y, tolerance))) {
        /* Beyond the plane only a relay can tell the nearest end from where the input stands. */
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

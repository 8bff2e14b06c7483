#include "hysteron_mcu.h"

/* No product may be fused with a sum. GCC does not know the standard's pragma. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("fp-contract=off")
#else
#pragma STDC FP_CONTRACT OFF
#endif

/* float also needs sums of float: FLT_EVAL_METHOD 1 would make them double. */
#ifdef FLT_EVAL_METHOD
typedef char hys_float_is_float[FLT_EVAL_METHOD == 0 || sizeof(hys_real) == sizeof(double) ? 1 : -1];
#endif

#define ZERO ((hys_real)0)
#define ONE ((hys_real)1)
#define HALF ((hys_real)0.5)

/* Higher than every position. */
#define ENDLESS ((hys_real)1e9)

/* The start of every history among the turning points: below the plane, after endless heights. There are enough of these
 * for a look at two corners back to need no case of its own. A minimum, as all turning points at odd places. */
#define LOOK 4u
#define START HYS_START
typedef char hys_start_looks_back[HYS_START == LOOK + 1u ? 1 : -1];

enum { MKP = 0, RELAY = 2 };

static int is_finite(hys_real x)
{
    return x - x == ZERO;
}

static hys_real larger(hys_real a, hys_real b)
{
    return a > b ? a : b;
}

static hys_real smaller(hys_real a, hys_real b)
{
    return a < b ? a : b;
}

static hys_real limited(hys_real x, hys_real low, hys_real high)
{
    return smaller(larger(x, low), high);
}

/* K and positions fit int32_t, whose conversions are one instruction on most targets. */
static hys_real number(size_t n)
{
    return (hys_real)(int32_t)n;
}

static size_t whole(hys_real x)
{
    return (size_t)(int32_t)x;
}

/* ---- The plane ---- */

/* The position of an input: level k stands at k, one step below the lowest at 0. */
static hys_real normalise(const hys_model *model, hys_real input)
{
    return limited((input - model->min) * model->per_unit + ONE, ZERO, model->top);
}

static hys_real denormalise(const hys_model *model, hys_real x)
{
    return x >= model->top ? model->max : model->min + (x - ONE) * model->step;
}

static hys_real level(const hys_model *model, size_t k)
{
    return denormalise(model, number(k));
}

/* The highest level at or below an input. The levels themselves decide, not the rounding of the position. */
static size_t level_at_or_below(const hys_model *model, hys_real input)
{
    size_t near = whole(normalise(model, input));
    if (near < model->levels && level(model, near + 1u) <= input) {
        return near + 1u;
    }
    return near > 0u && level(model, near) > input ? near - 1u : near;
}

/* A relay knows its levels only: rising, the last level reached; falling, the level below the last one left. */
static hys_real relay_position(const hys_state *state, hys_real input)
{
    const hys_model *model = state->model;
    size_t below;
    if (input == state->input) {
        return state->x;
    }
    below = level_at_or_below(model, input);
    if (input < state->input && below > 0u && level(model, below) >= input) {
        below -= 1u;
    }
    return number(below);
}

/* ---- The Everett function: what the output loses when the input falls from a maximum to a minimum ---- */

/* A position as its grid cell and the part of it, 0 <= part <= 1. */
typedef struct {
    size_t cell;
    hys_real part;
} split;

/* On a grid line it is the even one of the two cells, and the last cell at the end of the plane: the function is
 * continuous, but its digits are not those of either. */
static split split_of(const hys_model *model, hys_real x)
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

/* Place of C[p][q]. */
static size_t table_index(size_t p, size_t q)
{
    return p * (p + 1u) / 2u + q;
}

/* e(M, m) for m <= M: linear on the triangle that (M, m) lies in. */
static hys_real everett(const hys_model *model, split max, split min)
{
    const hys_real *row = model->table + table_index(max.cell, min.cell);
    hys_real near = row[0];
    hys_real far = row[max.cell + 2u];
    if (max.part > min.part) {
        hys_real mid = row[max.cell + 1u];
        return near + max.part * (mid - near) + min.part * (far - mid);
    } else {
        hys_real mid = row[1];
        return near + min.part * (mid - near) + max.part * (far - mid);
    }
}

/* ---- The turning points ---- */

static int is_rising(const hys_state *state)
{
    return (state->top & 1u) == (START & 1u);
}

static void start(hys_state *state)
{
    state->top = START;
    state->x = ZERO;
    state->y = ZERO;
    state->began_cell = 0u;
    state->began_part = ZERO;
    state->began_y = ZERO;
    state->end = ENDLESS;
    state->input = state->model->bottom;
}

/* Makes one corner of the last one and the one that falls to the present position, where both lie in one grid cell with
 * the corner before them; says whether they do.
 *
 * In the cell, the state becomes min(max(state, u'), v') and then min(max(state, u''), v''), with u'' < u' and v' < v''.
 * Since the corner before has left it below v', both together are min(max(state, u), v'') with u = clamp(v', u'', u').
 * Everything outside the cell sees only the corner before and the last minimum. */
static int merged(hys_state *state)
{
    const hys_model *model = state->model;
    hys_turn *recent = state->turns + (state->top - LOOK); /* two corners, maximum and minimum each, and the peak */
    split peak, min, outer, inner, at_max;
    hys_real held, max;
    /* With fewer than two corners before, one of them is an endless height, which is not close. */
    if (!(recent[0].x - recent[4].x < ONE && state->x - recent[1].x < ONE)) {
        return 0;
    }
    peak = split_of(model, recent[4].x);
    min = split_of(model, state->x);
    outer = split_of(model, recent[1].x);
    inner = split_of(model, recent[3].x);
    if (outer.cell != min.cell || inner.cell != min.cell || split_of(model, recent[0].x).cell != peak.cell ||
        split_of(model, recent[2].x).cell != peak.cell) {
        return 0;
    }
    held = number(peak.cell) + (recent[3].x - number(min.cell));
    max = limited(held, recent[4].x, recent[2].x);
    at_max = split_of(model, max);
    /* From the corner before on, so that ten thousand of these leave no more rounding than one. */
    recent[2].x = max;
    recent[2].y = recent[1].y + everett(model, at_max, outer);
    recent[3].x = state->x;
    recent[3].y = recent[2].y - everett(model, at_max, min);
    return 1;
}

/* Changes to the next branch on the way to `x`. Where the input turned, the present position becomes a turning point.
 * Where the branch ended, the extreme there is wiped out with the opposite one after it. */
static void leave(hys_state *state, int rising, hys_real x)
{
    split began;
    if (rising ? x >= state->x : x <= state->x) {
        state->top -= 2u;
        if (state->top < START) {
            /* Below everything: all operators are off, as at the start, and the next way is up. */
            state->top = START;
            state->x = ZERO;
        }
    } else if (!rising && merged(state)) {
        state->top -= 1u;
    } else {
        state->top += 1u;
        state->turns[state->top].x = state->x;
        state->turns[state->top].y = state->y;
    }
    began = split_of(state->model, state->turns[state->top].x);
    state->began_cell = began.cell;
    state->began_part = began.part;
    state->began_y = state->turns[state->top].y;
    state->end = state->turns[state->top - 1u].x;
}

/* Moves to a position in [0, K]. At most 2K + 3 turns of the loop: the input turns, at most 2K corners are wiped out,
 * and it turns once more at the bottom of the plane. */
static void travel(hys_state *state, hys_real x)
{
    const hys_model *model = state->model;
    split here, began;
    int rising = is_rising(state);
    while (!(rising ? x >= state->x && x < state->end : x <= state->x && x > state->end)) {
        leave(state, rising, x);
        rising = is_rising(state);
    }
    here = split_of(model, x);
    began.cell = state->began_cell;
    began.part = state->began_part;
    state->x = x;
    state->y = rising ? state->began_y + everett(model, here, began) : state->began_y - everett(model, began, here);
}

static void move(hys_state *state, hys_real input)
{
    const hys_model *model = state->model;
    travel(state, model->kind == RELAY ? relay_position(state, input) : normalise(model, input));
    state->input = input;
}

/* From the sum of weights times states to the model's output: states of KP and relay run from -1 to 1. */
static hys_real outward(const hys_model *model, hys_real sum)
{
    hys_real own = model->kind == MKP ? sum : sum + sum - model->total;
    return model->falls ? model->offset - own : model->offset + own;
}

static int usable(const hys_state *state)
{
    if (state == NULL) {
        return HYS_NULL;
    }
    return state->model == NULL || state->turns == NULL ? HYS_STATE_MISMATCH : HYS_OK;
}

int hys_start(const hys_model *model, hys_state *state, hys_turn *turns, size_t count)
{
    size_t n;
    if (model == NULL || state == NULL || turns == NULL) {
        return HYS_NULL;
    }
    if (count < 4u * model->levels + 8u) {
        return HYS_MEMORY_TOO_SMALL;
    }
    for (n = 0u; n <= START; n++) { /* START + 1 turns */
        turns[n].x = n < START ? ENDLESS : ZERO;
        turns[n].y = ZERO;
    }
    state->model = model;
    state->turns = turns;
    start(state);
    return HYS_OK;
}

int hys_reset_off(hys_state *state)
{
    int code = usable(state);
    if (code == HYS_OK) {
        start(state);
    }
    return code;
}

int hys_reset_on(hys_state *state)
{
    int code = hys_reset_off(state);
    if (code == HYS_OK) {
        move(state, state->model->max);
    }
    return code;
}

int hys_step(hys_state *state, hys_real input, hys_real *output)
{
    int code = usable(state);
    if (code != HYS_OK) {
        return code;
    }
    if (output == NULL) {
        return HYS_NULL;
    }
    if (!is_finite(input)) {
        return HYS_INPUT_NOT_FINITE;
    }
    move(state, input);
    *output = outward(state->model, state->y);
    return HYS_OK;
}

int hys_save(const hys_state *state, hys_real *points, size_t capacity, size_t *count, hys_real *input)
{
    size_t n, held;
    int code = usable(state);
    if (code != HYS_OK) {
        return code;
    }
    if (count == NULL || input == NULL) {
        return HYS_NULL;
    }
    held = state->top - START;
    *count = held + 1u;
    if (capacity < held + 1u) {
        return HYS_MEMORY_TOO_SMALL;
    }
    if (points == NULL) {
        return HYS_NULL;
    }
    for (n = 0u; n < held; n++) { /* at most 4K + 2 turns */
        points[n] = state->turns[START + 1u + n].x;
    }
    points[held] = state->x;
    *input = state->input;
    return HYS_OK;
}

int hys_rebase(hys_state *state)
{
    const hys_model *model;
    hys_turn last;
    split from, to;
    size_t n;
    int code = usable(state);
    if (code != HYS_OK) {
        return code;
    }
    model = state->model;
    last = state->turns[START];
    from = split_of(model, last.x);
    for (n = START + 1u; n <= state->top + 1u; n++) { /* at most 4K + 3 turns */
        hys_real x = n <= state->top ? state->turns[n].x : state->x;
        hys_real y;
        to = split_of(model, x);
        y = x > last.x ? last.y + everett(model, to, from) : last.y - everett(model, from, to);
        if (n <= state->top) {
            state->turns[n].y = y;
            last = state->turns[n];
            from = to;
        } else {
            state->began_y = last.y;
            state->y = y;
        }
    }
    return HYS_OK;
}

int hys_restore(hys_state *state, const hys_real *points, size_t count, hys_real input)
{
    size_t n;
    hys_real low = ZERO, high;
    int code = usable(state);
    if (code != HYS_OK) {
        return code;
    }
    if (points == NULL && count > 0u) {
        return HYS_NULL;
    }
    if (!is_finite(input)) {
        return HYS_INPUT_NOT_FINITE;
    }
    high = state->model->top;
    for (n = 0u; n < count; n++) { /* as many turns as points */
        /* Written so that NaN fails. */
        if (!(low <= points[n] && points[n] <= high)) {
            return HYS_TURNING_POINTS;
        }
        if ((n & 1u) == 0u) {
            high = points[n];
        } else {
            low = points[n];
        }
    }
    start(state);
    for (n = 0u; n < count; n++) { /* as many turns as points */
        travel(state, larger(points[n], ZERO)); /* never -0 */
    }
    state->input = input;
    return HYS_OK;
}

/* ---- The inverse ---- */

/* What an output on the way has to do: come to `value`, where the slack makes `limit` enough, or, `beyond`, exceed it. */
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
static goal upward(hys_real value, int beyond, hys_real slack)
{
    goal to;
    to.value = value;
    to.limit = beyond ? value : value - slack;
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
    while (low < high) { /* at most log2(2K + 1) + 1 turns */
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
    while (low < high) { /* at most log2(K) + 1 turns */
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
    while (low < high) { /* at most log2(K) + 1 turns */
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

/* The first input on the way up at which the sum comes to `value` or goes `beyond` it. */
static hys_real rising_to(const hys_state *state, hys_real value, int beyond)
{
    const hys_model *model = state->model;
    branch on = find(state, 0u, upward(value, beyond, model->slack));
    hys_real x = climb(model, on.began.x, on.start, upward(value - on.began.y, beyond, model->slack));
    x = limited(x, on.start, on.end);
    if (model->kind == RELAY) {
        size_t up = whole(x);
        up += number(up) < x && up < model->levels ? 1u : 0u;
        return smaller(larger(level(model, up), state->input + model->nudge), model->max);
    }
    return denormalise(model, x);
}

/* The first input on the way down. */
static hys_real falling_to(const hys_state *state, hys_real value, int beyond)
{
    const hys_model *model = state->model;
    goal to;
    branch on;
    hys_real x;
    to.value = value;
    to.limit = beyond ? value : value + model->slack;
    to.beyond = beyond;
    on = find(state, 1u, to);
    /* What the output lost since the branch began rises. */
    x = descend(model, on.began.x, on.start, upward(on.began.y - value, beyond, model->slack));
    x = limited(x, on.end, on.start);
    if (model->kind == RELAY) {
        /* Off at the level itself: one above the last level left on. */
        size_t down = whole(x);
        down = down < model->levels ? down + 1u : model->levels;
        return larger(smaller(level(model, down), state->input - model->nudge), model->bottom);
    }
    return denormalise(model, x);
}

/* The sum at which a target that turns to `up` stands still: where the branch of that direction began or, before it has,
 * the present one. */
static hys_real rest_of(const hys_state *state, int up)
{
    return is_rising(state) == up ? state->began_y : state->y;
}

/* The input for a target of the operators' own sum; `heading` and `status` are of that, too. */
static hys_real solve(const hys_state *state, hys_real target, int heading, hys_real tolerance, int *status)
{
    const hys_model *model = state->model;
    hys_real wanted = target, reach, rest;
    int back;
    tolerance = larger(tolerance, ZERO); /* NaN too */
    if (model->kind != MKP) {
        wanted = HALF * target + HALF * model->total;
        tolerance = HALF * tolerance;
    }
    reach = larger(tolerance, model->slack);
    if (wanted > model->total + reach) {
        *status = HYS_HIGH;
        return model->max;
    }
    if (wanted < -reach) {
        *status = HYS_LOW;
        return model->bottom;
    }
    *status = HYS_REACHED;
    wanted = limited(wanted, ZERO, model->total);
    if (heading != HYS_HOLD) {
        rest = rest_of(state, heading == HYS_RISING);
        if (within(wanted, rest, reach)) {
            return heading == HYS_RISING ? rising_to(state, rest + tolerance, 1)
                                         : falling_to(state, rest - tolerance, 1);
        }
    }
    back = (wanted > state->y) != is_rising(state);
    if (within(wanted, state->y, model->slack) || (back && within(wanted, state->y, tolerance))) {
        /* Beyond the plane only a relay could tell the nearest end from where it stands: on the way back it switches. */
        return model->kind == RELAY ? state->input : limited(state->input, model->bottom, model->max);
    }
    return wanted > state->y ? rising_to(state, wanted, 0) : falling_to(state, wanted, 0);
}

int hys_inverse_step(hys_state *state, hys_real target, int heading, hys_real tolerance, hys_real *input, int *status)
{
    int found;
    hys_real to;
    int code = usable(state);
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
    move(state, to);
    *input = to;
    *status = state->model->falls ? -found : found;
    return HYS_OK;
}

/* The forward step, and the turning points of a state. */
#include "hysteron_mcu_internal.h"

/* Higher than every position. */
#define ENDLESS ((hys_real)1e9)

/* ---- The plane ---- */

/* The highest level at or below an input, 0 for none. The levels decide, because the position is
 * rounded. */
static size_t level_at_or_below(const hys_model *model, hys_real input)
{
    size_t near = whole(normalise(model, input));
    if (near < model->levels && level(model, near + 1u) <= input) {
        return near + 1u;
    }
    return near > 0u && level(model, near) > input ? near - 1u : near;
}

/* The position of a relay model. For a rising input it is the last level reached, for a falling one
 * the level below the last one left. */
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

/* ---- The turning points ---- */

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

/* Replaces two corners by one, where both lie in one grid cell with the corner before them: the
 * last one among the turning points and the one from its peak down to the present position. Returns
 * whether it did.
 *
 * In the cell, the first corner maps a state s to min(max(s, u'), v') and the second to
 * min(max(s, u''), v''), with u'' < u' and v' < v''. The corner before them has left s below v'. So
 * both together equal min(max(s, u), v'') with u = clamp(v', u'', u'): one corner. The operators
 * outside the cell depend only on the corner before and on the last minimum. */
static int merged(hys_state *state)
{
    const hys_model *model = state->model;
    hys_turn *recent = state->turns + (state->top - LOOK); /* two corners, maximum and minimum each, and the peak */
    split peak, min, outer, inner, at_max;
    hys_real held, max;
    /* With fewer than two corners before, this reads a sentinel, whose position is infinite. */
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
    max = hys_clamp(held, recent[4].x, recent[2].x);
    at_max = split_of(model, max);
    /* Computed from the corner before, so that rounding errors do not add up over many merges. */
    recent[2].x = max;
    recent[2].y = recent[1].y + everett(model, at_max, outer);
    recent[3].x = state->x;
    recent[3].y = recent[2].y - everett(model, at_max, min);
    return 1;
}

/* Changes to the next branch on the way to `x`. Where the input turned, the present position
 * becomes a turning point. Where the branch ended, the turning points that it began and ended at
 * are wiped out. */
static void leave(hys_state *state, int rising, hys_real x)
{
    const hys_turn *turns = state->turns;
    split began;
    if (rising ? x >= state->x : x <= state->x) {
        do { /* together with those of `travel` at most 2K + 3 iterations */
            state->top -= 2u;
        } while (state->top >= START && (rising ? x >= turns[state->top - 1u].x : x <= turns[state->top - 1u].x));
        if (state->top < START) {
            /* The bottom of the plane: all operators are off, as at the start. From here the input
             * can only rise. */
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

/* Moves to a position in [0, K]. At most 2K + 3 iterations, including those of `leave`: the input
 * turns, at most 2K corners are wiped out, and the input turns once more at the bottom of the
 * plane. */
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

static hys_real outward(const hys_model *model, hys_real sum)
{
    hys_real own = own_sum(model, sum);
    return model->falls ? model->offset - own : model->offset + own;
}

static void move(hys_state *state, hys_real input)
{
    const hys_model *model = state->model;
    travel(state, model->kind == RELAY ? relay_position(state, input) : normalise(model, input));
    state->input = input;
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
    for (n = 0u; n <= START; n++) { /* START + 1 iterations */
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
    int code = usable_state(state);
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
    int code = usable_state(state);
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
    int code = usable_state(state);
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
    for (n = 0u; n < held; n++) { /* at most 4K + 2 iterations */
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
    int code = usable_state(state);
    if (code != HYS_OK) {
        return code;
    }
    model = state->model;
    last = state->turns[START];
    from = split_of(model, last.x);
    for (n = START + 1u; n <= state->top + 1u; n++) { /* at most 4K + 3 iterations */
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
    int code = usable_state(state);
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
    for (n = 0u; n < count; n++) { /* as many iterations as points */
        /* Written so that NaN fails the comparison. */
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
    for (n = 0u; n < count; n++) { /* as many iterations as points */
        travel(state, hys_max(points[n], ZERO)); /* never -0 */
    }
    state->input = input;
    return HYS_OK;
}

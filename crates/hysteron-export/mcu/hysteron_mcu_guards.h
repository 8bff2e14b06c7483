/* The guards of adaptation: a watch for channels that stand still, and a gate for wrong readings.
 * hysteron_mcu_adapt.c includes it. Not for applications. */
#ifndef HYSTERON_MCU_GUARDS_H
#define HYSTERON_MCU_GUARDS_H

#include "hysteron_mcu_adapt.h"
#include "hysteron_mcu_internal.h"

/* Of the gate: length of the running mean in samples, and the numbers by which the range is divided
 * for the scale at the start and for the smallest scale. */
#define MEMORY 64u
#define AT_START 50u
#define LEAST 1000u

#define EPSILON ((hys_real)(sizeof(hys_real) == sizeof(double) ? DBL_EPSILON : (double)FLT_EPSILON))

/* Of the watch. What each is for is said in the library, at the constants of the same names. The
 * range is divided by PIECE, NOISE, FAR_PIECE and FAR_RUN, and the plane's width by WIDE. */
#define STILL 5u
#define CYCLE 14u
#define MOST 32u
#define PIECE 2u
#define READINGS_PIECE 4u
#define READINGS_OUTPUT 10u
#define READINGS_INPUT 16u
#define WIDE 2u
#define NOISE 16u
#define FAR_PIECE 8u
#define FAR_RUN 4u
#define LATELY 1u

/* Of a run. */
#define FOLLOWS 3u
#define CHANCE 4u
#define BEFORE 4u
#define ROUNDING 1024u

static hys_real size_of(hys_real x)
{
    return hys_max(x, -x);
}

/* ---- Spans ---- */

static void begin_span(hys_span *span, hys_real at)
{
    span->low = at;
    span->high = at;
}

static void widen(hys_span *span, hys_real at)
{
    span->low = hys_min(span->low, at);
    span->high = hys_max(span->high, at);
}

static hys_real width_of(const hys_span *span)
{
    return span->high - span->low;
}

static void begin_spans(hys_span *spans, const hys_real *reading)
{
    size_t n;
    for (n = 0u; n < 3u; n++) {
        begin_span(spans + n, reading[n]);
    }
}

static void widen_spans(hys_span *spans, const hys_real *reading)
{
    size_t n;
    for (n = 0u; n < 3u; n++) {
        widen(spans + n, reading[n]);
    }
}

static void begin_lately(hys_lately *lately, hys_real at)
{
    begin_span(lately->spans, at);
    begin_span(lately->spans + 1, at);
    lately->travel = ZERO;
}

/* A stretch ends after the way `most`. */
static void take_lately(hys_lately *lately, hys_real at, hys_real travel, hys_real most)
{
    widen(lately->spans, at);
    lately->travel += travel;
    if (lately->travel >= most) {
        lately->spans[1].low = lately->spans[0].low;
        lately->spans[1].high = lately->spans[0].high;
        begin_span(lately->spans, at);
        lately->travel = ZERO;
    }
}

static hys_real width_lately(const hys_lately *lately)
{
    hys_span both;
    both.low = lately->spans[0].low;
    both.high = lately->spans[0].high;
    widen(&both, lately->spans[1].low);
    widen(&both, lately->spans[1].high);
    return width_of(&both);
}

/* ---- Runs ---- */

/* `reading` may be run->last. */
static void begin_run(hys_run *run, const hys_real *reading)
{
    size_t n;
    begin_spans(run->spans, reading);
    run->travel = ZERO;
    for (n = 0u; n < 2u; n++) {
        run->first[n] = reading[n];
        run->sums[n] = ZERO;
        run->squares[n] = ZERO;
    }
    for (n = 0u; n < 3u; n++) {
        run->last[n] = reading[n];
    }
    run->way = ZERO;
    run->count = ZERO;
    run->product = ZERO;
    run->readings = 1u;
}

/* Takes a reading, to which the moving channel travelled. `lately` is its span lately. */
static void take_run(hys_run *run, const hys_real *reading, hys_real travel, hys_real lately)
{
    hys_real step, x, y, before = run->last[0];
    size_t n;
    widen_spans(run->spans, reading);
    run->travel += travel;
    run->readings += run->readings < UINT32_MAX ? 1u : 0u;
    for (n = 0u; n < 3u; n++) {
        run->last[n] = reading[n];
    }
    if (number(BEFORE) * run->travel < lately) {
        run->first[0] = reading[0];
        run->first[1] = reading[1];
        return;
    }
    step = size_of(reading[0] - before);
    x = reading[0] - run->first[0];
    y = reading[1] - run->first[1];
    run->way += step;
    run->count += ONE;
    run->sums[0] += step * x;
    run->sums[1] += step * y;
    run->squares[0] += step * x * x;
    run->squares[1] += step * y * y;
    run->product += step * x * y;
}

/* Whether the one channel follows the other: their correlation is positive, and its square at least
 * a third, more with few readings. A channel that keeps its value but for rounding follows nothing.
 */
static int follows(const hys_run *run)
{
    hys_real x = run->sums[0], y = run->sums[1];
    hys_real product = run->way * run->product - x * y;
    hys_real moving = run->way * run->squares[0] - x * x;
    hys_real still = run->way * run->squares[1] - y * y;
    hys_real rounding = number(ROUNDING) * EPSILON * run->way * run->squares[1];
    hys_real least = run->count / number(FOLLOWS) + number(CHANCE);
    return still > rounding && product > ZERO &&
           product * product * run->count >= moving * still * least;
}

/* ---- Watch ---- */

static void begin_piece(hys_piece *piece, const hys_real *reading)
{
    begin_spans(piece->spans, reading);
    piece->travel = ZERO;
    piece->readings = 0u;
}

/* Nothing is known yet, so a run has to be proved twice: `follows` is 1. */
static void begin_trail(hys_trail *trail, const hys_real *reading)
{
    trail->anchor = reading[0];
    trail->longest = ZERO;
    begin_lately(&trail->lately, reading[0]);
    begin_run(&trail->run, reading);
    begin_piece(&trail->piece, reading);
    trail->begun = 1u;
    trail->follows = 1u;
}

/* What a piece that ends says: whether both channels moved in it, and whether the input did. */
typedef struct {
    int ended, alive, moved;
} hys_ended;

/* Takes a reading. A run ends also where the position moves by `rest`. */
static void look_along(hys_trail *trail, const hys_real *reading, hys_real range, hys_real rest,
                       hys_ended *says)
{
    hys_run *run = &trail->run;
    hys_piece *piece = &trail->piece;
    hys_real travel, lately, band, before, far;
    says->ended = 0;
    says->alive = 0;
    says->moved = 0;
    if (!trail->begun) {
        begin_trail(trail, reading);
        return;
    }
    travel = size_of(reading[0] - trail->anchor);
    if (travel >= range / number(NOISE)) {
        trail->anchor = reading[0];
    } else {
        travel = ZERO;
    }
    /* A wrong reading is no cycle. */
    travel = hys_min(travel, range / number(PIECE));
    take_lately(&trail->lately, reading[0], travel, range * number(LATELY));
    lately = hys_max(width_lately(&trail->lately), width_of(run->spans));
    band = hys_max(lately, range / number(FAR_RUN)) / number(STILL);
    before = width_of(run->spans + 1);
    take_run(run, reading, travel, lately);
    /* A band that gets narrower ends no run: only a move does. */
    if ((width_of(run->spans + 1) > before && width_of(run->spans + 1) >= band) ||
        width_of(run->spans + 2) >= rest) {
        trail->longest = hys_max(trail->longest, run->travel);
        begin_run(run, reading);
        trail->follows = 0u;
    }
    widen_spans(piece->spans, reading);
    piece->travel += travel;
    piece->readings += piece->readings < UINT32_MAX ? 1u : 0u;
    if (piece->travel < range / number(PIECE) || piece->readings < READINGS_PIECE) {
        return;
    }
    far = width_of(piece->spans);
    says->ended = 1;
    says->alive =
        far >= range / number(FAR_PIECE) && width_of(piece->spans + 1) * number(STILL) >= far;
    says->moved = width_of(piece->spans + 2) >= HALF;
    begin_piece(piece, reading);
}

/* Whether the run proves the channel still: the other one, whose span counts as at least `least`,
 * went there and back in `few` readings or more, and the input moved by `wide`. */
static int is_still(hys_trail *trail, hys_real range, hys_real least, hys_real wide, uint32_t few)
{
    hys_run *run = &trail->run;
    hys_real beyond_longest, span, cycle, most;
    int followed;
    if (!trail->begun) {
        return 0;
    }
    beyond_longest = trail->longest + trail->longest * HALF;
    span = hys_max(hys_max(width_lately(&trail->lately), width_of(run->spans)), least);
    most = span * (number(MOST) / number(8u));
    cycle = hys_max(span * (number(CYCLE) / number(8u)), hys_min(beyond_longest, most));
    if (run->travel < cycle || run->readings < few ||
        !(width_of(run->spans) >= range / number(FAR_RUN)) || width_of(run->spans + 2) < wide) {
        return 0;
    }
    followed = trail->follows;
    trail->follows = follows(run) ? 1u : 0u;
    if (followed || trail->follows) {
        begin_run(run, run->last);
        return 0;
    }
    return 1;
}

static void restart_watch(hys_watch *watch)
{
    watch->output.begun = 0u;
    watch->input.begun = 0u;
    watch->last = ZERO;
    watch->stuck = 0;
}

/* Looks at a reading; `watch->stuck` becomes what stands still. Where a piece of the output ends and
 * nothing is stuck, returns 1, and 2 if both channels moved in it. Otherwise returns 0. */
static int look(hys_watch *watch, hys_real position, hys_real expected, hys_real measured,
                int believed)
{
    hys_real step = measured - watch->last, reading[3];
    hys_ended output, input;
    int same = size_of(step) < watch->range / number(NOISE);
    watch->last = measured;
    if (!(believed || same)) {
        return 0;
    }
    reading[0] = expected;
    reading[1] = measured;
    reading[2] = position;
    /* The position never moves by more than the width. */
    look_along(&watch->output, reading, watch->range, watch->width + ONE, &output);
    reading[0] = measured;
    reading[1] = expected;
    look_along(&watch->input, reading, watch->range, HALF, &input);
    if ((watch->stuck == HYS_OUTPUT_STUCK && !output.alive) ||
        (watch->stuck == HYS_INPUT_STUCK && !(output.alive || input.moved))) {
        return 0;
    }
    watch->stuck = 0;
    if (is_still(&watch->output, watch->range, ZERO, watch->width / number(WIDE),
                 READINGS_OUTPUT)) {
        watch->stuck = HYS_OUTPUT_STUCK;
    } else if (is_still(&watch->input, watch->range, watch->range, ZERO, READINGS_INPUT)) {
        watch->stuck = HYS_INPUT_STUCK;
    }
    return watch->stuck != 0 || !output.ended ? 0 : (output.alive ? 2 : 1);
}

/* ---- Gate ---- */

static void restart(hys_gate *gate)
{
    gate->scale = gate->range / number(AT_START);
    gate->left = ZERO;
    gate->last = ZERO;
    gate->refused = 0u;
    gate->agreeing = 0u;
}

static void rescale(hys_gate *gate, hys_real scale)
{
    if (is_finite(scale)) {
        gate->scale = hys_max(scale, gate->range / number(LEAST));
    }
}

static void believe(hys_gate *gate, hys_real scale)
{
    gate->refused = 0u;
    gate->agreeing = 0u;
    rescale(gate, scale);
}

/* Whether two surprises may come from one jump: they differ by at most half of the larger one. */
static int agree(hys_real a, hys_real b)
{
    return size_of(a - b) <= ONE / number(2u) * hys_max(size_of(a), size_of(b));
}

/* Whether a reading whose prediction has this error is accepted. */
static int believes(hys_gate *gate, hys_real error, const hys_adapt_options *options)
{
    hys_real surprise = error - gate->left, size = size_of(surprise);
    if (options->gate == ZERO) {
        return 1;
    }
    if (size <= options->gate * gate->scale || gate->scale == ZERO) {
        believe(gate, gate->scale + (size - gate->scale) / number(MEMORY));
        return 1;
    }
    gate->agreeing = gate->agreeing > 0u && agree(surprise, gate->last) ? gate->agreeing + 1u : 1u;
    gate->refused += 1u;
    gate->last = surprise;
    if (gate->agreeing >= options->burst) {
        believe(gate, size);
        return 1;
    }
    if (gate->refused >= options->burst) {
        gate->refused = 0u;
        rescale(gate, gate->scale + gate->scale);
    }
    return 0;
}

/* Keeps the error that is left after an accepted reading. */
static void settle(hys_gate *gate, hys_real left)
{
    gate->left = is_finite(left) ? left : ZERO;
}

#endif

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

/* Of the watch: the numbers of pieces, and of readings in each; how much narrower the span of a
 * channel that stands still is; and the numbers by which the range is divided for a piece, for moves
 * that are noise, and for spans that say something, and the plane's width for a wide motion. */
#define PIECES 4u
#define READINGS 4u
#define STILL 5u
#define PIECE 2u
#define NOISE 16u
#define FAR_PIECE 8u
#define FAR_ALL 4u
#define WIDE 2u

/* ---- Watch ---- */

static hys_real size_of(hys_real x)
{
    return hys_max(x, -x);
}

static void begin_piece(hys_piece *piece, const hys_real *reading)
{
    size_t n;
    for (n = 0u; n < 3u; n++) {
        piece->low[n] = reading[n];
        piece->high[n] = reading[n];
    }
    piece->travel = ZERO;
    piece->readings = 0u;
    piece->begun = 1u;
}

/* Widens the spans of a piece by those of another one. */
static void widen(hys_piece *piece, const hys_real *low, const hys_real *high)
{
    size_t n;
    for (n = 0u; n < 3u; n++) {
        piece->low[n] = hys_min(piece->low[n], low[n]);
        piece->high[n] = hys_max(piece->high[n], high[n]);
    }
}

static hys_real span(const hys_piece *piece, size_t n)
{
    return piece->high[n] - piece->low[n];
}

static int is_still(const hys_piece *piece)
{
    return span(piece, 1u) * number(STILL) < span(piece, 0u);
}

/* Copied member by member, because a copy of the whole struct may become a call of memcpy. */
static void copy_piece(hys_piece *to, const hys_piece *from)
{
    size_t n;
    for (n = 0u; n < 3u; n++) {
        to->low[n] = from->low[n];
        to->high[n] = from->high[n];
    }
    to->travel = from->travel;
    to->readings = from->readings;
    to->begun = from->begun;
}

/* What a piece that ends says: whether both channels moved in it, whether over all pieces one moved
 * there and back while the other one stood still, and how far the position moved in the piece and
 * over all. */
typedef struct {
    int ended, alive, still;
    hys_real moves, moved;
} hys_ended;

static void look_along(hys_trail *trail, const hys_real *reading, hys_real range, hys_ended *says)
{
    hys_piece *piece = trail->pieces;
    hys_piece all;
    hys_real step, travel = ZERO, far;
    size_t n, begun = 0u;
    says->ended = 0;
    if (!piece->begun) {
        trail->anchor = reading[0];
        begin_piece(piece, reading);
        return;
    }
    step = size_of(reading[0] - trail->anchor);
    if (step >= range / number(NOISE)) {
        trail->anchor = reading[0];
        piece->travel += step;
    }
    widen(piece, reading, reading);
    piece->readings += piece->readings < UINT32_MAX ? 1u : 0u;
    if (piece->travel < range / number(PIECE) || piece->readings < READINGS) {
        return;
    }
    copy_piece(&all, piece);
    for (n = 0u; n < PIECES; n++) { /* PIECES iterations */
        if (trail->pieces[n].begun) {
            begun++;
            travel += trail->pieces[n].travel;
            widen(&all, trail->pieces[n].low, trail->pieces[n].high);
        }
    }
    far = span(&all, 0u);
    says->ended = 1;
    says->alive = span(piece, 0u) >= range / number(FAR_PIECE) && !is_still(piece);
    says->still = begun == PIECES && travel >= far + far * (ONE / number(2u)) &&
                  far >= range / number(FAR_ALL) && is_still(&all);
    says->moves = span(piece, 2u);
    says->moved = span(&all, 2u);
    for (n = PIECES - 1u; n > 0u; n--) { /* less than PIECES iterations */
        copy_piece(trail->pieces + n, trail->pieces + (n - 1u));
    }
    begin_piece(piece, reading);
}

static void restart_watch(hys_watch *watch)
{
    size_t n;
    for (n = 0u; n < PIECES; n++) {
        watch->output.pieces[n].begun = 0u;
        watch->input.pieces[n].begun = 0u;
    }
    watch->output.anchor = ZERO;
    watch->input.anchor = ZERO;
    watch->last = ZERO;
    watch->stuck = 0;
}

/* Looks at a reading; `watch->stuck` becomes what stands still. Where a piece of the output ends and
 * nothing is stuck, returns 1, and 2 if both channels moved in it. Otherwise returns 0. */
static int look(hys_watch *watch, hys_real position, hys_real expected, hys_real measured, int believed)
{
    hys_real half = ONE / number(2u), step = measured - watch->last, reading[3];
    hys_ended output, input;
    int alive, returns, same = size_of(step) < watch->range / number(NOISE);
    watch->last = measured;
    if (!(believed || same)) {
        return 0;
    }
    reading[0] = expected;
    reading[1] = measured;
    reading[2] = position;
    look_along(&watch->output, reading, watch->range, &output);
    reading[0] = measured;
    reading[1] = expected;
    look_along(&watch->input, reading, watch->range, &input);
    alive = output.ended && output.alive;
    returns = input.ended && input.moves >= half;
    if ((watch->stuck == HYS_OUTPUT_STUCK && !alive) || (watch->stuck == HYS_INPUT_STUCK && !(alive || returns))) {
        return 0;
    }
    watch->stuck = 0;
    if (output.ended && output.still && output.moved >= watch->width / number(WIDE)) {
        watch->stuck = HYS_OUTPUT_STUCK;
    } else if (input.ended && input.still && input.moved < half) {
        watch->stuck = HYS_INPUT_STUCK;
    }
    return watch->stuck != 0 || !output.ended ? 0 : (alive ? 2 : 1);
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

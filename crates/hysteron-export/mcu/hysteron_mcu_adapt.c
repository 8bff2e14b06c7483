#include "hysteron_mcu_adapt.h"
#include "hysteron_mcu_internal.h"

#define EPSILON ((hys_real)(sizeof(hys_real) == sizeof(double) ? DBL_EPSILON : (double)FLT_EPSILON))

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

/* Number of running sums of a long sum. The rounding of the library depends on it. */
#define LANES 8u

static size_t operators(const hys_adaptive *self)
{
    return self->model.levels * (self->model.levels + 1u) / 2u;
}

/* Index of operator (i, j), 1 <= i <= j, among the weights. */
static size_t operator_index(size_t i, size_t j)
{
    return j * (j - 1u) / 2u + (i - 1u);
}

static void copy(hys_real *to, const hys_real *from, size_t count)
{
    size_t n;
    for (n = 0u; n < count; n++) {
        to[n] = from[n];
    }
}

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

/* Starts the watch again, from the present parameters. */
static void watch_anew(hys_adaptive *self)
{
    size_t count = operators(self) + 1u;
    copy(self->trusted, self->theta, count);
    copy(self->pending, self->theta, count);
    self->expected = ZERO;
    restart_watch(&self->watch);
}

/* ---- The operators' states ---- */

/* The ridge of level k: 0 up to one step below the level, 1 from the level on, linear between. */
static hys_real ridge(hys_real x, size_t k)
{
    return hys_clamp(x - number(k - 1u), ZERO, ONE);
}

/* The row or column on whose ridge a position lies. */
static size_t touched(const hys_model *model, hys_real x)
{
    size_t cell = whole(x);
    return (cell < model->levels ? cell : model->levels - 1u) + 1u;
}

/* Moves the operators' states, and the output that the off-line weights expect. A rising input
 * changes only rows, a falling one only columns: at most one pass over the operators. */
static void follow(hys_adaptive *self, hys_real from, hys_real to)
{
    hys_real change = ZERO;
    const hys_model *model = &self->model;
    size_t first = touched(model, hys_min(from, to)), last = touched(model, hys_max(from, to));
    size_t i, j;
    if (to > from) {
        for (j = first; j <= last; j++) { /* at most K iterations */
            hys_real on = ridge(to, j);
            for (i = 1u; i <= j; i++) { /* at most K iterations */
                size_t n = operator_index(i, j);
                hys_real moved = hys_max(self->gamma[n], on);
                change += self->offline[n] * (moved - self->gamma[n]);
                self->gamma[n] = moved;
            }
        }
    } else if (to < from) {
        for (i = first; i <= last; i++) { /* at most K iterations */
            hys_real off = ridge(to, i);
            for (j = i; j <= model->levels; j++) { /* at most K iterations */
                size_t n = operator_index(i, j);
                hys_real moved = hys_min(self->gamma[n], off);
                change += self->offline[n] * (moved - self->gamma[n]);
                self->gamma[n] = moved;
            }
        }
    }
    self->expected += (model->kind == MKP ? ONE : number(2u)) * change;
}

/* Whether the operators' states belong to the present position and branch of the state. */
static int is_aligned(const hys_adaptive *self)
{
    const hys_state *here = &self->state;
    return self->aligned && here->x == self->seen_x && here->top == self->seen_top && here->end == self->seen_end &&
           here->began_cell == self->seen_cell && here->began_part == self->seen_part;
}

static void see(hys_adaptive *self)
{
    const hys_state *here = &self->state;
    self->seen_x = here->x;
    self->seen_end = here->end;
    self->seen_part = here->began_part;
    self->seen_top = here->top;
    self->seen_cell = here->began_cell;
    self->aligned = 1u;
}

/* Computes the operators' states from the turning points. */
static void align(hys_adaptive *self)
{
    const hys_state *state = &self->state;
    size_t i, j, n, count = operators(self);
    for (n = 0u; n < count; n++) {
        self->gamma[n] = ZERO;
    }
    for (n = START + 1u; n <= state->top + 1u; n++) { /* at most 4K + 3 iterations */
        hys_real x = n <= state->top ? state->turns[n].x : state->x;
        for (j = 1u; j <= self->model.levels; j++) { /* K iterations */
            for (i = 1u; i <= j; i++) { /* at most K iterations */
                hys_real *gamma = self->gamma + operator_index(i, j);
                *gamma = hys_max(ridge(x, j), hys_min(*gamma, ridge(x, i)));
            }
        }
    }
    self->learned = state->x;
    watch_anew(self);
}

/* ---- Weights and table ---- */

/* The derivative of the output with respect to parameter n: the output of its operator, or the
 * offset's share. */
static hys_real regressor(const hys_adaptive *self, size_t n, size_t count)
{
    hys_real gamma;
    if (n == count) {
        return self->options.offset_share;
    }
    gamma = self->gamma[n];
    return self->model.kind == MKP ? gamma : gamma + gamma - ONE;
}

/* The sum of parameters times regressor. For NULL, the sum of the squares of the regressor. */
static hys_real dot(const hys_adaptive *self, const hys_real *parameters)
{
    hys_real sums[LANES], sum = ZERO;
    size_t n, count = operators(self), even = (count + 1u) / LANES * LANES;
    for (n = 0u; n < LANES; n++) {
        sums[n] = ZERO;
    }
    for (n = 0u; n < even; n++) { /* at most N + 1 iterations */
        hys_real phi = regressor(self, n, count);
        sums[n % LANES] += (parameters != NULL ? parameters[n] : phi) * phi;
    }
    for (n = 0u; n < LANES; n++) {
        sum += sums[n];
    }
    for (n = even; n <= count; n++) { /* less than LANES iterations */
        hys_real phi = regressor(self, n, count);
        sum += (parameters != NULL ? parameters[n] : phi) * phi;
    }
    return sum;
}

/* The offset without sign. */
static hys_real offset_of(const hys_adaptive *self)
{
    return self->offset + self->options.offset_share * self->theta[operators(self)];
}

/* Writes the table, and what depends on it, from the weights. */
static void rewrite(hys_adaptive *self)
{
    hys_model *model = &self->model;
    hys_real *row = self->table;
    size_t p, q;
    row[0] = ZERO;
    for (p = 1u; p <= model->levels; p++) { /* K iterations */
        const hys_real *above = row, *weights = self->theta + operator_index(1u, p);
        hys_real sum = ZERO;
        row += p;
        row[p] = ZERO;
        for (q = p; q-- > 0u;) { /* at most K iterations */
            sum += weights[q];
            row[q] = above[q] + sum;
        }
    }
    model->total = row[0];
    model->rounding = number(4u) * EPSILON * model->total;
    model->offset = model->falls ? -offset_of(self) : offset_of(self);
}

static void clear_trial(hys_adaptive *self)
{
    self->now_squares = ZERO;
    self->candidate_squares = ZERO;
    self->good_squares = ZERO;
    self->rounding_squares = ZERO;
    self->samples = 0u;
}

static void take_back(hys_adaptive *self)
{
    size_t count = operators(self) + 1u;
    copy(self->theta, self->good, count);
    copy(self->candidate, self->good, count);
    clear_trial(self);
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

/* ---- Learning ---- */

/* Adds a sample to the trial. At its end the candidate becomes the good one if it predicted no
 * worse. Returns whether the good weights replaced the present ones, because these had more than
 * four times the mean square error. */
static int judge(hys_adaptive *self, hys_real now, hys_real candidate, hys_real good, hys_real measured)
{
    hys_real rounding = number(256u) * EPSILON * measured;
    size_t count = operators(self) + 1u;
    self->now_squares += now * now;
    self->candidate_squares += candidate * candidate;
    self->good_squares += good * good;
    self->rounding_squares += rounding * rounding;
    self->samples += 1u;
    if (self->samples < self->options.trial) {
        return 0;
    }
    now = self->now_squares;
    candidate = self->candidate_squares;
    good = self->good_squares;
    rounding = self->rounding_squares;
    clear_trial(self);
    /* Sums that overflow give no answer: the outlier is in all of them. */
    if (candidate <= good && is_finite(candidate)) {
        copy(self->good, self->candidate, count);
    }
    if (now > number(4u) * (hys_min(candidate, good) + rounding)) {
        copy(self->theta, self->good, count);
        copy(self->candidate, self->good, count);
        return 1;
    }
    copy(self->candidate, self->theta, count);
    return 0;
}

/* Moves the parameters along the regressor by a fraction of the error. Weights stay at zero or
 * above. */
static void update(hys_adaptive *self, hys_real error)
{
    size_t n, count = operators(self);
    hys_real leakage = self->options.leakage;
    hys_real step = self->options.gain * error / (self->floor + dot(self, NULL));
    if (!is_finite(step)) {
        return;
    }
    for (n = 0u; n <= count; n++) { /* N + 1 iterations */
        hys_real theta = self->theta[n], offline = n < count ? self->offline[n] : ZERO;
        theta = theta + step * regressor(self, n, count) + leakage * (offline - theta);
        self->theta[n] = n < count ? hys_max(theta, ZERO) : theta;
    }
}

/* Whether a channel stands still. If one begins to, the parameters from before return; the table is
 * not written. */
static int find_stuck(hys_adaptive *self, hys_real measured, int believed)
{
    size_t count = operators(self) + 1u;
    int already = self->watch.stuck;
    int piece = look(&self->watch, self->state.x, self->expected, measured, believed);
    if (piece == 2) {
        copy(self->trusted, self->pending, count);
    }
    if (piece != 0) {
        copy(self->pending, self->theta, count);
    }
    if (self->watch.stuck != 0 && already == 0) {
        copy(self->good, self->trusted, count);
        copy(self->pending, self->trusted, count);
        take_back(self);
        restart(&self->gate);
        self->undone = 1u;
    }
    return self->watch.stuck;
}

static int learn(hys_adaptive *self, hys_real measured, hys_real error)
{
    hys_real rest = measured - self->offset, zone = self->options.dead_zone, counted;
    hys_real candidate, good;
    int believed = believes(&self->gate, error, &self->options);
    if (self->options.gate > ZERO) {
        int stuck = find_stuck(self, measured, believed);
        if (stuck != 0) {
            return stuck;
        }
    }
    if (!believed) {
        return HYS_REJECTED;
    }
    candidate = rest - dot(self, self->candidate);
    good = rest - dot(self, self->good);
    if (judge(self, error, candidate, good, measured)) {
        return HYS_ROLLED_BACK;
    }
    counted = error - hys_clamp(error, -zone, zone);
    if (counted == ZERO) {
        return HYS_WAITING;
    }
    update(self, counted);
    return HYS_LEARNED;
}

/* Whether the input moved since the last sample learned from. If not, the sample would be the same
 * equation again. */
static int moves(hys_adaptive *self)
{
    hys_real way = self->state.x - self->learned;
    int moved = hys_max(way, -way) > self->options.movement;
    if (moved) {
        self->learned = self->state.x;
    }
    return moved;
}

/* Copies the model without its weights. Member by member, because a copy of the whole struct may
 * become a call of memcpy. */
static void inherit(hys_adaptive *self, const hys_model *from)
{
    hys_model *model = &self->model;
    model->table = self->table;
    model->levels = from->levels;
    model->top = from->top;
    model->min = from->min;
    model->max = from->max;
    model->bottom = from->bottom;
    model->step = from->step;
    model->per_unit = from->per_unit;
    model->nudge = from->nudge;
    model->kind = from->kind;
    model->falls = from->falls;
    model->inverse = 1u;
}

static int usable(const hys_adaptive *self)
{
    if (self == NULL) {
        return HYS_NULL;
    }
    return self->table == NULL || self->state.model != &self->model ? HYS_STATE_MISMATCH : HYS_OK;
}

void hys_adapt_defaults(hys_adapt_options *options)
{
    if (options != NULL) {
        options->gain = number(30u) / number(100u);
        options->offset_share = ONE;
        options->dead_zone = ZERO;
        options->leakage = ZERO;
        options->movement = number(5u) / number(100u);
        options->trial = 256u;
        options->gate = number(12u);
        options->burst = 8u;
    }
}

static int from_zero(hys_real x)
{
    return x >= ZERO && is_finite(x);
}

int hys_adapt_start(hys_adaptive *adaptive, const hys_model *model, const hys_real *weights, hys_real offset,
                    const hys_adapt_options *options, hys_real *memory, size_t numbers, hys_turn *turns, size_t count)
{
    hys_adaptive *self = adaptive;
    hys_real size = ZERO;
    size_t n, levels, all, table;
    if (self == NULL || model == NULL || weights == NULL || options == NULL || memory == NULL || turns == NULL) {
        return HYS_NULL;
    }
    levels = model->levels;
    all = levels * (levels + 1u) / 2u;
    table = all + levels + 1u;
    if (numbers < table + 5u * (all + 1u) + all || count < 4u * levels + 8u) {
        return HYS_MEMORY_TOO_SMALL;
    }
    if (!(options->gain > ZERO && options->gain < number(2u) && from_zero(options->offset_share) &&
          from_zero(options->dead_zone) && options->leakage >= ZERO && options->leakage <= ONE &&
          from_zero(options->movement) && options->trial > 0u && options->burst > 0u &&
          (options->gate == ZERO || (options->gate >= number(2u) && is_finite(options->gate))))) {
        return HYS_ADAPTATION;
    }
    if (!is_finite(offset)) {
        return HYS_INPUT_NOT_FINITE;
    }
    for (n = 0u; n < all; n++) { /* N iterations */
        size += hys_max(weights[n], -weights[n]);
        if (!is_finite(size + size)) {
            return HYS_WEIGHT_NOT_FINITE;
        }
    }
    for (n = 0u; n < all; n++) { /* N iterations */
        if (weights[n] < ZERO) {
            return HYS_NEGATIVE_WEIGHTS;
        }
    }
    self->table = memory;
    self->theta = memory + table;
    self->good = self->theta + (all + 1u);
    self->candidate = self->good + (all + 1u);
    self->trusted = self->candidate + (all + 1u);
    self->pending = self->trusted + (all + 1u);
    self->gamma = self->pending + (all + 1u);
    self->options.gain = options->gain;
    self->options.offset_share = options->offset_share;
    self->options.dead_zone = options->dead_zone;
    self->options.leakage = options->leakage;
    self->options.movement = options->movement;
    self->options.trial = options->trial;
    self->options.gate = options->gate;
    self->options.burst = options->burst;
    self->offline = weights;
    inherit(self, model);
    self->offset = model->falls ? -offset : offset;
    self->floor = number(all) / number(100u);
    self->aligned = 0u;
    self->frozen = 0u;
    self->undone = 0u;
    copy(self->theta, weights, all);
    self->theta[all] = ZERO;
    copy(self->good, self->theta, all + 1u);
    copy(self->candidate, self->theta, all + 1u);
    clear_trial(self);
    rewrite(self);
    self->gate.range = self->model.total;
    if (model->kind != MKP) {
        self->gate.range += self->model.total;
    }
    restart(&self->gate);
    self->watch.range = self->gate.range;
    self->watch.width = number(levels);
    watch_anew(self);
    (void)hys_start(&self->model, &self->state, turns, count);
    self->learned = ZERO;
    return HYS_OK;
}

int hys_adapt_step(hys_adaptive *adaptive, hys_real input, hys_real measured, hys_real *output, int *outcome)
{
    hys_adaptive *self = adaptive;
    hys_real from, own, offset, error, expected;
    int found, moved, code = usable(self);
    if (code != HYS_OK) {
        return code;
    }
    if (output == NULL || outcome == NULL) {
        return HYS_NULL;
    }
    if (!is_finite(input) || !is_finite(measured)) {
        return HYS_INPUT_NOT_FINITE;
    }
    if (!is_aligned(self)) {
        align(self);
    }
    from = self->state.x;
    (void)hys_step(&self->state, input, &expected);
    follow(self, from, self->state.x);
    see(self);
    if (self->model.falls) {
        measured = -measured;
    }
    own = own_sum(&self->model, self->state.y);
    offset = offset_of(self);
    error = measured - own - offset;
    moved = moves(self);
    if (self->frozen) {
        found = HYS_FROZEN;
    } else {
        found = moved ? learn(self, measured, error) : HYS_AT_REST;
    }
    if (found == HYS_LEARNED) {
        rewrite(self);
        if (!is_finite(self->model.total + self->model.total) || !is_finite(offset_of(self))) {
            take_back(self);
            found = HYS_ROLLED_BACK;
        }
    }
    if (found == HYS_ROLLED_BACK || self->undone) {
        rewrite(self);
    }
    if (found == HYS_LEARNED || found == HYS_ROLLED_BACK || self->undone) {
        (void)hys_rebase(&self->state);
    }
    self->undone = 0u;
    if (found == HYS_LEARNED || found == HYS_WAITING || found == HYS_ROLLED_BACK || found == HYS_OUTPUT_STUCK ||
        found == HYS_INPUT_STUCK) {
        settle(&self->gate, measured - own_sum(&self->model, self->state.y) - offset_of(self));
    }
    expected = own + offset;
    *output = self->model.falls ? -expected : expected;
    *outcome = found;
    return HYS_OK;
}

const hys_real *hys_adapt_weights(const hys_adaptive *adaptive)
{
    return usable(adaptive) == HYS_OK ? adaptive->theta : NULL;
}

int hys_adapt_freeze(hys_adaptive *adaptive, int frozen)
{
    int code = usable(adaptive);
    if (code == HYS_OK) {
        adaptive->frozen = frozen != 0 ? 1u : 0u;
        restart_watch(&adaptive->watch);
    }
    return code;
}

int hys_adapt_keep(hys_adaptive *adaptive)
{
    int code = usable(adaptive);
    if (code == HYS_OK) {
        size_t count = operators(adaptive) + 1u;
        copy(adaptive->good, adaptive->theta, count);
        copy(adaptive->candidate, adaptive->theta, count);
        clear_trial(adaptive);
        watch_anew(adaptive);
    }
    return code;
}

int hys_adapt_roll_back(hys_adaptive *adaptive)
{
    int code = usable(adaptive);
    if (code == HYS_OK) {
        take_back(adaptive);
        restart(&adaptive->gate);
        watch_anew(adaptive);
        rewrite(adaptive);
        (void)hys_rebase(&adaptive->state);
    }
    return code;
}

int hys_adapt_realign(hys_adaptive *adaptive)
{
    int code = usable(adaptive);
    if (code == HYS_OK) {
        adaptive->aligned = 0u;
    }
    return code;
}

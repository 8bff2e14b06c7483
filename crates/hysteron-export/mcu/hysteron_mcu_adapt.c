#include "hysteron_mcu_adapt.h"
#include "hysteron_mcu_guards.h"
#include "hysteron_mcu_internal.h"

/* Number of running sums of a long sum. The rounding of the library depends on it. */
#define LANES 8u

/* A sample leads at most one negative weight back to zero for each of so many parameters. */
#define PARAMETERS_PER_STEP 4u

static size_t operators(const hys_adaptive *self)
{
    return self->model.levels * (self->model.levels + 1u) / 2u;
}

/* Index of operator (i, j), 1 <= i <= j, among the weights. */
static size_t operator_index(size_t i, size_t j)
{
    return j * (j - 1u) / 2u + (i - 1u);
}

/* Index of element (a, b) in the lower triangle of a symmetric matrix, row by row. */
static size_t packed(size_t a, size_t b)
{
    return a < b ? operator_index(a + 1u, b + 1u) : operator_index(b + 1u, a + 1u);
}

static void copy(hys_real *to, const hys_real *from, size_t count)
{
    size_t n;
    for (n = 0u; n < count; n++) {
        to[n] = from[n];
    }
}

static void fill(hys_real *to, hys_real value, size_t count)
{
    size_t n;
    for (n = 0u; n < count; n++) {
        to[n] = value;
    }
}

/* The change of an operator's output while its state goes from 0 to 1. */
static hys_real stroke(const hys_adaptive *self)
{
    return self->model.kind == MKP ? ONE : number(2u);
}

/* The amount of an error beyond the dead zone. */
static hys_real beyond(const hys_adaptive *self, hys_real error)
{
    hys_real zone = self->options.dead_zone;
    return error - hys_clamp(error, -zone, zone);
}

/* The sum of products of as many numbers as there are parameters. */
static hys_real dot(const hys_real *a, const hys_real *b, size_t count)
{
    hys_real sums[LANES], sum = ZERO;
    size_t n, even = count / LANES * LANES;
    fill(sums, ZERO, LANES);
    for (n = 0u; n < even; n++) { /* at most as many iterations as parameters */
        sums[n % LANES] += a[n] * b[n];
    }
    for (n = 0u; n < LANES; n++) {
        sum += sums[n];
    }
    for (n = even; n < count; n++) { /* less than LANES iterations */
        sum += a[n] * b[n];
    }
    return sum;
}

/* Starts the watch again, from the present parameters. */
static void watch_anew(hys_adaptive *self)
{
    copy(self->trusted, self->theta, self->parameters);
    copy(self->pending, self->theta, self->parameters);
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
    self->expected += stroke(self) * change;
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
    size_t i, j, n;
    if (self->gamma != NULL) {
        fill(self->gamma, ZERO, operators(self));
        for (n = START + 1u; n <= state->top + 1u; n++) { /* at most 4K + 3 iterations */
            hys_real x = n <= state->top ? state->turns[n].x : state->x;
            for (j = 1u; j <= self->model.levels; j++) { /* K iterations */
                for (i = 1u; i <= j; i++) { /* at most K iterations */
                    hys_real *gamma = self->gamma + operator_index(i, j);
                    *gamma = hys_max(ridge(x, j), hys_min(*gamma, ridge(x, i)));
                }
            }
        }
    }
    self->learned = state->x;
    self->under_way = 0u;
    watch_anew(self);
}

/* ---- Parameters and table ---- */

/* The offset without sign. */
static hys_real offset_of(const hys_adaptive *self)
{
    return self->offset + self->options.offset_share * self->theta[self->parameters - 1u];
}

/* Computes row p of a table from the row above it. */
static void fill_row(const hys_adaptive *self, size_t p, const hys_real *above, hys_real *row)
{
    const hys_real *weights = self->theta + operator_index(1u, p);
    hys_real sum = ZERO;
    size_t q;
    row[p] = ZERO;
    for (q = p; q-- > 0u;) { /* at most K iterations */
        sum += weights[q];
        row[q] = above[q] + sum;
    }
}

/* What the model has of its table. */
static void take(hys_adaptive *self, hys_real *table)
{
    self->table = table;
    self->model.table = table;
    self->model.total = table[table_index(self->model.levels, 0u)];
    self->model.rounding = number(4u) * EPSILON * self->model.total;
    self->renewed = 1u;
}

/* Writes the table from the parameters. */
static void rewrite(hys_adaptive *self)
{
    hys_real *row = self->table;
    size_t p, q, n;
    row[0] = ZERO;
    for (p = 1u; p <= self->model.levels; p++) { /* K iterations */
        const hys_real *above = row;
        row += p;
        if (self->basis == NULL) {
            fill_row(self, p, above, row);
            continue;
        }
        fill(row, ZERO, p + 1u);
        for (n = 0u; n < self->basis->count; n++) { /* as many iterations as coefficients */
            const hys_real *member = self->basis->tables + n * self->basis->length + table_index(p, 0u);
            for (q = 0u; q <= p; q++) { /* at most K + 1 iterations */
                row[q] += self->theta[n] * member[q];
            }
        }
    }
    take(self, self->table);
    self->rows_due = 0u;
}

/* Writes the next row of the second table. After the last row the model uses it. Returns 1 then, 0
 * before, and -1 where the weights overflow. */
static int renew_row(hys_adaptive *self)
{
    hys_real *above, *row, *now = self->table;
    self->other[0] = ZERO;
    above = self->other + table_index(self->renewed - 1u, 0u);
    row = above + self->renewed;
    fill_row(self, self->renewed, above, row);
    if (!is_finite(row[0] + row[0])) {
        self->renewed = 1u;
        return -1;
    }
    self->renewed += 1u;
    if (self->renewed <= self->model.levels) {
        return 0;
    }
    take(self, self->other);
    self->other = now;
    return 1;
}

static void clear_trial(hys_trial *trial)
{
    trial->now = ZERO;
    trial->candidate = ZERO;
    trial->good = ZERO;
    trial->rounding = ZERO;
    trial->samples = 0u;
}

static void clear_trials(hys_adaptive *self)
{
    clear_trial(&self->trial);
    clear_trial(&self->level);
}

/* Restarts estimate and covariance from the present parameters, after these were replaced. */
static void restart_estimate(hys_adaptive *self)
{
    size_t count = self->parameters;
    if (self->estimate != NULL) {
        copy(self->covariance, self->start, count * (count + 1u) / 2u);
        copy(self->estimate, self->theta, count);
    }
}

static void take_back(hys_adaptive *self)
{
    copy(self->theta, self->good, self->parameters);
    copy(self->candidate, self->good, self->parameters);
    restart_estimate(self);
    clear_trials(self);
}

/* ---- Learning ---- */

/* Prediction errors of a sample, with the present, the candidate and the last good parameters. */
typedef struct {
    hys_real now, candidate, good;
} hys_errors;

/* Adds a sample to a trial of the parameters from `first` on. At its end the candidate becomes the
 * good one if it predicted no worse. Returns whether the good parameters replaced the present ones,
 * because these had more than four times the mean square error. */
static int judge(hys_adaptive *self, hys_trial *trial, size_t first, size_t count, const hys_errors *errors,
                 hys_real measured)
{
    hys_real rounding = number(256u) * EPSILON * measured, now, candidate, good;
    trial->now += errors->now * errors->now;
    trial->candidate += errors->candidate * errors->candidate;
    trial->good += errors->good * errors->good;
    trial->rounding += rounding * rounding;
    trial->samples += 1u;
    if (trial->samples < self->options.trial) {
        return 0;
    }
    now = trial->now;
    candidate = trial->candidate;
    good = trial->good;
    rounding = trial->rounding;
    clear_trial(trial);
    /* Sums that overflow give no answer: the outlier is in all of them. */
    if (candidate <= good && is_finite(candidate)) {
        copy(self->good + first, self->candidate + first, count);
    }
    if (now > number(4u) * (hys_min(candidate, good) + rounding)) {
        copy(self->theta + first, self->good + first, count);
        copy(self->candidate + first, self->good + first, count);
        return 1;
    }
    copy(self->candidate + first, self->theta + first, count);
    return 0;
}

#include "hysteron_mcu_increments.h"
#include "hysteron_mcu_least_squares.h"

/* Whether a channel stands still. If one begins to, the parameters from before return; the table is
 * not written. */
static int find_stuck(hys_adaptive *self, hys_real measured, int believed)
{
    size_t count = self->parameters;
    hys_real expected = self->basis == NULL ? self->expected : expected_by_basis(self);
    int already = self->watch.stuck;
    int piece = look(&self->watch, self->state.x, expected, measured, believed);
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
        self->under_way = 0u;
        self->undone = 1u;
    }
    return self->watch.stuck;
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

/* Learns from a reading, if the input moved and the gate accepts it. `above` is the measured output
 * less the operators' sum. */
static int learn(hys_adaptive *self, hys_real measured, hys_real above)
{
    hys_real error = above - offset_of(self);
    int by_rows = self->options.learner == HYS_INCREMENTS;
    int moved = moves(self), ends, believed, found;
    if (self->frozen) {
        return HYS_FROZEN;
    }
    ends = by_rows && increment_ends(self);
    if (!moved && !ends) {
        return HYS_AT_REST;
    }
    believed = believes(&self->gate, error, &self->options);
    if (self->options.gate > ZERO) {
        found = find_stuck(self, measured, believed);
        if (found != 0) {
            return found;
        }
    }
    if (!believed) {
        self->under_way = 0u;
        return HYS_REJECTED;
    }
    if (!by_rows) {
        return learn_squares(self, measured, error);
    }
    moved = moved ? 1 + learn_level(self, measured, above) : 0;
    found = ends ? learn_slope(self, measured) : HYS_WAITING;
    if (moved == 2) {
        return HYS_ROLLED_BACK;
    }
    return found == HYS_WAITING && moved == 0 ? HYS_AT_REST : found;
}

/* Updates the table from the parameters. Where it would not be finite, the last good parameters
 * return. `*changed` tells whether the model changed. */
static int renew(hys_adaptive *self, int found, int *changed)
{
    int by_rows = self->options.learner == HYS_INCREMENTS, undone = self->undone, row;
    self->undone = 0u;
    *changed = 1;
    if (found == HYS_ROLLED_BACK || undone) {
        rewrite(self);
        return found;
    }
    if (found == HYS_LEARNED && !by_rows) {
        rewrite(self);
        if (is_finite(self->model.total + self->model.total) && is_finite(offset_of(self))) {
            return found;
        }
    } else {
        if (found == HYS_LEARNED) {
            /* At most the rest of the pass under way, and one whole pass. */
            self->rows_due = 2u * self->model.levels;
        }
        if (self->rows_due == 0u) {
            *changed = 0;
            return found;
        }
        self->rows_due -= 1u;
        row = renew_row(self);
        if (row >= 0) {
            *changed = row;
            return found;
        }
    }
    take_back(self);
    rewrite(self);
    return HYS_ROLLED_BACK;
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

/* Member by member, as above. */
static void copy_options(hys_adapt_options *to, const hys_adapt_options *from)
{
    to->basis = from->basis;
    to->learner = from->learner;
    to->trial = from->trial;
    to->burst = from->burst;
    to->gain = from->gain;
    to->span = from->span;
    to->forgetting = from->forgetting;
    to->noise = from->noise;
    to->spread = from->spread;
    to->correlation = from->correlation;
    to->offset_share = from->offset_share;
    to->dead_zone = from->dead_zone;
    to->leakage = from->leakage;
    to->movement = from->movement;
    to->gate = from->gate;
}

static int usable(const hys_adaptive *self)
{
    if (self == NULL) {
        return HYS_NULL;
    }
    return self->table == NULL || self->state.model != &self->model ? HYS_STATE_MISMATCH : HYS_OK;
}

static int from_zero(hys_real x)
{
    return x >= ZERO && is_finite(x);
}

/* Whether an option of least squares has a square that is a number, and is above zero. */
static int has_square(hys_real x)
{
    return x > ZERO && x * x > ZERO && is_finite(x * x);
}

static int in_range(const hys_adapt_options *options)
{
    const hys_adapt_options *o = options;
    if (!(from_zero(o->offset_share) && from_zero(o->dead_zone) && o->leakage >= ZERO && o->leakage <= ONE &&
          from_zero(o->movement) && o->trial > 0u && o->burst > 0u &&
          (o->gate == ZERO || (o->gate >= number(2u) && is_finite(o->gate))))) {
        return 0;
    }
    switch (o->learner) {
    case HYS_INCREMENTS:
        return o->gain > ZERO && o->gain < number(2u) && o->span >= ONE / number(8u) && o->span <= number(8u);
    case HYS_LEAST_SQUARES:
    case HYS_DRIFT:
        return o->forgetting > ZERO && o->forgetting <= ONE && has_square(o->noise) && has_square(o->spread) &&
               (o->learner == HYS_DRIFT ? o->basis != NULL && o->correlation == ZERO : from_zero(o->correlation));
    default:
        return 0;
    }
}

/* Divides `memory` into the arrays. Returns how many numbers they need; with NULL it only counts. */
static size_t divide(hys_adaptive *self, size_t levels, const hys_adapt_options *options, hys_real *memory)
{
    size_t all = levels * (levels + 1u) / 2u, table = all + levels + 1u, used = 0u;
    size_t weights = options->learner == HYS_DRIFT ? options->basis->count : all, count = weights + 1u;
    int by_rows = options->learner == HYS_INCREMENTS;
    size_t triangle = by_rows ? 0u : count * (count + 1u) / 2u, squares = by_rows ? 0u : count;
    size_t states = options->learner == HYS_DRIFT ? 0u : all;
#define NEXT(array, length)                                                         \
    do {                                                                            \
        if (memory != NULL) {                                                       \
            self->array = (length) > 0u ? memory + used : NULL;                     \
        }                                                                           \
        used += (length);                                                           \
    } while (0)
    NEXT(table, table);
    NEXT(other, by_rows ? table : 0u);
    NEXT(theta, count);
    NEXT(good, count);
    NEXT(candidate, count);
    NEXT(trusted, count);
    NEXT(pending, count);
    NEXT(gamma, states);
    NEXT(anchor, by_rows ? all : 0u);
    NEXT(phi, squares);
    NEXT(initial, squares);
    NEXT(covariance, triangle);
    NEXT(start, triangle);
    NEXT(step, squares);
    NEXT(estimate, squares);
#undef NEXT
    if (memory != NULL) {
        self->parameters = count;
        self->basis = options->learner == HYS_DRIFT ? options->basis : NULL;
    }
    return used;
}

int hys_adapt_start(hys_adaptive *adaptive, const hys_model *model, const hys_real *parameters, hys_real offset,
                    const hys_adapt_options *options, hys_real *memory, size_t numbers, hys_turn *turns, size_t count)
{
    hys_adaptive *self = adaptive;
    hys_real size = ZERO;
    size_t n, levels, all;
    if (self == NULL || model == NULL || parameters == NULL || options == NULL || memory == NULL || turns == NULL) {
        return HYS_NULL;
    }
    levels = model->levels;
    if (!in_range(options)) {
        return HYS_ADAPTATION;
    }
    if (numbers < divide(NULL, levels, options, NULL) || count < 4u * levels + 8u) {
        return HYS_MEMORY_TOO_SMALL;
    }
    if (!is_finite(offset)) {
        return HYS_INPUT_NOT_FINITE;
    }
    all = options->learner == HYS_DRIFT ? options->basis->count : levels * (levels + 1u) / 2u;
    for (n = 0u; n < all; n++) { /* as many iterations as parameters */
        size += hys_max(parameters[n], -parameters[n]);
        if (!is_finite(size + size)) {
            return HYS_WEIGHT_NOT_FINITE;
        }
    }
    for (n = 0u; n < all; n++) { /* as many iterations as parameters */
        if (parameters[n] < ZERO) {
            return HYS_NEGATIVE_WEIGHTS;
        }
    }
    (void)divide(self, levels, options, memory);
    copy_options(&self->options, options);
    inherit(self, model);
    self->offset = model->falls ? -offset : offset;
    self->aligned = 0u;
    self->under_way = 0u;
    self->frozen = 0u;
    self->undone = 0u;
    copy(self->theta, parameters, all);
    self->theta[all] = ZERO;
    self->offline = parameters;
    if (self->initial != NULL) {
        copy(self->initial, self->theta, all + 1u);
        self->offline = self->initial;
    }
    copy(self->good, self->theta, all + 1u);
    copy(self->candidate, self->theta, all + 1u);
    start_covariance(self);
    restart_estimate(self);
    clear_trials(self);
    rewrite(self);
    self->model.offset = offset;
    self->gate.range = stroke(self) * self->model.total;
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
    hys_real from, own, expected;
    int found, changed, code = usable(self);
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
    if (self->gamma != NULL) {
        follow(self, from, self->state.x);
    }
    see(self);
    if (self->model.falls) {
        measured = -measured;
    }
    own = own_sum(&self->model, self->state.y);
    expected = own + offset_of(self);
    found = renew(self, learn(self, measured, measured - own), &changed);
    if (changed) {
        (void)hys_rebase(&self->state);
    }
    if (found != HYS_AT_REST && found != HYS_FROZEN && found != HYS_REJECTED) {
        settle(&self->gate, measured - own_sum(&self->model, self->state.y) - offset_of(self));
    }
    self->model.offset = self->model.falls ? -offset_of(self) : offset_of(self);
    *output = self->model.falls ? -expected : expected;
    *outcome = found;
    return HYS_OK;
}

const hys_real *hys_adapt_parameters(const hys_adaptive *adaptive)
{
    return usable(adaptive) == HYS_OK ? adaptive->theta : NULL;
}

int hys_adapt_freeze(hys_adaptive *adaptive, int frozen)
{
    int code = usable(adaptive);
    if (code == HYS_OK) {
        adaptive->frozen = frozen != 0 ? 1u : 0u;
        adaptive->under_way = 0u;
        restart_watch(&adaptive->watch);
    }
    return code;
}

int hys_adapt_keep(hys_adaptive *adaptive)
{
    int code = usable(adaptive);
    if (code == HYS_OK) {
        copy(adaptive->good, adaptive->theta, adaptive->parameters);
        copy(adaptive->candidate, adaptive->theta, adaptive->parameters);
        watch_anew(adaptive);
        clear_trials(adaptive);
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
        adaptive->model.offset = adaptive->model.falls ? -offset_of(adaptive) : offset_of(adaptive);
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

/* The learner of increments (time-difference scheme, Tan & Baras 2005). While the input crosses some
 * levels, only the operators in these rows and columns change. So the change of the output concerns
 * their weights alone. hysteron_mcu_adapt.c includes it. Not for applications. */

/* Whether an increment ends at the present position, or the first one begins there. */
static int increment_ends(hys_adaptive *self)
{
    hys_real least = hys_max(self->options.span, self->options.movement), x = self->state.x, way;
    if (!self->under_way) {
        return 1;
    }
    self->low = hys_min(self->low, x);
    self->high = hys_max(self->high, x);
    way = x - self->began;
    return hys_max(way, -way) >= least;
}

/* The change of the output of operator n since the increment began. */
static hys_real change(const hys_adaptive *self, size_t n)
{
    return stroke(self) * (self->gamma[n] - self->anchor[n]);
}

/* The operators in the rows and columns from `first` to `last`, one after the other: index n of the
 * operator (i, j). */
#define WITHIN(self, first, last, i, j, n)                                                              \
    for ((j) = (first); (j) <= (self)->model.levels; (j)++)          /* at most K iterations */         \
        for ((i) = (j) <= (last) ? 1u : (first); (i) <= ((j) <= (last) ? (j) : (last)); (i)++)          \
            if (((n) = operator_index((i), (j))), 1)

/* Learns the weights from a finished increment, and starts the next one. */
static int learn_slope(hys_adaptive *self, hys_real measured)
{
    hys_real gained = measured - self->at_start, norm = ZERO, counted, step, phi;
    hys_errors errors;
    size_t first, last, i, j, n, weights = self->parameters - 1u;
    int found = HYS_WAITING, begins = !self->under_way;
    first = touched(&self->model, begins ? self->state.x : self->low);
    last = touched(&self->model, begins ? self->state.x : self->high);
    self->under_way = 1u;
    self->at_start = measured;
    self->began = self->state.x;
    self->low = self->state.x;
    self->high = self->state.x;
    if (begins) {
        copy(self->anchor, self->gamma, weights);
        return HYS_WAITING;
    }
    errors.now = gained;
    errors.candidate = gained;
    errors.good = gained;
    WITHIN(self, first, last, i, j, n)
    {
        phi = change(self, n);
        norm += phi * phi;
        errors.now -= self->theta[n] * phi;
        errors.candidate -= self->candidate[n] * phi;
        errors.good -= self->good[n] * phi;
    }
    counted = beyond(self, errors.now);
    if (judge(self, &self->trial, 0u, weights, &errors, measured)) {
        found = HYS_ROLLED_BACK;
    } else if (counted != ZERO) {
        step = self->options.gain * counted / norm;
        WITHIN(self, first, last, i, j, n)
        {
            hys_real theta = self->theta[n];
            theta = theta + step * change(self, n) + self->options.leakage * (self->offline[n] - theta);
            if (is_finite(theta)) {
                self->theta[n] = hys_max(theta, ZERO);
            }
        }
        found = HYS_LEARNED;
    }
    WITHIN(self, first, last, i, j, n)
    {
        self->anchor[n] = self->gamma[n];
    }
    return found;
}

/* Learns the offset from the error of the output. Increments have no information about it. Returns
 * whether a trial took the offset back. */
static int learn_level(hys_adaptive *self, hys_real measured, hys_real above)
{
    size_t n = self->parameters - 1u;
    hys_real share = self->options.offset_share, norm = share * share + number(operators(self)), moved;
    hys_errors errors;
    errors.now = above - self->offset - share * self->theta[n];
    errors.candidate = above - self->offset - share * self->candidate[n];
    errors.good = above - self->offset - share * self->good[n];
    if (judge(self, &self->level, n, 1u, &errors, measured)) {
        return 1;
    }
    moved = self->theta[n] + self->options.gain * beyond(self, errors.now) * share / norm;
    if (is_finite(moved * share)) {
        self->theta[n] = moved;
    }
    return 0;
}

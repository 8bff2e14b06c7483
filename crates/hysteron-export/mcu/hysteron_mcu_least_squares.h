/* Recursive least squares with regularised forgetting (Kulhavy & Kraus 1996), of all weights or of
 * the coefficients of a basis. hysteron_mcu_adapt.c includes it. Not for applications. */

/* Adds the Everett function between two extremes to the regressor: positive on the way up, negative
 * on the way down. */
static void add_terms(hys_adaptive *self, hys_real from, hys_real to)
{
    const hys_adapt_basis *basis = self->basis;
    hys_real sign = to > from ? ONE : -ONE, larger, smaller, factors[3];
    split max = split_of(&self->model, to > from ? to : from), min = split_of(&self->model, to > from ? from : to);
    size_t k, n, at[3];
    at[0] = table_index(max.cell, min.cell);
    at[1] = at[0] + (max.part > min.part ? max.cell + 1u : 1u);
    at[2] = at[0] + max.cell + 2u;
    larger = hys_max(max.part, min.part);
    smaller = hys_min(max.part, min.part);
    factors[0] = sign * (ONE - larger);
    factors[1] = sign * (larger - smaller);
    factors[2] = sign * smaller;
    for (k = 0u; k < 3u; k++) { /* 3 iterations */
        for (n = 0u; n < basis->count; n++) { /* as many iterations as coefficients */
            self->phi[n] += factors[k] * basis->tables[n * basis->length + at[k]];
        }
    }
}

/* Writes the regressor: the derivative of the output with respect to each parameter. */
static void regress(hys_adaptive *self, hys_real share)
{
    const hys_state *state = &self->state;
    size_t n, weights = self->parameters - 1u;
    hys_real last = ZERO;
    self->phi[weights] = share;
    if (self->basis == NULL) {
        for (n = 0u; n < weights; n++) { /* N iterations */
            hys_real gamma = self->gamma[n];
            self->phi[n] = self->model.kind == MKP ? gamma : gamma + gamma - ONE;
        }
        return;
    }
    fill(self->phi, ZERO, weights);
    for (n = START + 1u; n <= state->top; n++) { /* at most 4K + 3 iterations */
        add_terms(self, last, state->turns[n].x);
        last = state->turns[n].x;
    }
    add_terms(self, state->turns[state->top].x, state->x);
    if (self->model.kind != MKP) {
        for (n = 0u; n < weights; n++) { /* as many iterations as coefficients */
            const hys_real *table = self->basis->tables + n * self->basis->length;
            self->phi[n] = self->phi[n] + self->phi[n] - table[table_index(self->model.levels, 0u)];
        }
    }
}

/* The output expected by the coefficients at the start, but for a constant. */
static hys_real expected_by_basis(hys_adaptive *self)
{
    regress(self, ZERO);
    return dot(self->offline, self->phi, self->parameters);
}

/* Writes the covariance at the start. */
static void start_covariance(hys_adaptive *self)
{
    hys_real variance = self->options.spread * self->options.spread;
    hys_real correlation = self->options.correlation, *entry = self->start;
    size_t i, j, k, l, n, count = self->parameters;
    if (entry == NULL) {
        return;
    }
    fill(entry, ZERO, count * (count + 1u) / 2u);
    for (n = 0u; n < count; n++) { /* as many iterations as parameters */
        self->start[packed(n, n)] = variance;
    }
    if (self->basis != NULL || !(correlation > ZERO)) {
        return;
    }
    for (j = 1u; j <= self->model.levels; j++) { /* together N iterations */
        for (i = 1u; i <= j; i++) {
            for (l = 1u; l <= j; l++) { /* together at most N iterations */
                for (k = 1u; k <= l && (l < j || k <= i); k++) {
                    hys_real rows = number(i > k ? i - k : k - i), columns = number(j - l);
                    hys_real distance = rows * rows + columns * columns;
                    *entry++ = variance / (ONE + distance / (correlation * correlation));
                }
            }
        }
    }
}

/* Covariance times regressor. */
static void multiply(hys_adaptive *self)
{
    const hys_real *row = self->covariance, *x = self->phi;
    hys_real *out = self->step;
    size_t n, m;
    for (n = 0u; n < self->parameters; n++) { /* as many iterations as parameters */
        for (m = 0u; m < n; m++) {
            out[m] += x[n] * row[m];
        }
        out[n] = row[n] * x[n] + dot(row, x, n);
        row += n + 1u;
    }
}

/* Updates the estimate and the covariance with a sample. */
static void update(hys_adaptive *self, hys_real error)
{
    const hys_adapt_options *options = &self->options;
    hys_real spread, total, step, forgetting = options->forgetting, back = ONE - forgetting;
    hys_real *row = self->covariance;
    const hys_real *start = self->start;
    size_t n, m, count = self->parameters;
    multiply(self);
    spread = dot(self->phi, self->step, count);
    if (spread < ZERO || !is_finite(spread)) {
        /* After very many samples, rounding can make the covariance indefinite. Restart it. */
        copy(self->covariance, self->start, count * (count + 1u) / 2u);
        multiply(self);
        spread = dot(self->phi, self->step, count);
    }
    total = options->noise * options->noise + spread;
    step = error / total;
    if (!is_finite(step) || !is_finite(total)) {
        return;
    }
    for (n = 0u; n < count; n++) { /* as many iterations as parameters */
        hys_real now = self->estimate[n];
        self->estimate[n] = now + step * self->step[n] + options->leakage * (self->offline[n] - now);
    }
    for (n = 0u; n < count; n++) { /* as many iterations as parameters */
        hys_real scaled = forgetting * self->step[n] / total;
        for (m = 0u; m <= n; m++) {
            row[m] = forgetting * row[m] - scaled * self->step[m] + back * start[m];
        }
        row += n + 1u;
        start += n + 1u;
    }
}

/* Leads negative weights back to zero along the covariance. Those that remain negative are set to
 * zero in the parameters, but not in the estimate. */
static void project(hys_adaptive *self)
{
    size_t k, n, round, weights = self->parameters - 1u;
    for (round = 0u; round < weights / PARAMETERS_PER_STEP + 1u; round++) {
        hys_real distance = ZERO, step = ZERO;
        size_t worst = 0u;
        for (k = 0u; k < weights; k++) { /* as many iterations as parameters */
            if (self->estimate[k] < ZERO) {
                hys_real way = self->estimate[k] / self->covariance[packed(k, k)];
                if (self->estimate[k] * way > distance) {
                    distance = self->estimate[k] * way;
                    step = way;
                    worst = k;
                }
            }
        }
        if (!(distance > ZERO && is_finite(distance))) {
            break;
        }
        for (n = 0u; n <= weights; n++) { /* as many iterations as parameters */
            self->estimate[n] -= step * self->covariance[packed(n, worst)];
        }
        self->estimate[worst] = ZERO;
    }
    copy(self->theta, self->estimate, weights + 1u);
    for (n = 0u; n < weights; n++) { /* as many iterations as parameters */
        self->theta[n] = hys_max(self->theta[n], ZERO);
    }
}

/* Learns from a sample. */
static int learn_squares(hys_adaptive *self, hys_real measured, hys_real error)
{
    hys_real rest = measured - self->offset, counted;
    size_t count = self->parameters;
    hys_errors errors;
    regress(self, self->options.offset_share);
    errors.now = error;
    errors.candidate = rest - dot(self->candidate, self->phi, count);
    errors.good = rest - dot(self->good, self->phi, count);
    if (judge(self, &self->trial, 0u, count, &errors, measured)) {
        restart_estimate(self);
        return HYS_ROLLED_BACK;
    }
    counted = beyond(self, rest - dot(self->estimate, self->phi, count));
    if (counted == ZERO) {
        return HYS_WAITING;
    }
    update(self, counted);
    project(self);
    return HYS_LEARNED;
}

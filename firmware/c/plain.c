/* Equation (5). Rising: γ ← max(γ, r_j). Falling: γ ← min(γ, r_i). The direction is the same for
 * all operators, and each ridge is computed once. So an operator costs one comparison and one
 * product. */
#include "plain.h"

static void ridges(const plain_model *model, hys_real input, hys_real *ridge) {
    hys_real x = (input - model->min) * ((hys_real)(model->levels - 1) / (model->max - model->min)) + 1;
    int k;
    for (k = 0; k < model->levels; k++) {
        hys_real r = x - (hys_real)k;
        ridge[k] = r < 0 ? 0 : r > 1 ? 1 : r;
    }
}

/* The double loop. It is inlined for each direction, and for a step and a trial step, so that it
 * has no tests of these. */
static inline __attribute__((always_inline)) hys_real sweep(const plain_state *state, hys_real input, int rising, int keep) {
    const hys_real *mu = state->model->weights;
    hys_real *gamma = state->gamma;
    hys_real ridge[PLAIN_LEVELS];
    hys_real sum = 0;
    int i, j, levels = state->model->levels;
    ridges(state->model, input, ridge);
    for (j = 0; j < levels; j++) {
        hys_real upper = ridge[j];
        for (i = 0; i <= j; i++, gamma++, mu++) {
            hys_real g = *gamma;
            hys_real bound = rising ? upper : ridge[i];
            if (rising ? bound > g : bound < g) {
                g = bound;
                if (keep)
                    *gamma = g;
            }
            sum += *mu * g;
        }
    }
    return sum;
}

/* The output of a step to `input`. The operators stay as they are, so nothing has to be copied. */
static hys_real trial(const plain_state *state, hys_real input, int rising) {
    return rising ? sweep(state, input, 1, 0) : sweep(state, input, 0, 0);
}

void plain_start(const plain_model *model, plain_state *state, hys_real *gamma) {
    int n;
    for (n = 0; n < model->levels * (model->levels + 1) / 2; n++)
        gamma[n] = 0;
    state->model = model;
    state->gamma = gamma;
    state->input = model->min - (model->max - model->min) / (hys_real)(model->levels - 1);
    state->output = 0;
}

void plain_step(plain_state *state, hys_real input, hys_real *output) {
    if (input > state->input)
        state->output = sweep(state, input, 1, 1);
    else if (input < state->input)
        state->output = sweep(state, input, 0, 1);
    state->input = input;
    *output = state->output;
}

/* Bisection between the present input and the end of the range in the target's direction. */
void plain_inverse_step(plain_state *state, hys_real target, hys_real *input, int *status) {
    const plain_model *model = state->model;
    int rising = target > state->output;
    hys_real step = (model->max - model->min) / (hys_real)(model->levels - 1);
    hys_real here = state->input, there = rising ? model->max : model->min - step;
    hys_real output;
    int n;
    *status = 0;
    if (target != state->output) {
        for (n = 0; n < PLAIN_HALVINGS; n++) {
            hys_real middle = here + (there - here) / 2;
            output = trial(state, middle, rising);
            if (rising ? output >= target : output <= target)
                there = middle;
            else
                here = middle;
        }
        here = there;
    }
    plain_step(state, here, &output);
    *input = here;
}

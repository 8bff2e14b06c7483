/* The forward step of an actuator with stages, and its state. */
#include "hysteron_mcu_latent.h"

static int begin(const hys_actuator *actuator, hys_actuator_state *state, const hys_model *model,
                 hys_turn *turns, size_t count)
{
    size_t k;
    int code = hys_start(model, &state->operators, turns, count);
    if (code == HYS_OK && actuator->start.numbers != NULL) {
        code = hys_restore(&state->operators, actuator->start.numbers, actuator->start.count,
                           actuator->start_input);
    }
    if (code != HYS_OK) {
        return code;
    }
    state->actuator = actuator;
    state->started = 0;
    state->temperature = ZERO;
    for (k = 0u; k < HYS_BEHIND_MEMORY; k++) {
        state->behind[k] = ZERO;
    }
    return HYS_OK;
}

int hys_actuator_start(const hys_actuator *actuator, hys_actuator_state *state, hys_turn *turns,
                       size_t count)
{
    if (actuator == NULL || state == NULL) {
        return HYS_NULL;
    }
    if (actuator->parts != NULL) {
        return HYS_MEMORY_TOO_SMALL;
    }
    state->mixed = NULL;
    return begin(actuator, state, actuator->operators, turns, count);
}

/* The values of the Bernstein polynomials at s in [0, 1], by de Casteljau's algorithm. */
static void bernstein(hys_real s, size_t count, hys_real *values)
{
    size_t n, k;
    values[0] = ONE;
    for (n = 1u; n < count; n++) { /* at most HYS_MOST_PARTS iterations, as the next loop */
        values[n] = s * values[n - 1u];
        for (k = n - 1u; k > 0u; k--) {
            values[k] = s * values[k - 1u] + (ONE - s) * values[k];
        }
        values[0] = (ONE - s) * values[0];
    }
}

/* The model at a load: its table is the sum of those of the parts. */
static void mix(const hys_parts *parts, hys_mixed *mixed, hys_real load)
{
    hys_model *model = &mixed->model;
    const hys_real *part = parts->tables;
    hys_real *table = mixed->table;
    size_t entries = table_index(model->levels + 1u, 0u), n, k;
    hys_real factors[HYS_MOST_PARTS];
    bernstein(hys_clamp((load - parts->min) / (parts->max - parts->min), ZERO, ONE), parts->count,
              factors);
    for (n = 0u; n < entries; n++) { /* (K + 1)(K + 2)/2 iterations */
        table[n] = ZERO;
    }
    for (k = 0u; k < parts->count; k++, part += entries) { /* at most HYS_MOST_PARTS iterations */
        for (n = 0u; n < entries; n++) { /* (K + 1)(K + 2)/2 iterations */
            table[n] = table[n] + factors[k] * part[n];
        }
    }
    model->total = table[table_index(model->levels, 0u)];
    model->rounding = (hys_real)4 * HYS_EPSILON * model->total;
    mixed->offset = ZERO;
    for (k = 0u; k < parts->count; k++) {
        mixed->offset = mixed->offset + factors[k] * parts->offsets[k];
    }
    mixed->load = load;
}

/* The same for a state, whose operators stay as they are. */
static int mix_state(hys_mixed *mixed, const hys_parts *parts, hys_state *operators, hys_real load)
{
    if (!is_finite(load)) {
        return HYS_LOAD;
    }
    mix(parts, mixed, load);
    return hys_rebase(operators);
}

int hys_actuator_start_mixed(const hys_actuator *actuator, hys_actuator_state *state,
                             hys_turn *turns, size_t count, hys_mixed *mixed, hys_real *table,
                             size_t entries)
{
    if (actuator == NULL || state == NULL) {
        return HYS_NULL;
    }
    if (actuator->parts == NULL) {
        return hys_actuator_start(actuator, state, turns, count);
    }
    if (mixed == NULL || table == NULL
        || entries < table_index(actuator->operators->levels + 1u, 0u)) {
        return HYS_MEMORY_TOO_SMALL;
    }
    mixed->model = *actuator->operators;
    mixed->model.table = table;
    mixed->table = table;
    mixed->place = mix_state;
    mix(actuator->parts, mixed, actuator->parts->min);
    state->mixed = mixed;
    return begin(actuator, state, &mixed->model, turns, count);
}

int hys_actuator_step(hys_actuator_state *state, hys_real drive, hys_real load, hys_real *output)
{
    const hys_actuator *actuator;
    loaded_axis at;
    hys_real temperature, sum;
    int code = usable_actuator(state);
    if (code != HYS_OK) {
        return code;
    }
    if (output == NULL) {
        return HYS_NULL;
    }
    actuator = state->actuator;
    temperature = heated(state, drive);
    if (!(is_finite(drive) && is_finite(temperature))) {
        return HYS_INPUT_NOT_FINITE;
    }
    code = curves_at(actuator, load, &at);
    if (code == HYS_OK) {
        code = place(state, load);
    }
    if (code == HYS_OK) {
        hys_real seen;
        temperature = bound(state, &at, temperature);
        seen = seen_at(actuator, &at, state->operators.input, temperature);
        code = hys_step(&state->operators, seen, &sum);
    }
    if (code != HYS_OK) {
        return code;
    }
    sum = behind_forward(state, at.gain * sum);
    state->started = 1;
    state->temperature = temperature;
    *output = at.offset + (actuator->falls ? offset_of(state) - sum : offset_of(state) + sum);
    return HYS_OK;
}

int hys_actuator_save(const hys_actuator_state *state, hys_real *numbers)
{
    size_t k;
    int code = usable_actuator(state);
    if (code != HYS_OK) {
        return code;
    }
    if (numbers == NULL) {
        return HYS_NULL;
    }
    numbers[0] = state->started ? ONE : ZERO;
    numbers[1] = state->temperature;
    for (k = 0u; k < HYS_BEHIND_MEMORY; k++) {
        numbers[2u + k] = state->behind[k];
    }
    return HYS_OK;
}

int hys_actuator_restore(hys_actuator_state *state, const hys_real *numbers)
{
    size_t k;
    int code = usable_actuator(state);
    if (code != HYS_OK) {
        return code;
    }
    if (numbers == NULL) {
        return HYS_NULL;
    }
    for (k = 0u; k < HYS_STAGE_NUMBERS; k++) {
        if (!is_finite(numbers[k])) {
            return HYS_INPUT_NOT_FINITE;
        }
    }
    state->started = numbers[0] != ZERO;
    state->temperature = numbers[1];
    for (k = 0u; k < HYS_BEHIND_MEMORY; k++) {
        state->behind[k] = numbers[2u + k];
    }
    return HYS_OK;
}

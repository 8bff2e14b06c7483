/* The forward step of an actuator with stages, and its state. */
#include "hysteron_mcu_stages_internal.h"

int hys_actuator_start(const hys_actuator *actuator, hys_actuator_state *state, hys_turn *turns,
                       size_t count)
{
    size_t k;
    int code;
    if (actuator == NULL || state == NULL) {
        return HYS_NULL;
    }
    code = hys_start(actuator->operators, &state->operators, turns, count);
    if (code == HYS_OK && actuator->start != NULL) {
        code = hys_restore(&state->operators, actuator->start, actuator->start_count,
                           actuator->start_input);
    }
    if (code != HYS_OK) {
        return code;
    }
    state->actuator = actuator;
    state->started = 0;
    state->temperature = ZERO;
    for (k = 0u; k < HYS_MOST_CREEP; k++) {
        state->crept[k] = ZERO;
    }
    state->lagged = ZERO;
    return HYS_OK;
}

/* The temperature after a sample time in which `drive` was held. It moves towards its value at rest
 * and never beyond it, so one time constant holds for all of the sample time. */
static hys_real heated(const hys_actuator_state *state, hys_real drive)
{
    const hys_actuator *actuator = state->actuator;
    hys_real rest, factor;
    if (!actuator->body) {
        return drive;
    }
    rest = actuator->ambient + actuator->gain * drive;
    if (!state->started) {
        return rest;
    }
    factor = rest > state->temperature ? actuator->heating : actuator->cooling;
    return rest + (state->temperature - rest) * factor;
}

/* Creep and lag of the operators' sum. */
static hys_real settled(hys_actuator_state *state, hys_real h)
{
    const hys_actuator *actuator = state->actuator;
    int rests = !state->started; /* at the first sample nothing of a past is left */
    hys_real sum = h;
    size_t k;
    for (k = 0u; k < HYS_MOST_CREEP; k++) {
        hys_real past = rests ? h : state->crept[k];
        state->crept[k] = past;
        if (k < actuator->creep_count) {
            state->crept[k] = h + (past - h) * (rests ? ZERO : actuator->fade[k]);
            sum = sum + actuator->creep[k] * state->crept[k];
        }
    }
    state->lagged = sum + ((rests ? h : state->lagged) - sum) * (rests ? ZERO : actuator->lag);
    return state->lagged;
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
        code = hys_step(&state->operators, seen_at(actuator, &at, temperature), &sum);
    }
    if (code != HYS_OK) {
        return code;
    }
    sum = settled(state, at.gain * sum);
    state->started = 1;
    state->temperature = temperature;
    *output = at.offset + (actuator->falls ? actuator->offset - sum : actuator->offset + sum);
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
    for (k = 0u; k < HYS_MOST_CREEP; k++) {
        numbers[2u + k] = state->crept[k];
    }
    numbers[2u + HYS_MOST_CREEP] = state->lagged;
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
    for (k = 0u; k < HYS_MOST_CREEP; k++) {
        state->crept[k] = numbers[2u + k];
    }
    state->lagged = numbers[2u + HYS_MOST_CREEP];
    return HYS_OK;
}

/* The form over the caller's memory. */
#include "check.h"
#include <math.h>
#include <string.h>

#define LEVELS 3
static const double WEIGHTS[6] = {1.0, 0.5, 1.0, 0.25, 0.5, 1.0};

static void learns(int32_t method) {
    struct HysteronAdaptation options;
    struct HysteronLearning learning;
    struct HysteronCoreModel *model, *plant;
    struct HysteronCoreState *state, *there, *ahead;
    struct HysteronCoreEstimator *estimator;
    size_t model_bytes = hysteron_core_model_size(LEVELS, 2), state_bytes = hysteron_core_state_size(LEVELS);
    size_t estimator_bytes;
    void *memory[6];
    double measured, offset, input, start[6], error = 0.0;
    int32_t status;
    int n;
    for (n = 0; n < 6; n++) {
        start[n] = 0.7 * WEIGHTS[n];
    }
    OK(hysteron_adaptation_default(method, &options));
    estimator_bytes = hysteron_core_estimator_size(LEVELS, &options);
    for (n = 0; n < 6; n++) {
        memory[n] = room(n < 2 ? model_bytes : n < 5 ? state_bytes : estimator_bytes);
    }
    OK(hysteron_core_model_init(memory[0], model_bytes, HYSTERON_MKP, 20.0, 80.0, LEVELS, start, 6, &model));
    OK(hysteron_core_model_init(memory[1], model_bytes, HYSTERON_MKP, 20.0, 80.0, LEVELS, WEIGHTS, 6, &plant));
    OK(hysteron_core_state_init(model, memory[2], state_bytes, &state));
    OK(hysteron_core_state_init(plant, memory[3], state_bytes, &there));
    OK(hysteron_core_state_init(model, memory[4], state_bytes, &ahead));
    OK(hysteron_core_estimator_init(model, &options, start, 6, 0.0, memory[5], estimator_bytes, &estimator));
    for (n = 0; n < 20000; n++) {
        input = 50.0 - 45.0 * cos(0.07 * n) * cos(0.011 * n);
        OK(hysteron_core_step(plant, there, input, &measured, NULL));
        OK(hysteron_core_estimator_step(estimator, model, state, input, measured, &learning));
        error = n < 19000 ? 0.0 : fmax(error, fabs(learning.error));
    }
    REQUIRE(error < 0.1); /* 1.3 before it learned */
    OK(hysteron_core_estimator_offset(estimator, &offset));
    REQUIRE(isfinite(offset));
    OK(hysteron_core_estimator_freeze(estimator, 1));
    OK(hysteron_core_estimator_step(estimator, model, state, 30.0, 1000.0, &learning));
    REQUIRE(learning.outcome == HYSTERON_FROZEN);

    /* A state from before the weights changed is refused, until it is brought up to date. */
    REQUIRE(hysteron_core_inverse_step(model, ahead, 2.0, HYSTERON_HOLD, 0.0, &input, &status) == HYSTERON_STATE_MISMATCH);
    OK(hysteron_core_state_rebase(model, ahead));
    OK(hysteron_core_inverse_step(model, ahead, 2.0, HYSTERON_HOLD, 0.0, &input, &status));
    REQUIRE(status == HYSTERON_INSIDE);
    for (n = 0; n < 6; n++) {
        free(memory[n]);
    }
}

static void save_and_restore(void) {
    struct HysteronCoreModel *model;
    struct HysteronCoreState *state, *other;
    size_t model_bytes = hysteron_core_model_size(LEVELS, 1), state_bytes = hysteron_core_state_size(LEVELS), count;
    void *memory[3];
    double points[32], input, a, b;
    memory[0] = room(model_bytes);
    memory[1] = room(state_bytes);
    memory[2] = room(state_bytes);
    OK(hysteron_core_model_init(memory[0], model_bytes, HYSTERON_KP, 20.0, 80.0, LEVELS, WEIGHTS, 6, &model));
    OK(hysteron_core_state_init(model, memory[1], state_bytes, &state));
    OK(hysteron_core_state_init(model, memory[2], state_bytes, &other));
    OK(hysteron_core_step(model, state, 70.0, &a, NULL));
    OK(hysteron_core_step(model, state, 35.0, &a, NULL));
    REQUIRE(hysteron_core_state_save(state, points, 1, &count, &input) == HYSTERON_MEMORY_TOO_SMALL);
    REQUIRE(count == 2);
    OK(hysteron_core_state_save(state, points, 32, &count, &input));
    OK(hysteron_core_state_restore(model, other, points, count, input));
    OK(hysteron_core_step(model, state, 60.0, &a, NULL));
    OK(hysteron_core_step(model, other, 60.0, &b, NULL));
    REQUIRE(memcmp(&a, &b, sizeof a) == 0);

    /* A state of another model. */
    {
        static const double larger[10] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
        struct HysteronCoreModel *foreign;
        size_t bytes = hysteron_core_model_size(4, 1);
        void *place = room(bytes);
        OK(hysteron_core_model_init(place, bytes, HYSTERON_KP, 20.0, 80.0, 4, larger, 10, &foreign));
        REQUIRE(hysteron_core_step(foreign, state, 60.0, &a, NULL) == HYSTERON_STATE_MISMATCH);
        free(place);
    }

    /* Too little, nothing, not an object, not in its place. */
    REQUIRE(hysteron_core_state_init(model, memory[2], state_bytes - 1, &other) == HYSTERON_MEMORY_TOO_SMALL);
    REQUIRE(hysteron_core_state_init(model, NULL, state_bytes, &other) == HYSTERON_NULL);
    REQUIRE(hysteron_core_state_init(model, (char *)memory[2] + 1, state_bytes - 1, &other) == HYSTERON_ALIGNMENT);
    REQUIRE(hysteron_core_step(NULL, state, 60.0, &a, NULL) == HYSTERON_NULL);
    memset(memory[2], 0, state_bytes);
    REQUIRE(hysteron_core_step(model, memory[2], 60.0, &a, NULL) == HYSTERON_HANDLE);
    REQUIRE(hysteron_core_step(model, state, NAN, &a, NULL) == HYSTERON_INPUT_NOT_FINITE);
    REQUIRE(hysteron_core_run(model, state, points, points, 2) == HYSTERON_OVERLAP);
    REQUIRE(hysteron_core_model_size(1, 1) == 0 && hysteron_core_model_size((size_t)-1, 1) == 0);
    REQUIRE(hysteron_core_model_size(LEVELS, 3) == 0 && hysteron_core_state_size(0) == 0);
    REQUIRE(hysteron_core_estimator_size(LEVELS, NULL) == 0);
    free(memory[0]);
    free(memory[1]);
    free(memory[2]);
}

void memory_form(void) {
    save_and_restore();
    learns(HYSTERON_INCREMENTS);
    learns(HYSTERON_LEAST_SQUARES);
}

/* Objects in memory of the caller. */
#include "check.h"
#include <math.h>
#include <string.h>

#define LEVELS 3
static const double WEIGHTS[6] = {1.0, 0.5, 1.0, 0.25, 0.5, 1.0};

static void learns(uint64_t model, uint64_t plant_model, int32_t method) {
    struct HysteronAdaptation options;
    struct HysteronLearning learning;
    uint64_t plant, adaptive, now;
    size_t bytes;
    void *memory;
    double measured, input, error = 0.0;
    int32_t status;
    int n;
    OK(hysteron_adaptation_default(method, &options));
    bytes = hysteron_adaptive_size(model, &options);
    memory = room(bytes);
    OK(hysteron_adaptive_place(model, &options, memory, bytes, &adaptive));
    OK(hysteron_state_new(plant_model, &plant));
    for (n = 0; n < 20000; n++) {
        input = 50.0 - 45.0 * cos(0.07 * n) * cos(0.011 * n);
        OK(hysteron_step(plant, input, &measured, NULL));
        OK(hysteron_adaptive_step(adaptive, input, NAN, measured, &learning));
        error = n < 19000 ? 0.0 : fmax(error, fabs(learning.error));
    }
    REQUIRE(error < 0.1); /* 1.3 before it learned */
    OK(hysteron_adaptive_freeze(adaptive, 1));
    OK(hysteron_adaptive_step(adaptive, 30.0, NAN, 1000.0, &learning));
    REQUIRE(learning.outcome == HYSTERON_FROZEN);
    OK(hysteron_adaptive_inverse_step(adaptive, 2.0, HYSTERON_HOLD, 0.0, NAN, &input, &status));
    REQUIRE(status == HYSTERON_INSIDE);
    OK(hysteron_adaptive_model(adaptive, &now));
    OK(hysteron_model_free(now));
    OK(hysteron_adaptive_free(adaptive));
    OK(hysteron_state_free(plant));
    free(memory);
}

static void save_and_restore(uint64_t model) {
    size_t bytes = hysteron_state_size(model), count;
    void *memory[2];
    uint64_t state, other, again;
    double points[32], input, a, b;
    memory[0] = room(bytes);
    memory[1] = room(bytes);
    OK(hysteron_state_place(model, memory[0], bytes, &state));
    OK(hysteron_state_place(model, memory[1], bytes, &other));
    OK(hysteron_step(state, 70.0, &a, NULL));
    OK(hysteron_step(state, 35.0, &a, NULL));
    REQUIRE(hysteron_state_save(state, points, 1, &count, &input) == HYSTERON_MEMORY_TOO_SMALL);
    REQUIRE(count == 2);
    OK(hysteron_state_save(state, points, 32, &count, &input));
    OK(hysteron_state_restore(other, points, count, input));
    OK(hysteron_step(state, 60.0, &a, NULL));
    OK(hysteron_step(other, 60.0, &b, NULL));
    REQUIRE(memcmp(&a, &b, sizeof a) == 0);

    /* Too little, nothing, not in its place, in the midst of another object. */
    REQUIRE(hysteron_state_place(model, memory[1], bytes - 1, &again) == HYSTERON_MEMORY_TOO_SMALL);
    REQUIRE(hysteron_state_place(model, NULL, bytes, &again) == HYSTERON_NULL);
    REQUIRE(hysteron_state_place(model, (char *)memory[1] + 1, bytes - 1, &again) == HYSTERON_ALIGNMENT);
    REQUIRE(hysteron_state_place(state, memory[1], bytes, &again) == HYSTERON_HANDLE);
    REQUIRE(hysteron_state_size(state) == 0 && hysteron_adaptive_size(0, NULL) == 0);
    REQUIRE(hysteron_step(state, 60.0, memory[0], NULL) == HYSTERON_OVERLAP);
    OK(hysteron_step(other, 61.0, &b, NULL)); /* as it was */
    OK(hysteron_state_place(model, memory[1], bytes, &again));
    REQUIRE(hysteron_step(other, 62.0, &b, NULL) == HYSTERON_HANDLE); /* its memory was taken */
    OK(hysteron_state_free(again));
    REQUIRE(hysteron_state_free(again) == HYSTERON_HANDLE);
    REQUIRE(hysteron_step(state, NAN, &a, NULL) == HYSTERON_INPUT_NOT_FINITE);
    OK(hysteron_state_free(state));
    free(memory[0]);
    free(memory[1]);
}

void memory_form(void) {
    double softer[6];
    uint64_t model, plant;
    int n;
    for (n = 0; n < 6; n++) {
        softer[n] = 0.7 * WEIGHTS[n];
    }
    OK(hysteron_model_new(HYSTERON_MKP, 20.0, 80.0, LEVELS, softer, 6, 0.0, 1, &model));
    OK(hysteron_model_new(HYSTERON_MKP, 20.0, 80.0, LEVELS, WEIGHTS, 6, 0.0, 1, &plant));
    save_and_restore(model);
    learns(model, plant, HYSTERON_INCREMENTS);
    learns(model, plant, HYSTERON_LEAST_SQUARES);
    OK(hysteron_model_free(model));
    OK(hysteron_model_free(plant));
}

/* The form with handles: save and restore, adaptation, and what is left of a model after it was
 * freed. */
#include "check.h"
#include <math.h>
#include <string.h>

static const double WEIGHTS[6] = {1.0, 0.5, 1.0, 0.25, 0.5, 1.0};

static double wave(int n) {
    return 50.0 - 45.0 * cos(0.07 * n) * cos(0.011 * n);
}

static void save_and_restore(uint64_t model) {
    uint64_t whole, broken;
    double points[32], input, a, b;
    size_t count;
    int n;
    OK(hysteron_state_new(model, &whole));
    OK(hysteron_state_new(model, &broken));
    for (n = 0; n < 500; n++) {
        OK(hysteron_step(whole, wave(n), &a, NULL));
        OK(hysteron_step(broken, wave(n), &b, NULL));
        REQUIRE(memcmp(&a, &b, sizeof a) == 0);
        if (n % 50 == 49) {
            REQUIRE(hysteron_state_save(broken, NULL, 0, &count, &input) == HYSTERON_MEMORY_TOO_SMALL);
            REQUIRE(count >= 1 && count <= 32);
            OK(hysteron_state_save(broken, points, 32, &count, &input));
            OK(hysteron_state_free(broken));
            OK(hysteron_state_new(model, &broken));
            OK(hysteron_state_restore(broken, points, count, input));
        }
    }
    OK(hysteron_state_saturate(whole));
    OK(hysteron_step(whole, 80.0, &a, NULL));
    REQUIRE(fabs(a - 14.25) < 1e-12);
    OK(hysteron_state_reset(whole));
    OK(hysteron_step(whole, -1e9, &a, NULL));
    REQUIRE(a == 10.0);
    OK(hysteron_state_free(whole));
    OK(hysteron_state_free(broken));
}

/* A whole series: where it goes next, and the inputs for it. */
static void series(uint64_t model) {
    static const double target[7] = {11.0, 12.0, 13.0, 13.0, 12.95, 11.0, 12.5};
    static const int32_t next[7] = {1, 1, 1, -1, -1, -1, 1};
    struct HysteronModelInfo info;
    uint64_t inverse, forward;
    double input[7], reached[7];
    int32_t heading[7], status[7];
    char text[32];
    size_t needed;
    int n;
    OK(hysteron_model_info(model, &info));
    REQUIRE(info.usual_tolerance == 0.01 * (info.output_on - info.output_off));
    OK(hysteron_headings(target, 7, 0.1, heading));
    REQUIRE(memcmp(heading, next, sizeof next) == 0);
    OK(hysteron_state_new(model, &inverse));
    OK(hysteron_state_new(model, &forward));
    OK(hysteron_inverse_run(inverse, target, heading, 0.1, input, status, 7));
    OK(hysteron_run(forward, input, reached, 7));
    for (n = 0; n < 7; n++) {
        REQUIRE(status[n] == HYSTERON_INSIDE);
        REQUIRE(fabs(reached[n] - target[n]) <= 0.1 + 1e-12);
    }
    REQUIRE(input[3] < input[2]); /* the target rests there, and the input is at the far edge of the dead band already */
    OK(hysteron_model_quantity(model, 1, text, sizeof text, &needed));
    REQUIRE(strcmp(text, "output") == 0 && needed == 7);
    OK(hysteron_model_quantity(model, 0, text, 3, &needed));
    REQUIRE(strcmp(text, "in") == 0 && needed == 6);
    OK(hysteron_state_free(inverse));
    OK(hysteron_state_free(forward));
}

static void adaptation(uint64_t model, uint64_t plant_model, int32_t method) {
    struct HysteronAdaptation options;
    struct HysteronLearning learning;
    uint64_t adaptive, plant, now;
    double measured, expected, input, error = 0.0;
    int32_t status;
    int n;
    OK(hysteron_adaptation_default(method, &options));
    OK(hysteron_adaptive_new(model, &options, &adaptive));
    OK(hysteron_state_new(plant_model, &plant));
    for (n = 0; n < 20000; n++) {
        OK(hysteron_step(plant, wave(n), &measured, NULL));
        OK(hysteron_adaptive_step(adaptive, wave(n), NAN, measured, &learning));
        error = n < 19000 ? 0.0 : fmax(error, fabs(learning.error));
    }
    REQUIRE(error < 0.1); /* 2.1 before it learned */

    OK(hysteron_adaptive_keep(adaptive));
    OK(hysteron_adaptive_freeze(adaptive, 1));
    OK(hysteron_adaptive_step(adaptive, 60.0, NAN, 1000.0, &learning));
    REQUIRE(learning.outcome == HYSTERON_FROZEN);
    OK(hysteron_adaptive_freeze(adaptive, 0));
    OK(hysteron_adaptive_roll_back(adaptive));
    OK(hysteron_adaptive_reset(adaptive));
    OK(hysteron_adaptive_inverse_step(adaptive, 12.0, HYSTERON_HOLD, 0.0, NAN, &input, &status));
    REQUIRE(status == HYSTERON_INSIDE);
    OK(hysteron_adaptive_simulate(adaptive, input, NAN, &expected));
    REQUIRE(fabs(expected - 12.0) < 1e-9);

    OK(hysteron_adaptive_model(adaptive, &now));
    /* What was learned outlives the program: the model read back says the same. */
    OK(hysteron_model_write(now, "learned.json"));
    OK(hysteron_model_free(now));
    OK(hysteron_model_read("learned.json", &now));
    OK(hysteron_adaptive_free(adaptive));
    OK(hysteron_state_free(plant));
    OK(hysteron_state_new(now, &plant));
    OK(hysteron_step(plant, input, &measured, NULL));
    REQUIRE(fabs(measured - 12.0) < 0.01);
    OK(hysteron_state_free(plant));
    OK(hysteron_model_free(now));
}

void handles(void) {
    double stiffer[6];
    uint64_t model, plant, state;
    double output;
    int32_t clipped;
    size_t n;
    for (n = 0; n < 6; n++) {
        stiffer[n] = 1.5 * WEIGHTS[n];
    }
    OK(hysteron_model_new(HYSTERON_MKP, 20.0, 80.0, 3, WEIGHTS, 6, 10.0, 1, &model));
    OK(hysteron_model_new(HYSTERON_MKP, 20.0, 80.0, 3, stiffer, 6, 10.0, 1, &plant));
    save_and_restore(model);
    series(model);
    adaptation(model, plant, HYSTERON_INCREMENTS);
    adaptation(model, plant, HYSTERON_LEAST_SQUARES);
    OK(hysteron_state_new(model, &state));
    OK(hysteron_model_free(model));
    OK(hysteron_step(state, 100.0, &output, &clipped)); /* the state outlives its model */
    REQUIRE(clipped == HYSTERON_HIGH && output == 14.25);
    OK(hysteron_state_free(state));
    OK(hysteron_model_free(plant));
    REQUIRE(strlen(hysteron_version()) >= 5);
}

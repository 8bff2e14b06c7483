/* A model with every stage: forward and inverse, saved and restored. */
#include "check.h"
#include <math.h>
#include <string.h>

#define COUNT 300
static const char WHOLE[] =
    "{\"format\": \"hysteron-model\", \"version\": 2, \"operator\": \"mkp\","
    "\"plane\": {\"min\": 30, \"max\": 60, \"levels\": 3},"
    "\"input\": {\"name\": \"duty\"}, \"output\": {\"name\": \"lift\", \"unit\": \"mm\", \"offset\": 2, \"sign\": -1},"
    "\"weights\": [1, 0.5, 1, 0.25, 0.5, 1],"
    "\"load\": {\"name\": \"stress\", \"unit\": \"MPa\", \"min\": 50, \"max\": 200,"
    "  \"parts\": [{\"offset\": 2, \"weights\": [1, 0.5, 1, 0.25, 0.5, 1]}],"
    "  \"curves\": {\"loads\": [50, 100, 200], \"shifts\": [0, 5, 20], \"gains\": [1, 1.2, 1.3]}},"
    "\"thermal\": {\"kind\": \"first-order\", \"ambient\": 20, \"gain\": 100, \"tau_heating\": 2, \"tau_cooling\": 5},"
    "\"drive\": {\"min\": 0, \"max\": 1}, \"spacing\": [15, 35, 40, 60],"
    "\"creep\": [{\"coefficient\": 0.02, \"tau\": 1}], \"lag\": 0.05}";

static double drive[COUNT], target[COUNT], load[COUNT], at[COUNT];

static void series(void) {
    int n;
    for (n = 0; n < COUNT; n++) {
        drive[n] = 0.5 - 0.5 * cos(0.13 * n) * cos(0.017 * n);
        target[n] = 0.5 + 2.0 * cos(0.05 * n);
        load[n] = 125.0 + 70.0 * sin(0.03 * n);
        at[n] = 0.1 * n;
    }
}

/* The output of a run follows the targets that the inverse was given, as far as its limits go. */
static void inverse_and_back(uint64_t model) {
    static double found[COUNT], reached[COUNT];
    static int32_t status[COUNT];
    struct HysteronLimits limits;
    uint64_t inverse, forward;
    int n, within = 0;
    OK(hysteron_model_limits(model, &limits));
    REQUIRE(limits.drive_min == 0.0 && limits.drive_max == 1.0 && limits.horizon == 0.0);
    limits.drive_max = 0.8;
    OK(hysteron_state_new(model, &inverse));
    OK(hysteron_state_new(model, &forward));
    OK(hysteron_inverse_run_in(inverse, target, NULL, 0.0, at, NAN, load, &limits, found, status, COUNT));
    OK(hysteron_run_in(forward, found, at, NAN, load, reached, NULL, COUNT));
    for (n = 0; n < COUNT; n++) {
        REQUIRE(found[n] >= 0.0 && found[n] <= 0.8);
        if (status[n] == HYSTERON_INSIDE) {
            REQUIRE(fabs(reached[n] - target[n]) < 1e-9);
            within++;
        } else {
            REQUIRE(status[n] == HYSTERON_LIMITED || status[n] == HYSTERON_LOW || status[n] == HYSTERON_HIGH);
        }
    }
    REQUIRE(within > 20 && within < COUNT);
    OK(hysteron_state_free(inverse));
    OK(hysteron_state_free(forward));
}

static void save_and_restore(uint64_t model) {
    struct HysteronStageState stages;
    uint64_t whole, broken;
    double points[32], input, a, b;
    size_t count;
    int n;
    OK(hysteron_state_new(model, &whole));
    OK(hysteron_state_new(model, &broken));
    for (n = 0; n < COUNT; n++) {
        OK(hysteron_step_in(whole, drive[n], 0.1, load[n], &a, NULL));
        OK(hysteron_step_in(broken, drive[n], 0.1, load[n], &b, NULL));
        REQUIRE(memcmp(&a, &b, sizeof a) == 0);
        if (n % 50 == 49) {
            OK(hysteron_state_save(broken, points, 32, &count, &input));
            OK(hysteron_state_save_stages(broken, &stages));
            OK(hysteron_state_start(broken, HYSTERON_START_ON));
            OK(hysteron_state_restore(broken, points, count, input));
            OK(hysteron_state_restore_stages(broken, &stages));
        }
    }
    OK(hysteron_state_half_width(whole, &a));
    REQUIRE(a != a); /* the model does not say how far it errs */
    OK(hysteron_state_temperature(whole, &a));
    OK(hysteron_state_temperature(broken, &b));
    REQUIRE(a == b && a > 20.0 && a < 120.0);
    OK(hysteron_state_free(whole));
    OK(hysteron_state_free(broken));
}

static void refusals(uint64_t model) {
    struct HysteronLimits limits = {1.0, 0.0, 0.0, -INFINITY, INFINITY};
    uint64_t state;
    double output[2], input;
    int32_t status;
    char detail[256];
    OK(hysteron_state_new(model, &state));
    REQUIRE(hysteron_step(state, 0.5, output, NULL) == HYSTERON_FIT); /* no load */
    OK(hysteron_step_in(state, 0.5, NAN, 100.0, output, NULL));
    REQUIRE(hysteron_step_in(state, 0.5, NAN, 100.0, output, NULL) == HYSTERON_THERMAL);
    REQUIRE(hysteron_step_in(state, 0.5, -1.0, 100.0, output, NULL) == HYSTERON_THERMAL);
    REQUIRE(hysteron_step_in(state, 0.5, 0.1, 300.0, output, NULL) == HYSTERON_FIT);
    REQUIRE(hysteron_last_error(detail, sizeof detail) > 0 && strstr(detail, "stress 300") != NULL);
    REQUIRE(hysteron_run_in(state, drive, at, NAN, load, output, NULL, 2) == HYSTERON_THERMAL); /* when was the last? */
    REQUIRE(hysteron_run_in(state, drive, at, 0.0, drive, output, NULL, 2) == HYSTERON_OVERLAP);
    REQUIRE(hysteron_run_in(state, drive, at, 0.0, target, output, NULL, 2) == HYSTERON_FIT);
    REQUIRE(hysteron_run_in(state, drive, at, 0.0, load, NULL, NULL, 2) == HYSTERON_NULL);
    REQUIRE(hysteron_inverse_step_in(state, 1.0, 0, 0.0, 0.1, 100.0, &limits, &input, &status) == HYSTERON_VALUE);
    REQUIRE(hysteron_last_error(detail, sizeof detail) > 0 && strstr(detail, "`drive_min`") != NULL);
    REQUIRE(hysteron_inverse_step_in(state, 1.0, 7, 0.0, 0.1, 100.0, NULL, &input, &status) == HYSTERON_VALUE);
    REQUIRE(hysteron_state_start(state, -1) == HYSTERON_VALUE);
    REQUIRE(hysteron_state_temperature(model, &input) == HYSTERON_HANDLE);
    REQUIRE(hysteron_state_save_stages(state, NULL) == HYSTERON_NULL);
    OK(hysteron_state_free(state));
    REQUIRE(hysteron_state_start(state, HYSTERON_START_OFF) == HYSTERON_HANDLE);
}

void stages(void) {
    struct HysteronModelNeeds needs;
    uint64_t model;
    series();
    OK(hysteron_model_parse(WHOLE, &model));
    OK(hysteron_model_needs(model, &needs));
    REQUIRE(needs.time == 1 && needs.load == 1 && needs.body == 1 && needs.fitted_start == 0);
    REQUIRE(needs.load_min == 50.0 && needs.load_max == 200.0 && needs.drive_max == 1.0);
    inverse_and_back(model);
    save_and_restore(model);
    refusals(model);
    OK(hysteron_model_free(model));
}

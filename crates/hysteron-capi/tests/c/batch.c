/* Batches: every lane is a state alone, and an error moves none. */
#include "check.h"
#include <math.h>
#include <string.h>

#define LANES 11
#define SAMPLES 300
#define COUNT (LANES * SAMPLES)

static const double WEIGHTS[6] = {1.0, 0.5, 1.0, 0.25, 0.5, 1.0};
/* A load shifts the input, and the output lags. */
static const char STAGED[] =
    "{\"format\": \"hysteron-model\", \"version\": 2, \"operator\": \"mkp\", \"lag\": 0.5,"
    "\"plane\": {\"min\": 20, \"max\": 80, \"levels\": 2}, \"weights\": [1, 2, 1],"
    "\"load\": {\"min\": 1, \"max\": 2, \"parts\": [{\"offset\": 0, \"weights\": [1, 2, 1]}],"
    "\"curves\": {\"loads\": [1, 2], \"shifts\": [0, 0.5]}}}";

static double input[COUNT], output[COUNT], expected[COUNT], load[COUNT], times[SAMPLES];

static void make_series(void) {
    int lane, n;
    for (lane = 0; lane < LANES; lane++) {
        for (n = 0; n < SAMPLES; n++) {
            input[lane * SAMPLES + n] = 50.0 - 45.0 * cos(0.07 * n + lane) * cos(0.011 * n * (lane + 1));
            load[lane * SAMPLES + n] = 1.5 + 0.5 * sin(0.1 * n + lane);
            times[n] = 0.25 * n;
        }
    }
}

/* All lanes but the odd ones have stages. */
static void lanes_are_states(const uint64_t *models) {
    uint64_t batch, state, copy;
    double points[2][32], inputs[2], column[LANES], loads[LANES], stepped[LANES];
    size_t count[2];
    int lane, n;
    OK(hysteron_batch_new(models, LANES, &batch));
    OK(hysteron_batch_run_in(batch, input, times, SAMPLES, NAN, load, output, COUNT));
    for (lane = 0; lane < LANES; lane++) {
        const double *loads_of = lane % 2 == 0 ? load + lane * SAMPLES : NULL;
        OK(hysteron_state_new(models[lane], &state));
        OK(hysteron_run_in(state, input + lane * SAMPLES, times, NAN, loads_of, expected + lane * SAMPLES, NULL, SAMPLES));
        OK(hysteron_batch_state(batch, (size_t)lane, &copy));
        OK(hysteron_state_save(state, points[0], 32, &count[0], &inputs[0]));
        OK(hysteron_state_save(copy, points[1], 32, &count[1], &inputs[1]));
        REQUIRE(count[0] == count[1] && memcmp(points[0], points[1], count[0] * sizeof(double)) == 0);
        REQUIRE(inputs[0] == inputs[1]);
        OK(hysteron_state_free(state));
        OK(hysteron_state_free(copy));
    }
    REQUIRE(memcmp(output, expected, sizeof output) == 0);
    /* The same sample by sample, and the second half apart from the first. */
    OK(hysteron_batch_reset(batch));
    for (n = 0; n < SAMPLES; n++) {
        for (lane = 0; lane < LANES; lane++) {
            column[lane] = input[lane * SAMPLES + n];
            loads[lane] = load[lane * SAMPLES + n];
        }
        OK(hysteron_batch_step_in(batch, column, n == 0 ? 0.0 : 0.25, loads, stepped, LANES));
        for (lane = 0; lane < LANES; lane++) {
            REQUIRE(memcmp(&stepped[lane], &expected[lane * SAMPLES + n], sizeof(double)) == 0);
        }
    }
    OK(hysteron_batch_free(batch));
    REQUIRE(hysteron_batch_free(batch) == HYSTERON_HANDLE);
}

/* One model, many inputs; then what is refused. */
static void one_model(uint64_t model) {
    uint64_t batch, state, lone;
    double alone[SAMPLES], wrong[LANES] = {0.0}, before, after;
    char text[64];
    int lane;
    OK(hysteron_batch_of(model, LANES, &batch));
    OK(hysteron_batch_run(batch, input, output, COUNT));
    for (lane = 0; lane < LANES; lane++) {
        OK(hysteron_state_new(model, &state));
        OK(hysteron_run(state, input + lane * SAMPLES, alone, SAMPLES));
        REQUIRE(memcmp(alone, output + lane * SAMPLES, sizeof alone) == 0);
        OK(hysteron_state_free(state));
    }
    wrong[4] = NAN;
    REQUIRE(hysteron_batch_step(batch, wrong, output, LANES) == HYSTERON_INPUT_NOT_FINITE);
    REQUIRE(hysteron_last_error(text, sizeof text) > 0 && strstr(text, "lane number 4 ") == text);
    OK(hysteron_batch_state(batch, 0, &lone)); /* where it was */
    OK(hysteron_step(lone, input[SAMPLES - 1], &before, NULL));
    OK(hysteron_run(lone, NULL, NULL, 0));
    OK(hysteron_state_new(model, &state));
    OK(hysteron_run(state, input, alone, SAMPLES));
    OK(hysteron_step(state, input[SAMPLES - 1], &after, NULL));
    REQUIRE(before == after);
    REQUIRE(hysteron_batch_step(batch, wrong, output, LANES - 1) == HYSTERON_FIT);
    REQUIRE(hysteron_batch_run(batch, input, output, COUNT - 1) == HYSTERON_FIT);
    REQUIRE(hysteron_batch_run(batch, input, input + 1, LANES) == HYSTERON_OVERLAP);
    REQUIRE(hysteron_batch_run(batch, NULL, output, LANES) == HYSTERON_NULL);
    OK(hysteron_batch_run(batch, NULL, NULL, 0));
    REQUIRE(hysteron_batch_step_in(batch, input, NAN, load, output, LANES) == HYSTERON_FIT);
    REQUIRE(hysteron_batch_state(batch, LANES, &state) == HYSTERON_VALUE);
    REQUIRE(hysteron_batch_of(model, (size_t)-1, &lone) == HYSTERON_FIT);
    REQUIRE(hysteron_batch_of(batch, 1, &lone) == HYSTERON_HANDLE);
    REQUIRE(hysteron_batch_new(&batch, 1, &lone) == HYSTERON_HANDLE);
    REQUIRE(hysteron_batch_run(model, input, output, COUNT) == HYSTERON_HANDLE);
    OK(hysteron_state_free(state));
    OK(hysteron_state_free(lone));
    OK(hysteron_batch_free(batch));
}

void batches(void) {
    uint64_t plain, staged, models[LANES];
    int lane;
    make_series();
    OK(hysteron_model_new(HYSTERON_MKP, 20.0, 80.0, 3, WEIGHTS, 6, 10.0, 1, &plain));
    OK(hysteron_model_parse(STAGED, &staged));
    for (lane = 0; lane < LANES; lane++) {
        models[lane] = lane % 2 == 0 ? staged : plain;
    }
    lanes_are_states(models);
    one_model(plain);
    OK(hysteron_model_free(plain));
    OK(hysteron_model_free(staged));
}

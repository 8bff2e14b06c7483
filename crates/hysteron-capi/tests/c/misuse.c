/* Wrong calls: a status, a text, and the objects as they were. */
#include "check.h"
#include <math.h>
#include <string.h>

static const double WEIGHTS[3] = {1.0, 2.0, 1.0};
static const char MODEL[] = "{\"format\": \"hysteron-model\", \"version\": 1, \"operator\": \"mkp\","
                            "\"plane\": {\"min\": 0, \"max\": 1, \"levels\": 2}, \"weights\": [1, 2, 1]}";

static void models(void) {
    uint64_t model = 7;
    char text[sizeof MODEL], detail[64];
    size_t length, needed;
    double weights[3] = {1.0, NAN, 1.0};
    /* Cut off anywhere. */
    for (length = 0; length < sizeof MODEL - 1; length++) {
        memcpy(text, MODEL, length);
        text[length] = '\0';
        REQUIRE(hysteron_model_parse(text, &model) == HYSTERON_MODEL_FILE);
    }
    REQUIRE(model == 7); /* written with success only */
    needed = hysteron_last_error(NULL, 0);
    REQUIRE(needed > 20);
    REQUIRE(hysteron_last_error(detail, 8) == needed && strlen(detail) == 7);
    REQUIRE(hysteron_model_parse("\xff\xfe", &model) == HYSTERON_TEXT);
    REQUIRE(hysteron_model_parse(NULL, &model) == HYSTERON_NULL);
    REQUIRE(hysteron_last_error(detail, sizeof detail) > 0 && strstr(detail, "`json`") != NULL);
    REQUIRE(hysteron_model_parse(MODEL, NULL) == HYSTERON_NULL);
    REQUIRE(hysteron_model_read("/no/such/model.json", &model) == HYSTERON_FILE);
    REQUIRE(hysteron_model_read("/", &model) == HYSTERON_FILE);
    REQUIRE(hysteron_model_read("run --old/m.json", &model) == HYSTERON_FILE);
    REQUIRE(hysteron_last_error(detail, sizeof detail) > 0 && strstr(detail, "run --old/m.json: ") == detail);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 2, NULL, 3, 0.0, 1, &model) == HYSTERON_NULL);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 2, WEIGHTS, 2, 0.0, 1, &model) == HYSTERON_WEIGHT_COUNT);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 2, WEIGHTS, (size_t)-1, 0.0, 1, &model) == HYSTERON_VALUE);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 1, WEIGHTS, 3, 0.0, 1, &model) == HYSTERON_LEVELS);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 1.0, NAN, 2, WEIGHTS, 3, 0.0, 1, &model) == HYSTERON_RANGE);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 2, weights, 3, 0.0, 1, &model) == HYSTERON_WEIGHT_NOT_FINITE);
    REQUIRE(hysteron_model_new(9, 0.0, 1.0, 2, WEIGHTS, 3, 0.0, 1, &model) == HYSTERON_VALUE);
    REQUIRE(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 2, WEIGHTS, 3, 0.0, 0, &model) == HYSTERON_VALUE);
}

static void steps(uint64_t model, uint64_t state) {
    double array[5] = {0.1, 0.9, NAN, 0.3, 0.0}, output[5], before, after, twice[2] = {0.5, 0.2}, input;
    size_t count;
    int32_t status, headings[5] = {0};
    uint64_t other;
    OK(hysteron_step(state, 0.6, &before, NULL));
    REQUIRE(hysteron_step(state, NAN, &after, NULL) == HYSTERON_INPUT_NOT_FINITE);
    REQUIRE(hysteron_step(state, INFINITY, &after, NULL) == HYSTERON_INPUT_NOT_FINITE);
    REQUIRE(hysteron_step(state, 0.5, NULL, NULL) == HYSTERON_NULL);
    output[0] = 7.0, output[4] = 8.0;
    REQUIRE(hysteron_run(state, array, output, 5) == HYSTERON_INPUT_NOT_FINITE);
    REQUIRE(output[0] == 7.0 && output[4] == 8.0);
    REQUIRE(hysteron_run(state, array, array + 1, 2) == HYSTERON_OVERLAP);
    REQUIRE(hysteron_run(state, NULL, output, 2) == HYSTERON_NULL);
    OK(hysteron_run(state, NULL, NULL, 0));
    REQUIRE(hysteron_inverse_step(state, NAN, HYSTERON_HOLD, 0.0, &input, &status) == HYSTERON_INPUT_NOT_FINITE);
    REQUIRE(hysteron_inverse_step(state, 1.0, 5, 0.0, &input, &status) == HYSTERON_VALUE);
    REQUIRE(hysteron_inverse_step(state, 1.0, HYSTERON_HOLD, 0.0, NULL, &status) == HYSTERON_NULL);
    REQUIRE(hysteron_state_restore(state, twice + 1, 1, NAN) == HYSTERON_INPUT_NOT_FINITE);
    array[0] = 0.5, array[1] = 0.9;
    REQUIRE(hysteron_state_restore(state, array, 2, 0.1) == HYSTERON_TURNING_POINTS);
    REQUIRE(hysteron_state_save(state, NULL, 9, &count, &input) == HYSTERON_NULL);
    OK(hysteron_step(state, 0.6, &after, NULL));
    REQUIRE(memcmp(&before, &after, sizeof before) == 0); /* nothing moved */

    /* A series that cannot be leaves the state where it was. */
    array[0] = 1.0, array[1] = NAN;
    REQUIRE(hysteron_inverse_run(state, array, NULL, 0.0, output, NULL, 2) == HYSTERON_INPUT_NOT_FINITE);
    array[1] = 2.0, headings[1] = 5;
    REQUIRE(hysteron_inverse_run(state, array, headings, 0.0, output, NULL, 2) == HYSTERON_VALUE);
    REQUIRE(hysteron_inverse_run(state, array, NULL, 0.0, array + 1, NULL, 2) == HYSTERON_OVERLAP);
    REQUIRE(hysteron_inverse_run(state, array, headings, 0.0, output, headings + 1, 2) == HYSTERON_OVERLAP);
    REQUIRE(hysteron_inverse_run(state, NULL, NULL, 0.0, output, NULL, 2) == HYSTERON_NULL);
    REQUIRE(hysteron_headings(array, 2, -1.0, headings) == HYSTERON_VALUE);
    REQUIRE(hysteron_headings(array, 5, 0.0, headings) == HYSTERON_INPUT_NOT_FINITE); /* one is NaN */
    OK(hysteron_step(state, 0.6, &after, NULL));
    REQUIRE(memcmp(&before, &after, sizeof before) == 0);

    /* A handle of another kind, of nothing, and one that was freed. */
    REQUIRE(hysteron_step(model, 0.5, &after, NULL) == HYSTERON_HANDLE);
    REQUIRE(hysteron_step(0, 0.5, &after, NULL) == HYSTERON_HANDLE);
    REQUIRE(hysteron_step((uint64_t)-1, 0.5, &after, NULL) == HYSTERON_HANDLE);
    REQUIRE(hysteron_model_free(state) == HYSTERON_HANDLE);
    REQUIRE(hysteron_model_quantity(model, 2, NULL, 0, &count) == HYSTERON_VALUE);
    REQUIRE(hysteron_model_quantity(model, 0, NULL, 0, NULL) == HYSTERON_NULL);
    REQUIRE(hysteron_model_write(state, "none.json") == HYSTERON_HANDLE);
    REQUIRE(hysteron_model_write(model, NULL) == HYSTERON_NULL);
    REQUIRE(hysteron_model_write(model, "no/such/folder/model.json") == HYSTERON_FILE);
    OK(hysteron_state_free(state));
    REQUIRE(hysteron_state_free(state) == HYSTERON_HANDLE);
    OK(hysteron_state_new(model, &other)); /* takes the place of the one freed */
    REQUIRE(other != state);
    REQUIRE(hysteron_step(state, 0.5, &after, NULL) == HYSTERON_HANDLE);
    OK(hysteron_state_free(other));
}

static void refusals(uint64_t model) {
    static const double negative[3] = {1.0, -2.0, 1.0};
    struct HysteronAdaptation options;
    uint64_t other, state, adaptive;
    double input;
    int32_t status;
    OK(hysteron_model_new(HYSTERON_MKP, 0.0, 1.0, 2, negative, 3, 0.0, 1, &other));
    OK(hysteron_state_new(other, &state));
    REQUIRE(hysteron_inverse_step(state, 1.0, HYSTERON_HOLD, 0.0, &input, &status) == HYSTERON_NEGATIVE_WEIGHTS);
    /* What is refused writes nothing. */
    double kept[2] = {3.0, 4.0};
    int32_t marks[2] = {7, 8};
    const double wanted[2] = {1.0, 2.0};
    REQUIRE(hysteron_inverse_run(state, wanted, NULL, 0.0, kept, marks, 2) == HYSTERON_NEGATIVE_WEIGHTS);
    REQUIRE(kept[0] == 3.0 && kept[1] == 4.0 && marks[0] == 7 && marks[1] == 8);
    REQUIRE(hysteron_adaptive_new(other, NULL, &adaptive) == HYSTERON_NEGATIVE_WEIGHTS);
    OK(hysteron_state_free(state));
    OK(hysteron_model_free(other));
    REQUIRE(hysteron_adaptation_default(8, &options) == HYSTERON_VALUE);
    OK(hysteron_adaptation_default(HYSTERON_INCREMENTS, &options));
    options.gain = 3.0;
    REQUIRE(hysteron_adaptive_new(model, &options, &adaptive) == HYSTERON_ADAPTATION);
    REQUIRE(hysteron_model_at_load(model, 1.0, &other) == HYSTERON_FIT);
    REQUIRE(strcmp(hysteron_error_message(HYSTERON_NULL), "null pointer") == 0);
    REQUIRE(strcmp(hysteron_error_message(-5), "unknown code") == 0);
}

void misuse(void) {
    uint64_t model, state;
    models();
    OK(hysteron_model_parse(MODEL, &model));
    OK(hysteron_state_new(model, &state));
    steps(model, state);
    refusals(model);
    OK(hysteron_model_free(model));
    REQUIRE(hysteron_model_free(model) == HYSTERON_HANDLE);
}

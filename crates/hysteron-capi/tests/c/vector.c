/* A run of a test vector, by handle and over own memory. */
#include "check.h"
#include <math.h>
#include <string.h>

struct form {
    struct HysteronModelInfo info;
    uint64_t state;
    struct HysteronCoreModel *model;
    struct HysteronCoreState *core;
};

static void forward(const struct form *form, FILE *file, size_t count, double tolerance) {
    double *input = room(count * sizeof *input), *output = room(count * sizeof *output);
    double *run = room(count * sizeof *run);
    size_t n;
    for (n = 0; n < count; n++) {
        double sum, stepped;
        REQUIRE(fscanf(file, "%lf %lf", &input[n], &output[n]) == 2);
        OK(hysteron_step(form->state, input[n], &stepped, NULL));
        REQUIRE(fabs(stepped - output[n]) <= tolerance);
        OK(hysteron_core_step(form->model, form->core, input[n], &sum, NULL));
        REQUIRE(fabs(form->info.offset + form->info.sign * sum - output[n]) <= tolerance);
    }
    OK(hysteron_state_reset(form->state));
    OK(hysteron_run(form->state, input, run, count));
    for (n = 0; n < count; n++) {
        REQUIRE(fabs(run[n] - output[n]) <= tolerance);
    }
    OK(hysteron_core_state_reset(form->model, form->core));
    OK(hysteron_core_run(form->model, form->core, input, run, count));
    for (n = 0; n < count; n++) {
        REQUIRE(fabs(form->info.offset + form->info.sign * run[n] - output[n]) <= tolerance);
    }
    free(input);
    free(output);
    free(run);
}

static void inverse(const struct form *form, FILE *file, size_t count, double tolerance, double policy) {
    double *target = room(count * sizeof *target), *stepped = room(count * sizeof *stepped);
    double *run = room(count * sizeof *run);
    int32_t *heading = room(count * sizeof *heading), *flags = room(count * sizeof *flags);
    size_t n;
    for (n = 0; n < count; n++) {
        int expected, sign = form->info.sign;
        double input, found, sum;
        int32_t status;
        REQUIRE(fscanf(file, "%d %lf %lf %d", &heading[n], &target[n], &input, &expected) == 4);
        OK(hysteron_inverse_step(form->state, target[n], heading[n], policy, &stepped[n], &status));
        REQUIRE(fabs(stepped[n] - input) <= tolerance);
        REQUIRE(status == expected);
        sum = sign * (target[n] - form->info.offset);
        OK(hysteron_core_inverse_step(form->model, form->core, sum, sign * heading[n], policy, &found, &status));
        REQUIRE(fabs(found - input) <= tolerance);
        REQUIRE(sign * status == expected);
        flags[n] = expected;
    }
    OK(hysteron_state_reset(form->state));
    {
        int32_t *status = room(count * sizeof *status);
        OK(hysteron_inverse_run(form->state, target, heading, policy, run, status, count));
        REQUIRE(memcmp(run, stepped, count * sizeof *run) == 0);
        REQUIRE(memcmp(status, flags, count * sizeof *status) == 0);
        free(status);
    }
    free(target);
    free(stepped);
    free(run);
    free(heading);
    free(flags);
}

void vector_run(const char *model_file, const char *run_file) {
    struct form form;
    uint64_t model;
    size_t count, bytes, found;
    double tolerance, policy, *weights;
    void *memory, *state_memory;
    char kind[16];
    FILE *file = fopen(run_file, "r");
    REQUIRE(file != NULL);
    REQUIRE(fscanf(file, "%15s", kind) == 1);
    if (strcmp(kind, "stages") == 0) {
        vector_stages(model_file, file);
        fclose(file);
        return;
    }
    OK(hysteron_model_read(model_file, &model));
    OK(hysteron_model_info(model, &form.info));
    OK(hysteron_state_new(model, &form.state));

    weights = room(form.info.weights * sizeof *weights);
    OK(hysteron_model_weights(model, weights, form.info.weights, &found));
    REQUIRE(found == form.info.weights);
    OK(hysteron_model_free(model));
    bytes = hysteron_core_model_size(form.info.levels, 1);
    memory = room(bytes);
    OK(hysteron_core_model_init(memory, bytes, form.info.operator_kind, form.info.min, form.info.max,
                                form.info.levels, weights, found, &form.model));
    free(weights);
    bytes = hysteron_core_state_size(form.info.levels);
    state_memory = room(bytes);
    OK(hysteron_core_state_init(form.model, state_memory, bytes, &form.core));

    REQUIRE(fscanf(file, "%zu %lf %lf", &count, &tolerance, &policy) == 3);
    if (strcmp(kind, "forward") == 0) {
        forward(&form, file, count, tolerance);
    } else {
        inverse(&form, file, count, tolerance, policy);
    }
    OK(hysteron_state_free(form.state));
    free(memory);
    free(state_memory);
    fclose(file);
}

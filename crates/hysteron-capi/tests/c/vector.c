/* A run of a test vector, in memory of the library or of this program. */
#include "check.h"
#include <math.h>
#include <string.h>

static void forward(uint64_t state, FILE *file, size_t count, double tolerance) {
    double *input = room(count * sizeof *input), *stepped = room(count * sizeof *stepped);
    double *run = room(count * sizeof *run);
    size_t n;
    for (n = 0; n < count; n++) {
        double output;
        REQUIRE(fscanf(file, "%lf %lf", &input[n], &output) == 2);
        OK(hysteron_step(state, input[n], &stepped[n], NULL));
        REQUIRE(fabs(stepped[n] - output) <= tolerance);
    }
    OK(hysteron_state_reset(state));
    OK(hysteron_run(state, input, run, count));
    REQUIRE(memcmp(run, stepped, count * sizeof *run) == 0);
    free(input);
    free(stepped);
    free(run);
}

static void inverse(uint64_t state, FILE *file, size_t count, double tolerance, double policy) {
    double *target = room(count * sizeof *target), *stepped = room(count * sizeof *stepped);
    double *run = room(count * sizeof *run);
    int32_t *heading = room(count * sizeof *heading), *flags = room(count * sizeof *flags);
    int32_t *status = room(count * sizeof *status);
    size_t n;
    for (n = 0; n < count; n++) {
        int expected;
        double input;
        REQUIRE(fscanf(file, "%d %lf %lf %d", &heading[n], &target[n], &input, &expected) == 4);
        OK(hysteron_inverse_step(state, target[n], heading[n], policy, &stepped[n], &flags[n]));
        REQUIRE(fabs(stepped[n] - input) <= tolerance);
        REQUIRE(flags[n] == expected);
    }
    OK(hysteron_state_reset(state));
    OK(hysteron_inverse_run(state, target, heading, policy, run, status, count));
    REQUIRE(memcmp(run, stepped, count * sizeof *run) == 0);
    REQUIRE(memcmp(status, flags, count * sizeof *status) == 0);
    free(target);
    free(stepped);
    free(run);
    free(heading);
    free(flags);
    free(status);
}

static void one_state(uint64_t model, uint64_t state, FILE *file) {
    size_t count;
    double tolerance, policy;
    char kind[16];
    rewind(file);
    REQUIRE(fscanf(file, "%15s", kind) == 1);
    if (strcmp(kind, "stages") == 0) {
        vector_stages(model, state, file);
    } else {
        REQUIRE(fscanf(file, "%zu %lf %lf", &count, &tolerance, &policy) == 3);
        if (strcmp(kind, "forward") == 0) {
            forward(state, file, count, tolerance);
        } else {
            inverse(state, file, count, tolerance, policy);
        }
    }
    OK(hysteron_state_free(state));
}

void vector_run(const char *model_file, const char *run_file) {
    uint64_t model, state;
    size_t bytes;
    void *memory;
    FILE *file = fopen(run_file, "r");
    REQUIRE(file != NULL);
    OK(hysteron_model_read(model_file, &model));
    OK(hysteron_state_new(model, &state));
    one_state(model, state, file);
    bytes = hysteron_state_size(model);
    memory = room(bytes);
    OK(hysteron_state_place(model, memory, bytes, &state));
    one_state(model, state, file);
    OK(hysteron_model_free(model));
    free(memory);
    fclose(file);
}

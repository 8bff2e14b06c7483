/* A run of a test vector with stages: step by step and as a series by handle, and over own memory.
 */
#include "check.h"
#include <math.h>
#include <string.h>

/* Operators, state and stages in own memory. */
struct own {
    void *memory[3];
    struct HysteronCoreModel *operators;
    struct HysteronCoreState *state;
    struct HysteronCoreStages *stages;
    struct HysteronStageState past;
};

static void own_start(struct own *own, uint64_t model) {
    struct HysteronModelInfo info;
    struct HysteronStages constants;
    double *weights;
    size_t bytes, found;
    OK(hysteron_model_info(model, &info));
    weights = room(info.weights * sizeof *weights);
    OK(hysteron_model_weights(model, weights, info.weights, &found));
    OK(hysteron_model_stages(model, &constants));
    bytes = hysteron_core_model_size(info.levels, 1);
    own->memory[0] = room(bytes);
    OK(hysteron_core_model_init(own->memory[0], bytes, info.operator_kind, info.min, info.max, info.levels, weights,
                                found, &own->operators));
    free(weights);
    bytes = hysteron_core_state_size(info.levels);
    own->memory[1] = room(bytes);
    OK(hysteron_core_state_init(own->operators, own->memory[1], bytes, &own->state));
    bytes = hysteron_core_stages_size(&constants);
    own->memory[2] = room(bytes);
    OK(hysteron_core_stages_init(own->operators, &constants, own->memory[2], bytes, &own->stages));
    memset(&own->past, 0, sizeof own->past);
}

/* The columns of the file, and the time of each sample. */
struct columns {
    double *given, *expected, *dt, *load, *time, *found;
    int32_t *heading, *status, *flags;
};

static void read_rows(struct columns *c, FILE *file, size_t count, int inverse) {
    double **numbers[6];
    size_t n;
    numbers[0] = &c->given, numbers[1] = &c->expected, numbers[2] = &c->dt;
    numbers[3] = &c->load, numbers[4] = &c->time, numbers[5] = &c->found;
    for (n = 0; n < 6; n++) {
        *numbers[n] = room(count * sizeof(double));
    }
    c->heading = room(count * sizeof *c->heading);
    c->status = room(count * sizeof *c->status);
    c->flags = room(count * sizeof *c->flags);
    for (n = 0; n < count; n++) {
        c->heading[n] = c->status[n] = 0;
        if (inverse) {
            REQUIRE(fscanf(file, "%d %lf %lf %d", &c->heading[n], &c->given[n], &c->expected[n], &c->status[n]) == 4);
        } else {
            REQUIRE(fscanf(file, "%lf %lf", &c->given[n], &c->expected[n]) == 2);
        }
        REQUIRE(fscanf(file, "%lf %lf", &c->dt[n], &c->load[n]) == 2);
        c->time[n] = n == 0 ? 0.0 : c->time[n - 1] + c->dt[n];
    }
}

static void free_rows(struct columns *c) {
    free(c->given), free(c->expected), free(c->dt), free(c->load), free(c->time), free(c->found);
    free(c->heading), free(c->status), free(c->flags);
}

void vector_stages(const char *model_file, FILE *file) {
    struct own own;
    struct columns c;
    struct HysteronLimits limits;
    struct HysteronModelNeeds needs;
    uint64_t model, state;
    size_t count, n;
    double tolerance, policy, low, high, horizon;
    char kind[16];
    int inverse;
    REQUIRE(fscanf(file, "%15s %zu %lf %lf", kind, &count, &tolerance, &policy) == 4);
    REQUIRE(fscanf(file, "%lf %lf %lf", &low, &high, &horizon) == 3);
    inverse = strcmp(kind, "inverse") == 0;
    read_rows(&c, file, count, inverse);
    OK(hysteron_model_read(model_file, &model));
    OK(hysteron_model_needs(model, &needs));
    OK(hysteron_model_limits(model, &limits));
    if (!isnan(low)) {
        limits.drive_min = low, limits.drive_max = high, limits.horizon = horizon;
    }
    OK(hysteron_state_new(model, &state));
    own_start(&own, model);
    for (n = 0; n < count; n++) {
        double by_handle, by_memory;
        int32_t flag = 0, other = 0;
        if (inverse) {
            OK(hysteron_inverse_step_in(state, c.given[n], c.heading[n], policy, c.dt[n], c.load[n],
                                        isnan(low) ? NULL : &limits, &by_handle, &flag));
            OK(hysteron_core_stages_inverse_step(own.stages, own.operators, own.state, &own.past, c.given[n],
                                                 c.heading[n], policy, c.dt[n], c.load[n], &limits, &by_memory,
                                                 &other));
            REQUIRE(flag == c.status[n]);
        } else {
            OK(hysteron_step_in(state, c.given[n], c.dt[n], c.load[n], &by_handle, &flag));
            OK(hysteron_core_stages_step(own.stages, own.operators, own.state, &own.past, c.given[n], c.dt[n],
                                         c.load[n], &by_memory, &other));
        }
        REQUIRE(fabs(by_handle - c.expected[n]) <= tolerance);
        REQUIRE(memcmp(&by_handle, &by_memory, sizeof by_handle) == 0 && flag == other);
        c.found[n] = by_handle;
    }
    /* The same as a series, from the start again. */
    OK(hysteron_state_reset(state));
    {
        double *run = room(count * sizeof *run);
        const double *time = needs.time ? c.time : NULL, *load = needs.load ? c.load : NULL;
        if (inverse) {
            OK(hysteron_inverse_run_in(state, c.given, c.heading, policy, time, NAN, load, &limits, run, c.flags,
                                       count));
            REQUIRE(memcmp(c.flags, c.status, count * sizeof *c.flags) == 0);
        } else {
            OK(hysteron_run_in(state, c.given, time, NAN, load, run, NULL, count));
        }
        REQUIRE(memcmp(run, c.found, count * sizeof *run) == 0);
        free(run);
    }
    OK(hysteron_state_free(state));
    OK(hysteron_model_free(model));
    for (n = 0; n < 3; n++) {
        free(own.memory[n]);
    }
    free_rows(&c);
}

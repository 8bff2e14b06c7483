/* A run of a test vector with stages: step by step and as a series. */
#include "check.h"
#include <math.h>
#include <string.h>

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

void vector_stages(uint64_t model, uint64_t state, FILE *file) {
    struct columns c;
    struct HysteronLimits limits;
    struct HysteronModelNeeds needs;
    size_t count, n;
    double tolerance, policy, low, high, horizon, *run, *time, *load;
    char kind[16];
    int inverse;
    REQUIRE(fscanf(file, "%15s %zu %lf %lf", kind, &count, &tolerance, &policy) == 4);
    REQUIRE(fscanf(file, "%lf %lf %lf", &low, &high, &horizon) == 3);
    inverse = strcmp(kind, "inverse") == 0;
    read_rows(&c, file, count, inverse);
    OK(hysteron_model_needs(model, &needs));
    OK(hysteron_model_limits(model, &limits));
    if (!isnan(low)) {
        limits.drive_min = low, limits.drive_max = high, limits.horizon = horizon;
    }
    for (n = 0; n < count; n++) {
        int32_t flag = 0;
        if (inverse) {
            OK(hysteron_inverse_step_in(state, c.given[n], c.heading[n], policy, c.dt[n], c.load[n],
                                        isnan(low) ? NULL : &limits, &c.found[n], &flag));
            REQUIRE(flag == c.status[n]);
        } else {
            OK(hysteron_step_in(state, c.given[n], c.dt[n], c.load[n], &c.found[n], &flag));
        }
        REQUIRE(fabs(c.found[n] - c.expected[n]) <= tolerance);
    }
    /* The same as a series, from the start again. */
    OK(hysteron_state_reset(state));
    run = room(count * sizeof *run);
    time = needs.time ? c.time : NULL, load = needs.load ? c.load : NULL;
    if (inverse) {
        OK(hysteron_inverse_run_in(state, c.given, c.heading, policy, time, NAN, load, &limits, run, c.flags, count));
        REQUIRE(memcmp(c.flags, c.status, count * sizeof *c.flags) == 0);
    } else {
        OK(hysteron_run_in(state, c.given, time, NAN, load, run, NULL, count));
    }
    REQUIRE(memcmp(run, c.found, count * sizeof *run) == 0);
    free(run);
    free_rows(&c);
}

/* Drives an FMU (FMI 2.0) through C alone: replays a table, misuses it, or times it against the
 * plain double loop.
 *
 *   driver replay LIBRARY URI GUID ROWS OUT
 *   driver misuse LIBRARY URI GUID
 *   driver time   LIBRARY URI GUID PLANE
 *
 * ROWS: lines "input heading". OUT: lines "output flag", the output as hexadecimal float.
 * PLANE: "min max levels weights...".
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#include <time.h>
#endif
#include "fmi2Functions.h"

#define NEED(condition)                                                                \
    do {                                                                               \
        if (!(condition)) {                                                            \
            fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                                   \
        }                                                                              \
    } while (0)

static struct {
    fmi2InstantiateTYPE *instantiate;
    fmi2FreeInstanceTYPE *free;
    fmi2SetupExperimentTYPE *setup;
    fmi2EnterInitializationModeTYPE *enter;
    fmi2ExitInitializationModeTYPE *leave;
    fmi2TerminateTYPE *terminate;
    fmi2ResetTYPE *reset;
    fmi2SetRealTYPE *set;
    fmi2GetRealTYPE *get;
    fmi2SetIntegerTYPE *set_integer;
    fmi2GetIntegerTYPE *get_integer;
    fmi2DoStepTYPE *step;
    fmi2GetFMUstateTYPE *save;
    fmi2SetFMUstateTYPE *restore;
    fmi2FreeFMUstateTYPE *forget;
    fmi2SerializedFMUstateSizeTYPE *size;
    fmi2SerializeFMUstateTYPE *serialise;
    fmi2DeSerializeFMUstateTYPE *deserialise;
} fmu;

static void load(const char *path) {
#ifdef _WIN32
    HMODULE library = LoadLibraryA(path);
#define FIND(name) ((void *)GetProcAddress(library, name))
#else
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
#define FIND(name) dlsym(library, name)
#endif
    NEED(library);
    const char *names[] = {
        "fmi2Instantiate",
        "fmi2FreeInstance",
        "fmi2SetupExperiment",
        "fmi2EnterInitializationMode",
        "fmi2ExitInitializationMode",
        "fmi2Terminate",
        "fmi2Reset",
        "fmi2SetReal",
        "fmi2GetReal",
        "fmi2SetInteger",
        "fmi2GetInteger",
        "fmi2DoStep",
        "fmi2GetFMUstate",
        "fmi2SetFMUstate",
        "fmi2FreeFMUstate",
        "fmi2SerializedFMUstateSize",
        "fmi2SerializeFMUstate",
        "fmi2DeSerializeFMUstate",
    };
    NEED(sizeof names / sizeof *names == sizeof fmu / sizeof(void *));
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        void *function = FIND(names[n]);
        NEED(function);
        memcpy((char *)&fmu + n * sizeof function, &function, sizeof function);
    }
}

static char last_message[1000];

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                   fmi2String category, fmi2String message, ...) {
    va_list arguments;
    va_start(arguments, message);
    vsnprintf(last_message, sizeof last_message, message, arguments);
    va_end(arguments);
    NEED(environment == (void *)last_message && status >= fmi2Error &&
         strcmp(category, "logStatusError") == 0);
    NEED(strcmp(instance, "spring") == 0 || *instance == 0);
}

static const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, last_message};
static const fmi2ValueReference signal_in[] = {1}, signal_out[] = {2}, flag[] = {3},
                                heading[] = {4};

static fmi2Component start(const char *uri, const char *guid) {
    fmi2Component c = fmu.instantiate("spring", fmi2CoSimulation, guid, uri, &callbacks, 0, 0);
    if (!c) {
        fprintf(stderr, "%s\n", last_message);
        exit(2);
    }
    NEED(fmu.setup(c, 0, 0, 0, 0, 0) == fmi2OK && fmu.enter(c) == fmi2OK && fmu.leave(c) == fmi2OK);
    return c;
}

static void replay(const char *uri, const char *guid, const char *rows, const char *out) {
    fmi2Component c = start(uri, guid);
    FILE *from = fopen(rows, "r"), *to = fopen(out, "w");
    NEED(from && to);
    double input, output, time = 0;
    int ahead, found;
    while (fscanf(from, "%lf %d", &input, &ahead) == 2) {
        NEED(fmu.set(c, signal_in, 1, &input) == fmi2OK);
        if (ahead != 9) /* a model has no heading */
            NEED(fmu.set_integer(c, heading, 1, &ahead) == fmi2OK);
        NEED(fmu.step(c, time++, 1, fmi2True) == fmi2OK);
        NEED(fmu.get(c, signal_out, 1, &output) == fmi2OK &&
             fmu.get_integer(c, flag, 1, &found) == fmi2OK);
        unsigned long long bits;
        memcpy(&bits, &output, sizeof bits);
        fprintf(to, "%016llx %d\n", bits, found);
    }
    NEED(fmu.terminate(c) == fmi2OK);
    fmu.free(c);
    fclose(from);
    fclose(to);
}

static void misuse(const char *uri, const char *guid) {
    double value = 0.5, bad = NAN;
    NEED(!fmu.instantiate(NULL, fmi2CoSimulation, guid, uri, &callbacks, 0, 0));
    NEED(!fmu.instantiate("spring", fmi2CoSimulation, guid, uri, NULL, 0, 0));
    NEED(!fmu.instantiate("spring", fmi2ModelExchange, guid, uri, &callbacks, 0, 0));
    NEED(!fmu.instantiate("spring", fmi2CoSimulation, "{100% wrong #1}", uri, &callbacks, 0, 0));
    NEED(strstr(last_message, "`{100%% wrong ##1}`") || strstr(last_message, "`{100% wrong ##1}`"));
    NEED(!fmu.instantiate("spring", fmi2CoSimulation, guid, "file:///no/such/folder", &callbacks, 0,
                          0));
    NEED(strstr(last_message, "model.txt"));
    fmi2Component c = start(uri, guid);
    NEED(fmu.set(c, signal_in, 1, &bad) == fmi2OK && fmu.step(c, 0, 1, fmi2True) == fmi2Error);
    NEED(strstr(last_message, "fmi2DoStep: "));
    NEED(fmu.set(c, signal_in, 1, &value) == fmi2OK && fmu.step(c, 0, 1, fmi2True) == fmi2OK);
    NEED(fmu.set(c, NULL, 1, &value) == fmi2Error && fmu.get(c, signal_out, 1, NULL) == fmi2Error);
    NEED(fmu.set(c, signal_out, 1, &value) == fmi2Error &&
         fmu.step(c, 7, 1, fmi2True) == fmi2Error);
    fmi2FMUstate state = NULL, second = NULL;
    NEED(fmu.save(c, &state) == fmi2OK && fmu.save(c, NULL) == fmi2Error);
    size_t size;
    NEED(fmu.size(c, state, &size) == fmi2OK);
    fmi2Byte *bytes = malloc(size);
    NEED(fmu.serialise(c, state, bytes, size - 1) == fmi2Error &&
         fmu.serialise(c, state, bytes, size) == fmi2OK);
    for (size_t n = 0; n < size; n++) {
        NEED(fmu.deserialise(c, bytes, n, &second) == fmi2Error);
        bytes[n] ^= 1;
        NEED(fmu.deserialise(c, bytes, size, &second) == fmi2Error);
        bytes[n] ^= 1;
    }
    NEED(fmu.deserialise(c, bytes, size, &second) == fmi2OK && fmu.restore(c, second) == fmi2OK);
    free(bytes);
    fmi2FMUstate gone = state;
    NEED(fmu.forget(c, &state) == fmi2OK && !state && fmu.restore(c, gone) == fmi2Error);
    NEED(fmu.reset(c) == fmi2OK && fmu.step(c, 0, 1, fmi2True) == fmi2Error);
    fmu.free(c); /* with `second` still there: it goes with its instance */
    fmu.free(c);
    NEED(fmu.step(c, 0, 1, fmi2True) == fmi2Error && fmu.reset(c) == fmi2Error);
    NEED(fmu.step(NULL, 0, 1, fmi2True) == fmi2Error &&
         fmu.step((void *)&value, 0, 1, fmi2True) == fmi2Error);
    fmu.free(NULL);
}

#ifndef _WIN32
static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

/* Equation (5) for every operator, ridges worked out once a level. */
static double plain(int levels, double min, double per_unit, const double *weights, double *states,
                    double *ridges, double input) {
    double x = (input - min) * per_unit + 1, sum = 0;
    for (int k = 0; k < levels; k++) {
        double ridge = x - k;
        ridges[k] = ridge < 0 ? 0 : ridge > 1 ? 1 : ridge;
    }
    for (int j = 0; j < levels; j++) {
        for (int i = 0; i <= j; i++) {
            double state = *states;
            state = state < ridges[i] ? state : ridges[i];
            state = state > ridges[j] ? state : ridges[j];
            sum += *weights++ * (*states++ = state);
        }
    }
    return sum;
}

static int by_size(const void *a, const void *b) {
    double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static void measure(const char *uri, const char *guid, const char *plane) {
    enum { STEPS = 20000, RUNS = 21 };
    FILE *from = fopen(plane, "r");
    double min, max;
    int levels;
    NEED(from && fscanf(from, "%lf %lf %d", &min, &max, &levels) == 3);
    size_t count = (size_t)levels * (levels + 1) / 2;
    double *weights = malloc(count * sizeof *weights), *ridges = malloc(levels * sizeof *ridges);
    double *states = calloc(count, sizeof *states), *inputs = malloc(STEPS * sizeof *inputs);
    for (size_t n = 0; n < count; n++)
        NEED(fscanf(from, "%lf", &weights[n]) == 1);
    fclose(from);
    for (int n = 0; n < STEPS; n++) /* ever smaller loops, thirty in a run */
        inputs[n] = min + (max - min) * (0.5 - 0.5 * (1 - n / (1.1 * STEPS)) *
                                                   cos(n * 2 * acos(-1) * 30 / STEPS));
    double ratios[RUNS], fmu_times[RUNS], plain_times[RUNS], worst = 0,
                                                             per_unit = (levels - 1) / (max - min);
    for (int run = 0; run < RUNS; run++) {
        fmi2Component c = start(uri, guid);
        memset(states, 0, count * sizeof *states);
        double output, difference = 0, begun = seconds();
        for (int n = 0; n < STEPS; n++) {
            fmu.set(c, signal_in, 1, &inputs[n]);
            fmu.step(c, n, 1, fmi2True);
            fmu.get(c, signal_out, 1, &output);
            difference += output;
        }
        double between = seconds();
        for (int n = 0; n < STEPS; n++)
            difference -= plain(levels, min, per_unit, weights, states, ridges, inputs[n]);
        double ended = seconds();
        fmu.free(c);
        fmu_times[run] = (between - begun) / STEPS;
        plain_times[run] = (ended - between) / STEPS;
        ratios[run] = fmu_times[run] / plain_times[run];
        worst = fabs(difference) / STEPS > worst ? fabs(difference) / STEPS : worst;
    }
    NEED(worst < 1e-9); /* both computed the same */
    qsort(ratios, RUNS, sizeof *ratios, by_size);
    qsort(fmu_times, RUNS, sizeof *fmu_times, by_size);
    qsort(plain_times, RUNS, sizeof *plain_times, by_size);
    printf("%.3f %.0f %.0f\n", ratios[RUNS / 2], 1e9 * fmu_times[RUNS / 2],
           1e9 * plain_times[RUNS / 2]);
}
#endif

int main(int count, char **arguments) {
    NEED(count >= 5);
    load(arguments[2]);
    if (strcmp(arguments[1], "replay") == 0 && count == 7)
        replay(arguments[3], arguments[4], arguments[5], arguments[6]);
    else if (strcmp(arguments[1], "misuse") == 0)
        misuse(arguments[3], arguments[4]);
#ifndef _WIN32
    else if (strcmp(arguments[1], "time") == 0 && count == 6)
        measure(arguments[3], arguments[4], arguments[5]);
#endif
    else
        return 64;
    return 0;
}

/* The runs. `host tables` writes the constants. */
#ifndef RUN_H
#define RUN_H
#include <stddef.h>
#ifdef PLAIN
#include "plain.h"
typedef plain_model model_type;
#else
#include "hysteron_mcu.h"
typedef hys_model model_type;
#endif

/* The largest number of levels for which there is memory. */
#define MOST 40

enum { FORWARD = 2 }; /* kind of a forward step; other kinds are the heading of an inverse step */

typedef struct {
    const char *name;
    const model_type *model;
    int levels;
    hys_real tolerance;
    size_t count;
    const signed char *kinds;
    const hys_real *values;
} run;

extern const run runs[];
extern const size_t run_count;

#ifndef PLAIN
#include "hysteron_mcu_stages.h"

/* A run of a model with stages. */
typedef struct {
    const char *name;
    const hys_actuator *actuator;
    int levels;
    hys_real tolerance;
    size_t count;
    const signed char *kinds;
    const hys_real *values, *loads;
} staged_run;

extern const staged_run staged_runs[];
extern const size_t staged_run_count;
#endif
#endif

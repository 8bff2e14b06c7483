/* An instance of a block, for whichever standard: hysteron_fmi2.c and hysteron_fmi3.c are thin
 * layers over it. The functions return NULL, or what is wrong; an instance is then as before. */
#ifndef HYSTERON_BLOCK_H
#define HYSTERON_BLOCK_H

#include "block.h"

#include <math.h>

/* The standards hand over more than the block needs. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#elif defined(_MSC_VER)
#pragma warning(disable : 4100)
#endif

/* A stop time that never comes. */
#define BLOCK_NEVER HUGE_VAL

enum { BLOCK_INSTANTIATED, BLOCK_INITIALISING, BLOCK_STEPPING, BLOCK_TERMINATED };

/* Points that a saved state has at most, beside its numbers. */
#define BLOCK_POINTS (4 * BLOCK_LEVELS + 3)

/* What a tool sets. */
typedef struct {
    double signal;     /* input, or the wanted output */
    double tolerance;  /* of the inverse */
    int heading;       /* of the inverse */
    int start_on;
} block_inputs;

/* All that changes: what a saved state holds. */
typedef struct {
    int phase;
    double time, stop;
    block_inputs inputs;
    double result;  /* output, or the input found */
    int flag;       /* `clipped`, or `status` */
    hys_state state;
    hys_turn turns[BLOCK_TURNS];
} block_run;

/* A saved state as bytes: those of this struct. */
typedef struct {
    char token[sizeof BLOCK_TOKEN];
    int phase, flag;
    double time, stop, result, input;
    block_inputs inputs;
    size_t count;
    double points[BLOCK_POINTS];
} block_saved;

typedef struct {
    block_run run;
    /* Of the tool: where messages go. */
    char *name;
    void *environment;
    void (*logger)(void);
    int is_logging;
} block;

/* An instance, NULL if there is no memory. */
block *block_new(const char *name, void *environment, void (*logger)(void));
void block_free(block *instance);
const char *block_refuses(const char *name, const char *token);

const char *block_reset(block_run *run);
const char *block_experiment(block_run *run, double start, double stop);
const char *block_enter(block_run *run);
const char *block_exit(block_run *run);
const char *block_step(block_run *run, double from, double size);
const char *block_terminate(block_run *run);

const char *block_get_real(const block_run *run, unsigned reference, double *value);
const char *block_get_integer(const block_run *run, unsigned reference, int *value);
const char *block_get_boolean(const block_run *run, unsigned reference, int *value);
/* These write into a copy of the inputs, which block_set then takes as a whole. */
const char *block_put_real(block_inputs *inputs, unsigned reference, double value);
const char *block_put_integer(block_inputs *inputs, unsigned reference, int value);
const char *block_put_boolean(block_inputs *inputs, unsigned reference, int value);
const char *block_set(block_run *run, const block_inputs *inputs);

void block_copy(block_run *to, const block_run *from);
const char *block_save(const block_run *run, block_saved *saved);
const char *block_restore(block_run *run, const block_saved *saved);

#endif

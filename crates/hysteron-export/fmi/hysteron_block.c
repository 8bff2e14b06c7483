#include "hysteron_block.h"

#include <stdlib.h>
#include <string.h>

/* Variables by their value references, as in modelDescription.xml. */
enum { TIME, SIGNAL, RESULT, FLAG, HEADING, TOLERANCE, START_ON };

static const char UNKNOWN[] = "there is no variable of this type with the value reference";
static const char OUTPUT[] = "the variable with the value reference cannot be set";
static const char NOT_FINITE[] = "input or wanted output is not a finite number";

static int is_finite(double number) { return number - number == 0; }

static double size_of(double number) { return number < 0 ? -number : number; }

/* Tools add steps up to times, which gives rounding errors. */
static int is_close(double a, double b)
{
    double most = size_of(a) > size_of(b) ? size_of(a) : size_of(b);
    return size_of(a - b) <= 1e-9 * (most > 1 ? most : 1);
}

static const char *expect(const block_run *run, int phase)
{
    static const char *const words[] = {
        "initialisation has not been entered yet", "the instance is being initialised",
        "the instance is initialised already", "the instance was terminated: reset it first"
    };
    return run->phase == phase ? NULL : words[run->phase];
}

/* A step of operators, whatever its length. */
static const char *move(block_run *run)
{
    double signal = run->inputs.signal;
    if (!is_finite(signal)) return NOT_FINITE;
#if BLOCK_INVERSE
    if (hys_inverse_step(&run->state, signal, run->inputs.heading, run->inputs.tolerance,
                         &run->result, &run->flag) != HYS_OK)
        return NOT_FINITE;
#else
    if (hys_step(&run->state, signal, &run->result) != HYS_OK) return NOT_FINITE;
    run->flag = signal > BLOCK_MODEL.max ? 1 : signal < BLOCK_MODEL.bottom ? -1 : 0;
#endif
    return NULL;
}

/* The state after the start inputs. */
static const char *begin(block_run *run)
{
    if (hys_start(&BLOCK_MODEL, &run->state, run->turns, BLOCK_TURNS) != HYS_OK)
        return "the model is broken";
    if (run->inputs.start_on) hys_reset_on(&run->state);
#ifdef BLOCK_START
    else if (hys_restore(&run->state, BLOCK_START, sizeof BLOCK_START / sizeof *BLOCK_START,
                         BLOCK_START_INPUT) != HYS_OK)
        return "the model's start is broken";
#endif
    return move(run);
}

block *block_new(const char *name, void *environment, void (*logger)(void))
{
    block *instance = calloc(1, sizeof *instance);
    if (!instance) return NULL;
    instance->name = malloc(strlen(name) + 1);
    if (!instance->name) {
        free(instance);
        return NULL;
    }
    strcpy(instance->name, name);
    instance->environment = environment;
    instance->logger = logger;
    instance->is_logging = 1;
    block_reset(&instance->run);
    return instance;
}

void block_free(block *instance)
{
    if (instance) free(instance->name);
    free(instance);
}

const char *block_refuses(const char *name, const char *token)
{
    if (!name || !*name) return "the instance has no name";
    if (!token || strcmp(token, BLOCK_TOKEN) != 0)
        return "the GUID (instantiation token) is not that of the model";
    return NULL;
}

const char *block_reset(block_run *run)
{
    static const block_inputs first = { BLOCK_FIRST, 0, 0, 0 };
    memset(run, 0, sizeof *run);
    run->inputs = first;
    run->stop = BLOCK_NEVER;
    return begin(run);
}

const char *block_experiment(block_run *run, double start, double stop)
{
    const char *wrong = expect(run, BLOCK_INSTANTIATED);
    if (wrong) return wrong;
    if (!is_finite(start) || !(stop >= start)) return "no experiment has these times";
    run->time = start;
    run->stop = stop;
    return NULL;
}

const char *block_enter(block_run *run)
{
    const char *wrong = expect(run, BLOCK_INSTANTIATED);
    if (!wrong) run->phase = BLOCK_INITIALISING;
    return wrong;
}

const char *block_exit(block_run *run)
{
    const char *wrong = expect(run, BLOCK_INITIALISING);
    if (!wrong) wrong = begin(run);
    if (!wrong) run->phase = BLOCK_STEPPING;
    return wrong;
}

const char *block_step(block_run *run, double from, double size)
{
    const char *wrong = expect(run, BLOCK_STEPPING);
    double to = from + size;
    if (wrong) return wrong;
    if (!(size >= 0) || !is_finite(to)) return "no step has this length";
    if (!is_close(from, run->time)) return "the step begins elsewhere than the last one ended";
    if (to > run->stop && !is_close(to, run->stop)) return "the step ends after the stop time";
    wrong = move(run);
    if (!wrong) run->time = to;
    return wrong;
}

const char *block_terminate(block_run *run)
{
    const char *wrong = expect(run, BLOCK_STEPPING);
    if (!wrong) run->phase = BLOCK_TERMINATED;
    return wrong;
}

/* Before the first step the results are those of the start. They are not kept, so that a tool can
 * try other inputs. */
static const char *results(const block_run *run, double *result, int *flag)
{
    block_run begun;
    const char *wrong = NULL;
    if (run->phase < BLOCK_STEPPING) {
        block_copy(&begun, run);
        wrong = begin(&begun);
        run = &begun;
    }
    *result = run->result;
    *flag = run->flag;
    return wrong;
}

const char *block_get_real(const block_run *run, unsigned reference, double *value)
{
    int flag;
    switch (reference) {
    case TIME: *value = run->time; return NULL;
    case SIGNAL: *value = run->inputs.signal; return NULL;
    case RESULT: return results(run, value, &flag);
#if BLOCK_INVERSE
    case TOLERANCE: *value = run->inputs.tolerance; return NULL;
#endif
    default: return UNKNOWN;
    }
}

const char *block_get_integer(const block_run *run, unsigned reference, int *value)
{
    double result;
    switch (reference) {
    case FLAG: return results(run, &result, value);
#if BLOCK_INVERSE
    case HEADING: *value = run->inputs.heading; return NULL;
#endif
    default: return UNKNOWN;
    }
}

const char *block_get_boolean(const block_run *run, unsigned reference, int *value)
{
    if (reference != START_ON) return UNKNOWN;
    *value = run->inputs.start_on;
    return NULL;
}

const char *block_put_real(block_inputs *inputs, unsigned reference, double value)
{
    switch (reference) {
    case SIGNAL: inputs->signal = value; return NULL;
    case TIME:
    case RESULT: return OUTPUT;
#if BLOCK_INVERSE
    case TOLERANCE:
        if (!(value >= 0) || !is_finite(value))
            return "`tolerance` has to be a finite number from 0 on";
        inputs->tolerance = value;
        return NULL;
#endif
    default: return UNKNOWN;
    }
}

const char *block_put_integer(block_inputs *inputs, unsigned reference, int value)
{
    switch (reference) {
    case FLAG: return OUTPUT;
#if BLOCK_INVERSE
    case HEADING:
        if (value < -1 || value > 1) return "`heading` has to be -1, 0 or 1";
        inputs->heading = value;
        return NULL;
#endif
    default: return UNKNOWN;
    }
}

const char *block_put_boolean(block_inputs *inputs, unsigned reference, int value)
{
    if (reference != START_ON) return UNKNOWN;
    inputs->start_on = value != 0;
    return NULL;
}

const char *block_set(block_run *run, const block_inputs *inputs)
{
    if (run->phase == BLOCK_TERMINATED) return expect(run, BLOCK_STEPPING);
    if (run->phase == BLOCK_STEPPING && inputs->start_on != run->inputs.start_on)
        return "`start_on` acts at the start: it is fixed from there on";
    run->inputs = *inputs;
    return NULL;
}

void block_copy(block_run *to, const block_run *from)
{
    *to = *from;
    to->state.turns = to->turns;
}

const char *block_save(const block_run *run, block_saved *saved)
{
    memset(saved, 0, sizeof *saved);
    strcpy(saved->token, BLOCK_TOKEN);
    saved->phase = run->phase;
    saved->flag = run->flag;
    saved->time = run->time;
    saved->stop = run->stop;
    saved->result = run->result;
    saved->inputs = run->inputs;
    return hys_save(&run->state, saved->points, BLOCK_POINTS, &saved->count, &saved->input)
                   == HYS_OK
               ? NULL
               : "the state is broken";
}

/* The bytes come from outside. Numbers that no run can have are those of other bytes. */
static int is_whole(const block_saved *saved)
{
    const block_inputs *inputs = &saved->inputs;
    return saved->phase >= BLOCK_INSTANTIATED && saved->phase <= BLOCK_TERMINATED
           && inputs->heading >= -1 && inputs->heading <= 1
           && (inputs->start_on == 0 || inputs->start_on == 1)
           && inputs->tolerance >= 0 && is_finite(inputs->tolerance)
           && is_finite(saved->time) && (saved->stop >= 0 || saved->stop < 0)
           && saved->count <= BLOCK_POINTS;
}

const char *block_restore(block_run *run, const block_saved *saved)
{
    block_run other;
    if (memcmp(saved->token, BLOCK_TOKEN, sizeof saved->token) != 0)
        return "the state belongs to another model";
    block_reset(&other);
    if (!is_whole(saved)
        || hys_restore(&other.state, saved->points, saved->count, saved->input) != HYS_OK)
        return "the saved state is cut or changed";
    other.phase = saved->phase;
    other.flag = saved->flag;
    other.time = saved->time;
    other.stop = saved->stop;
    other.result = saved->result;
    other.inputs = saved->inputs;
    block_copy(run, &other);
    return NULL;
}

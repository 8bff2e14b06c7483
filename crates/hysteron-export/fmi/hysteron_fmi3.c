/* FMI 3.0 for co-simulation over hysteron_block. The standard's headers come with the tool that
 * compiles this. */
#include "fmi3Functions.h"
#include "hysteron_block.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*plain)(void);

static void tell(void *environment, plain logger, const char *call, const char *why)
{
    char said[200];
    if (!logger) return;
    snprintf(said, sizeof said, "%s: %s", call, why);
    ((fmi3LogMessageCallback)logger)(environment, fmi3Error, "logStatusError", said);
}

static fmi3Status answer(block *c, const char *call, const char *wrong)
{
    if (!wrong) return fmi3OK;
    if (c && c->is_logging) tell(c->environment, (plain)c->logger, call, wrong);
    return fmi3Error;
}

#define NO_INSTANCE(c) if (!(c)) return fmi3Error

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count,
                               const fmi3String categories[])
{
    size_t n;
    NO_INSTANCE(c);
    for (n = 0; n < count; n++)
        if (strcmp(categories[n], "logStatusError") != 0)
            return answer(c, "fmi3SetDebugLogging", "there is no such log category");
    ((block *)c)->is_logging = on;
    return fmi3OK;
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
    const fmi3ValueReference intermediate[], size_t count,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3IntermediateUpdateCallback update)
{
    const char *wrong = block_refuses(name, token);
    block *made;
    if (!wrong && events) wrong = "this FMU has no event mode";
    made = wrong ? NULL : block_new(name, environment, (plain)log);
    if (!made) tell(environment, (plain)log, "instantiate", wrong ? wrong : "there is no memory");
    return made;
}

static const char CO_SIMULATION[] = "this FMU is for co-simulation only";

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log)
{
    tell(environment, (plain)log, "instantiate", CO_SIMULATION);
    return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock)
{
    tell(environment, (plain)log, "instantiate", CO_SIMULATION);
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c) { block_free(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean has_stop, fmi3Float64 stop)
{
    const char *wrong;
    NO_INSTANCE(c);
    wrong = block_experiment(&((block *)c)->run, start, has_stop ? stop : BLOCK_NEVER);
    if (!wrong) wrong = block_enter(&((block *)c)->run);
    return answer(c, "fmi3EnterInitializationMode", wrong);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi3ExitInitializationMode", block_exit(&((block *)c)->run));
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi3Terminate", block_terminate(&((block *)c)->run));
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi3Reset", block_reset(&((block *)c)->run));
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 from, fmi3Float64 size, fmi3Boolean no_rollback,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early,
                      fmi3Float64 *last)
{
    const char *wrong;
    NO_INSTANCE(c);
    wrong = block_step(&((block *)c)->run, from, size);
    if (event) *event = fmi3False;
    if (terminate) *terminate = fmi3False;
    if (early) *early = fmi3False;
    if (last) *last = ((block *)c)->run.time;
    return answer(c, "fmi3DoStep", wrong);
}

static const char *get_boolean(const block_run *run, unsigned reference, fmi3Boolean *value)
{
    int number = 0;
    const char *wrong = block_get_boolean(run, reference, &number);
    *value = number != 0;
    return wrong;
}

#define REFERENCES fmi3Instance c, const fmi3ValueReference references[], size_t count

static const char AS_MANY[] = "as many values as references are needed";

#define VALUES(type, get, put)                                                                     \
    fmi3Status fmi3Get##type(REFERENCES, fmi3##type values[], size_t value_count)                  \
    {                                                                                              \
        const char *wrong = count == value_count ? NULL : AS_MANY;                                 \
        size_t n;                                                                                  \
        NO_INSTANCE(c);                                                                            \
        for (n = 0; n < count && !wrong; n++)                                                      \
            wrong = get(&((block *)c)->run, references[n], &values[n]);                            \
        return answer(c, "fmi3Get" #type, wrong);                                                  \
    }                                                                                              \
    fmi3Status fmi3Set##type(REFERENCES, const fmi3##type values[], size_t value_count)            \
    {                                                                                              \
        const char *wrong = count == value_count ? NULL : AS_MANY;                                 \
        block_inputs inputs;                                                                       \
        size_t n;                                                                                  \
        NO_INSTANCE(c);                                                                            \
        inputs = ((block *)c)->run.inputs;                                                         \
        for (n = 0; n < count && !wrong; n++) wrong = put(&inputs, references[n], values[n]);      \
        return answer(c, "fmi3Set" #type,                                                          \
                      wrong ? wrong : block_set(&((block *)c)->run, &inputs));                     \
    }

VALUES(Float64, block_get_real, block_put_real)
VALUES(Int32, block_get_integer, block_put_integer)
VALUES(Boolean, get_boolean, block_put_boolean)

/* What the block does not have, as its description says; of variables an empty list is no error. */
static const char NOTHING[] = "this FMU has no such thing";

#define NONE_OF(name, ...)                                                                         \
    fmi3Status name(REFERENCES, __VA_ARGS__)                                                       \
    {                                                                                              \
        NO_INSTANCE(c);                                                                            \
        return answer(c, #name, count > 0 ? NOTHING : NULL);                                       \
    }

#define NO_VARIABLES(type)                                                                         \
    NONE_OF(fmi3Get##type, fmi3##type values[], size_t value_count)                                \
    NONE_OF(fmi3Set##type, const fmi3##type values[], size_t value_count)

NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(UInt32)
NO_VARIABLES(Int64)
NO_VARIABLES(UInt64)
NO_VARIABLES(String)
NONE_OF(fmi3GetBinary, size_t sizes[], fmi3Binary values[], size_t value_count)
NONE_OF(fmi3SetBinary, const size_t sizes[], const fmi3Binary values[], size_t value_count)
NONE_OF(fmi3GetClock, fmi3Clock values[])
NONE_OF(fmi3SetClock, const fmi3Clock values[])
NONE_OF(fmi3GetIntervalDecimal, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
NONE_OF(fmi3GetIntervalFraction, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
        fmi3IntervalQualifier qualifiers[])
NONE_OF(fmi3GetShiftDecimal, fmi3Float64 shifts[])
NONE_OF(fmi3GetShiftFraction, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
NONE_OF(fmi3SetIntervalDecimal, const fmi3Float64 intervals[])
NONE_OF(fmi3SetIntervalFraction, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
NONE_OF(fmi3SetShiftDecimal, const fmi3Float64 shifts[])
NONE_OF(fmi3SetShiftFraction, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])

#define REFUSED(name, ...)                                                                         \
    fmi3Status name(__VA_ARGS__)                                                                   \
    {                                                                                              \
        NO_INSTANCE(c);                                                                            \
        return answer(c, #name, NOTHING);                                                          \
    }

REFUSED(fmi3EnterEventMode, fmi3Instance c)
REFUSED(fmi3EnterStepMode, fmi3Instance c)
REFUSED(fmi3EnterConfigurationMode, fmi3Instance c)
REFUSED(fmi3ExitConfigurationMode, fmi3Instance c)
REFUSED(fmi3EvaluateDiscreteStates, fmi3Instance c)
REFUSED(fmi3UpdateDiscreteStates, fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
        fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *has_next, fmi3Float64 *next)
REFUSED(fmi3GetNumberOfVariableDependencies, fmi3Instance c, fmi3ValueReference reference,
        size_t *n)
REFUSED(fmi3GetVariableDependencies, fmi3Instance c, fmi3ValueReference reference, size_t element[],
        fmi3ValueReference independents[], size_t elements[], fmi3DependencyKind kinds[], size_t n)
REFUSED(fmi3GetDirectionalDerivative, fmi3Instance c, const fmi3ValueReference u[], size_t nu,
        const fmi3ValueReference k[], size_t nk, const fmi3Float64 seed[], size_t ns,
        fmi3Float64 found[], size_t nf)
REFUSED(fmi3GetAdjointDerivative, fmi3Instance c, const fmi3ValueReference u[], size_t nu,
        const fmi3ValueReference k[], size_t nk, const fmi3Float64 seed[], size_t ns,
        fmi3Float64 found[], size_t nf)
REFUSED(fmi3GetOutputDerivatives, fmi3Instance c, const fmi3ValueReference references[], size_t n,
        const fmi3Int32 orders[], fmi3Float64 values[], size_t nv)
REFUSED(fmi3EnterContinuousTimeMode, fmi3Instance c)
REFUSED(fmi3CompletedIntegratorStep, fmi3Instance c, fmi3Boolean no_rollback, fmi3Boolean *event,
        fmi3Boolean *terminate)
REFUSED(fmi3SetTime, fmi3Instance c, fmi3Float64 time)
REFUSED(fmi3SetContinuousStates, fmi3Instance c, const fmi3Float64 states[], size_t n)
REFUSED(fmi3GetContinuousStates, fmi3Instance c, fmi3Float64 states[], size_t n)
REFUSED(fmi3GetContinuousStateDerivatives, fmi3Instance c, fmi3Float64 derivatives[], size_t n)
REFUSED(fmi3GetNominalsOfContinuousStates, fmi3Instance c, fmi3Float64 nominals[], size_t n)
REFUSED(fmi3GetNumberOfContinuousStates, fmi3Instance c, size_t *n)
REFUSED(fmi3GetEventIndicators, fmi3Instance c, fmi3Float64 indicators[], size_t n)
REFUSED(fmi3GetNumberOfEventIndicators, fmi3Instance c, size_t *n)
REFUSED(fmi3ActivateModelPartition, fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)

#define STATES(name) fmi3##name##FMUState
#define STATE fmi3FMUState
#define STATUS fmi3Status
#define BYTE fmi3Byte
#define INSTANCE fmi3Instance
#define SIZED fmi3SerializedFMUStateSize
#define SERIALISE fmi3SerializeFMUState
#define DESERIALISE fmi3DeserializeFMUState
#include "hysteron_states.h"

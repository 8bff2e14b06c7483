/* FMI 2.0 for co-simulation over hysteron_block. The standard's headers come with the tool that
 * compiles this. */
#include "fmi2Functions.h"
#include "hysteron_block.h"

#include <stdlib.h>
#include <string.h>

typedef void (*plain)(void);

/* Messages have no `%` and no `#`, which would mean something in them. */
static void tell(const char *name, void *environment, plain logger, const char *call,
                 const char *why)
{
    if (logger)
        ((fmi2CallbackLogger)logger)(environment, name, fmi2Error, "logStatusError", "%s: %s", call,
                                     why);
}

static fmi2Status answer(block *c, const char *call, const char *wrong)
{
    if (!wrong) return fmi2OK;
    if (c && c->is_logging) tell(c->name, c->environment, (plain)c->logger, call, wrong);
    return fmi2Error;
}

#define NO_INSTANCE(c) if (!(c)) return fmi2Error

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String categories[])
{
    size_t n;
    NO_INSTANCE(c);
    for (n = 0; n < count; n++)
        if (strcmp(categories[n], "logStatusError") != 0)
            return answer(c, "fmi2SetDebugLogging", "there is no such log category");
    ((block *)c)->is_logging = on != fmi2False;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type kind, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    const char *wrong = block_refuses(name, guid);
    block *made;
    if (!functions) return NULL;
    if (!wrong && kind != fmi2CoSimulation) wrong = "this FMU is for co-simulation only";
    made = wrong ? NULL
                 : block_new(name, functions->componentEnvironment, (plain)functions->logger);
    if (!made)
        tell(name ? name : "", functions->componentEnvironment, (plain)functions->logger,
             "fmi2Instantiate", wrong ? wrong : "there is no memory");
    return made;
}

void fmi2FreeInstance(fmi2Component c) { block_free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean has_stop, fmi2Real stop)
{
    NO_INSTANCE(c);
    return answer(c, "fmi2SetupExperiment",
                  block_experiment(&((block *)c)->run, start, has_stop ? stop : BLOCK_NEVER));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi2EnterInitializationMode", block_enter(&((block *)c)->run));
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi2ExitInitializationMode", block_exit(&((block *)c)->run));
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi2Terminate", block_terminate(&((block *)c)->run));
}

fmi2Status fmi2Reset(fmi2Component c)
{
    NO_INSTANCE(c);
    return answer(c, "fmi2Reset", block_reset(&((block *)c)->run));
}

#define VALUES(type, ctype, get, put)                                                              \
    fmi2Status fmi2Get##type(fmi2Component c, const fmi2ValueReference references[], size_t count, \
                             ctype values[])                                                       \
    {                                                                                              \
        const char *wrong = NULL;                                                                  \
        size_t n;                                                                                  \
        NO_INSTANCE(c);                                                                            \
        for (n = 0; n < count && !wrong; n++)                                                      \
            wrong = get(&((block *)c)->run, references[n], &values[n]);                            \
        return answer(c, "fmi2Get" #type, wrong);                                                  \
    }                                                                                              \
    fmi2Status fmi2Set##type(fmi2Component c, const fmi2ValueReference references[], size_t count, \
                             const ctype values[])                                                 \
    {                                                                                              \
        const char *wrong = NULL;                                                                  \
        block_inputs inputs;                                                                       \
        size_t n;                                                                                  \
        NO_INSTANCE(c);                                                                            \
        inputs = ((block *)c)->run.inputs;                                                         \
        for (n = 0; n < count && !wrong; n++) wrong = put(&inputs, references[n], values[n]);      \
        return answer(c, "fmi2Set" #type,                                                          \
                      wrong ? wrong : block_set(&((block *)c)->run, &inputs));                     \
    }

VALUES(Real, fmi2Real, block_get_real, block_put_real)
VALUES(Integer, fmi2Integer, block_get_integer, block_put_integer)
VALUES(Boolean, fmi2Boolean, block_get_boolean, block_put_boolean)

/* What the block does not have, as its description says. */
#define NOTHING(name, parameters, has)                                                             \
    fmi2Status name parameters                                                                     \
    {                                                                                              \
        NO_INSTANCE(c);                                                                            \
        return answer(c, #name, (has) ? "this FMU has no such thing" : NULL);                      \
    }

NOTHING(fmi2GetString, (fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2String v[]),
        n > 0)
NOTHING(fmi2SetString,
        (fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2String v[]),
        n > 0)
NOTHING(fmi2GetDirectionalDerivative,
        (fmi2Component c, const fmi2ValueReference u[], size_t nu, const fmi2ValueReference k[],
         size_t nk, const fmi2Real dk[], fmi2Real du[]),
        1)
NOTHING(fmi2SetRealInputDerivatives,
        (fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[],
         const fmi2Real v[]),
        1)
NOTHING(fmi2GetRealOutputDerivatives,
        (fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[],
         fmi2Real v[]),
        1)
NOTHING(fmi2CancelStep, (fmi2Component c), 1)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real size, fmi2Boolean no_rollback)
{
    NO_INSTANCE(c);
    return answer(c, "fmi2DoStep", block_step(&((block *)c)->run, from, size));
}

/* Steps are never pending, so only the time can be asked for. */
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    NO_INSTANCE(c);
    if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
    *value = ((block *)c)->run.time;
    return fmi2OK;
}

#define NO_STATUS(name, type)                                                                      \
    fmi2Status name(fmi2Component c, const fmi2StatusKind kind, type *value)                       \
    {                                                                                              \
        NO_INSTANCE(c);                                                                            \
        return fmi2Discard;                                                                        \
    }

NO_STATUS(fmi2GetStatus, fmi2Status)
NO_STATUS(fmi2GetIntegerStatus, fmi2Integer)
NO_STATUS(fmi2GetBooleanStatus, fmi2Boolean)
NO_STATUS(fmi2GetStringStatus, fmi2String)

#define STATES(name) fmi2##name##FMUstate
#define STATE fmi2FMUstate
#define STATUS fmi2Status
#define BYTE fmi2Byte
#define INSTANCE fmi2Component
#define SIZED fmi2SerializedFMUstateSize
#define SERIALISE fmi2SerializeFMUstate
#define DESERIALISE fmi2DeSerializeFMUstate
#include "hysteron_states.h"

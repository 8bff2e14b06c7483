#include "block.h"
#include <math.h>
#include <string.h>
#include <time.h>

static struct block *blocks;

/* ---- Errors ---- */

static const char *identifier(int32_t status) {
    switch (status) {
    case HYSTERON_NEGATIVE_WEIGHTS: return "hysteron:negativeWeights";
    case HYSTERON_INPUT_NOT_FINITE: return "hysteron:notFinite";
    case HYSTERON_TURNING_POINTS: return "hysteron:turningPoints";
    case HYSTERON_FILE: return "hysteron:file";
    case HYSTERON_MODEL_FILE: return "hysteron:modelFile";
    case HYSTERON_VALUE: return "hysteron:argument";
    case HYSTERON_LOAD:
    case HYSTERON_FIT: return "hysteron:load";
    case HYSTERON_TIME_STEP:
    case HYSTERON_THERMAL: return "hysteron:thermal";
    default: return "hysteron:error";
    }
}

static void raise(int32_t status) {
    char detail[1024];
    if (status != HYSTERON_OK) {
        hysteron_last_error(detail, sizeof detail);
        mexErrMsgIdAndTxt(identifier(status), "%s", detail);
    }
}

/* ---- Arguments ---- */

char *text(const mxArray *value, const char *name) {
    /* Not mxArrayToString: Octave does not free its result. A character takes at most 4 bytes. */
    size_t count = mxGetNumberOfElements(value), room = 4 * count + 1;
    char *found = mxIsChar(value) && mxGetM(value) <= 1 ? mxCalloc(room, 1) : NULL;
    int fails = found == NULL || (count > 0 && mxGetString(value, found, room) != 0);
    if (fails || strlen(found) < count) {
        mexErrMsgIdAndTxt("hysteron:argument",
                          "`%s` has to be a text in one row, without a zero in it", name);
    }
    return found;
}

static const mxArray *reals(const mxArray *value, const char *name) {
    mxArray *converted, *given = (mxArray *)value;
    int other = mxIsComplex(value) || mxIsSparse(value);
    /* Of 64 bits, it is likelier a block than a signal, and a double cannot hold it. */
    if (!mxIsNumeric(value) || other || mxIsUint64(value) || mxIsInt64(value)) {
        mexErrMsgIdAndTxt("hysteron:argument",
                          "`%s` has to be an array of real numbers, not %s%s", name,
                          mxIsComplex(value) ? "complex " : mxIsSparse(value) ? "sparse " : "",
                          mxGetClassName(value));
    }
    if (mxIsDouble(value)) {
        return value;
    }
    mexCallMATLAB(1, &converted, 1, &given, "double");
    return converted;
}

const mxArray *samples(const mxArray *value, const char *name) {
    const mxArray *array = reals(value, name);
    const double *x = mxGetPr(array);
    size_t n, count = mxGetNumberOfElements(array);
    for (n = 0; n < count; n++) {
        if (!(x[n] - x[n] == 0.0)) {
            mexErrMsgIdAndTxt("hysteron:notFinite",
                              "`%s(%.0f)` is %s: every sample has to be a finite number",
                              name, (double)n + 1.0, isnan(x[n]) ? "NaN" : "infinite");
        }
    }
    return array;
}

double *series(const mxArray *value, const char *name, size_t count, int repeats) {
    double *copy;
    size_t n, found;
    if (value == NULL) {
        return NULL;
    }
    value = samples(value, name);
    found = mxGetNumberOfElements(value);
    if (found != count && !(repeats && found == 1)) {
        mexErrMsgIdAndTxt("hysteron:argument", "`%s` has %.0f numbers for %.0f samples", name,
                          (double)found, (double)count);
    }
    copy = mxCalloc(count + 1, sizeof *copy);
    for (n = 0; n < count; n++) {
        copy[n] = mxGetPr(value)[found == 1 ? 0 : n];
    }
    return copy;
}

double number(const mxArray *value, const char *name) {
    const mxArray *array = samples(value, name);
    if (mxGetNumberOfElements(array) != 1) {
        mexErrMsgIdAndTxt("hysteron:argument", "`%s` has to be one number", name);
    }
    return *mxGetPr(array);
}

void options(int nrhs, const mxArray *prhs[], int from, const char *const names[],
             const mxArray *values[], int count) {
    int n, option;
    for (n = from; n < nrhs; n += 2) {
        const char *name = text(prhs[n], "option");
        for (option = 0; option < count && strcmp(name, names[option]) != 0; option++) {
        }
        if (option == count) {
            mexErrMsgIdAndTxt("hysteron:argument", "there is no option `%s` here: see the help",
                              name);
        }
        if (n + 1 == nrhs) {
            mexErrMsgIdAndTxt("hysteron:argument", "the option `%s` needs a value", name);
        }
        values[option] = prhs[n + 1];
    }
}

mxArray *shaped_like(const mxArray *other, mxClassID type) {
    return mxCreateNumericArray(mxGetNumberOfDimensions(other), mxGetDimensions(other), type,
                                mxREAL);
}

/* ---- Blocks ---- */

static void close_block(struct block *block) {
    struct block **place = &blocks;
    while (*place != block) {
        place = &(*place)->next;
    }
    *place = block->next;
    hysteron_state_free(block->state);
    hysteron_model_free(block->model);
    free(block);
}

/* When the function is cleared, or the session ends. */
static void close_all(void) {
    while (blocks != NULL) {
        close_block(blocks);
    }
}

/* Numbers begin anew when the function is cleared and loaded again. They begin elsewhere then: an
 * old block must not be taken for a new one. Those of the inverse are odd, the others even: a block
 * of one function must not be taken for one of the other. */
static uint64_t next_id(void) {
    static uint64_t last;
    if (last == 0) {
        last = ((uint64_t)time(NULL) << 24) ^ ((uint64_t)(size_t)&last & 0xfff000u);
        last += is_inverse;
        mexAtExit(close_all);
    }
    return last += 2;
}

static int32_t start_of(const mxArray *value, const char *usual) {
    static const char *const words[] = {"fitted", "off", "on"};
    static const int32_t starts[] = {HYSTERON_START_FITTED, HYSTERON_START_OFF, HYSTERON_START_ON};
    const char *word = value == NULL ? usual : text(value, "start");
    int n;
    for (n = 0; n < 3 && strcmp(word, words[n]) != 0; n++) {
    }
    if (n == 3) {
        mexErrMsgIdAndTxt("hysteron:argument", "`start` is 'fitted', 'off' or 'on', not '%s'",
                          word);
    }
    return starts[n];
}

static struct block *open_block(const mxArray *path, const mxArray *load, const mxArray *start) {
    const char *name = text(path, "model");
    double at = load == NULL ? 0.0 : number(load, "load");
    int32_t from = start_of(start, "fitted"), status;
    uint64_t model, at_load, state;
    struct block *block;
    raise(hysteron_model_read(name, &model));
    if (load != NULL) {
        status = hysteron_model_at_load(model, at, &at_load);
        hysteron_model_free(model);
        raise(status);
        model = at_load;
    }
    status = hysteron_state_new(model, &state);
    if (status != HYSTERON_OK) {
        hysteron_model_free(model);
        raise(status);
    }
    hysteron_state_start(state, from);
    block = malloc(sizeof *block);
    if (block == NULL) {
        hysteron_state_free(state);
        hysteron_model_free(model);
        mexErrMsgIdAndTxt("hysteron:error", "no memory left");
    }
    block->id = next_id();
    block->model = model;
    block->state = state;
    block->time = NAN;
    block->next = blocks;
    blocks = block;
    return block;
}

static struct block *find(const mxArray *value) {
    struct block *block = NULL;
    if (mxIsUint64(value) && mxGetNumberOfElements(value) == 1) {
        uint64_t id = *(const uint64_t *)mxGetData(value);
        for (block = blocks; block != NULL && block->id != id; block = block->next) {
        }
    }
    if (block == NULL) {
        mexErrMsgIdAndTxt("hysteron:block", "this is no open block of this function: "
                                            "open one with 'open', or name a model file");
    }
    return block;
}

struct block *take(const mxArray *first, const mxArray *start) {
    if (mxIsChar(first)) {
        return open_block(first, NULL, start);
    }
    if (start != NULL) {
        mexErrMsgIdAndTxt("hysteron:argument", "`start` is told when a block is opened or reset");
    }
    return find(first);
}

void passed(struct block *block, const double *time, size_t count) {
    if (time != NULL && count > 0) {
        block->time = time[count - 1];
    }
}

void done(struct block *block, const mxArray *first, int32_t status) {
    char detail[1024];
    if (status != HYSTERON_OK) {
        hysteron_last_error(detail, sizeof detail);
    }
    if (mxIsChar(first)) {
        close_block(block);
    }
    if (status != HYSTERON_OK) {
        mexErrMsgIdAndTxt(identifier(status), "%s", detail);
    }
}

/* ---- Commands ---- */

static mxArray *saved(const struct block *block) {
    static const char *names[] = {"turning_points", "input", "stages", "time"};
    mxArray *result = mxCreateStructMatrix(1, 1, 4, names), *points, *numbers;
    struct HysteronStageState stages;
    double input, none;
    size_t count;
    hysteron_state_save(block->state, &none, 0, &count, &input); /* no room: tells how many */
    points = mxCreateDoubleMatrix(1, count, mxREAL);
    numbers = mxCreateDoubleMatrix(1, sizeof stages / sizeof(double), mxREAL);
    raise(hysteron_state_save(block->state, mxGetPr(points), count, &count, &input));
    raise(hysteron_state_save_stages(block->state, &stages));
    memcpy(mxGetPr(numbers), &stages, sizeof stages); /* a structure of doubles */
    mxSetField(result, 0, "turning_points", points);
    mxSetField(result, 0, "input", mxCreateDoubleScalar(input));
    mxSetField(result, 0, "stages", numbers);
    mxSetField(result, 0, "time", isnan(block->time) ? mxCreateDoubleMatrix(0, 0, mxREAL)
                                                     : mxCreateDoubleScalar(block->time));
    return result;
}

/* Without `stages` and `time`, all stages are at rest with the next sample. */
static void restore(struct block *block, const mxArray *from) {
    const mxArray *points, *input, *numbers, *time;
    struct HysteronStageState stages;
    double last, at = NAN;
    if (!mxIsStruct(from) || mxGetNumberOfElements(from) != 1 ||
        (points = mxGetField(from, 0, "turning_points")) == NULL ||
        (input = mxGetField(from, 0, "input")) == NULL) {
        mexErrMsgIdAndTxt("hysteron:argument",
                          "what to restore has to be a struct that 'save' gave");
    }
    points = samples(points, "turning_points");
    last = number(input, "input");
    numbers = mxGetField(from, 0, "stages");
    time = mxGetField(from, 0, "time");
    memset(&stages, 0, sizeof stages);
    if (numbers != NULL) {
        numbers = samples(numbers, "stages");
        if (mxGetNumberOfElements(numbers) != sizeof stages / sizeof(double)) {
            mexErrMsgIdAndTxt("hysteron:argument", "`stages` has to be the one that 'save' gave");
        }
        memcpy(&stages, mxGetPr(numbers), sizeof stages);
    }
    if (time != NULL && !mxIsEmpty(time)) {
        at = number(time, "time");
    }
    raise(hysteron_state_restore(block->state, mxGetPr(points), mxGetNumberOfElements(points),
                                 last));
    raise(hysteron_state_restore_stages(block->state, &stages));
    block->time = at;
}

static mxArray *quantity(uint64_t model, int32_t which) {
    char name[1024];
    size_t needed;
    raise(hysteron_model_quantity(model, which, name, sizeof name, &needed));
    return mxCreateString(name);
}

static mxArray *pair(double min, double max) {
    mxArray *range = mxCreateDoubleMatrix(1, 2, mxREAL);
    mxGetPr(range)[0] = min;
    mxGetPr(range)[1] = max;
    return range;
}

static mxArray *info(const struct block *block) {
    static const char *names[] = {"operator",     "levels",     "range",        "input",
                                  "output",       "offset",     "sign",         "output_off",
                                  "output_on",    "usual_tolerance", "needs_time", "needs_load",
                                  "load",         "load_range", "drive_range",  "active_range",
                                  "fitted_start"};
    static const char *operators[] = {"mkp", "kp", "relay"};
    mxArray *result = mxCreateStructMatrix(1, 1, 17, names), *none;
    struct HysteronModelInfo info;
    struct HysteronModelNeeds needs;
    raise(hysteron_model_info(block->model, &info));
    raise(hysteron_model_needs(block->model, &needs));
    none = mxCreateDoubleMatrix(0, 0, mxREAL);
    mxSetField(result, 0, "operator", mxCreateString(operators[info.operator_kind]));
    mxSetField(result, 0, "levels", mxCreateDoubleScalar((double)info.levels));
    mxSetField(result, 0, "range", pair(info.min, info.max));
    mxSetField(result, 0, "input", quantity(block->model, 0));
    mxSetField(result, 0, "output", quantity(block->model, 1));
    mxSetField(result, 0, "offset", mxCreateDoubleScalar(info.offset));
    mxSetField(result, 0, "sign", mxCreateDoubleScalar(info.sign));
    mxSetField(result, 0, "output_off", mxCreateDoubleScalar(info.output_off));
    mxSetField(result, 0, "output_on", mxCreateDoubleScalar(info.output_on));
    mxSetField(result, 0, "usual_tolerance", mxCreateDoubleScalar(info.usual_tolerance));
    mxSetField(result, 0, "needs_time", mxCreateLogicalScalar(needs.time != 0));
    mxSetField(result, 0, "needs_load", mxCreateLogicalScalar(needs.load != 0));
    mxSetField(result, 0, "load", needs.load ? quantity(block->model, 2) : mxCreateString(""));
    mxSetField(result, 0, "load_range", needs.load ? pair(needs.load_min, needs.load_max) : none);
    mxSetField(result, 0, "drive_range", pair(needs.drive_min, needs.drive_max));
    mxSetField(result, 0, "active_range", pair(needs.active_min, needs.active_max));
    mxSetField(result, 0, "fitted_start", mxCreateLogicalScalar(needs.fitted_start != 0));
    return result;
}

/* The commands, with how many arguments follow the word. */
static const struct {
    const char *word;
    int least, most;
} COMMANDS[] = {{"open", 1, 5}, {"reset", 1, 2},       {"save", 1, 1}, {"restore", 2, 2},
                {"info", 1, 1}, {"temperature", 1, 1}, {"close", 1, 1}};

enum { OPEN, RESET, SAVE, RESTORE, INFO, TEMPERATURE, CLOSE, COUNT };

int command(const char *function, mxArray *plhs[], int nrhs, const mxArray *prhs[]) {
    static const char *const names[] = {"load", "start"};
    const mxArray *values[] = {NULL, NULL};
    const char *word;
    struct block *block;
    double temperature;
    int which;
    if (nrhs < 2) {
        mexErrMsgIdAndTxt("hysteron:argument",
                          "%s needs a model and samples, or a command and a block: see help %s",
                          function, function);
    }
    if (!mxIsChar(prhs[0])) {
        return 0;
    }
    word = text(prhs[0], "model");
    for (which = 0; which < COUNT && strcmp(word, COMMANDS[which].word) != 0; which++) {
    }
    if (which == COUNT) {
        return 0;
    }
    if (nrhs - 1 < COMMANDS[which].least || nrhs - 1 > COMMANDS[which].most) {
        mexErrMsgIdAndTxt("hysteron:argument", "'%s' takes %d to %d arguments: see help %s", word,
                          COMMANDS[which].least, COMMANDS[which].most, function);
    }
    if (which == OPEN) {
        options(nrhs, prhs, 2, names, values, 2);
        block = open_block(prhs[1], values[0], values[1]);
        /* A place for one result is always there, whoever asks for it. */
        plhs[0] = mxCreateNumericMatrix(1, 1, mxUINT64_CLASS, mxREAL);
        *(uint64_t *)mxGetData(plhs[0]) = block->id;
        return 1;
    }
    block = which == INFO ? take(prhs[1], NULL) : find(prhs[1]);
    switch (which) {
    case RESET:
        raise(hysteron_state_start(block->state, start_of(nrhs == 3 ? prhs[2] : NULL, "off")));
        block->time = NAN;
        break;
    case SAVE: plhs[0] = saved(block); break;
    case RESTORE: restore(block, prhs[2]); break;
    case INFO:
        plhs[0] = info(block);
        done(block, prhs[1], HYSTERON_OK);
        break;
    case TEMPERATURE:
        raise(hysteron_state_temperature(block->state, &temperature));
        plhs[0] = mxCreateDoubleScalar(temperature);
        break;
    default: close_block(block); break;
    }
    return 1;
}

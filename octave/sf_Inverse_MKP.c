/* The block sf_Inverse_MKP: displacement to temperature. Its help is in sf_Inverse_MKP.m. */
#include "block.h"
#include <string.h>

const uint64_t is_inverse = 1;

enum { POLICY, TOLERANCE, HEADING, TIME, LOAD, START, DRIVE_RANGE, HORIZON, COUNT };

static const char *const NAMES[COUNT] = {"policy", "tolerance", "heading",     "time",
                                         "load",   "start",     "drive_range", "horizon"};

/* Whether the policy is to anticipate. */
static int anticipates(const mxArray *policy) {
    const char *word = policy == NULL ? "hold" : text(policy, "policy");
    if (strcmp(word, "hold") != 0 && strcmp(word, "anticipate") != 0) {
        mexErrMsgIdAndTxt("hysteron:argument", "`policy` is 'hold' or 'anticipate', not '%s'",
                          word);
    }
    return word[0] == 'a';
}

/* Headings that the caller knows: one for each target, or one for all. */
static void given(const mxArray *value, int32_t *heading, size_t count) {
    const mxArray *array = samples(value, "heading");
    size_t n, length = mxGetNumberOfElements(array);
    if (length != 1 && length != count) {
        mexErrMsgIdAndTxt("hysteron:argument", "`heading` has %.0f numbers for %.0f targets",
                          (double)length, (double)count);
    }
    for (n = 0; n < count; n++) {
        double way = mxGetPr(array)[length == 1 ? 0 : n];
        if (way != -1.0 && way != 0.0 && way != 1.0) {
            mexErrMsgIdAndTxt("hysteron:argument", "`heading(%.0f)` is %g: -1, 0 or 1 is needed",
                              (double)n + 1.0, way);
        }
        heading[n] = (int32_t)way;
    }
}

/* Limits other than those of the model. The library checks them. */
static void change(struct HysteronLimits *limits, const double *drive, double horizon) {
    if (drive != NULL) {
        limits->drive_min = drive[0];
        limits->drive_max = drive[1];
    }
    limits->horizon = horizon;
}

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[]) {
    const mxArray *values[COUNT] = {NULL}, *target;
    struct HysteronLimits limits;
    int32_t *heading, *flags, status = HYSTERON_OK;
    struct HysteronModelInfo info;
    struct block *block;
    double tolerance = 0.0, horizon, *time, *load, *drive;
    int anticipate;
    size_t n, count;
    if (command("sf_Inverse_MKP", plhs, nrhs, prhs)) {
        return;
    }
    options(nrhs, prhs, 2, NAMES, values, COUNT);
    target = samples(prhs[1], "target");
    count = mxGetNumberOfElements(target);
    anticipate = anticipates(values[POLICY]);
    if (values[HEADING] != NULL && values[POLICY] != NULL && !anticipate) {
        mexErrMsgIdAndTxt("hysteron:argument",
                          "`heading` is for the policy 'anticipate', not for 'hold'");
    }
    if (anticipate && values[HEADING] == NULL && count == 1 && !mxIsChar(prhs[0])) {
        mexErrMsgIdAndTxt("hysteron:argument",
                          "one target does not tell where the next one goes: "
                          "give `heading`, 1 or -1");
    }
    if (values[TOLERANCE] != NULL) {
        tolerance = number(values[TOLERANCE], "tolerance");
    }
    if (tolerance < 0.0) {
        mexErrMsgIdAndTxt("hysteron:argument", "`tolerance` is %g: 0 or more is needed", tolerance);
    }
    time = series(values[TIME], "time", count, 0);
    load = series(values[LOAD], "load", count, 1);
    drive = series(values[DRIVE_RANGE], "drive_range", 2, 0);
    horizon = values[HORIZON] == NULL ? 0.0 : number(values[HORIZON], "horizon");
    heading = mxCalloc(count + 1, sizeof *heading);
    flags = mxCalloc(count + 1, sizeof *flags);
    if (values[HEADING] != NULL) {
        given(values[HEADING], heading, count);
    }
    plhs[0] = shaped_like(prhs[1], mxDOUBLE_CLASS);
    if (nlhs > 1) {
        plhs[1] = shaped_like(prhs[1], mxINT8_CLASS);
    }
    block = take(prhs[0], values[START]);
    status = hysteron_model_limits(block->model, &limits);
    change(&limits, drive, horizon);
    if (status == HYSTERON_OK && anticipate && values[TOLERANCE] == NULL) {
        status = hysteron_model_info(block->model, &info);
        tolerance = status == HYSTERON_OK ? info.usual_tolerance : 0.0;
    }
    if (status == HYSTERON_OK && anticipate && values[HEADING] == NULL) {
        status = hysteron_headings(mxGetPr(target), count, tolerance, heading);
    }
    if (status == HYSTERON_OK) {
        status = hysteron_inverse_run_in(block->state, mxGetPr(target), heading, tolerance, time,
                                         block->time, load, &limits, mxGetPr(plhs[0]), flags,
                                         count);
    }
    if (status == HYSTERON_OK) {
        passed(block, time, count);
    }
    for (n = 0; n < count && nlhs > 1; n++) {
        ((int8_t *)mxGetData(plhs[1]))[n] = (int8_t)flags[n];
    }
    done(block, prhs[0], status);
}

/* The block sf_MKP: temperature to displacement. What it does says sf_MKP.m. */
#include "block.h"

const uint64_t is_inverse = 0;

enum { TIME, LOAD, START, COUNT };

static const char *const NAMES[COUNT] = {"time", "load", "start"};

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[]) {
    const mxArray *values[COUNT] = {NULL, NULL, NULL}, *input;
    double *time, *load;
    struct block *block;
    int32_t status, *clipped;
    size_t n, count;
    if (command("sf_MKP", plhs, nrhs, prhs)) {
        return;
    }
    options(nrhs, prhs, 2, NAMES, values, COUNT);
    input = samples(prhs[1], "input");
    count = mxGetNumberOfElements(input);
    time = series(values[TIME], "time", count, 0);
    load = series(values[LOAD], "load", count, 1);
    clipped = mxCalloc(count + 1, sizeof *clipped);
    plhs[0] = shaped_like(prhs[1], mxDOUBLE_CLASS);
    if (nlhs > 1) {
        plhs[1] = shaped_like(prhs[1], mxINT8_CLASS);
    }
    block = take(prhs[0], values[START]);
    status = hysteron_run_in(block->state, mxGetPr(input), time, block->time, load,
                             mxGetPr(plhs[0]), clipped, count);
    if (status == HYSTERON_OK) {
        passed(block, time, count);
    }
    for (n = 0; n < count && nlhs > 1; n++) {
        ((int8_t *)mxGetData(plhs[1]))[n] = (int8_t)clipped[n];
    }
    done(block, prhs[0], status);
}

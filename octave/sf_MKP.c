/* The block sf_MKP: temperature to displacement. What it does says sf_MKP.m. */
#include "block.h"

void mexFunction(int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[]) {
    static const char *const names[] = {"load"};
    const mxArray *load = NULL, *input;
    const double *x;
    double *y;
    int8_t *clipped = NULL;
    struct block *block;
    int32_t status = HYSTERON_OK, side;
    size_t n, count;
    if (command("sf_MKP", plhs, nrhs, prhs)) {
        return;
    }
    options(nrhs, prhs, 2, names, &load, 1);
    input = samples(prhs[1], "input");
    count = mxGetNumberOfElements(input);
    plhs[0] = shaped_like(prhs[1], mxDOUBLE_CLASS);
    if (nlhs > 1) {
        plhs[1] = shaped_like(prhs[1], mxINT8_CLASS);
        clipped = mxGetData(plhs[1]);
    }
    x = mxGetPr(input);
    y = mxGetPr(plhs[0]);
    block = take(prhs[0], load);
    for (n = 0; n < count && status == HYSTERON_OK; n++) {
        status = hysteron_step(block->state, x[n], &y[n], &side);
        if (clipped != NULL) {
            clipped[n] = (int8_t)side;
        }
    }
    done(block, prhs[0], status);
}

/* What sf_MKP and sf_Inverse_MKP share: blocks that are open, arguments, errors. */
#ifndef BLOCK_H
#define BLOCK_H

#include "hysteron.h"
#include "mex.h"

/* A model and a state of it. */
struct block {
    uint64_t id;
    uint64_t model;
    uint64_t state;
    double time; /* of the last sample; NaN for none */
    struct block *next;
};

/* 1 in sf_Inverse_MKP, 0 in sf_MKP. */
extern const uint64_t is_inverse;

/* Runs a call whose first argument is a command (`open`, `reset`, `save`, `restore`, `info`,
 * `temperature`, `close`). Returns whether it was one. `function` is the name for messages. */
int command(const char *function, mxArray *plhs[], int nrhs, const mxArray *prhs[]);

/* The block that the first argument names: an open one, or, for a model file, one made for this
 * call, which takes the option `start`. Give it back with `done`. */
struct block *take(const mxArray *first, const mxArray *start);

/* Ends the use of a block: raises the error of `status`, if it is one. */
void done(struct block *block, const mxArray *first, int32_t status);

/* Real samples as doubles, all finite: the array itself, or a copy of other types. */
const mxArray *samples(const mxArray *value, const char *name);

/* A copy of the numbers of an option that goes with `count` samples; NULL where it is not given. For
 * `repeats` one number may stand for all. */
double *series(const mxArray *value, const char *name, size_t count, int repeats);

/* Notes the time of the last sample of a call. */
void passed(struct block *block, const double *time, size_t count);

/* One real, finite number. */
double number(const mxArray *value, const char *name);

/* Reads options: pairs of name and value from argument `from` on. `values` has as many places as
 * there are `names`, that is `count`. */
void options(int nrhs, const mxArray *prhs[], int from, const char *const names[],
             const mxArray *values[], int count);

/* A text without a zero in it, which Octave and MATLAB free when the call ends. */
char *text(const mxArray *value, const char *name);

/* An array of the shape of another. */
mxArray *shaped_like(const mxArray *other, mxClassID type);

#endif

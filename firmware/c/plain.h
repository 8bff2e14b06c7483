/* The plain loop of the chapter: every operator in every step. */
#ifndef PLAIN_H
#define PLAIN_H
#include "hysteron_mcu.h" /* hys_real only */

typedef struct {
    int levels;
    hys_real min, max;
    const hys_real *weights; /* row by row: j = 1…K, i = 1…j */
} plain_model;

typedef struct {
    const plain_model *model;
    hys_real *gamma; /* K(K + 1)/2 */
    hys_real input, output;
} plain_state;

/* The largest number of levels. The ridges are on the stack. */
#define PLAIN_LEVELS 40

/* Number of halvings of an inverse step: as fine as the number type. */
#define PLAIN_HALVINGS (sizeof(hys_real) == sizeof(float) ? 24 : 53)

void plain_start(const plain_model *model, plain_state *state, hys_real *gamma);
void plain_step(plain_state *state, hys_real input, hys_real *output);
void plain_inverse_step(plain_state *state, hys_real target, hys_real *input, int *status);
#endif

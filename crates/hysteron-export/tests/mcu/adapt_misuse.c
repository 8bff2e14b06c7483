/* What adaptation refuses. */
#include <string.h>

#include "check.h"
#include "hysteron_mcu_adapt.h"
#include "models.h"

static hys_adaptive adaptive;
static hys_real memory[MOST_NUMBERS];
static hys_turn turns[MOST_TURNS];
static hys_adapt_options options;

static int start(const hys_real *theirs)
{
    return hys_adapt_start(&adaptive, models[0], theirs, 0, &options, memory, MOST_NUMBERS, turns,
                           MOST_TURNS);
}

int main(void)
{
    const hys_model *model = models[0];
    const hys_real *w = weights[0];
    hys_real bad[MOST_NUMBERS], zero = 0, nan = zero / zero, infinity = 1 / zero, y = 42;
    int outcome = 42, n;

    CHECK(hys_adapt_step(&adaptive, 1, 1, &y, &outcome) == HYS_STATE_MISMATCH);
    CHECK(hys_adapt_freeze(&adaptive, 1) == HYS_STATE_MISMATCH &&
          hys_adapt_keep(&adaptive) == HYS_STATE_MISMATCH);
    CHECK(hys_adapt_roll_back(&adaptive) == HYS_STATE_MISMATCH &&
          hys_adapt_realign(&adaptive) == HYS_STATE_MISMATCH);
    CHECK(hys_adapt_parameters(&adaptive) == NULL && hys_adapt_parameters(NULL) == NULL);
    options = *defaults[0][0];
    CHECK(hys_adapt_start(NULL, model, w, 0, &options, memory, MOST_NUMBERS, turns, MOST_TURNS) ==
          HYS_NULL);
    CHECK(hys_adapt_start(&adaptive, NULL, w, 0, &options, memory, MOST_NUMBERS, turns,
                          MOST_TURNS) == HYS_NULL);
    CHECK(hys_adapt_start(&adaptive, model, NULL, 0, &options, memory, MOST_NUMBERS, turns,
                          MOST_TURNS) == HYS_NULL);
    CHECK(hys_adapt_start(&adaptive, model, w, 0, NULL, memory, MOST_NUMBERS, turns, MOST_TURNS) ==
          HYS_NULL);
    CHECK(hys_adapt_start(&adaptive, model, w, 0, &options, NULL, MOST_NUMBERS, turns,
                          MOST_TURNS) == HYS_NULL);
    CHECK(hys_adapt_start(&adaptive, model, w, 0, &options, memory, MOST_NUMBERS, NULL,
                          MOST_TURNS) == HYS_NULL);
    for (n = 0; n < 3; n++) {
        options = *defaults[0][n];
        CHECK(hys_adapt_start(&adaptive, model, n < 2 ? w : options.basis->coefficients, 0, &options,
                              memory, needed[0][n] - 1, turns, MOST_TURNS) == HYS_MEMORY_TOO_SMALL);
    }
    options = *defaults[0][0];
    CHECK(hys_adapt_start(&adaptive, model, w, 0, &options, memory, MOST_NUMBERS, turns,
                          MOST_TURNS - 1) == HYS_MEMORY_TOO_SMALL);
    CHECK(hys_adapt_start(&adaptive, model, w, nan, &options, memory, MOST_NUMBERS, turns,
                          MOST_TURNS) == HYS_INPUT_NOT_FINITE);
#define REFUSED(field, value)                 \
    do {                                      \
        options = *defaults[0][n];            \
        options.field = value;                \
        CHECK(start(w) == HYS_ADAPTATION);    \
    } while (0)
    n = 0;
    REFUSED(gain, 0);
    REFUSED(gain, 2);
    REFUSED(gain, nan);
    REFUSED(span, 0);
    REFUSED(span, 9);
    REFUSED(span, nan);
    REFUSED(learner, 0);
    REFUSED(learner, 4);
    REFUSED(offset_share, -1);
    REFUSED(offset_share, infinity);
    REFUSED(dead_zone, -1);
    REFUSED(dead_zone, nan);
    REFUSED(leakage, 2);
    REFUSED(leakage, nan);
    REFUSED(movement, -1);
    REFUSED(movement, infinity);
    REFUSED(trial, 0);
    REFUSED(gate, 1);
    REFUSED(gate, -8);
    REFUSED(gate, nan);
    REFUSED(gate, infinity);
    REFUSED(burst, 0);
    for (n = 1; n < 3; n++) {
        REFUSED(forgetting, 0);
        REFUSED(forgetting, 2);
        REFUSED(forgetting, nan);
        REFUSED(noise, 0);
        REFUSED(noise, infinity);
        REFUSED(spread, -1);
        REFUSED(spread, nan);
        REFUSED(correlation, -1);
        REFUSED(correlation, infinity);
    }
    n = 2;
    REFUSED(basis, NULL);
    REFUSED(correlation, 1);
    options = *defaults[0][0];
    memset(bad, 0, sizeof bad);
    bad[1] = -1;
    CHECK(start(bad) == HYS_NEGATIVE_WEIGHTS);
    bad[1] = nan;
    CHECK(start(bad) == HYS_WEIGHT_NOT_FINITE);
    CHECK(hys_adapt_step(&adaptive, 1, 1, &y, &outcome) == HYS_STATE_MISMATCH);

    CHECK(start(w) == HYS_OK);
    CHECK(hys_adapt_step(NULL, 1, 1, &y, &outcome) == HYS_NULL);
    CHECK(hys_adapt_step(&adaptive, 1, 1, NULL, &outcome) == HYS_NULL);
    CHECK(hys_adapt_step(&adaptive, 1, 1, &y, NULL) == HYS_NULL);
    CHECK(hys_adapt_step(&adaptive, nan, 1, &y, &outcome) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_adapt_step(&adaptive, 1, infinity, &y, &outcome) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_adapt_freeze(NULL, 1) == HYS_NULL && hys_adapt_keep(NULL) == HYS_NULL);
    CHECK(hys_adapt_roll_back(NULL) == HYS_NULL && hys_adapt_realign(NULL) == HYS_NULL &&
          hys_rebase(NULL) == HYS_NULL);
    CHECK(y == 42 && outcome == 42);
    CHECK(hys_adapt_step(&adaptive, model->max, 1, &y, &outcome) == HYS_OK &&
          outcome == HYS_WAITING);
    return 0;
}

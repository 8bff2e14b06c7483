/* What must be refused, and leave everything as it was. The second of the models has no inverse. */
#include <string.h>

#include "check.h"
#include "models.h"

int main(void)
{
    const hys_model *model = models[0], *forward = models[1];
    static hys_turn turns[MOST_TURNS], others[MOST_TURNS];
    hys_real points[MOST_TURNS];
    size_t needed = 4 * model->levels + 8, count = 99;
    hys_real zero = 0, nan = zero / zero, infinity = 1 / zero, y = 42, x = 42, there;
    hys_state state, other, before;
    int status = 42;

    memset(&state, 0, sizeof state);
    CHECK(hys_step(&state, 1, &y) == HYS_STATE_MISMATCH);
    CHECK(hys_reset_off(&state) == HYS_STATE_MISMATCH);
    CHECK(hys_reset_on(&state) == HYS_STATE_MISMATCH);
    CHECK(hys_inverse_step(&state, 1, 0, 0, &x, &status) == HYS_STATE_MISMATCH);
    CHECK(hys_save(&state, points, MOST_TURNS, &count, &x) == HYS_STATE_MISMATCH);
    CHECK(hys_restore(&state, points, 0, 1) == HYS_STATE_MISMATCH);

    CHECK(hys_start(NULL, &state, turns, needed) == HYS_NULL);
    CHECK(hys_start(model, NULL, turns, needed) == HYS_NULL);
    CHECK(hys_start(model, &state, NULL, needed) == HYS_NULL);
    CHECK(hys_start(model, &state, turns, 0) == HYS_MEMORY_TOO_SMALL);
    CHECK(hys_start(model, &state, turns, needed - 1) == HYS_MEMORY_TOO_SMALL);
    CHECK(state.model == NULL);
    CHECK(hys_start(model, &state, turns, needed) == HYS_OK);
    CHECK(hys_start(forward, &other, others, MOST_TURNS) == HYS_OK);

    /* A history, so that there is something to keep. */
    CHECK(hys_step(&state, model->max, &y) == HYS_OK);
    CHECK(hys_step(&state, model->min, &y) == HYS_OK);
    CHECK(hys_step(&state, (model->max + model->min) / 2, &y) == HYS_OK);
    there = y;
    before = state;

    CHECK(hys_step(NULL, 1, &y) == HYS_NULL);
    CHECK(hys_step(&state, 1, NULL) == HYS_NULL);
    CHECK(hys_step(&state, nan, &y) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_step(&state, infinity, &y) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_step(&state, -infinity, &y) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_reset_off(NULL) == HYS_NULL);
    CHECK(hys_reset_on(NULL) == HYS_NULL);

    CHECK(hys_inverse_step(NULL, 1, 0, 0, &x, &status) == HYS_NULL);
    CHECK(hys_inverse_step(&state, 1, 0, 0, NULL, &status) == HYS_NULL);
    CHECK(hys_inverse_step(&state, 1, 0, 0, &x, NULL) == HYS_NULL);
    CHECK(hys_inverse_step(&state, 1, 7, 0, &x, &status) == HYS_VALUE);
    CHECK(hys_inverse_step(&state, 1, -2147483647 - 1, 0, &x, &status) == HYS_VALUE);
    CHECK(hys_inverse_step(&state, nan, 0, 0, &x, &status) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_inverse_step(&state, infinity, 1, 0, &x, &status) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_inverse_step(&state, -infinity, -1, 0, &x, &status) == HYS_INPUT_NOT_FINITE);
    CHECK(hys_inverse_step(&other, 1, 0, 0, &x, &status) == HYS_NEGATIVE_WEIGHTS);

    CHECK(hys_save(NULL, points, MOST_TURNS, &count, &x) == HYS_NULL);
    CHECK(hys_save(&state, points, MOST_TURNS, NULL, &x) == HYS_NULL);
    CHECK(hys_save(&state, points, MOST_TURNS, &count, NULL) == HYS_NULL);
    CHECK(hys_save(&state, NULL, MOST_TURNS, &count, &x) == HYS_NULL);
    count = 99;
    CHECK(hys_save(&state, NULL, 0, &count, &x) == HYS_MEMORY_TOO_SMALL && count == 3);
    CHECK(hys_save(&state, points, 2, &count, &x) == HYS_MEMORY_TOO_SMALL && count == 3);
    CHECK(x == 42 && status == 42 && y == there);

    CHECK(hys_restore(NULL, points, 0, 1) == HYS_NULL);
    CHECK(hys_restore(&state, NULL, 1, 1) == HYS_NULL);
    points[0] = 1;
    CHECK(hys_restore(&state, points, 1, nan) == HYS_INPUT_NOT_FINITE);
    points[0] = nan;
    CHECK(hys_restore(&state, points, 1, 1) == HYS_TURNING_POINTS);
    points[0] = infinity;
    CHECK(hys_restore(&state, points, 1, 1) == HYS_TURNING_POINTS);
    points[0] = -1;
    CHECK(hys_restore(&state, points, 1, 1) == HYS_TURNING_POINTS);
    points[0] = model->top + 1;
    CHECK(hys_restore(&state, points, 1, 1) == HYS_TURNING_POINTS);
    points[0] = 1;
    points[1] = 2;
    CHECK(hys_restore(&state, points, 2, 1) == HYS_TURNING_POINTS);
    CHECK(memcmp(&state.top, &before.top, sizeof state.top) == 0 && state.x == before.x &&
          state.y == before.y && state.end == before.end && state.input == before.input);

    /* Nothing of that did any harm. */
    CHECK(hys_step(&state, (model->max + model->min) / 2, &y) == HYS_OK && y == there);
    CHECK(hys_inverse_step(&state, there, HYS_HOLD, nan, &x, &status) == HYS_OK &&
          status == HYS_REACHED);
    CHECK(hys_inverse_step(&state, there, HYS_HOLD, infinity, &x, &status) == HYS_OK);
    CHECK(hys_restore(&state, NULL, 0, model->bottom) == HYS_OK);
    CHECK(hys_step(&state, model->bottom, &y) == HYS_OK &&
          y == (model->kind == 0 ? model->offset : y));
    CHECK(hys_step(&other, forward->max, &y) == HYS_OK);
    return 0;
}

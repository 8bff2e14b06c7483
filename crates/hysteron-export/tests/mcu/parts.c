/* What hys_controller_step_after refuses, and that nothing is changed then. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "wire.h"

static hys_turn turns[2][WIRE_TURNS];
static hys_actuator_state wanted, followed;
static hys_real under_way[WIRE_LATE + 1];
static hys_controller controller;

static int after(hys_real dt)
{
    hys_action action;
    return hys_controller_step_after(&controller, dt, 1, 1, HYS_HOLD, 1, &action);
}

int main(void)
{
    hys_actuator other = wire;
    hys_control fixed = wire_control;
    hys_controller before;
    const hys_real wrong[] = {0, -1, NAN, INFINITY};
    size_t n;
    CHECK(hys_actuator_start(&wire, &wanted, turns[0], WIRE_TURNS) == HYS_OK);
    CHECK(hys_actuator_start(&wire, &followed, turns[1], WIRE_TURNS) == HYS_OK);
    CHECK(hys_controller_start(&controller, &wire_control, &wanted.operators, &followed.operators,
                               under_way, WIRE_LATE + 1) == HYS_OK);
    CHECK(after(wire_control.dt) == HYS_OK);
    before = controller;
    for (n = 0; n < sizeof wrong / sizeof wrong[0]; n++) {
        CHECK(after(wrong[n]) == HYS_VALUE);
    }
    /* States of another model. */
    followed.actuator = &other;
    CHECK(after(1) == HYS_STATE_MISMATCH);
    followed.actuator = &wire;
    /* A loop that was exported without measured time, beside others that have it. */
    fixed.has = 0;
    fixed.clock = NULL;
    controller.control = &fixed;
    CHECK(after(1) == HYS_VALUE);
    controller.control = &wire_control;
    CHECK(memcmp(&before, &controller, sizeof before) == 0);
    CHECK(hys_controller_step_after(NULL, 1, 1, 1, HYS_HOLD, 1, NULL) == HYS_NULL);
    /* Twice the time leaves the square. */
    CHECK(after(wire_control.dt) == HYS_OK);
    CHECK(wire.heating == other.heating);
    CHECK(after(2 * wire_control.dt) == HYS_OK);
    CHECK(fabs((double)(wire.heating - other.heating * other.heating)) < 1e-6);
    return 0;
}

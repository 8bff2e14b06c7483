/* A model with stages in a control loop. */
#include "hysteron_mcu_control.h"
#include "hysteron_mcu_stages.h"

/* The operators are the first member. */
static hys_actuator_state *around(hys_state *state)
{
    return (hys_actuator_state *)state;
}

static int step(hys_state *state, hys_real drive, hys_real *output)
{
    return hys_actuator_step(around(state), drive, (hys_real)0, output);
}

static int invert(hys_state *state, hys_real target, int heading, hys_real tolerance,
                  hys_real *drive, int *status)
{
    return hys_actuator_inverse_step(around(state), target, heading, tolerance, (hys_real)0, drive,
                                     status);
}

static void copy(hys_state *to, const hys_state *from)
{
    hys_state operators;
    hys_plain_in_loop.copy(to, from);
    operators = *to;
    *around(to) = *(const hys_actuator_state *)from;
    *to = operators;
}

const hys_in_loop hys_staged_in_loop = {step, invert, copy};

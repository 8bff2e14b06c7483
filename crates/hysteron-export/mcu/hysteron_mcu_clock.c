/* The factors of a measured time. */
#include "hysteron_mcu_clock.h"
#include "hysteron_mcu_decay.h"

static hys_real factor(hys_real time, hys_real dt)
{
    return time > ZERO ? hys_decay(dt / time) : ZERO;
}

int hys_clock_pass(const hys_clock *clock, hys_state *wanted, hys_state *followed, hys_real dt)
{
    /* Clock and operators are the first members. */
    const hys_times *self = (const hys_times *)clock;
    const hys_actuator_state *both[2];
    size_t k;
    both[0] = (const hys_actuator_state *)wanted;
    both[1] = (const hys_actuator_state *)(followed != NULL ? followed : wanted);
    if (both[0]->actuator != self->model || both[1]->actuator != self->model) {
        return HYS_STATE_MISMATCH;
    }
    self->model->heating = factor(self->heating, dt);
    self->model->cooling = factor(self->cooling, dt);
    for (k = 0u; k < HYS_BEHIND_FACTORS; k++) {
        self->model->factors[k] = factor(self->behind[k], dt);
    }
    return HYS_OK;
}

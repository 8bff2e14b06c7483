/* The measured time of a model with stages in a control loop.
 *
 * hys_controller_step_after computes the factors of its `dt` and writes them into the model, which
 * is in RAM for that. So all states of the model step by the time of the last call, and two loops
 * around one model have to run in one thread. Not for applications. */
#ifndef HYSTERON_MCU_CLOCK_H
#define HYSTERON_MCU_CLOCK_H

#include "hysteron_mcu_control.h"
#include "hysteron_mcu_stages.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The time constants of a model, in seconds; 0 where a factor is not there. */
typedef struct {
    hys_clock clock;             /* what the controller knows of it */
    hys_actuator *model;
    hys_real heating, cooling, behind[HYS_BEHIND_FACTORS];
} hys_times;

/* Sets the factors for `dt`. Error: HYS_STATE_MISMATCH for states of another model. */
int hys_clock_pass(const hys_clock *self, hys_state *wanted, hys_state *followed, hys_real dt);

#ifdef __cplusplus
}
#endif

#endif

/* A learner in the shadow of the fixed model that it began from, in a control loop: its inverse is
 * used only while its predictions have been the better ones, so that a learner that goes wrong does
 * no harm.
 *
 *     hys_controller_step(&controller, reference, ahead, HYS_HOLD, reading, &action);
 *     hys_shadow_step(&shadow, reading, &action);      after it, at each sample
 *
 * Both models predict each reading from the drive that it answers. The mean of the squares of some
 * hundred errors decides: the model that is not used has to err less by a fifth to be used. The
 * other one then takes over without a bump.
 *
 * Nothing is learned from a drive at a limit, nor from a reading that the controller does not
 * believe; the learner itself leaves out what stands still and what its gate refuses.
 *
 * Worst case of hys_shadow_step: one hys_adapt_step, and one hys_rebase of the inverse's state. */
#ifndef HYSTERON_MCU_SHADOW_H
#define HYSTERON_MCU_SHADOW_H

#include "hysteron_mcu_adapt.h"
#include "hysteron_mcu_control.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is remembered of both models. An application may read `learner`, which is 1 while that is
 * used. */
typedef struct {
    hys_controller *controller;
    hys_adaptive *adaptive;
    const hys_model *fixed;
    hys_real fixed_error, learned_error; /* the recent mean squares */
    unsigned char samples, learner;
} hys_shadow;

/* Starts with the fixed model. `controller` and `adaptive` are started, of one model without stages;
 * the controller needs its state that follows the drive. Where the states were restored, that of
 * `adaptive` was, too. All of them have to stay where they are. Errors: HYS_NULL,
 * HYS_STATE_MISMATCH. */
int hys_shadow_start(hys_shadow *self, hys_controller *controller, hys_adaptive *adaptive);

/* Learns from `reading`, that of the last hys_controller_step, whose answer `action` is. Errors: those
 * of hys_adapt_step. */
int hys_shadow_step(hys_shadow *self, hys_real reading, const hys_action *action);

#ifdef __cplusplus
}
#endif

#endif

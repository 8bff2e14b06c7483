/* Chooses between a learner and the fixed model that it began from: trust.rs of the library. */
#include "hysteron_mcu_shadow.h"
#include "hysteron_mcu_internal.h"

#define KEPT ((hys_real)0.99)   /* what a sample counts relative to the next one */
#define BETTER ((hys_real)0.8)  /* the other one has to err less by this factor, in the mean square */
#define FIRST 30u               /* samples before the learner can be used */

/* A mean square error with one more error. */
static hys_real mean(hys_real before, hys_real error)
{
    return KEPT * before + (ONE - KEPT) * error * error;
}

/* Whether the learner is to be used after these errors. A sum that is not finite is no reason to. */
static int choose(hys_shadow *self, hys_real fixed, hys_real learned)
{
    self->fixed_error = mean(self->fixed_error, fixed);
    self->learned_error = mean(self->learned_error, learned);
    self->samples = (unsigned char)(self->samples + (self->samples < FIRST));
    if (self->learner) {
        return self->fixed_error >= BETTER * self->learned_error;
    }
    return self->samples >= FIRST && self->learned_error < BETTER * self->fixed_error;
}

int hys_shadow_start(hys_shadow *self, hys_controller *controller, hys_adaptive *adaptive)
{
    if (self == NULL || controller == NULL || adaptive == NULL || controller->followed == NULL) {
        return HYS_NULL;
    }
    if (controller->control->model != &hys_plain_in_loop || hys_adapt_parameters(adaptive) == NULL
        || controller->followed->model->levels != adaptive->model.levels) {
        return HYS_STATE_MISMATCH;
    }
    self->controller = controller;
    self->adaptive = adaptive;
    self->fixed = controller->followed->model;
    self->fixed_error = self->learned_error = ZERO;
    self->samples = self->learner = 0u;
    return HYS_OK;
}

int hys_shadow_step(hys_shadow *self, hys_real reading, const hys_action *action)
{
    hys_controller *controller;
    hys_real acting, expected;
    int outcome, code, learner;
    if (self == NULL || action == NULL || self->controller == NULL) {
        return HYS_NULL;
    }
    controller = self->controller;
    acting = controller->acting;
    if (!is_finite(acting)) {
        return HYS_OK; /* no reading answers a drive yet */
    }
    if (acting <= controller->control->drive_min || acting >= controller->control->drive_max
        || (action->status & (HYS_NO_READING | HYS_STUCK | HYS_SAFE)) != 0u || !is_finite(reading)) {
        return hys_step(&self->adaptive->state, acting, &expected);
    }
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    if ((controller->control->has & HYS_HAS_FILTER) != 0u) {
        reading = controller->seen; /* the drives are as late */
    }
#endif
    code = hys_adapt_step(self->adaptive, acting, reading, &expected, &outcome);
    if (code != HYS_OK) {
        return code;
    }
    learner = choose(self, reading - action->prediction, reading - expected);
    if (learner != self->learner) {
        self->learner = (unsigned char)learner;
        controller->wanted->model = learner ? &self->adaptive->model : self->fixed;
        (void)hys_rebase(controller->wanted);
        return hys_controller_go_on_from(controller, controller->drive);
    }
    return learner ? hys_rebase(controller->wanted) : HYS_OK;
}

/* A controller: from manual to automatic, a lost sensor, and the safe state. */
#include "check.h"
#include <math.h>

static const double WEIGHTS[6] = {1.0, 0.5, 1.0, 0.25, 0.5, 1.0};

/* One sample in front of an actuator. */
static double sample(uint64_t controller, double reference, double reading,
                     struct HysteronAction *action) {
    OK(hysteron_controller_step(controller, NAN, reference, HYSTERON_HOLD, &reference, 1, reading,
                                NAN, action));
    REQUIRE(action->drive >= 0.0 && action->drive <= 80.0);
    return action->drive;
}

void control(void) {
    struct HysteronControl settings;
    struct HysteronControllerInfo info;
    struct HysteronAction action;
    uint64_t model, plant, learner, controller, learned;
    double output, drive = 30.0, last;
    int n;
    OK(hysteron_model_new(HYSTERON_MKP, 20.0, 80.0, 3, WEIGHTS, 6, 10.0, 1, &model));
    OK(hysteron_state_new(model, &plant));
    OK(hysteron_adaptive_new(model, NULL, &learner));
    OK(hysteron_control_default(model, 0.1, 0.0, 80.0, &settings));
    settings.gain = 2.0;
    settings.integral_s = 0.5;
    settings.slew = 200.0;
    settings.lost_s = 0.5;
    OK(hysteron_controller_new(&settings, model, learner, &controller));
    OK(hysteron_controller_info(controller, &info));
    REQUIRE(info.due == 1 && info.rest_drive == 0.0 && isnan(info.stuck_s));

    /* By hand, then without a bump. */
    for (n = 0; n < 10; n++) {
        OK(hysteron_step(plant, drive, &output, NULL));
        OK(hysteron_controller_command(controller, NAN, 30.0, output, NAN, &action));
        drive = action.drive;
        REQUIRE(drive == 30.0);
    }
    OK(hysteron_controller_go_on_from(controller, drive));
    for (n = 0; n < 100; n++) {
        last = drive;
        OK(hysteron_step(plant, drive, &output, NULL));
        drive = sample(controller, 12.0, output + 0.001 * (n % 3), &action);
        REQUIRE(fabs(drive - last) <= 20.0 + 1e-9);
    }
    REQUIRE(fabs(output - 12.0) < 0.05);

    /* The cable breaks: the loop holds, then gives up, until it is told to go on. */
    for (n = 0; n < 4; n++) {
        sample(controller, 12.0, NAN, &action);
        REQUIRE(action.status & HYSTERON_NO_READING && !(action.status & HYSTERON_SAFE));
    }
    REQUIRE(sample(controller, 12.0, NAN, &action) == 0.0 && action.status & HYSTERON_SAFE);
    REQUIRE(sample(controller, 12.0, 12.0, &action) == 0.0 && action.status & HYSTERON_SAFE);
    OK(hysteron_controller_go_on_from(controller, 0.0));
    sample(controller, 12.0, 12.5, &action);
    REQUIRE(!(action.status & HYSTERON_SAFE));

    OK(hysteron_controller_model(controller, &learned));
    OK(hysteron_model_free(learned));
    OK(hysteron_controller_free(controller));
    OK(hysteron_adaptive_free(learner));
    OK(hysteron_state_free(plant));
    OK(hysteron_model_free(model));
}

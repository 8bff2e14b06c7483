/* A loop on a plant that is the model, GAIN times as strong: shadow GAIN MODE NOISE. MODE is f for the
 * fixed model, s for a learner in its shadow, and l for the learner alone. With a NOISE of more than
 * one the learner's guards are off, so that it learns what is not there.
 *
 * Prints for each sample what is wanted, the output without noise, the reading, what the fixed model
 * predicted, and the shadow's two mean squares and choice, with all digits. */
#include "wire.h"
#include <stdio.h>
#include <stdlib.h>

static hys_turn turns[4][WIRE_TURNS];
static hys_state plant, wanted, followed;
static hys_controller controller;
static hys_real under_way[WIRE_LATE + 1], memory[WIRE_INCREMENTS_NUMBERS];
static hys_adaptive adaptive;
static hys_shadow shadow;

static int start(const hys_adapt_options *options)
{
    return hys_start(&wire, &plant, turns[0], WIRE_TURNS) | hys_start(&wire, &wanted, turns[1], WIRE_TURNS)
        | hys_start(&wire, &followed, turns[2], WIRE_TURNS)
        | hys_adapt_start(&adaptive, &wire, wire_weights, wire.offset, options, memory, WIRE_INCREMENTS_NUMBERS,
                          turns[3], WIRE_TURNS);
}

/* What a shadow refuses, and then it begins. */
static int begin(void)
{
    hys_control staged = wire_control;
    hys_state *const states[2] = {NULL, &followed};
    int n;
    staged.model = NULL;
    for (n = 0; n < 3; n++) {
        int code = hys_controller_start(&controller, n == 1 ? &staged : &wire_control, &wanted, states[n > 0],
                                        under_way, WIRE_LATE + 1);
        int wants = n == 0 ? HYS_NULL : n == 1 ? HYS_STATE_MISMATCH : HYS_OK;
        if (code != HYS_OK || hys_shadow_start(&shadow, &controller, &adaptive) != wants)
            return 1;
    }
    return hys_shadow_start(NULL, &controller, &adaptive) != HYS_NULL || hys_shadow_step(&shadow, 1, NULL) != HYS_NULL
        || hys_controller_go_on_from(&controller, 0) != HYS_OK;
}

/* What is wanted at a sample: up and down, in turn by all of the way, three fifths and a fifth of it. */
static hys_real reference_at(int n, hys_real gain)
{
    hys_real share = (hys_real)(n % 400 < 200 ? n % 200 : 200 - n % 200) / 200;
    return 1 + gain * (2 + 4 * share * (1 - (hys_real)0.4 * (hys_real)(n / 400 % 3)));
}

int main(int count, char **args)
{
    hys_adapt_options options = wire_increments;
    hys_action action = {0, 0, 0};
    hys_real gain, noise;
    uint32_t seed = 1;
    char mode;
    int n;
    if (count < 4)
        return 1;
    gain = (hys_real)atof(args[1]);
    mode = args[2][0];
    noise = (hys_real)atof(args[3]);
    if (noise > 1) {
        options.gain = (hys_real)1.9;
        options.gate = options.dead_zone = options.leakage = 0;
    }
    if (start(&options) != HYS_OK || begin() != 0)
        return 2;
    for (n = 0; n < 6000; n++) {
        hys_real reference = reference_at(n, gain), ahead = reference_at(n + 1, gain), output, reading, expected;
        int outcome, code = HYS_OK;
        seed = seed * 1664525u + 1013904223u;
        (void)hys_step(&plant, action.drive, &output);
        output = 1 + gain * (output - 1);
        reading = output + noise * ((hys_real)(seed >> 8) / 16777216 - (hys_real)0.5);
        if (hys_controller_step(&controller, reference, ahead, HYS_HOLD, reading, &action) != HYS_OK)
            return 3;
        if (mode == 's')
            code = hys_shadow_step(&shadow, reading, &action);
        if (mode == 'l') {
            wanted.model = &adaptive.model; /* the first step has copied another one */
            code = hys_adapt_step(&adaptive, controller.acting, reading, &expected, &outcome) | hys_rebase(&wanted);
        }
        if (code != HYS_OK)
            return 4;
        printf("%.9g %.9g %.9g %.9g %.9g %.9g %d\n", (double)reference, (double)output, (double)reading,
               (double)action.prediction, (double)shadow.fixed_error, (double)shadow.learned_error,
               shadow.learner == (wanted.model == &adaptive.model) || mode == 'l' ? shadow.learner : 9);
    }
    return 0;
}

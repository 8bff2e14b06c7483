/* A loop whose model learns, on a chip and on the host: inverse, PID and, with LEARNS, the learner, at
 * a fixed rate on a plant that is the model, GAIN times as strong, with noise of 0.01. Prints, as
 * cost.c does, a hash of all drives; the mean square error of the last quarter, in 1e-9 of its unit;
 * and the most that one sample took. */
#include MODEL_HEADER
#include "bits.h"
#include "port.h"

enum { COUNT = 8000 };
static hys_turn turns[4][TURNS];
static hys_state plant, wanted, followed;
static hys_controller controller;
static hys_real under_way[LATE + 1];
static hys_adaptive adaptive;
static hys_real memory[NUMBERS];
static uint32_t most;
static hys_real sum;

/* One sample of the loop, as a program on a chip has it. The reading answers the last drive. */
static void sample(hys_real reference, hys_real ahead, hys_real reading, hys_action *action) {
#ifdef LEARNS
    hys_real expected;
    int outcome;
    (void)hys_adapt_step(&adaptive, action->drive, reading, &expected, &outcome);
    (void)hys_rebase(&wanted);
    (void)hys_rebase(&followed);
#endif
    (void)hys_controller_step(&controller, reference, ahead, HYS_HOLD, reading, action);
}

static void all(void) {
    /* Two slow waves as sums of their last two values: no library is needed. */
    hys_real wave = 1, before = (hys_real)0.99988752, slow = 0, rise = (hys_real)0.00235, next, reading;
    hys_action action = {0, 0, 0};
    const hys_model *model = &MODEL;
    int n;
    (void)hys_start(&MODEL, &plant, turns[0], TURNS);
    (void)hys_adapt_start(&adaptive, &MODEL, PARAMETERS, MODEL.offset, &OPTIONS, memory, NUMBERS, turns[1], TURNS);
#ifdef LEARNS
    model = &adaptive.model;
#endif
    (void)hys_start(model, &wanted, turns[2], TURNS);
    (void)hys_start(model, &followed, turns[3], TURNS);
    (void)hys_controller_start(&controller, &CONTROL, &wanted, &followed, under_way, LATE + 1);
    (void)hys_controller_go_on_from(&controller, 0);
    next = 1 + (hys_real)GAIN * (2 - (hys_real)1.2 * wave);
    for (n = 0; n < COUNT; n++) {
        hys_real reference = next, old = wave, error;
        uint32_t from, taken;
        wave = (hys_real)1.99977501 * wave - before;
        before = old;
        rise -= (hys_real)5.5225e-06 * slow;
        slow += rise;
        next = 1 + (hys_real)GAIN * (2 - (hys_real)1.2 * wave * (1 + (hys_real)0.3 * slow));
        (void)hys_step(&plant, action.drive, &reading);
        reading = 1 + (hys_real)GAIN * (reading - 1) + (hys_real)0.01 * (chance() - (hys_real)0.5);
        error = reference - reading;
        if (4 * n >= 3 * COUNT)
            sum += error * error;
        from = port_now();
        sample(reference, next, reading, &action);
        taken = port_taken(from);
        if (taken > most)
            most = taken;
        take(action.drive);
    }
}

int main(void) {
    port_start();
    all();
    port_print(hash);
    port_print((uint32_t)(sum * (hys_real)(4e9 / COUNT)));
    port_print(most);
    port_end();
    return 0;
}

/* Steps, inverse steps and a control loop of an exported model, on a chip and on the host: a hash of
 * every bit of the results, and what one call took at most. Prints five lines: hash, step, inverse
 * step, sample of the loop (in units of port.h), and bytes of stack. */
#include MODEL_HEADER
#include "bits.h"
#include "port.h"

#ifdef STAGED
#define STATE hys_actuator_state
#define START hys_actuator_start
#define OPERATORS(state) (&(state).operators)
#define STEP(x, y) hys_actuator_step(&states[0], x, 0, y)
#define INVERT(y, x, found) hys_actuator_inverse_step(&states[0], y, HYS_HOLD, 0, 0, x, found)
#else
#define STATE hys_state
#define START hys_start
#define OPERATORS(state) (&(state))
#define STEP(x, y) hys_step(&states[0], x, y)
#define INVERT(y, x, found) hys_inverse_step(&states[0], y, HYS_HOLD, 0, x, found)
#endif

/* Two where the board has room for a state that follows the drive. */
static hys_turn turns[STATES][TURNS];
static STATE states[STATES];
static hys_controller controller;
static hys_real under_way[LATE + 1];
static uint32_t most[3];

enum { FORWARD, BACK, LOOP };

static void start(void) {
    uint8_t n;
    for (n = 0; n < STATES; n++)
        (void)START(&MODEL, &states[n], turns[n], TURNS);
}

#define TIMED(what, call) \
    do { \
        uint32_t before = port_now(), taken; \
        call; \
        taken = port_taken(before); \
        if (taken > most[what]) \
            most[what] = taken; \
    } while (0)

static hys_real forward(hys_real share) {
    hys_real y = 0;
    TIMED(FORWARD, (void)STEP(LOW + (HIGH - LOW) * share, &y));
    take(y);
    return y;
}

static void back(hys_real share) {
    hys_real x = 0;
    int found = 0;
    hys_real y = OFF + (ON - OFF) * share;
    TIMED(BACK, (void)INVERT(y, &x, &found));
    take(x);
    take((hys_real)found);
}

static void loop(hys_real share) {
    hys_real wanted = OFF + (ON - OFF) * share;
    hys_real reading = wanted + (ON - OFF) * (hys_real)0.1 * chance();
    hys_action action = {0, 0, 0};
    TIMED(LOOP, (void)hys_controller_step(&controller, wanted, wanted, HYS_HOLD, reading, &action));
    take(action.drive);
}

/* Turns that come closer by half a cell each, so that all of them are kept, and then one jump over
 * all: the worst case of a model without stages. */
static void staircase(void (*call)(hys_real)) {
    int n;
    for (n = 0; n < 2 * LEVELS; n++) {
        hys_real off = (hys_real)(n + 1) / (4 * LEVELS + 4);
        call(off);
        call(1 - off);
    }
    call(1);
    call(0);
}

static void forward_alone(hys_real share) { (void)forward(share); }

static void all(int count) {
    int n, k;
    start();
    for (n = 0; n < count; n++) {
        for (k = 0; k <= (n & 3); k++)
            (void)forward(chance());
        back(chance());
    }
    staircase(forward_alone);
    staircase(back);
    start();
    (void)hys_controller_start(&controller, &CONTROL, OPERATORS(states[0]),
                               STATES > 1 ? OPERATORS(states[STATES - 1]) : NULL, under_way, LATE + 1);
    (void)hys_controller_go_on_from(&controller, LOW);
    for (n = 0; n < count; n++)
        loop(chance());
    staircase(loop);
}

int main(void) {
    port_start();
    port_paint();
    all(1500);
    port_print(hash);
    port_print(most[FORWARD]);
    port_print(most[BACK]);
    port_print(most[LOOP]);
    port_print(port_stack());
    port_end();
    return 0;
}

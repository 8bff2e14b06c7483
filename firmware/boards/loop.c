/* The image whose size is measured: a control loop (WHAT 1), or an endless loop over nothing. */
#include MODEL_HEADER

#ifdef STAGED
#define STATE hys_actuator_state
#define START hys_actuator_start
#define OPERATORS(state) (&(state).operators)
#else
#define STATE hys_state
#define START hys_start
#define OPERATORS(state) (&(state))
#endif

volatile hys_real reference, reading, drive;

int main(void) {
#if WHAT
    static hys_turn turns[STATES][TURNS];
    static STATE states[STATES];
    static hys_real under_way[LATE + 1];
    static hys_controller controller;
    int n;
    for (n = 0; n < STATES; n++)
        START(&MODEL, &states[n], turns[n], TURNS);
    hys_controller_start(&controller, &CONTROL, OPERATORS(states[0]), OPERATORS(states[STATES - 1]),
                         under_way, LATE + 1);
#endif
    for (;;) {
#if WHAT
        hys_action action;
        hys_controller_step(&controller, reference, reference, HYS_HOLD, reading, &action);
        drive = action.drive;
#endif
    }
}

/* A model that learns with its inverse beside it, on a chip and on the host: prints, as cost.c does, a
 * hash, what one sample of the learner took at most, what one inverse step took, and bytes of memory
 * for both. */
#include MODEL_HEADER
#include "bits.h"
#include "port.h"

static hys_turn turns[2][TURNS];
static hys_state wanted, plant;
static hys_turn plant_turns[TURNS];
static hys_adaptive adaptive;
static hys_real memory[NUMBERS];
static uint32_t most[2];

#define TIMED(what, call) \
    do { \
        uint32_t before = port_now(), taken; \
        call; \
        taken = port_taken(before); \
        if (taken > most[what]) \
            most[what] = taken; \
    } while (0)

static int all(void) {
    hys_real input = 0, output = 0, expected = 0, found = 0;
    int n, outcome = 0, status = 0;
    if (hys_start(&MODEL, &plant, plant_turns, TURNS) != HYS_OK ||
        hys_adapt_start(&adaptive, &MODEL, PARAMETERS, MODEL.offset, &OPTIONS, memory, NUMBERS, turns[0], TURNS) !=
            HYS_OK ||
        hys_start(&adaptive.model, &wanted, turns[1], TURNS) != HYS_OK)
        return 1;
    for (n = 0; n < 1000; n++) {
        input += (chance() - (hys_real)0.5) * (hys_real)0.2;
        input = input < 0 ? 0 : input > 1 ? 1 : input;
        (void)hys_step(&plant, input, &output);
        output = (hys_real)1.2 * output + (hys_real)0.02 * chance();
        TIMED(0, (void)hys_adapt_step(&adaptive, input, output, &expected, &outcome));
        take(expected);
        output = 1 + 8 * chance();
        TIMED(1, (void)hys_rebase(&wanted); (void)hys_inverse_step(&wanted, output, HYS_HOLD, 0, &found, &status));
        take(found);
    }
    return 0;
}

int main(void) {
    port_start();
    if (all() != 0)
        hash = 0;
    port_print(hash);
    port_print(most[0]);
    port_print(most[1]);
    port_print(sizeof adaptive + sizeof memory + sizeof turns + sizeof wanted);
    port_end();
    return 0;
}

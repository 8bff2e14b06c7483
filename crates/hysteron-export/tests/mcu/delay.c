/* Inputs of a model with a dead time, from standard input. Prints outputs as bit patterns. */
#include <stdio.h>

#include "late.h"
#include "words.h"

static hys_turn turns[LATE_TURNS];
static hys_real under_way[LATE_LATE];
static hys_delay delay;
#ifdef STAGED
static hys_actuator_state state;
#define START hys_actuator_start
#define STEP(input, output) hys_actuator_step(&state, input, 0, output)
#else
static hys_state state;
#define START hys_start
#define STEP(input, output) hys_step(&state, input, output)
#endif

int main(void)
{
    static char line[64];
    if (START(&late, &state, turns, LATE_TURNS) != HYS_OK
        || hys_delay_start(&delay, under_way, LATE_LATE) != HYS_OK
        || hys_delay_start(&delay, NULL, 1) != HYS_NULL
        || hys_delay_start(NULL, under_way, 1) != HYS_NULL) {
        return 1;
    }
    while (fgets(line, sizeof line, stdin) != NULL) {
        hys_real acting = 0, output = 0;
        hys_real input = number(strtok(line, " \n"));
        int code = hys_delay_pass(&delay, input, &acting);
        if (code == HYS_OK) {
            code = STEP(acting, &output);
        }
        printf("%d %" PRIx64 "\n", code, bits(output));
    }
    return 0;
}

/* Runs commands from standard input on the loops that models.h names. Prints results as bit
 * patterns. */
#include <stdio.h>

#include "hysteron_mcu_control.h"
#include "hysteron_mcu_stages.h"

typedef struct {
    const hys_model *plain;
    const hys_actuator *staged;
    const hys_control *control;
    const hys_real *start;
    size_t starts;
    const hys_real *start_input;
} loop;

#include "models.h"
#include "words.h"

static hys_turn turns[2][MOST_TURNS];
static hys_real under_way[MOST_LATE + 1];
static union {
    hys_state plain;
    hys_actuator_state staged;
} states[2];
static hys_controller controller;

static int begin(const loop *self, size_t n)
{
    int code;
    memset(turns[n], 0x55, sizeof turns[n]);
    memset(&states[n], 0x55, sizeof states[n]);
    if (self->staged != NULL) {
        return hys_actuator_start(self->staged, &states[n].staged, turns[n], MOST_TURNS);
    }
    code = hys_start(self->plain, &states[n].plain, turns[n], MOST_TURNS);
    if (code == HYS_OK && self->start != NULL) {
        code = hys_restore(&states[n].plain, self->start, self->starts, *self->start_input);
    }
    return code;
}

/* Zero has no sign, and NaN no bits. */
static void print(hys_real x)
{
    if (x != x) {
        printf(" nan");
    } else {
        printf(" %" PRIx64, bits(x == 0 ? (hys_real)0 : x));
    }
}

/* A sample, after a measured time where there is one. */
static int stepped(hys_real dt, hys_real reference, hys_real ahead, int heading, hys_real reading,
                   hys_action *action)
{
#if (HYS_LOOP & HYS_HAS_TIME) != 0u
    if (dt == dt) {
        return hys_controller_step_after(&controller, dt, reference, ahead, heading, reading, action);
    }
#else
    (void)dt;
#endif
    return hys_controller_step(&controller, reference, ahead, heading, reading, action);
}

int main(void)
{
    static char line[1 << 12];
    while (fgets(line, sizeof line, stdin) != NULL) {
        const char *command = strtok(line, " \n");
        hys_action action = {0, 0, 0};
        const loop *self;
        hys_real reference, ahead, reading, dt;
        int code, heading;
        switch (command == NULL ? ' ' : command[0]) {
        case 'm':
            self = &loops[atoi(word())];
            heading = atoi(word()); /* whether a second state follows */
            memset(&controller, 0x55, sizeof controller);
            code = begin(self, 0) != 0 ? -1 : begin(self, 1);
            if (code == HYS_OK) {
                code = hys_controller_start(&controller, self->control, &states[0].plain,
                                            heading ? &states[1].plain : NULL, under_way,
                                            MOST_LATE + 1);
            }
            printf("m %d\n", code);
            break;
        case 'g':
            printf("g %d\n", hys_controller_go_on_from(&controller, number(word())));
            break;
        case 's':
            reference = number(word());
            ahead = number(word());
            heading = atoi(word());
            reading = number(word());
            dt = number(word()); /* NaN where none is told */
            code = stepped(dt, reference, ahead, heading, reading, &action);
            printf("s %d", code);
            print(action.drive);
            print(action.prediction);
            printf(" %d\n", action.status);
            break;
        default:
            printf("?\n");
            return 1;
        }
    }
    return 0;
}

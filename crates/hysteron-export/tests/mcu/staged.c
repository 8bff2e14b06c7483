/* Runs commands from standard input on the actuators that models.h names. Prints results as bit
 * patterns. */
#include <stdio.h>

#include "models.h"
#include "words.h"

static hys_turn turns[MOST_TURNS];
static hys_real points[MOST_TURNS];
static hys_actuator_state state;
static hys_mixed mixed;
static hys_real table[MOST_TABLE];

static int start(const hys_actuator *actuator, size_t count)
{
    size_t levels = actuator->operators->levels, entries = (levels + 1) * (levels + 2) / 2;
    memset(&state, 0x55, sizeof state);
    memset(&mixed, 0x55, sizeof mixed);
    memset(table, 0x55, sizeof table);
    if (actuator->parts == NULL) {
        return hys_actuator_start(actuator, &state, turns, count);
    }
    if (hys_actuator_start(actuator, &state, turns, count) != HYS_MEMORY_TOO_SMALL
        || hys_actuator_start_mixed(actuator, &state, turns, count, &mixed, table, entries - 1)
            != HYS_MEMORY_TOO_SMALL) {
        return -1;
    }
    return hys_actuator_start_mixed(actuator, &state, turns, count, &mixed, table, entries);
}

int main(void)
{
    static char line[1 << 12];
    hys_real numbers[HYS_STAGE_NUMBERS];
    size_t count = 0, n = 0, k;
    hys_real saved_input = 0;
    memset(numbers, 0, sizeof numbers);
    while (fgets(line, sizeof line, stdin) != NULL) {
        const char *command = strtok(line, " \n");
        hys_real x, load, tolerance, y = 0;
        int code, heading, status = 7;
        switch (command == NULL ? ' ' : command[0]) {
        case 'm':
            n = (size_t)atoi(word());
            code = start(models[n], 4 * models[n]->operators->levels + 8);
            printf("m %d\n", code);
            break;
        case 's':
            x = number(word());
            load = number(word());
            code = hys_actuator_step(&state, x, load, &y);
            printf("s %d %" PRIx64 "\n", code, bits(y));
            break;
        case 'i':
            x = number(word());
            heading = atoi(word());
            tolerance = number(word());
            load = number(word());
            code = hys_actuator_inverse_step(&state, x, heading, tolerance, load, &y, &status);
            printf("i %d %" PRIx64 " %d\n", code, bits(y), status);
            break;
        case 'v':
            code = hys_save(&state.operators, points, MOST_TURNS, &count, &saved_input);
            if (code == HYS_OK) {
                code = hys_actuator_save(&state, numbers);
            }
            printf("v %d %" PRIx64, code, bits(saved_input));
            for (k = 0; k < count; k++) {
                printf(" %" PRIx64, bits(points[k]));
            }
            for (k = 0; k < HYS_STAGE_NUMBERS; k++) {
                printf(" %" PRIx64, bits(numbers[k]));
            }
            printf("\n");
            break;
        case 'r':
            /* Into memory that held something else. */
            memset(turns, 0x55, sizeof turns);
            code = start(models[n], MOST_TURNS);
            if (code == HYS_OK) {
                code = hys_restore(&state.operators, points, count, saved_input);
            }
            printf("r %d\n", code != 0 ? code : hys_actuator_restore(&state, numbers));
            break;
        default:
            printf("?\n");
            return 1;
        }
    }
    return 0;
}

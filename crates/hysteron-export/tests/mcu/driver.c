/* Runs commands from standard input on the models that models.h names. Prints results as bit
 * patterns. */
#include <stdio.h>

/* The models' headers; `models`, an array of pointers to them; MOST_TURNS of the largest. */
#include "models.h"
#include "words.h"

#define MOST_POINTS MOST_TURNS

static hys_turn turns[MOST_TURNS];
static hys_real points[MOST_POINTS];
static hys_state state;

int main(void)
{
    static char line[1 << 20];
    size_t count = 0, n;
    hys_real saved_input = 0;
    while (fgets(line, sizeof line, stdin) != NULL) {
        const char *command = strtok(line, " \n");
        hys_real x, y, input = 0;
        int code, heading, status = 7;
        switch (command == NULL ? ' ' : command[0]) {
        case 'm':
            n = (size_t)atoi(word());
            code = hys_start(models[n], &state, turns, 4 * models[n]->levels + 8);
            printf("m %d\n", code);
            break;
        case 's':
            x = number(word());
            y = 0;
            code = hys_step(&state, x, &y);
            printf("s %d %" PRIx64 "\n", code, bits(y));
            break;
        case 'i':
            x = number(word());
            heading = atoi(word());
            y = number(word());
            code = hys_inverse_step(&state, x, heading, y, &input, &status);
            printf("i %d %" PRIx64 " %d\n", code, bits(input), status);
            break;
        case 'v':
            code = hys_save(&state, points, MOST_POINTS, &count, &saved_input);
            printf("v %d %" PRIx64, code, bits(saved_input));
            for (n = 0; n < count; n++) {
                printf(" %" PRIx64, bits(points[n]));
            }
            printf("\n");
            break;
        case 'r':
            /* Into memory that held something else. */
            memset(turns, 0x55, sizeof turns);
            code = hys_start(state.model, &state, turns, MOST_TURNS);
            printf("r %d\n", code != 0 ? code : hys_restore(&state, points, count, saved_input));
            break;
        case 'R':
            input = number(word());
            {
                static hys_real given[64];
                size_t many = (size_t)atoi(word());
                for (n = 0; n < many && n < 64; n++) {
                    given[n] = number(word());
                }
                printf("R %d\n", hys_restore(&state, given, n, input));
            }
            break;
        case '0':
            printf("0 %d\n", hys_reset_off(&state));
            break;
        case '1':
            printf("1 %d\n", hys_reset_on(&state));
            break;
        default:
            printf("?\n");
            return 1;
        }
    }
    return 0;
}

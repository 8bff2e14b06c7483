/* Runs commands from standard input on the models that models.h names, and prints results as bit patterns. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "models.h" /* the models' headers; `models`, an array of pointers to them, and MOST_TURNS of the largest */

#define MOST_POINTS MOST_TURNS

static hys_turn turns[MOST_TURNS];
static hys_real points[MOST_POINTS];
static hys_state state;

static hys_real number(const char *text)
{
    uint64_t wide = strtoull(text, NULL, 16);
    hys_real x;
    if (sizeof x == 4) {
        uint32_t bits = (uint32_t)wide;
        memcpy(&x, &bits, 4);
    } else {
        memcpy(&x, &wide, sizeof x);
    }
    return x;
}

static uint64_t bits(hys_real x)
{
    uint32_t narrow;
    uint64_t wide;
    if (sizeof x == 4) {
        memcpy(&narrow, &x, 4);
        return narrow;
    }
    memcpy(&wide, &x, sizeof wide);
    return wide;
}

static hys_real next(void)
{
    const char *word = strtok(NULL, " \n");
    return number(word == NULL ? "0" : word);
}

static int count_of(const char *word)
{
    return word == NULL ? 0 : atoi(word);
}

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
            n = (size_t)count_of(strtok(NULL, " \n"));
            code = hys_start(models[n], &state, turns, 4 * models[n]->levels + 8);
            printf("m %d\n", code);
            break;
        case 's':
            x = next();
            y = 0;
            code = hys_step(&state, x, &y);
            printf("s %d %" PRIx64 "\n", code, bits(y));
            break;
        case 'i':
            x = next();
            heading = count_of(strtok(NULL, " \n"));
            y = next();
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
            input = next();
            {
                static hys_real given[64];
                size_t many = (size_t)count_of(strtok(NULL, " \n"));
                for (n = 0; n < many && n < 64; n++) {
                    given[n] = next();
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

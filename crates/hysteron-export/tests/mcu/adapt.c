/* As driver.c, for models that learn. Beside `models`, models.h has their weights, and options and
 * sizes of memory for each learner. */
#include <stdio.h>

#include "hysteron_mcu_adapt.h"
#include "models.h"
#include "words.h"

static hys_turn turns[MOST_TURNS], others[MOST_TURNS];
static hys_real memory[MOST_NUMBERS];
static hys_adaptive adaptive;
static hys_state compensator;

int main(void)
{
    static char line[4096];
    size_t n = 0, k, count = 0;
    int learner;
    hys_adapt_options options;
    while (fgets(line, sizeof line, stdin) != NULL) {
        const char *command = strtok(line, " \n");
        hys_real x, y, z = 0, input = 0;
        int code, heading, status = 7;
        switch (command == NULL ? ' ' : command[0]) {
        case 'm':
            n = (size_t)atoi(word());
            learner = atoi(word());
            options = *defaults[n][learner - 1];
            if (atoi(word()) != 0) {
                options.gain = number(word());
                options.span = number(word());
                options.forgetting = number(word());
                options.noise = number(word());
                options.spread = number(word());
                options.correlation = number(word());
                options.offset_share = number(word());
                options.dead_zone = number(word());
                options.leakage = number(word());
                options.movement = number(word());
                options.trial = (uint32_t)atoi(word());
                options.gate = number(word());
                options.burst = (uint32_t)atoi(word());
            }
            k = models[n]->levels;
            count = learner == HYS_DRIFT ? options.basis->count : k * (k + 1) / 2;
            /* Exactly what is asked for, in memory that held something else. */
            memset(memory, 0x55, sizeof memory);
            code = hys_adapt_start(&adaptive, models[n],
                                   learner == HYS_DRIFT ? options.basis->coefficients : weights[n],
                                   models[n]->offset, &options, memory, needed[n][learner - 1],
                                   turns, 4 * k + 8);
            printf("m %d\n",
                   code != 0 ? code : hys_start(&adaptive.model, &compensator, others, 4 * k + 8));
            break;
        case 'a':
            x = number(word());
            y = number(word());
            code = hys_adapt_step(&adaptive, x, y, &z, &status);
            printf("a %d %" PRIx64 " %d\n", code, bits(z), status);
            break;
        case 's':
            x = number(word());
            code = hys_step(&adaptive.state, x, &z);
            printf("s %d\n", code);
            break;
        case 'i':
            x = number(word());
            heading = atoi(word());
            y = number(word());
            code = hys_rebase(&compensator);
            code =
                code != 0 ? code : hys_inverse_step(&compensator, x, heading, y, &input, &status);
            printf("i %d %" PRIx64 " %d\n", code, bits(input), status);
            break;
        case 'f':
            printf("f %d\n", hys_adapt_freeze(&adaptive, atoi(word())));
            break;
        case 'k':
            printf("k %d\n", hys_adapt_keep(&adaptive));
            break;
        case 'b':
            printf("b %d\n", hys_adapt_roll_back(&adaptive));
            break;
        case '0':
            code = hys_reset_off(&adaptive.state);
            printf("0 %d\n", code != 0 ? code : hys_adapt_realign(&adaptive));
            break;
        case 'w':
            printf("w %" PRIx64, bits(adaptive.model.offset));
            for (k = count; k-- > 0;) {
                printf(" %" PRIx64, bits(hys_adapt_parameters(&adaptive)[k]));
            }
            printf("\n");
            break;
        default:
            printf("?\n");
            return 1;
        }
    }
    return 0;
}

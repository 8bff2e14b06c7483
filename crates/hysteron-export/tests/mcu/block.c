/* Steps the block of an FMU's sources over the signals and headings of standard input. Before each
 * step its state goes through bytes. */
#include "hysteron_block.h"

#include <stdio.h>

static block_run run;

static int fails(const char *why)
{
    if (why) fprintf(stderr, "%s\n", why);
    return why != NULL;
}

int main(void)
{
    double signal, time = 0, result;
    int heading, flag;
    if (fails(block_reset(&run)) || fails(block_enter(&run)) || fails(block_exit(&run))) return 1;
    while (scanf("%lf %d", &signal, &heading) == 2) {
        block_inputs inputs = run.inputs;
        block_saved saved;
        if (fails(block_put_real(&inputs, 1, signal))
            || (BLOCK_INVERSE && fails(block_put_integer(&inputs, 4, heading)))
            || fails(block_set(&run, &inputs)) || fails(block_save(&run, &saved))
            || fails(block_restore(&run, &saved)) || fails(block_step(&run, time, 0.5))
            || fails(block_get_real(&run, 2, &result)) || fails(block_get_integer(&run, 3, &flag)))
            return 1;
        time += 0.5;
        printf("%.17g %d\n", result, flag);
    }
    return 0;
}

/* Steps the block of an FMU's sources over the signals and headings of standard input. Before each
 * step its state goes through bytes. */
#include "hysteron_block.h"

#include <stdio.h>

static block_run run;

/* Whether bytes that no run can have are refused. */
static int refuses(const block_saved *saved)
{
    int n;
    for (n = 0; n < 6; n++) {
        block_saved other = *saved;
        if (n == 0) other.phase = 9;
        if (n == 1) other.inputs.heading = 7;
        if (n == 2) other.inputs.start_on = 2;
        if (n == 3) other.inputs.tolerance = -1;
        if (n == 4) other.time = HUGE_VAL;
        if (n == 5) other.count = BLOCK_POINTS + 1;
        if (!block_restore(&run, &other)) return 0;
    }
    return 1;
}

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
            || !refuses(&saved) || fails(block_restore(&run, &saved)) || fails(block_step(&run, time, 0.5))
            || fails(block_get_real(&run, 2, &result)) || fails(block_get_integer(&run, 3, &flag)))
            return 1;
        time += 0.5;
        printf("%.17g %d\n", result, flag);
    }
    return 0;
}

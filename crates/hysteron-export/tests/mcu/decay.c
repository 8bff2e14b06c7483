/* Prints hys_decay of each number on standard input, as bit patterns. */
#include <stdio.h>

#include "words.h"

hys_real hys_decay(hys_real times);

int main(void)
{
    static char line[64];
    while (fgets(line, sizeof line, stdin) != NULL) {
        printf("%" PRIx64 "\n", bits(hys_decay(number(strtok(line, " \n")))));
    }
    return 0;
}

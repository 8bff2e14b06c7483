/* Words of a command: numbers as bit patterns, so that no digit is lost in text. */
#ifndef WORDS_H
#define WORDS_H

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "hysteron_mcu.h"

static inline hys_real number(const char *text)
{
    uint64_t wide = strtoull(text, NULL, 16);
    uint32_t narrow = (uint32_t)wide;
    hys_real x;
    memcpy(&x, sizeof x == 4 ? (const void *)&narrow : (const void *)&wide, sizeof x);
    return x;
}

static inline uint64_t bits(hys_real x)
{
    uint32_t narrow = 0;
    uint64_t wide = 0;
    memcpy(sizeof x == 4 ? (void *)&narrow : (void *)&wide, &x, sizeof x);
    return sizeof x == 4 ? narrow : wide;
}

/* The next word of the line that strtok was begun with. */
static inline const char *word(void)
{
    const char *found = strtok(NULL, " \n");
    return found == NULL ? "0" : found;
}

#endif

/* The numbers that a program is run with, the same everywhere, and a hash of every bit of what it
 * finds. Stands behind the model's header, which says what a number is. */
#ifndef BITS_H
#define BITS_H
#include <string.h>

static uint32_t hash = 2166136261u, seed = 1;

/* A number in [0, 1). */
static hys_real chance(void) {
    seed = seed * 1664525u + 1013904223u;
    return (hys_real)(int32_t)(seed >> 9) * (hys_real)1.1920929e-07;
}

static void take(hys_real x) {
    uint8_t bytes[sizeof x], n;
    memcpy(bytes, &x, sizeof x);
    for (n = 0; n < sizeof x; n++)
        hash = (hash ^ bytes[n]) * 16777619u;
}

#endif

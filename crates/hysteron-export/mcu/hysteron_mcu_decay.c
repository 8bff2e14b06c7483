/* e^(-x) without a library, with the bits that the library has: it computes it by the algorithm of
 * FreeBSD (e_exp.c, e_expf.c), of which this is the half below zero.
 *
 * Copyright (C) 2004 by Sun Microsystems, Inc. All rights reserved. Permission to use, copy, modify,
 * and distribute this software is freely granted, provided that this notice is preserved. */
#include "hysteron_mcu_decay.h"

/* On some targets double is what float is. */
#define WIDE (sizeof(hys_real) > 4u)
#define OF(wide, narrow) ((hys_real)(WIDE ? (wide) : (narrow)))

#define LN2_HIGH OF(6.93147180369123816490e-01, 6.9314575195e-01)
#define LN2_LOW OF(1.90821492927058770002e-10, 1.4286067653e-06)
#define PER_LN2 OF(1.44269504088896338700e+00, 1.4426950216e+00)
#define P1 OF(1.66666666666666019037e-01, 1.6666625440e-1)
#define P2 OF(-2.77777777770155933842e-03, -2.7667332906e-3)
#define P3 ((hys_real)6.61375632143793436117e-05)
#define P4 ((hys_real)-1.65339022054652515390e-06)
#define P5 ((hys_real)4.13813679705723846039e-08)

/* From here on there is nothing left, half of ln 2 and one and a half of it, and up to where 1 - x is
 * exact enough. */
#define NONE_LEFT OF(745.1332191019412, 103.97208404541016)
#define HALF_LN2 OF(0.3465735912322998, 0.3465736210346222)
#define MORE_LN2 OF(1.0397205352783203, 1.039720892906189)
#define SMALL OF(3.725293851175593e-09, 0.00012207032705191523)

/* Powers of two below these have not all digits. */
#define LOWEST (WIDE ? -1022 : -126)
#define DIGITS (WIDE ? 53 : 24)

/* 2^n for n from LOWEST to 0. */
static hys_real power_of_two(int n)
{
    hys_real power = ONE, base = HALF;
    int left;
    for (left = -n; left > 0; left /= 2) { /* at most 10 iterations */
        if (left % 2 != 0) {
            power = power * base;
        }
        base = base * base;
    }
    return power;
}

/* y · 2^n, rounded once. */
static hys_real scaled(hys_real y, int n)
{
    if (n < LOWEST) {
        y = y * power_of_two(LOWEST + DIGITS);
        n -= LOWEST + DIGITS;
    }
    return y * power_of_two(n);
}

hys_real hys_decay(hys_real times)
{
    hys_real x = -times, high = x, low = ZERO, square, c, y;
    int halvings = 0;
    if (!(times < NONE_LEFT)) {
        return ZERO;
    }
    if (times < SMALL) {
        return ONE + x;
    }
    if (times >= HALF_LN2) {
        halvings = times >= MORE_LN2 ? (int)(PER_LN2 * x - HALF) : -1;
        high = x - (hys_real)halvings * LN2_HIGH;
        low = (hys_real)halvings * LN2_LOW;
        x = high - low;
    }
    square = x * x;
    c = WIDE ? P3 + square * (P4 + square * P5) : ZERO;
    c = WIDE ? x - square * (P1 + square * (P2 + square * c)) : x - square * (P1 + square * P2);
    y = ONE + (x * c / ((hys_real)2 - c) - low + high);
    return halvings == 0 ? y : scaled(y, halvings);
}

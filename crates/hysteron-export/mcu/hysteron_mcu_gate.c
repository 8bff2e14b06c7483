/* The gate of a control loop, which holds back single wrong readings: gate.rs. */
#include "hysteron_mcu_control.h"
#include "hysteron_mcu_internal.h"

#define FACTOR ((hys_real)6)   /* a deviation so many times the usual one is no noise */
#define BURST 3                /* so many readings on one side are believed */

/* How far a reading may be from where the last ones lead. */
static hys_real width_of(const hys_spikes *self, hys_real least)
{
    hys_real sizes[HYS_REMEMBERED], usual = ZERO;
    size_t known = self->known, n, k;
    for (n = 0u; n < known; n++) { /* at most HYS_REMEMBERED iterations, as the next loop */
        hys_real size = self->deviations[n];
        for (k = n; k > 0u && sizes[k - 1u] > size; k--) {
            sizes[k] = sizes[k - 1u];
        }
        sizes[k] = size;
    }
    if (known > 0u) { /* while few are known, the largest may be the usual one */
        usual = sizes[known < HYS_REMEMBERED / 2u ? known - 1u : known / 2u];
    }
    return hys_max(FACTOR * usual, least);
}

int hys_gate_passes(hys_spikes *self, hys_real least, hys_real reading, hys_real expected)
{
    hys_real deviation, change, width, off;
    if (!is_finite(self->believed)) {
        self->believed = reading;
        self->slope = self->steps = ZERO;
        self->known = self->next = 0u;
        self->beyond = 0;
        return 1;
    }
    self->steps += ONE;
    deviation = reading - (self->believed + self->slope * self->steps);
    change = reading - self->believed;
    width = width_of(self, least);
    self->deviations[self->next] = hys_max(deviation, -deviation);
    self->known = (unsigned char)(self->known + (self->known < HYS_REMEMBERED));
    self->next = (unsigned char)((self->next + 1u) % HYS_REMEMBERED);
    off = change - expected;
    /* Written so that NaN is within nothing. */
    if (hys_max(deviation, -deviation) > width && !(hys_max(off, -off) <= width)) {
        int side = deviation > ZERO ? 1 : -1;
        self->beyond = (signed char)(self->beyond * side > 0 ? self->beyond + side : side);
        if (self->beyond * side < BURST) {
            return 0;
        }
        self->slope = ZERO; /* a jump leads nowhere */
    } else {
        self->slope = change / self->steps;
    }
    self->believed = reading;
    self->steps = ZERO;
    self->beyond = 0;
    return 1;
}

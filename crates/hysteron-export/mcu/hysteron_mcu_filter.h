/* The low-pass filter of a control loop: low_pass.rs. Not for applications. */
#ifndef HYSTERON_MCU_FILTER_H
#define HYSTERON_MCU_FILTER_H

#include "hysteron_mcu_control.h"
#include "hysteron_mcu_decay.h"

/* A value behind the filter, `passed` s after the last one; `filtered` is NaN before the first. */
static inline hys_real filter(const hys_control *control, hys_real *filtered, hys_real value,
                              hys_real passed)
{
    hys_real kept = ZERO;
    if ((control->has & HYS_HAS_FILTER) == 0u) {
        return value;
    }
    if (is_finite(*filtered)) {
        kept = hys_decay(passed / control->filter_s);
    }
    *filtered = kept > ZERO ? kept * *filtered + (ONE - kept) * value : value;
    return *filtered;
}

#endif

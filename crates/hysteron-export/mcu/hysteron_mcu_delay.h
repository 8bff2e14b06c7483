/* The dead time of an actuator, for microcontrollers: an input acts so many samples after it was
 * given. Before the first sample the input stood where it is first.
 *
 * Forward, pass each input before its step:
 *     hys_delay_pass(&delay, drive, &acting) == HYS_OK && hys_step(&state, acting, &output)
 * Inverse: the input that is found acts so many samples later. So the target of a sample is the one
 * that is due then. A controller (hysteron_mcu_control.h) does both by itself.
 *
 * The results have the bits of the library's over a whole series. */
#ifndef HYSTERON_MCU_DELAY_H
#define HYSTERON_MCU_DELAY_H

#include "hysteron_mcu.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Inputs that were given and have not acted yet. Only these functions may use its members. */
typedef struct {
    hys_real *under_way;
    size_t late, next;
    unsigned char begun;
} hys_delay;

/* Nothing is under way. `under_way` has `late` elements (NAME_LATE of the model), which are used
 * from now on. With 0 an input acts at once. Error: HYS_NULL. */
int hys_delay_start(hys_delay *self, hys_real *under_way, size_t late);

/* Writes the input that acts at the sample at which `input` is given. Error:
 * HYS_INPUT_NOT_FINITE, and nothing is changed. */
int hys_delay_pass(hys_delay *self, hys_real input, hys_real *acting);

#ifdef __cplusplus
}
#endif

#endif

/* The one function that a filter and a measured time need. Not for applications. */
#ifndef HYSTERON_MCU_DECAY_H
#define HYSTERON_MCU_DECAY_H

#include "hysteron_mcu_internal.h"

/* What is left after so many time constants: e^(-times), for `times` from 0 to infinity. */
hys_real hys_decay(hys_real times);

#endif

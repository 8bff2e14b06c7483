/* The dead time. */
#include "hysteron_mcu_delay.h"
#include "hysteron_mcu_internal.h"

int hys_delay_start(hys_delay *self, hys_real *under_way, size_t late)
{
    if (self == NULL || (under_way == NULL && late > 0u)) {
        return HYS_NULL;
    }
    self->under_way = under_way;
    self->late = late;
    self->next = 0u;
    self->begun = 0u;
    return HYS_OK;
}

int hys_delay_pass(hys_delay *self, hys_real input, hys_real *acting)
{
    size_t n;
    if (self == NULL || acting == NULL) {
        return HYS_NULL;
    }
    if (!is_finite(input)) {
        return HYS_INPUT_NOT_FINITE;
    }
    if (self->late == 0u) {
        *acting = input;
        return HYS_OK;
    }
    if (!self->begun) {
        for (n = 0u; n < self->late; n++) { /* late iterations, once */
            self->under_way[n] = input;
        }
        self->begun = 1u;
    }
    *acting = self->under_way[self->next];
    self->under_way[self->next] = input;
    self->next = self->next + 1u < self->late ? self->next + 1u : 0u;
    return HYS_OK;
}

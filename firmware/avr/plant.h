/* A simulated spring of a shape memory alloy under a weight: heat, then hysteresis. It is another
 * kind of model than hysteron's: plays of nine widths on the heat, each through its own curve.
 *
 * With a strength it is another actuator, whose input acts at once, as that of a piezo: the same
 * plays, and a stroke that is so many times as long. */
#ifndef PLANT_H
#define PLANT_H
#include <math.h>

#define PLAYS 9
#define ROOM 22.0      /* degC */
#define WARMER 90.0    /* at full drive, K */
#define COOLING_S 2.0  /* time constant */
#define STROKE 8.0     /* mm */

typedef struct {
    double heat, mm, play[PLAYS], strength; /* strength: 0 for a spring */
} plant;

static void plant_step(plant *self, double drive, double dt) {
    double sum = 0;
    int n;
    double to = ROOM + WARMER * drive;
    self->heat = self->strength > 0 ? to : self->heat + dt / COOLING_S * (to - self->heat);
    for (n = 0; n < PLAYS; n++) {
        double half = 1.0 + n; /* of its dead band, K */
        self->play[n] = fmin(fmax(self->play[n], self->heat - half), self->heat + half);
        sum += 1 / (1 + exp(-(self->play[n] - 60) / (4 + 0.5 * n)));
    }
    self->mm = 1 + (self->strength > 0 ? self->strength : 1) * STROKE * sum / PLAYS;
}

static void plant_start(plant *self, double strength) {
    int n;
    self->strength = strength;
    self->heat = ROOM;
    for (n = 0; n < PLAYS; n++)
        self->play[n] = ROOM;
    plant_step(self, 0, 0);
}

/* What is wanted at a time, mm: the knob of the potentiometer. Of an actuator whose stroke is so many
 * times as long, so many times as much: that is the same way. */
static double reference(const plant *self, double time) {
    double wave = cos(0.2 * time) * (1 + 0.3 * sin(0.047 * time));
    return self->strength > 0 ? 1 + self->strength * (3.5 - 1.6 * wave) : 5 - 2 * wave;
}
#endif

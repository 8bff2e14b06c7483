/* Simulated actuators, none of them one of hysteron's models.
 *
 * A spring of a shape memory alloy under a weight: heat, then plays of nine widths on it, each
 * through its own curve.
 * WIRE, a wire against a spring: cosine kinetics (Liang and Rogers 1990), whose temperatures rise with
 * the stress, and which bind heat while the wire pulls.
 * With a strength above 0 it is another actuator, whose input acts at once, as that of a piezo: the
 * plays of the spring, and a stroke that is so many times as long. `stroke` does that to spring and
 * wire. */
#ifndef PLANT_H
#define PLANT_H
#include <math.h>

#define PLAYS 9
#define ROOM 22.0      /* degC */
#define WARMER 90.0    /* at full drive, K */
#define COOLING_S 2.0  /* time constant */
#define STROKE 8.0     /* mm */
#define WIRE -1.0
#define BOUND 40.0     /* heat that the whole transformation binds, as K of the wire: 20 J/g */
#define STRESSED 6.0   /* by so many K the pulled spring raises all temperatures */

typedef struct {
    double heat, mm, play[PLAYS], strength; /* strength: 0 for the spring, WIRE, or above 0 */
    double stroke;                          /* of spring and wire, over STROKE */
    double cold, scale;                     /* share that is martensite, and of the branch */
    int warms;
} plant;

/* The cosine of the branch that is followed, at a temperature: of the share of martensite while it
 * warms, of the rest while it cools. */
static double branch(const plant *self, double at) {
    const double pi = acos(-1), raised = at - STRESSED * (1 - self->cold);
    double up = fmin(fmax((raised - 48) / 14, 0), 1), down = fmin(fmax((raised - 34) / 10, 0), 1);
    return self->warms ? (1 + cos(pi * up)) / 2 : (1 - cos(pi * down)) / 2;
}

/* The share that is martensite at a temperature: a branch begins where it turned. */
static double martensite(const plant *self, double at) {
    double share = self->scale * branch(self, at);
    return self->warms ? fmin(self->cold, share) : fmax(self->cold, 1 - share);
}

static void wire_step(plant *self, double drive, double dt) {
    /* Heat without what is bound: a change of share takes or gives its part. */
    double free = self->heat - BOUND * self->cold, low = ROOM - 1, high = ROOM + WARMER + BOUND;
    double change = dt / COOLING_S * (ROOM + WARMER * drive - self->heat);
    int n, warms = change > 0;
    if (warms != self->warms) {
        self->warms = warms;
        self->scale = (warms ? self->cold : 1 - self->cold) / fmax(branch(self, self->heat), 1e-6);
    }
    for (n = 0; n < 50; n++) {
        double middle = (low + high) / 2;
        *(middle - BOUND * martensite(self, middle) < free + change ? &low : &high) = middle;
    }
    self->heat = low;
    self->cold = martensite(self, low);
    self->mm = 1 + self->stroke * STROKE * (1 - self->cold);
}

static void plant_step(plant *self, double drive, double dt) {
    double sum = 0;
    int n;
    double to = ROOM + WARMER * drive;
    if (self->strength < 0) {
        wire_step(self, drive, dt);
        return;
    }
    self->heat = self->strength > 0 ? to : self->heat + dt / COOLING_S * (to - self->heat);
    for (n = 0; n < PLAYS; n++) {
        double half = 1.0 + n; /* of its dead band, K */
        self->play[n] = fmin(fmax(self->play[n], self->heat - half), self->heat + half);
        sum += 1 / (1 + exp(-(self->play[n] - 60) / (4 + 0.5 * n)));
    }
    self->mm = 1 + (self->strength > 0 ? self->strength : self->stroke) * STROKE * sum / PLAYS;
}

static void plant_start(plant *self, double strength, double stroke) {
    int n;
    self->strength = strength;
    self->stroke = stroke;
    self->heat = ROOM;
    self->cold = self->scale = 1;
    self->warms = 0;
    for (n = 0; n < PLAYS; n++)
        self->play[n] = ROOM;
    plant_step(self, 0, 0);
}

/* What is wanted at a time, mm: the knob of the potentiometer. Of an actuator whose stroke is so many
 * times as long, so many times as much: that is the same way. */
static double reference(const plant *self, double time) {
    double wave = cos(0.2 * time) * (1 + 0.3 * sin(0.047 * time));
    return self->strength > 0 ? 1 + self->strength * (3.5 - 1.6 * wave) : 1 + self->stroke * (4 - 2 * wave);
}
#endif

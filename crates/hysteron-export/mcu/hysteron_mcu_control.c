/* The controller. Beside each part stands the file of the library that it follows. */
#include "hysteron_mcu_control.h"
#include "hysteron_mcu_internal.h"
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
#include "hysteron_mcu_filter.h"
#endif

#define FADE 10u               /* samples within which a difference of the feedforward fades */
#define NOT_TURNED ((hys_real)8)
#define DERIVATIVE_FILTER ((hys_real)8)

/* An output that stands still: standstill.rs. */
#define WAY ((hys_real)0.45)
#define RANGE ((hys_real)0.02)
#define ROOM ((hys_real)0.5)
#define EXPECTED ((hys_real)0.05)
#define NOISE ((hys_real)0.01)
#define ASIDE ((hys_real)0.05)
#define FULL ((hys_real)0.1)
#define JAMMED ((hys_real)0.4)
#define ALIVE 10u
#define CHANCE 3u

static hys_real nothing(void)
{
    return ZERO / ZERO;
}

static hys_real size_of(hys_real x)
{
    return x < ZERO ? -x : x;
}

/* The time since the sample before. */
static hys_real dt_of(const hys_controller *self)
{
#if (HYS_LOOP & HYS_HAS_TIME) != 0u
    return self->dt;
#else
    return self->control->dt;
#endif
}

/* ---- What a loop has only where it was asked for ---- */

/* Whether a reading is no spike. The model expected `before` for the last one. */
static int is_believed(hys_controller *self, hys_real reading, hys_real before)
{
#if (HYS_LOOP & HYS_HAS_GATE) != 0u
    hys_real expected = ZERO;
    if ((self->control->has & HYS_HAS_GATE) == 0u) {
        return 1;
    }
    if (self->followed != NULL && is_finite(self->acting)) {
        expected = self->prediction - before;
    }
    return hys_gate_passes(&self->gate, self->control->gate, reading, expected);
#else
    (void)self;
    (void)reading;
    (void)before;
    return 1;
#endif
}

/* A reading behind the filter, `passed` s after the last one. */
static hys_real seen(hys_controller *self, hys_real reading, hys_real passed)
{
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    return filter(self->control, &self->seen, reading, passed);
#else
    (void)self;
    (void)passed;
    return reading;
#endif
}

/* The reference as late as the filter makes the reading. */
static hys_real asked_for(hys_controller *self, hys_real reference)
{
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    return filter(self->control, &self->asked, reference, dt_of(self));
#else
    (void)self;
    return reference;
#endif
}

/* The last drive, as late too; NaN before it. */
static hys_real given(hys_controller *self)
{
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    if (is_finite(self->drive)) {
        return filter(self->control, &self->given, self->drive, dt_of(self));
    }
#endif
    return self->drive;
}

/* ---- A model without stages ---- */

static void plain_copy(hys_state *to, const hys_state *from)
{
    size_t n;
    hys_turn *turns = to->turns;
    *to = *from;
    to->turns = turns;
    for (n = 0u; n <= from->top; n++) { /* at most 4K + 8 iterations */
        turns[n] = from->turns[n];
    }
}

const hys_in_loop hys_plain_in_loop = {hys_step, hys_inverse_step, plain_copy};

/* ---- The reading ---- */

/* Whether the output should have moved since it stands still. */
static int should_move(const hys_controller *self, hys_real expected, hys_real drive)
{
    const hys_control *control = self->control;
    hys_real moved = drive - self->since_drive, way;
    hys_real least = RANGE * (control->drive_max - control->drive_min);
    if (is_finite(self->since_expected) && is_finite(expected)) {
        return size_of(expected - self->since_expected)
            > EXPECTED * control->range;
    }
    way = moved > ZERO ? control->drive_max - self->since_drive
                       : self->since_drive - control->drive_min;
    return self->news >= ALIVE && size_of(moved) > hys_max(WAY * way, least);
}

/* Whether the output but for its noise is where it was, and the drive at a limit, though it is not
 * wanted there and the model expects it elsewhere. */
static int is_jammed(hys_controller *self, hys_real reading, hys_real wanted, hys_real expected,
                     hys_real drive)
{
    const hys_control *control = self->control;
    hys_real range = control->range, margin = FULL * (control->drive_max - control->drive_min);
    int is_near = size_of(reading - self->near_reading) <= NOISE * range;
    if (!is_finite(expected)) {
        self->near_reading = nothing();
        return 0;
    }
    if (!is_near) { /* also where there was none */
        self->near_reading = reading;
        self->near_expected = expected;
    }
    return size_of(expected - self->near_expected) > JAMMED * range
        && size_of(wanted - reading) > ASIDE * range
        && (drive < control->drive_min + margin || drive > control->drive_max - margin);
}

/* Whether a reading stands still where it has to move. */
static int stands_still(hys_controller *self, hys_real reading, hys_real wanted)
{
    const hys_control *control = self->control;
    hys_real drive = is_finite(self->drive) ? self->drive : control->drive_min;
    hys_real expected = is_finite(self->drive) ? self->prediction : nothing();
    int jammed = is_jammed(self, reading, wanted, expected, drive), counts = 0;
    self->repeats = self->news > 0u && reading == self->since_reading;
    if (self->repeats) {
        counts = self->still > 0u || should_move(self, expected, drive);
        self->still = (unsigned char)(self->still + (counts && self->still < CHANCE));
    } else {
        self->since_reading = reading;
        self->since_expected = expected;
        self->since_drive = drive;
        self->still = 0u;
        self->news = (unsigned char)(self->news + (self->news < ALIVE));
    }
    self->still_s = counts || jammed ? self->still_s + dt_of(self) : ZERO;
    return self->still >= CHANCE;
}

/* The reading, or NaN where there is none: sensor.rs. */
static hys_real sensed(hys_controller *self, hys_real reading, unsigned char *status)
{
    const hys_control *control = self->control;
    int repeated = control->repeats_s > ZERO && reading == self->last;
    if (is_finite(reading) && !repeated) {
        hys_real passed = self->gap + dt_of(self);
        self->last = reading;
        self->gap = ZERO;
        return seen(self, reading, passed);
    }
    self->gap += dt_of(self);
    if (!repeated || self->gap >= control->repeats_s) {
        *status |= HYS_NO_READING;
    }
    return nothing();
}

/* The drive that the output answers now. Before all of them, the actuator stood at the first. */
static hys_real arrives(hys_controller *self, hys_real drive)
{
    size_t late = self->control->late, n;
    hys_real first;
    if (!is_finite(drive) || late == 0u) {
        return drive;
    }
    if (!is_finite(self->acting)) {
        for (n = 0u; n < late; n++) { /* late iterations, once */
            self->under_way[n] = drive;
        }
    }
    first = self->under_way[self->place];
    self->under_way[self->place] = drive;
    self->place = self->place + 1u < late ? self->place + 1u : 0u;
    return first;
}

/* ---- The inverse: compensator.rs ---- */

/* The direction of the branch that the reference is on. */
static void turn(hys_controller *self, hys_real reference)
{
    hys_real tolerance = self->control->tolerance;
    self->low = hys_min(reference, self->low);
    self->high = hys_max(reference, self->high);
    if (self->branch != HYS_FALLING && self->high - reference > tolerance) {
        self->branch = HYS_FALLING;
    } else if (self->branch != HYS_RISING && reference - self->low > tolerance) {
        self->branch = HYS_RISING;
    } else {
        return;
    }
    self->low = reference;
    self->high = reference;
}

static int solve(hys_controller *self, hys_real target, int heading, hys_real *drive, int *status)
{
    const hys_control *control = self->control;
    hys_real tolerance = control->tolerance, output;
    int rises, turned;
    if (!self->aimed) {
        if (self->followed != NULL) {
            control->model->copy(self->wanted, self->followed);
        } else if (is_finite(self->acting)) {
            int code = control->model->step(self->wanted, self->acting, &output);
            if (code != HYS_OK) {
                return code;
            }
        }
        self->aimed = 1u;
        self->low = target;
        self->high = target;
    }
    turn(self, target);
    rises = is_rising(self->wanted) != control->falls;
    turned = self->branch != HYS_HOLD && rises != (self->branch == HYS_RISING);
    if (heading == HYS_HOLD && !turned) {
        tolerance = NOT_TURNED * tolerance;
    }
    return control->model->invert(self->wanted, target, heading, tolerance, drive, status);
}

/* ---- The feedback: pid.rs ---- */

static void begin(hys_controller *self, hys_real out, hys_real error, hys_real bias)
{
    hys_real integral = out - bias - self->control->gain * error;
    if (self->control->integral_s > ZERO && is_finite(integral)) {
        self->integral = integral;
        self->correction = out - bias;
        self->begun = 1u;
    }
    self->measured = nothing();
}

static hys_real follow(hys_controller *self, hys_real error, hys_real measured, hys_real bias,
                       hys_real low, hys_real high)
{
    const hys_control *control = self->control;
    hys_real gain = control->gain, dt = dt_of(self), fixed, out, slope = ZERO;
    if (is_finite(self->measured) && control->derivative_s > ZERO) {
        hys_real share = dt / (dt + control->derivative_s / DERIVATIVE_FILTER);
        slope = self->slope + share * ((self->measured - measured) / dt - self->slope);
    }
    self->measured = is_finite(measured + slope) ? measured : nothing();
    self->slope = slope;
    fixed = bias + gain * (error + control->derivative_s * slope);
    if (control->integral_s > ZERO) {
        hys_real growth = gain * error * dt / control->integral_s;
        hys_real sum = fixed + self->integral + growth;
        int up = growth > ZERO && (sum > high || self->held_high);
        int down = growth < ZERO && (sum < low || self->held_low);
        hys_real lowest = hys_min(low - bias, ZERO), highest = hys_max(high - bias, ZERO);
        self->begun = self->begun && (self->integral < lowest || self->integral > highest);
        if (self->begun) {
            lowest = hys_min(lowest, self->integral);
            highest = hys_max(highest, self->integral);
        }
        if (is_finite(sum) && !up && !down) {
            self->integral += growth;
        }
        self->integral = hys_clamp(self->integral, lowest, highest);
    }
    out = hys_clamp(fixed + self->integral, low, high);
    self->correction = out - bias;
    return out;
}

/* ---- The loop: controller.rs ---- */

/* The drive for a measured output, or without one. */
static hys_real answer(hys_controller *self, hys_real feedforward, hys_real reference,
                       hys_real measured)
{
    const hys_control *control = self->control;
    hys_real low = control->drive_min, high = control->drive_max, bias;
    hys_real error = is_finite(measured) ? reference - measured : ZERO;
    if (is_finite(self->from)) {
        if (control->feedback && !is_finite(measured)) {
            return hys_clamp(self->from, low, high); /* the loop is not closed before a reading */
        }
        self->fade = self->from - feedforward;
        if (control->feedback && control->integral_s <= ZERO) {
            self->fade = self->fade - control->gain * error;
        }
        self->left = FADE;
        if (control->feedback) {
            begin(self, self->from, error, feedforward + self->fade);
        }
        self->from = nothing();
    }
    bias = feedforward + self->fade * number(self->left) / number(FADE);
    self->left = (unsigned char)(self->left - (self->left > 0u));
    if (self->repeats && self->news >= ALIVE && !is_finite(self->since_expected)) {
        /* No model says whether the output should move: a stuck one leads to no limit. */
        hys_real at = self->since_drive, least = RANGE * (high - low);
        hys_real below = hys_max(ROOM * (at - low), least);
        hys_real above = hys_max(ROOM * (high - at), least);
        low = hys_max(low, at - below);
        high = hys_min(high, at + above);
    }
    if (control->feedback && is_finite(measured)) {
        return follow(self, error, measured, bias, low, high);
    }
    if (control->feedback) {
        self->measured = nothing();
        if (control->integral_s > ZERO && low < bias && bias < high) {
            /* The other terms answered to a moment that has passed. */
            hys_real dt = dt_of(self), part = dt / (dt + control->integral_s);
            self->correction += (self->integral - self->correction) * part;
        }
        return hys_clamp(bias + self->correction, low, high);
    }
    return hys_clamp(bias, low, high);
}

int hys_controller_start(hys_controller *self, const hys_control *control, hys_state *wanted,
                         hys_state *followed, hys_real *under_way, size_t count)
{
    if (self == NULL || control == NULL || wanted == NULL
        || (under_way == NULL && control->late > 0u)) {
        return HYS_NULL;
    }
    if (count < control->late) {
        return HYS_MEMORY_TOO_SMALL;
    }
    if (usable_state(wanted) != HYS_OK || (followed != NULL && usable_state(followed) != HYS_OK)
        || followed == wanted) {
        return HYS_STATE_MISMATCH;
    }
    self->control = control;
    self->wanted = wanted;
    self->followed = followed;
    self->under_way = under_way;
    self->place = 0u;
    self->from = self->drive = self->acting = self->prediction = nothing();
    self->fade = self->integral = self->slope = self->correction = ZERO;
    self->measured = self->last = nothing();
    self->low = self->high = self->gap = self->silent = ZERO;
    self->since_reading = self->since_drive = self->still_s = ZERO;
    self->since_expected = self->near_reading = self->near_expected = nothing();
    self->still = self->news = 0u;
    self->branch = HYS_HOLD;
    self->left = self->aimed = self->begun = self->held_low = self->held_high = 0u;
    self->repeats = self->is_safe = 0u;
#if (HYS_LOOP & HYS_HAS_GATE) != 0u
    self->gate.believed = nothing();
#endif
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    self->seen = self->given = self->asked = nothing();
#endif
    return HYS_OK;
}

int hys_controller_go_on_from(hys_controller *self, hys_real drive)
{
    if (self == NULL) {
        return HYS_NULL;
    }
    if (!is_finite(drive)) {
        return HYS_INPUT_NOT_FINITE;
    }
    self->from = self->drive = drive;
#if (HYS_LOOP & HYS_HAS_FILTER) != 0u
    self->asked = nothing(); /* the reference begins anew */
#endif
    if (self->is_safe) {
        self->is_safe = 0u;
        self->silent = self->still_s = ZERO;
        self->still = 0u;
    }
    return HYS_OK;
}

/* One sample, after the time that is known. */
static int sample(hys_controller *self, hys_real reference, hys_real ahead, int heading,
                  hys_real reading, hys_action *action)
{
    const hys_control *control;
    hys_real measured, feedforward, asked, drive, slack, before;
    unsigned char status = 0u;
    int found, is_read = is_finite(reading), code = HYS_OK;
    if (self == NULL || action == NULL || self->control == NULL) {
        return HYS_NULL;
    }
    control = self->control;
    if (!is_finite(reference) || !is_finite(ahead)) {
        return HYS_INPUT_NOT_FINITE;
    }
    if (heading != HYS_HOLD && heading != HYS_RISING && heading != HYS_FALLING) {
        return HYS_VALUE;
    }
    before = self->prediction;
    measured = reading;
    self->acting = arrives(self, given(self));
    self->silent = is_read ? ZERO : self->silent + dt_of(self);
    if (self->followed != NULL) {
        if (is_read && stands_still(self, reading, reference)) {
            status |= HYS_STUCK;
            measured = nothing();
        }
        if (is_finite(self->acting)) {
            code = control->model->step(self->followed, self->acting, &self->prediction);
        }
    }
    if (is_read && !is_believed(self, reading, before)) {
        status |= HYS_OUTLIER;
        measured = nothing();
    }
    measured = sensed(self, measured, &status);
    if (code == HYS_OK) {
        code = solve(self, ahead, heading, &feedforward, &found);
    }
    if (code != HYS_OK) {
        return code;
    }
    if (found == HYS_LOW || found == HYS_HIGH) {
        status |= HYS_OUT_OF_REACH;
    }
    reference = asked_for(self, reference);
    asked = answer(self, feedforward, reference, measured);
    asked = hys_clamp(asked, control->drive_min, control->drive_max);
    drive = asked;
    if (control->slew > ZERO && is_finite(self->drive)) {
        hys_real way = control->slew * dt_of(self);
        drive = hys_clamp(drive, self->drive - way, self->drive + way);
    }
    slack = dt_of(self) * (hys_real)0.01;
    if ((control->lost_s > ZERO && self->silent >= control->lost_s - slack)
        || (control->stuck_s > ZERO && (self->still == 0u || self->still >= CHANCE)
            && self->still_s >= control->stuck_s - slack)) {
        self->is_safe = 1u;
    }
    if (self->is_safe) {
        drive = control->safe;
        status |= HYS_SAFE;
    }
    self->held_low = drive <= control->drive_min || drive > asked;
    self->held_high = drive >= control->drive_max || drive < asked;
    if (self->held_low || self->held_high || asked <= control->drive_min
        || asked >= control->drive_max) {
        status |= HYS_AT_LIMIT;
    }
    self->drive = drive;
    action->drive = drive;
    action->prediction = self->prediction;
    action->status = status;
    return HYS_OK;
}

#if (HYS_LOOP & HYS_HAS_TIME) != 0u

int hys_controller_step_after(hys_controller *self, hys_real dt, hys_real reference,
                              hys_real ahead, int heading, hys_real reading, hys_action *action)
{
    const hys_control *control;
    int code = HYS_OK;
    if (self == NULL || self->control == NULL) {
        return HYS_NULL;
    }
    control = self->control;
    if (!(dt > ZERO && is_finite(dt))
        || (dt != control->dt && (control->has & HYS_HAS_TIME) == 0u)) {
        return HYS_VALUE;
    }
    if (control->clock != NULL) {
        code = control->clock->pass(control->clock, self->wanted, self->followed, dt);
    }
    if (code != HYS_OK) {
        return code;
    }
    self->dt = dt;
    return sample(self, reference, ahead, heading, reading, action);
}

int hys_controller_step(hys_controller *self, hys_real reference, hys_real ahead, int heading,
                        hys_real reading, hys_action *action)
{
    if (self == NULL || self->control == NULL) {
        return HYS_NULL;
    }
    return hys_controller_step_after(self, self->control->dt, reference, ahead, heading, reading,
                                     action);
}

#else

int hys_controller_step(hys_controller *self, hys_real reference, hys_real ahead, int heading,
                        hys_real reading, hys_action *action)
{
    return sample(self, reference, ahead, heading, reading, action);
}

#endif

/* The inverse step of an actuator with stages. Each stage is inverted for the present sample, from
 * the last to the first. Applications that only run models forward do not need this file. */
#include "hysteron_mcu_latent.h"

static const hys_real EIGHT_EPSILON = (hys_real)8 * HYS_EPSILON;
static const hys_real THOUSANDTH = (hys_real)1 / (hys_real)1000;

static hys_real magnitude(hys_real x)
{
    return hys_max(x, -x);
}

static hys_real inward(const hys_actuator_state *state, hys_real output)
{
    hys_real offset = offset_of(state);
    return state->actuator->falls ? offset - output : output - offset;
}

/* The operators' input for a sum. hys_inverse_step goes there, and everything goes back to where it
 * was. It writes over two turning points that are needed afterwards, those of a corner that merges
 * with another; it writes over others only after the last one. */
static int solve(hys_state *state, hys_real aim, int heading, hys_real tolerance,
                 hys_real *input, int *status)
{
    hys_turn *corner = state->turns + (state->top - 2u);
    hys_turn first = corner[0], second = corner[1];
    size_t top = state->top, began_cell = state->began_cell;
    hys_real began_part = state->began_part, began_y = state->began_y, end = state->end;
    hys_real x = state->x, y = state->y, last = state->input;
    int code = hys_inverse_step(state, aim, heading, tolerance, input, status);
    corner[0] = first;
    corner[1] = second;
    state->top = top;
    state->began_cell = began_cell;
    state->began_part = began_part;
    state->began_y = began_y;
    state->end = end;
    state->x = x;
    state->y = y;
    state->input = last;
    return code;
}

/* The operators' input, the temperature, and where the output is to go next. */
typedef struct {
    hys_real held, now;
    int heading;
} from_here;

/* The temperature that leads the operators from where they are to an input. Where that is the same,
 * every temperature between the two curves of a registration does it. */
static hys_real temperature_at(const hys_actuator *actuator, const loaded_axis *at,
                               const from_here *from, hys_real input)
{
    hys_real lowest;
    if (!HAS(REGISTRATION) || actuator->falling.numbers == NULL || input > from->held) {
        return leading_to(actuator, at, 1, input);
    }
    lowest = leading_to(actuator, at, 0, input);
    if (input < from->held || from->heading == HYS_FALLING) {
        return lowest;
    }
    if (from->heading == HYS_RISING) {
        return leading_to(actuator, at, 1, input);
    }
    return hys_clamp(from->now, lowest, hys_max(leading_to(actuator, at, 1, input), lowest));
}

/* How far the operators' input may be from the exact one by rounding, where the temperature comes
 * from numbers of the size `size`. */
static hys_real slack_of(const hys_actuator *actuator, const loaded_axis *at, hys_real size)
{
    hys_real effective = at->scale * size + magnitude(at->shift);
    hys_real ends = magnitude(actuator->operators->max) + magnitude(actuator->operators->bottom);
    const hys_list *knots = &actuator->knots;
    if (HAS(REGISTRATION) && knots->numbers != NULL) {
        effective = effective
            + (magnitude(knots->numbers[0]) + magnitude(knots->numbers[knots->count - 1u]));
    }
    return EIGHT_EPSILON * (effective * actuator->steepest + ends);
}

static hys_real within_range(const hys_actuator *actuator, hys_real drive)
{
    return actuator->limited ? hys_clamp(drive, actuator->drive_min, actuator->drive_max) : drive;
}

/* The drive that holds a temperature. */
static hys_real holding(const hys_actuator *actuator, hys_real temperature)
{
    return (temperature - actuator->ambient) / actuator->gain;
}

/* The drive for a temperature at the end of the sample time, within its range. */
static hys_real drive_for(const hys_actuator_state *state, hys_real temperature)
{
    const hys_actuator *actuator = state->actuator;
    hys_real now = state->temperature, factor, drive;
    if (!actuator->body) {
        return within_range(actuator, temperature);
    }
    if (!state->started) {
        return within_range(actuator, holding(actuator, temperature));
    }
    if (temperature == now) {
        drive = holding(actuator, temperature);
    } else {
        factor = temperature > now ? actuator->heating : actuator->cooling;
        drive = holding(actuator, now + (temperature - now) / (ONE - factor));
    }
    drive = within_range(actuator, drive);
    return is_finite(drive) ? drive : holding(actuator, now);
}

/* The drive for an input of the operators, and the size of the numbers that it comes from. */
static hys_real drive_to(const hys_actuator_state *state, const loaded_axis *at,
                         const from_here *from, hys_real input, hys_real *size)
{
    const hys_actuator *actuator = state->actuator;
    hys_real temperature = unbound(state, at, temperature_at(actuator, at, from, input));
    hys_real drive = drive_for(state, temperature);
    *size = magnitude(temperature);
    if (actuator->body) {
        *size = *size
            + (magnitude(actuator->ambient) + magnitude(actuator->gain * drive) + actuator->latent);
    }
    return drive;
}

/* The drive at which a relay switches: at its level and not an ulp before it. One that has just
 * switched switches back where the input turns by an ulp: a branch that stays goes on. */
static hys_real nudged(const hys_actuator_state *state, const loaded_axis *at,
                       const from_here *from, hys_real input, hys_real drive, hys_real *size)
{
    const hys_actuator *actuator = state->actuator;
    hys_real aim = input, last = state->operators.input;
    int rising = input > last, n;
    if (input == last) {
        rising = is_rising(&state->operators) && state->operators.x > ZERO;
    }
    for (n = 0; n < 4; n++) {
        hys_real seen = seen_at(actuator, at, last, heated(state, drive)), nudge;
        if (seen == input || (seen > input) == rising) {
            break;
        }
        /* In the unit of the operators' input, which need not be that of the temperature. */
        nudge = hys_max(actuator->operators->nudge, slack_of(actuator, at, *size));
        aim = rising ? aim + nudge : aim - nudge;
        drive = drive_to(state, at, from, aim, size);
    }
    return drive;
}

/* Whether an output, without the offset of the load, lies by more than `reach` beyond the ends of
 * those at rest. */
static int reach_of(const hys_actuator_state *state, hys_real low, hys_real high, hys_real reach,
                    hys_real output)
{
    int falls = state->actuator->falls;
    hys_real sum = inward(state, output);
    if (sum > high + reach) {
        return falls ? HYS_LOW : HYS_HIGH;
    }
    if (sum < low - reach) {
        return falls ? HYS_HIGH : HYS_LOW;
    }
    return HYS_REACHED;
}

int hys_actuator_inverse_step(hys_actuator_state *state, hys_real target, int heading,
                              hys_real tolerance, hys_real load, hys_real *drive, int *status)
{
    const hys_actuator *actuator;
    const hys_model *model;
    loaded_axis at;
    from_here from;
    hys_real off, on, sum, steepest, aim, gain, input, to, size, slack, reached, error, rounding, offsets, low, high, most;
    int found = HYS_LIMITED;
    int code = usable_actuator(state);
    if (code != HYS_OK) {
        return code;
    }
    if (drive == NULL || status == NULL) {
        return HYS_NULL;
    }
    if (heading != HYS_HOLD && heading != HYS_RISING && heading != HYS_FALLING) {
        return HYS_VALUE;
    }
    actuator = state->actuator;
    model = state->operators.model;
    if (!model->inverse) {
        return HYS_NEGATIVE_WEIGHTS;
    }
    if (!is_finite(target)) {
        return HYS_INPUT_NOT_FINITE;
    }
    code = curves_at(actuator, load, &at);
    if (code == HYS_OK) {
        code = place(state, load);
    }
    if (code != HYS_OK) {
        return code;
    }
    from.heading = actuator->falls ? -heading : heading;
    from.now = state->temperature;
    from.held = state->operators.input;
    if (model->kind != RELAY) {
        from.held = hys_clamp(from.held, model->bottom, model->max);
    }
    off = own_sum(model, ZERO);
    on = own_sum(model, model->total);
    sum = inward(state, target - at.offset);
    aim = behind_inverse(state, sum, at.gain * off, at.gain * on) / at.gain;
    steepest = behind_steepest(state);
    if (is_finite(aim)) {
        /* Within so much of the sum, the output stays within its tolerance wherever it is. */
        hys_real within =
            tolerance == ZERO ? ZERO : tolerance / (steepest * at.gain);
        code = solve(&state->operators, aim, from.heading, within, &input, &found);
        if (code != HYS_OK) {
            return code;
        }
    } else {
        /* A lag or a ring that cannot move in a sample: stay. */
        input = hys_clamp(state->operators.input, model->bottom, model->max);
    }
    to = drive_to(state, &at, &from, input, &size);
    if (model->kind == RELAY) {
        to = nudged(state, &at, &from, input, to, &size);
    }
    slack = slack_of(actuator, &at, size);
    code = hys_actuator_step(state, to, load, &reached);
    if (code != HYS_OK) {
        return code;
    }
    keep_wanted(state, sum);
    gain = at.gain * hys_max(actuator->steepest_behind, steepest);
    rounding = gain * (model->rounding + model->total * (slack / model->step));
    error = hys_max(reached - target, target - reached);
    offsets = magnitude(offset_of(state)) + magnitude(at.offset) + magnitude(target)
        + actuator->size_behind;
    low = behind_settled(actuator, at.gain * off);
    high = behind_settled(actuator, at.gain * on);
    most = (high - low) * THOUSANDTH;
    if (error <= hys_max(tolerance, ZERO) + hys_min(rounding + EIGHT_EPSILON * offsets, most)) {
        found = HYS_REACHED;
    } else {
        hys_real reach = hys_max(tolerance, gain * model->rounding);
        int beyond = reach_of(state, low, high, reach, target - at.offset);
        found = beyond != HYS_REACHED ? beyond : found == HYS_PASSED ? HYS_PASSED : HYS_LIMITED;
    }
    *drive = to;
    *status = found;
    return HYS_OK;
}

/* The C interface of hysteron: models of hysteresis, their exact inverse, and adaptation.
 *
 * Generated from the code by `cargo run -p hysteron-capi --example header`. Do not edit.
 *
 * Every function that can fail returns HYSTERON_OK or another of the codes below. Results are
 * written only with HYSTERON_OK. Exceptions are counts, which then give the size needed, and
 * arrays, which may then have zeros.
 *
 * A pointer points to as many elements as the count beside it says, one where there is no count. No
 * two pointers of a call may share memory: HYSTERON_OVERLAP, and nothing is written.
 *
 * A model may have stages around its operators: a thermal body, a load, creep, a lag, a ring.
 * Samples then need the time since the sample before, or a load. The functions whose names end with `_in` take
 * both; NAN stands for one that is not given. The `input` of a sample is the one held since the
 * sample before.
 *
 * Handles (uint64_t) are numbers. A handle that was freed or never given is refused. Handles may be
 * used from any thread.
 *
 * A state or a learner has its numbers in memory of the library (`..._new`), or in memory of the
 * caller (`..._size`, `..._place`). All other functions are the same for both. Over memory of the
 * caller they allocate nothing, but for `hysteron_adaptive_model`, `hysteron_state_half_width` and
 * the start HYSTERON_START_FITTED. The memory must stay where it is until the object is freed.
 * Another object that is made in it ends the one before, whose handle is then refused.
 */

#ifndef HYSTERON_H
#define HYSTERON_H

#include <stddef.h>
#include <stdint.h>

/**
 * No error.
 */
#define HYSTERON_OK 0

/**
 * Fewer than 2 or too many levels.
 */
#define HYSTERON_LEVELS 1

/**
 * The plane's range is not finite, empty or too narrow.
 */
#define HYSTERON_RANGE 2

/**
 * The number of weights is not `K(K + 1)/2`.
 */
#define HYSTERON_WEIGHT_COUNT 3

/**
 * A weight, or the weights' sum, is not finite.
 */
#define HYSTERON_WEIGHT_NOT_FINITE 4

/**
 * The inverse and adaptation need weights that are not negative.
 */
#define HYSTERON_NEGATIVE_WEIGHTS 5

/**
 * Memory or an array of the caller is too small.
 */
#define HYSTERON_MEMORY_TOO_SMALL 6

/**
 * An input, target or measurement is NaN or infinite.
 */
#define HYSTERON_INPUT_NOT_FINITE 7

/**
 * Turning points to restore do not nest.
 */
#define HYSTERON_TURNING_POINTS 8

/**
 * A state was used with a model other than the one that made it.
 */
#define HYSTERON_STATE_MISMATCH 9

/**
 * There is no such operator.
 */
#define HYSTERON_OPERATOR 10

/**
 * An option of an estimator is out of its range.
 */
#define HYSTERON_ADAPTATION 11

/**
 * The time since the sample before is needed: a finite number of seconds from 0 on.
 */
#define HYSTERON_TIME_STEP 12

/**
 * A load is needed that is a finite number.
 */
#define HYSTERON_LOAD 13

/**
 * A constant of a stage, or a limit of the inverse, is out of its range.
 */
#define HYSTERON_STAGE 14

/**
 * A file cannot be read or written.
 */
#define HYSTERON_FILE 20

/**
 * A model file is not valid.
 */
#define HYSTERON_MODEL_FILE 21

/**
 * A recording is not valid.
 */
#define HYSTERON_RECORDING 22

/**
 * The model or the options do not allow this call: a load is missing, out of range or too much.
 */
#define HYSTERON_FIT 23

/**
 * A filter's arguments do not fit the data.
 */
#define HYSTERON_FILTER 24

/**
 * A value lies outside the physics of the simulated rig.
 */
#define HYSTERON_RIG 25

/**
 * A step of the preparation cannot be done.
 */
#define HYSTERON_PREPARATION 26

/**
 * No experiment follows from the options.
 */
#define HYSTERON_DESIGN 27

/**
 * The model depends on time: the time since the sample before is missing or negative.
 */
#define HYSTERON_THERMAL 28

/**
 * A scenario is not valid.
 */
#define HYSTERON_SCENARIO 29

/**
 * The options of a controller are not valid.
 */
#define HYSTERON_CONTROL 30

/**
 * A model cannot be exported to this target.
 */
#define HYSTERON_EXPORT 31

/**
 * A pointer is null that must not be.
 */
#define HYSTERON_NULL 100

/**
 * There is no such handle or object: it was never made, was freed, or is of another kind.
 */
#define HYSTERON_HANDLE 101

/**
 * A text is not UTF-8.
 */
#define HYSTERON_TEXT 102

/**
 * A constant or a size is not one of those allowed.
 */
#define HYSTERON_VALUE 103

/**
 * Memory is not aligned as its content needs.
 */
#define HYSTERON_ALIGNMENT 104

/**
 * Two arrays of the call overlap.
 */
#define HYSTERON_OVERLAP 105

/**
 * A defect of this library, caught at its boundary.
 */
#define HYSTERON_INTERNAL 106

/**
 * Flag of a sample: the drive or the command is at a limit, or the drive changes as fast as it
 * may.
 */
#define HYSTERON_AT_LIMIT 1

/**
 * Flag of a sample: no input gives the reference. The nearest one was taken.
 */
#define HYSTERON_OUT_OF_REACH 2

/**
 * Flag of a sample: a reading was missing or held back. The loop went on without it.
 */
#define HYSTERON_NO_READING 4

/**
 * Flag of a sample: the output or the input stands still where it has to move.
 */
#define HYSTERON_STUCK 8

/**
 * Flag of a sample: the loop is given up, and the drive is the safe one.
 */
#define HYSTERON_SAFE 16

/**
 * Flag of a sample: the model learned from it.
 */
#define HYSTERON_ADAPTED 32

/**
 * Flag of a sample: the reading was taken as an outlier.
 */
#define HYSTERON_OUTLIER 64

/**
 * How many numbers the stages behind the operators remember.
 */
#define HYSTERON_BEHIND 8

/**
 * Operator: modified Krasnosel'skii-Pokrovskii, 0 to 1.
 */
#define HYSTERON_MKP 0

/**
 * Operator: Krasnosel'skii-Pokrovskii, −1 to 1.
 */
#define HYSTERON_KP 1

/**
 * Operator: relay of the classical Preisach model, −1 or 1.
 */
#define HYSTERON_RELAY 2

/**
 * Policy of the inverse: hold. The input stands still while the target does.
 */
#define HYSTERON_HOLD 0

/**
 * Policy of the inverse: the target rises next. The input crosses a dead band at once.
 */
#define HYSTERON_RISING 1

/**
 * Policy of the inverse: the target falls next. The input crosses a dead band at once.
 */
#define HYSTERON_FALLING -1

/**
 * The target is reached, or the input lies inside the plane.
 */
#define HYSTERON_INSIDE 0

/**
 * The target lies below every output, or the input below the plane.
 */
#define HYSTERON_LOW -1

/**
 * The target lies above every output, or the input above the plane.
 */
#define HYSTERON_HIGH 1

/**
 * The target lies inside a jump of a relay model. The output lies beyond it.
 */
#define HYSTERON_PASSED 2

/**
 * The model can give the target, but not in this sample: the input is at an end of its range, or
 * a stage is too slow. The input goes as far as it can.
 */
#define HYSTERON_LIMITED 3

/**
 * Start of a state: as a new one. It is what the fit found before the first sample, or off.
 */
#define HYSTERON_START_FITTED 0

/**
 * Start of a state: every operator off.
 */
#define HYSTERON_START_OFF 1

/**
 * Start of a state: every operator on.
 */
#define HYSTERON_START_ON 2

/**
 * Method of adaptation: normalised gradient on increments.
 */
#define HYSTERON_INCREMENTS 1

/**
 * Method of adaptation: recursive least squares with regularised forgetting.
 */
#define HYSTERON_LEAST_SQUARES 2

/**
 * Outcome of a sample: the weights moved.
 */
#define HYSTERON_LEARNED 0

/**
 * Outcome of a sample: the error lies within the dead zone, or an increment is not finished.
 */
#define HYSTERON_WAITING 1

/**
 * Outcome of a sample: the input did not move.
 */
#define HYSTERON_AT_REST 2

/**
 * Outcome of a sample: the estimator is frozen.
 */
#define HYSTERON_FROZEN 3

/**
 * Outcome of a sample: the last good weights are back.
 */
#define HYSTERON_ROLLED_BACK 4

/**
 * Outcome of a sample: the reading is taken as an outlier.
 */
#define HYSTERON_REJECTED 5

/**
 * Outcome of a sample: the output stands still while the input moves. What was learned since is
 * undone.
 */
#define HYSTERON_OUTPUT_STUCK 6

/**
 * Outcome of a sample: the input stands still while the output moves. What was learned since is
 * undone.
 */
#define HYSTERON_INPUT_STUCK 7

/**
 * Options of adaptation. `hysteron_adaptation_default` writes the defaults.
 */
typedef struct HysteronAdaptation {
  /**
   * `HYSTERON_INCREMENTS` or `HYSTERON_LEAST_SQUARES`.
   */
  int32_t method;
  /**
   * Samples learned from after which weights are compared with the last good ones, from 1.
   */
  uint32_t trial;
  /**
   * Increments: fraction of the error that an increment removes, above 0 and below 2.
   */
  double gain;
  /**
   * Increments: levels from the start of an increment to its end, 1/8 to 8.
   */
  double span;
  /**
   * Least squares: forgetting factor, above 0 and up to 1. 1 forgets nothing.
   */
  double forgetting;
  /**
   * Least squares: standard deviation of a reading's error, in the output's unit; above 0.
   */
  double noise;
  /**
   * Least squares: standard deviation of a weight from the off-line one, in the output's unit;
   * above 0.
   */
  double spread;
  /**
   * Least squares: levels over which deviations of weights are correlated, from 0.
   */
  double correlation;
  /**
   * How freely the offset moves, relative to one weight, from 0.
   */
  double offset_share;
  /**
   * Errors up to this are noise, in the output's unit, from 0.
   */
  double dead_zone;
  /**
   * Fraction of the way that weights return to the off-line ones with each update, 0 to 1.
   */
  double leakage;
  /**
   * Levels between two samples that are learned from, from 0.
   */
  double movement;
  /**
   * Readings with a surprise above so many times the usual one are refused, from 2. 0: none is.
   */
  double gate;
  /**
   * So many refused readings in a row that agree are learned from, from 1.
   */
  uint32_t burst;
} HysteronAdaptation;

/**
 * Options of the estimator of the shift: of a load that nobody measures.
 * `hysteron_shift_usual` writes those that follow from a model.
 */
typedef struct HysteronShiftOptions {
  /**
   * Standard deviation of a reading's error, model error included, in the output's unit; above
   * 0.
   */
  double noise;
  /**
   * Standard deviation of the shift at the start and after a jump, in the unit of the
   * temperature; above 0.
   */
  double spread;
  /**
   * Standard deviation of the change of the shift while the temperature moves by one level, in
   * the unit of the temperature, from 0.
   */
  double walk;
  /**
   * The largest shift to either side, in the unit of the temperature; above 0.
   */
  double reach;
  /**
   * Errors up to this are noise, in the output's unit, from 0.
   */
  double dead_zone;
  /**
   * Levels between two samples that are learned from, from 0.
   */
  double movement;
  /**
   * Readings with a surprise above so many times the usual one are refused, from 2. 0: none is.
   */
  double gate;
  /**
   * So many refused readings in a row that agree are a jump of the load, from 1.
   */
  uint32_t burst;
} HysteronShiftOptions;

/**
 * Result of a step that learns.
 */
typedef struct HysteronLearning {
  /**
   * Output predicted before the estimator learned from the sample.
   */
  double output;
  /**
   * Measured output less predicted output.
   */
  double error;
  /**
   * Outcome: `HYSTERON_LEARNED` to `HYSTERON_INPUT_STUCK`.
   */
  int32_t outcome;
  /**
   * Where the input lay: `HYSTERON_INSIDE`, `HYSTERON_LOW` or `HYSTERON_HIGH`.
   */
  int32_t clipped;
} HysteronLearning;

/**
 * What the estimator of the shift found.
 */
typedef struct HysteronShift {
  /**
   * The shift of the axis from the load that it departs from, in the unit of the temperature.
   */
  double shift;
  /**
   * Standard deviation of the shift, as the filter believes it.
   */
  double deviation;
  /**
   * The load that the shift tells. `NAN` for a model whose shift says nothing of the load.
   * Beyond the model's loads it is the outermost one.
   */
  double load;
} HysteronShift;

/**
 * The settings of a controller. `hysteron_control_default` fills them in.
 */
typedef struct HysteronControl {
  /**
   * Time between samples, s, above 0.
   */
  double interval_s;
  /**
   * Lowest drive, in its unit.
   */
  double drive_min;
  /**
   * Highest drive, above the lowest.
   */
  double drive_max;
  /**
   * Lowest command: the input that is asked for, in its unit. Without an inner loop the command
   * is the drive.
   */
  double command_min;
  /**
   * Highest command, above the lowest.
   */
  double command_max;
  /**
   * The command without feedback, for a loop without a model.
   */
  double bias;
  /**
   * Reversals of the reference up to this are noise, in the output's unit, from 0.
   */
  double tolerance;
  /**
   * Feedback: gain, command per unit of the error. `NAN` for the inverse alone.
   */
  double gain;
  /**
   * Feedback: integral time, s; 0 for no such term.
   */
  double integral_s;
  /**
   * Feedback: derivative time, s; 0 for no such term.
   */
  double derivative_s;
  /**
   * Inner loop around the input: gain, power per unit of the input. `NAN` for no inner loop.
   */
  double inner_gain;
  /**
   * Inner loop: integral time, s; 0 for no such term.
   */
  double inner_integral_s;
  /**
   * Inner loop: derivative time, s; 0 for no such term.
   */
  double inner_derivative_s;
  /**
   * Time constant of the low-pass filter on both readings, s, from 0.
   */
  double filter_s;
  /**
   * Time after which equal readings of a sensor are no readings, s, above 0. `NAN` where they
   * are normal, as those of a coarse converter.
   */
  double repeats_s;
  /**
   * The gate against spikes never holds back what deviates by this, in the output's unit, from
   * 0. `NAN` for no gate.
   */
  double gate;
  /**
   * The fastest change of the drive, in its unit per second, above 0. `NAN` for no such limit.
   */
  double slew;
  /**
   * Time without a reading after which the loop is given up, s, above 0. `NAN` for never.
   */
  double lost_s;
  /**
   * The same for an output that stands still where it has to move.
   */
  double stuck_s;
  /**
   * Samples until a drive moves the output that is read, up to 1001. -1 for one more than the
   * dead time of the model, without a model for none.
   */
  int32_t delay;
  /**
   * 1 for the policy *anticipate*, which takes the headings; 0 for *hold*, which does not.
   */
  int32_t anticipate;
  /**
   * 1 if the drive is the square root of the power of the inner loop, else 0.
   */
  int32_t square_root;
  /**
   * 1 if a sensor measures the input, else 0.
   */
  int32_t input_measured;
} HysteronControl;

/**
 * What a controller does at a sample.
 */
typedef struct HysteronAction {
  /**
   * The input that is asked for.
   */
  double command;
  /**
   * The drive to write to the device.
   */
  double drive;
  /**
   * The output that the model expected at the last input, before it learned from the reading.
   * `NAN` without a model.
   */
  double prediction;
  /**
   * The filtered output. `NAN` where there is no new valid reading.
   */
  double output;
  /**
   * The filtered input. `NAN` where there is none.
   */
  double input;
  /**
   * Flags, added: `HYSTERON_AT_LIMIT` to `HYSTERON_OUTLIER`.
   */
  int32_t status;
} HysteronAction;

/**
 * What a controller is and knows beside its samples.
 */
typedef struct HysteronControllerInfo {
  /**
   * Time between samples, s.
   */
  double interval_s;
  /**
   * The safe drive: zero, or the one within the limits that is nearest.
   */
  double rest_drive;
  /**
   * How long the output has stood still where it has to move, s. `NAN` where its sensor works.
   */
  double stuck_s;
  /**
   * Samples until a drive moves the output that is read: how far ahead the reference is needed.
   */
  size_t due;
  /**
   * 1 while the predictions of a learner beside a fixed model are used, else 0.
   */
  int32_t trusts_learner;
} HysteronControllerInfo;

/**
 * Limits of the inverse. `hysteron_model_limits` writes those that a model has of its own.
 */
typedef struct HysteronLimits {
  /**
   * Lowest input, in its unit: the lowest drive of a model with a thermal body. `-INFINITY` for
   * none.
   */
  double drive_min;
  /**
   * Highest input. `INFINITY` for none.
   */
  double drive_max;
  /**
   * Seconds in which a thermal body reaches the temperature it needs, from 0; the time step
   * where that is longer. With a longer horizon noise of the target moves the drive less, and
   * the output follows late.
   */
  double horizon;
  /**
   * Lowest temperature, as what comes next may need it: of the input itself without a thermal
   * body. `-INFINITY` for none.
   */
  double temperature_min;
  /**
   * Highest temperature. `INFINITY` for none.
   */
  double temperature_max;
} HysteronLimits;

/**
 * Properties of a model.
 */
typedef struct HysteronModelInfo {
  /**
   * `HYSTERON_MKP`, `HYSTERON_KP` or `HYSTERON_RELAY`.
   */
  int32_t operator_kind;
  /**
   * 1: the output rises with the input; −1: it falls.
   */
  int32_t sign;
  /**
   * `K`, the number of levels.
   */
  size_t levels;
  /**
   * `N = K(K + 1)/2`, the number of operators.
   */
  size_t weights;
  /**
   * Lowest level, in the unit of the operators' input. That is the temperature with a thermal
   * body; with levels at unequal distances the plane only numbers them.
   */
  double min;
  /**
   * Highest level, in the same unit.
   */
  double max;
  /**
   * One step below the lowest level, in the same unit. Every operator is off there.
   */
  double bottom;
  /**
   * Offset: what is added to the sum of the operators. Of a model that depends on a load, offset
   * and outputs are those without its curves, at the middle of the load range.
   */
  double offset;
  /**
   * Output with every operator off.
   */
  double output_off;
  /**
   * Output with every operator on.
   */
  double output_on;
  /**
   * Default tolerance for reversals of a target: 1 % of the output's range.
   */
  double usual_tolerance;
} HysteronModelInfo;

/**
 * What a model needs beside its input, and in which ranges.
 */
typedef struct HysteronModelNeeds {
  /**
   * 1 if the model depends on time, so that samples need `dt`; else
   * 0.
   */
  int32_t time;
  /**
   * 1 if the model depends on a load, which samples then need; else 0.
   */
  int32_t load;
  /**
   * 1 if the model has a thermal body, so that its input is a drive; else 0.
   */
  int32_t body;
  /**
   * 1 if the fit found a state before the first sample, in which states start; else 0.
   */
  int32_t fitted_start;
  /**
   * Smallest load, in its unit. NaN without a load.
   */
  double load_min;
  /**
   * Largest load. NaN without a load.
   */
  double load_max;
  /**
   * Lowest drive of the inverse, in the input's unit. `-INFINITY` without a thermal body.
   */
  double drive_min;
  /**
   * Highest drive of the inverse. `INFINITY` without a thermal body.
   */
  double drive_max;
  /**
   * Where the operators are at their lowest: the temperature with a thermal body, else the
   * input; with a load, at the middle of its range.
   */
  double active_min;
  /**
   * Where the operators are at their highest.
   */
  double active_max;
} HysteronModelNeeds;

/**
 * What the stages remember from one sample to the next. All zeros: there was no sample yet. A copy
 * of it is a saved state.
 */
typedef struct HysteronStageState {
  /**
   * 1 after the first sample, 0 before it. The stages are at rest with that sample.
   */
  double started;
  /**
   * The temperature; without a thermal body, the input itself.
   */
  double temperature;
  /**
   * What each stage behind the operators remembers.
   */
  double behind[HYSTERON_BEHIND];
} HysteronStageState;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Makes a model that adapts all weights of `model` and its offset. `options` may be null for the
 * defaults. All operators are off.
 */
int32_t hysteron_adaptive_new(uint64_t model, const struct HysteronAdaptation *options, uint64_t *adaptive);

/**
 * Size in bytes of the memory of such a model, for `hysteron_adaptive_place`. 0 if there is none
 * for this model and these options.
 */
size_t hysteron_adaptive_size(uint64_t model, const struct HysteronAdaptation *options);

/**
 * As `hysteron_adaptive_new`, with all numbers in `memory` of the caller, as in
 * `hysteron_state_place`.
 */
int32_t hysteron_adaptive_place(uint64_t model,
                                const struct HysteronAdaptation *options,
                                void *memory,
                                size_t bytes,
                                uint64_t *adaptive);

/**
 * Makes a model that follows a load that nobody measures. It follows the shift of the axis alone;
 * the weights stay, or are those of the load that the shift tells.
 *
 * `load` is the load to start at, `NAN` for the middle of the model's range. `options` may be null
 * for the usual ones (`hysteron_shift_usual`). All operators are off.
 */
int32_t hysteron_adaptive_load_new(uint64_t model,
                                   double load,
                                   const struct HysteronShiftOptions *options,
                                   uint64_t *adaptive);

/**
 * Size in bytes of the memory of such a model, for `hysteron_adaptive_load_place`. 0 if there is
 * no such model.
 */
size_t hysteron_adaptive_load_size(uint64_t model);

/**
 * As `hysteron_adaptive_load_new`, with all numbers in `memory` of the caller, as in
 * `hysteron_state_place`.
 */
int32_t hysteron_adaptive_load_place(uint64_t model,
                                     double load,
                                     const struct HysteronShiftOptions *options,
                                     void *memory,
                                     size_t bytes,
                                     uint64_t *adaptive);

/**
 * Frees a learner of either kind. Memory of the caller stays the caller's.
 */
int32_t hysteron_adaptive_free(uint64_t adaptive);

/**
 * Moves to `input`, predicts the output there, and learns from the output `measured`. `dt` is as
 * for `hysteron_step_in`; without stages it has no effect. After an error nothing has changed.
 */
int32_t hysteron_adaptive_step(uint64_t adaptive,
                               double input,
                               double dt,
                               double measured,
                               struct HysteronLearning *learning);

/**
 * Moves to `input` and writes the output predicted there, without learning.
 */
int32_t hysteron_adaptive_simulate(uint64_t adaptive, double input, double dt, double *output);

/**
 * As `hysteron_inverse_step_in`, with what was learned. The inverse has a state of its own,
 * separate from the state that follows the plant. It starts with all operators off.
 */
int32_t hysteron_adaptive_inverse_step(uint64_t adaptive,
                                       double target,
                                       int32_t heading,
                                       double tolerance,
                                       double dt,
                                       double *input,
                                       int32_t *status);

/**
 * Makes a model with what was learned: with the present weights and offset, or with the present
 * shift, which depends on no load. Free it with `hysteron_model_free`.
 */
int32_t hysteron_adaptive_model(uint64_t adaptive, uint64_t *model);

/**
 * Writes the shift of a learner of `hysteron_adaptive_load_new`, and the load that it tells.
 */
int32_t hysteron_adaptive_shift(uint64_t adaptive, struct HysteronShift *shift);

/**
 * Switches all operators off, those of the inverse too. What was learned stays.
 */
int32_t hysteron_adaptive_reset(uint64_t adaptive);

/**
 * Sets the state of the inverse to that of the measured input.
 */
int32_t hysteron_adaptive_align(uint64_t adaptive);

/**
 * Stops learning (`frozen` not 0), or resumes it (0).
 */
int32_t hysteron_adaptive_freeze(uint64_t adaptive, int32_t frozen);

/**
 * Takes the present weights of a learner of `hysteron_adaptive_new` as the last good ones.
 */
int32_t hysteron_adaptive_keep(uint64_t adaptive);

/**
 * Returns to the last good weights, of a learner of `hysteron_adaptive_new`.
 */
int32_t hysteron_adaptive_roll_back(uint64_t adaptive);

/**
 * Makes a batch of `lanes` models with a state each, which move together. A lane is one of them
 * with its state, as `hysteron_state_new` makes it. The same model may come more than once. The
 * models may be freed before the batch. Free the handle with `hysteron_batch_free`.
 *
 * Each lane gives the same outputs as a state alone, to the last bit. Many samples are divided
 * among all processors.
 */
int32_t hysteron_batch_new(const uint64_t *models, size_t lanes, uint64_t *batch);

/**
 * As `hysteron_batch_new`, with `lanes` states of one model.
 */
int32_t hysteron_batch_of(uint64_t model, size_t lanes, uint64_t *batch);

/**
 * Frees a batch. States of its lanes stay valid.
 */
int32_t hysteron_batch_free(uint64_t batch);

/**
 * Brings all lanes back to their start, as that of a new batch.
 */
int32_t hysteron_batch_reset(uint64_t batch);

/**
 * Moves every lane by one sample: `lanes` inputs, and as many outputs. The arrays must not
 * overlap. After an error, whose text names the lane, all lanes stay as they are.
 */
int32_t hysteron_batch_step(uint64_t batch, const double *input, double *output, size_t lanes);

/**
 * As `hysteron_batch_step`, for any models. `dt` is the time since the sample before in seconds,
 * 0 for the first one, or `NAN` for models that do not depend on time. `load` has the load of each
 * lane, or is null. A lane that does not depend on one of them takes no notice of it.
 */
int32_t hysteron_batch_step_in(uint64_t batch,
                               const double *input,
                               double dt,
                               const double *load,
                               double *output,
                               size_t lanes);

/**
 * Moves every lane through its inputs: `count` inputs, and as many outputs. They come row by row:
 * first all samples of lane 0, then all of lane 1. `count` is a multiple of the number of lanes.
 * The arrays must not overlap. After an error, whose text names the lane, all lanes stay as they
 * are.
 */
int32_t hysteron_batch_run(uint64_t batch, const double *input, double *output, size_t count);

/**
 * As `hysteron_batch_run`, for any models. `time` has the time of each of the `samples` of a lane
 * in seconds, or is null; it is the same for all lanes. `last_time` is the time of the sample
 * before the first one, `NAN` for a new batch. `load` has `count` loads in the order of the
 * inputs, or is null. A lane that does not depend on one of them takes no notice of it.
 */
int32_t hysteron_batch_run_in(uint64_t batch,
                              const double *input,
                              const double *time,
                              size_t samples,
                              double last_time,
                              const double *load,
                              double *output,
                              size_t count);

/**
 * Makes a state of its own from that of a lane, counted from 0: a copy, for all functions of a
 * state. Free it with `hysteron_state_free`.
 */
int32_t hysteron_batch_state(uint64_t batch, size_t lane, uint64_t *state);

/**
 * The text of a status code. It is never null and stays valid. `hysteron_last_error` gives the
 * details of the last error.
 */
const char *hysteron_error_message(int32_t code);

/**
 * The version of this library, for example "0.2.0".
 */
const char *hysteron_version(void);

/**
 * Fills in the settings of a loop that samples every `interval_s` seconds and drives from
 * `drive_min` to `drive_max`. It has no feedback, filter, gate, slew, inner loop or safe state yet.
 * The tolerance is the usual one of `model`, and 0 for `model` 0.
 */
int32_t hysteron_control_default(uint64_t model,
                                 double interval_s,
                                 double drive_min,
                                 double drive_max,
                                 struct HysteronControl *control);

/**
 * Makes a controller: a model and its inverse, feedback, or both. It is at rest.
 *
 * `model` is a fixed model, 0 for none. `learner` is one of `hysteron_adaptive_new` or
 * `hysteron_adaptive_load_new` in memory of the library, 0 for none. Both are copied and stay the
 * caller's. With both the learner is in the shadow of the model: it is used only while its
 * predictions have been the better ones. Free the handle with `hysteron_controller_free`.
 *
 * Settings that no loop can run with are `HYSTERON_CONTROL`; the text names the field.
 */
int32_t hysteron_controller_new(const struct HysteronControl *control,
                                uint64_t model,
                                uint64_t learner,
                                uint64_t *controller);

/**
 * Frees a controller.
 */
int32_t hysteron_controller_free(uint64_t controller);

/**
 * One sample of a loop that is closed: takes reference and readings, writes the drive to give. The
 * drive is finite and within its limits, whatever the readings are.
 *
 * `dt` is the measured time since the sample before, s, above 0; `NAN` for the interval of the
 * settings. `reference` is the output that is wanted now, `heading` the direction that the one
 * that is due takes next, as in `hysteron_inverse_step`. `next` has the references of the `count`
 * samples after this one; the inverse solves for the one that is due when this drive is seen to
 * act (`due` of `hysteron_controller_info`), or for the last one that it is told. It may be null
 * with `count` 0.
 *
 * `output` and `input` are readings; `NAN` for a sensor that gave nothing. `input` counts only with
 * `input_measured`. A reference that is not finite is refused, and nothing is changed.
 */
int32_t hysteron_controller_step(uint64_t controller,
                                 double dt,
                                 double reference,
                                 int32_t heading,
                                 const double *next,
                                 size_t count,
                                 double output,
                                 double input,
                                 struct HysteronAction *action);

/**
 * One sample of a loop that is open: gives a `command` without regard to the output. For manual
 * operation, recordings and step tests. Readings are as for `hysteron_controller_step`; limits and
 * slew hold.
 */
int32_t hysteron_controller_command(uint64_t controller,
                                    double dt,
                                    double command,
                                    double output,
                                    double input,
                                    struct HysteronAction *action);

/**
 * Goes on from `drive` at the next sample without a bump: from manual to automatic, and out of the
 * safe state. The integral begins so that the first drive is this one; what it cannot take fades
 * within ten samples.
 */
int32_t hysteron_controller_go_on_from(uint64_t controller, double drive);

/**
 * Tells that `drive` has acted up to the next reading, where that is not the drive of the last
 * sample: before the first sample, or where a drive was lost on its way.
 */
int32_t hysteron_controller_applied(uint64_t controller, double drive);

/**
 * Lets the model follow a sample that somebody else has answered: `drive` acted up to `output`,
 * which may be `NAN`. A run that goes on begins so.
 */
int32_t hysteron_controller_replay(uint64_t controller, double dt, double drive, double output);

/**
 * Gives the loop the weights of `model`, which were learned elsewhere: those of its fixed model, or
 * of a learner in its shadow that does not learn itself. What the operators remember stays, and the
 * drive does not jump. A model on another plane is `HYSTERON_CONTROL`.
 */
int32_t hysteron_controller_renew(uint64_t controller, uint64_t model);

/**
 * Makes a model with the weights that the loop has learned. Free it with `hysteron_model_free`.
 * `HYSTERON_CONTROL` where nothing learns weights.
 */
int32_t hysteron_controller_model(uint64_t controller, uint64_t *model);

/**
 * Writes what a controller is and knows.
 */
int32_t hysteron_controller_info(uint64_t controller, struct HysteronControllerInfo *info);

/**
 * The text of the last error in this thread, up to 1023 bytes.
 *
 * Copies as much of it as fits into the `size` bytes of `text`, with a zero byte at the end.
 * Returns the size of the whole text in bytes, with the zero byte. `text` may be null to ask for
 * the size.
 */
size_t hysteron_last_error(char *text, size_t size);

/**
 * Writes the limits that the inverse of `model` has where none are given. The drive stays within
 * that of the recording fitted, and the horizon is 0. A model without a thermal body has no
 * limits.
 */
int32_t hysteron_model_limits(uint64_t model, struct HysteronLimits *limits);

/**
 * Reads the model file at `path`. Free the handle with `hysteron_model_free`.
 */
int32_t hysteron_model_read(const char *path, uint64_t *model);

/**
 * Makes a model from the text of a model file.
 */
int32_t hysteron_model_parse(const char *json, uint64_t *model);

/**
 * Writes the model file to `path` and replaces a file of that name. After an error there is no
 * incomplete file.
 */
int32_t hysteron_model_write(uint64_t model, const char *path);

/**
 * Makes a model with `K` levels from `min` to `max`, in the input's unit, and `count = K(K + 1)/2`
 * weights, row by row: `j = 1…K`, within a row `i = 1…j`. Its output is `offset + sign · Σ μ γ`.
 * `sign` is 1 or −1.
 */
int32_t hysteron_model_new(int32_t operator_kind,
                           double min,
                           double max,
                           size_t levels,
                           const double *weights,
                           size_t count,
                           double offset,
                           int32_t sign,
                           uint64_t *model);

/**
 * Makes the model at one load from a model that depends on a load.
 */
int32_t hysteron_model_at_load(uint64_t model, double load, uint64_t *at_load);

/**
 * Frees a model. States of it stay valid.
 */
int32_t hysteron_model_free(uint64_t model);

/**
 * Writes what the model is.
 */
int32_t hysteron_model_info(uint64_t model, struct HysteronModelInfo *info);

/**
 * Writes what a model needs beside its input, and in which ranges.
 */
int32_t hysteron_model_needs(uint64_t model, struct HysteronModelNeeds *needs);

/**
 * Writes the dead time of a model in samples that are `dt` s apart, `NAN` for those of its
 * recording; 0 without one, at most 1000.
 *
 * An input that is given to a state, a lane or a learner acts so many samples later. Before the
 * first sample the input stood where it is first. The time step of the second sample tells how
 * many they are from there on. An inverse step gives the input at once that brings the target when
 * it arrives: its `target` is the one of so many samples later. It leaves nothing under way in its
 * state, so that forward steps need another one.
 */
int32_t hysteron_model_delay(uint64_t model, double dt, size_t *samples);

/**
 * Copies the weights, row by row. Of a model that depends on a load, they are those without its
 * curves, at the middle of the load range. `count` becomes their number, also if `capacity` is too
 * small.
 */
int32_t hysteron_model_weights(uint64_t model, double *weights, size_t capacity, size_t *count);

/**
 * Copies the name of the input (`quantity` 0), of the output (1) or of the load (2, of a model
 * that depends on one), and its unit in brackets if it has one, as in `"temperature [degC]"`.
 * Copies as much as fits into the `size` bytes of `text`, with a zero byte at the end. `needed`
 * becomes the size of the whole text in bytes, with the zero byte. `text` may be null with size 0.
 */
int32_t hysteron_model_quantity(uint64_t model, int32_t quantity, char *text, size_t size, size_t *needed);

/**
 * Writes the usual options for `model`.
 */
int32_t hysteron_shift_usual(uint64_t model, struct HysteronShiftOptions *options);

/**
 * Makes a state of `model`, as the fit found it before the first sample, or with all operators off
 * where it found none. The stages are at rest with the first sample. `model` may be freed
 * before the state.
 *
 * The model may have stages. Move the state by the functions
 * whose names end with `_in`, which take time and load. The others refuse what they cannot know.
 */
int32_t hysteron_state_new(uint64_t model, uint64_t *state);

/**
 * Size in bytes of the memory of a state of `model`, for `hysteron_state_place`. 0 if there is no
 * such model.
 */
size_t hysteron_state_size(uint64_t model);

/**
 * As `hysteron_state_new`, with the numbers of the state in `memory` of the caller, aligned like a
 * `uint64_t`. Steps, runs, saving and restoring then allocate nothing, also with errors. The state
 * has a copy of the weights.
 *
 * The memory belongs to the state until it is freed. An older object in it ends. Errors of time
 * and load have the codes `HYSTERON_TIME_STEP` and `HYSTERON_LOAD`.
 */
int32_t hysteron_state_place(uint64_t model, void *memory, size_t bytes, uint64_t *state);

/**
 * Frees a state. Memory of the caller stays the caller's.
 */
int32_t hysteron_state_free(uint64_t state);

/**
 * Switches all operators off, as at the bottom of the plane. The stages are at rest with the
 * next sample.
 */
int32_t hysteron_state_reset(uint64_t state);

/**
 * Switches all operators on, as at the top of the plane. The stages are at rest with the
 * next sample.
 */
int32_t hysteron_state_saturate(uint64_t state);

/**
 * Starts a state again: as a new one (`HYSTERON_START_FITTED`), with all operators off
 * (`HYSTERON_START_OFF`) or on (`HYSTERON_START_ON`). The stages are at rest with the
 * next sample.
 */
int32_t hysteron_state_start(uint64_t state, int32_t start);

/**
 * Saves the state: its turning points as normalised positions, at most `capacity`, and the last
 * input of the operators. A model with stages also needs `hysteron_state_save_stages`, one with a
 * dead time `hysteron_state_save_inputs`. `count` becomes the number of turning points, also if
 * `capacity` is too small.
 */
int32_t hysteron_state_save(uint64_t state, double *points, size_t capacity, size_t *count, double *input);

/**
 * Restores, bit for bit, what `hysteron_state_save` gave for a state of this model or of a model
 * with the same plane. The stages are at rest with the next sample, unless
 * `hysteron_state_restore_stages` comes after it.
 */
int32_t hysteron_state_restore(uint64_t state, const double *points, size_t count, double input);

/**
 * Saves what the stages remember. Together with `hysteron_state_save` it is the whole
 * state. A model without stages needs it not.
 */
int32_t hysteron_state_save_stages(uint64_t state, struct HysteronStageState *stages);

/**
 * Restores, bit for bit, what `hysteron_state_save_stages` gave. Call it after
 * `hysteron_state_restore`, which puts the stages at rest with the next sample.
 */
int32_t hysteron_state_restore_stages(uint64_t state, const struct HysteronStageState *stages);

/**
 * Saves the inputs that are under way: given, and not acting yet for the dead time of the model; at
 * most `capacity`, from the one that arrives next. A model without a dead time needs it not.
 * `count` becomes their number, also if `capacity` is too small.
 */
int32_t hysteron_state_save_inputs(uint64_t state, double *inputs, size_t capacity, size_t *count);

/**
 * Restores, bit for bit, what `hysteron_state_save_inputs` gave. Call it after
 * `hysteron_state_restore`, which leaves nothing under way. More inputs than the dead time has
 * samples are `HYSTERON_VALUE`.
 */
int32_t hysteron_state_restore_inputs(uint64_t state, const double *inputs, size_t count);

/**
 * Writes the temperature after the last sample: the input itself for a model without a thermal
 * body, and the bottom of the plane before the first sample.
 */
int32_t hysteron_state_temperature(uint64_t state, double *temperature);

/**
 * Writes how far the output may really be from the modelled one where the state is, in the
 * output's unit: half the width of the model's 95 % band, or 1.96 times its error on what was held
 * out of its fit, whichever is wider. `NAN` for a model that has neither. After an inverse step it
 * says how far the target may be missed that the status reports as reached.
 */
int32_t hysteron_state_half_width(uint64_t state, double *half_width);

/**
 * Moves to `input` and writes the output. `clipped` becomes `HYSTERON_INSIDE`, or `HYSTERON_LOW`
 * or `HYSTERON_HIGH` for an input of the operators outside the plane. It may be null.
 */
int32_t hysteron_step(uint64_t state, double input, double *output, int32_t *clipped);

/**
 * As `hysteron_step`, for any model.
 *
 * `input` is the one held since the sample before. `dt` is the time since that sample in seconds,
 * from 0; a model that depends on time needs it from its second sample on. `load` is the load,
 * which a model that depends on one needs within its range. `NAN` for a `dt` or a `load` that is
 * not given. `hysteron_model_needs` says what a model needs.
 */
int32_t hysteron_step_in(uint64_t state, double input, double dt, double load, double *output, int32_t *clipped);

/**
 * Moves through `count` inputs and writes as many outputs. The arrays must not overlap. After an
 * error the state stays as it is, and of an input that is not finite the outputs, too.
 */
int32_t hysteron_run(uint64_t state, const double *input, double *output, size_t count);

/**
 * As `hysteron_run`, for any model. After any error the state stays as it is.
 *
 * `time` has the time of each sample in seconds, and `load` its load; each has `count` elements or
 * is null. `last_time` is the time of the sample before the first one. It is `NAN` for a new
 * state, whose first sample has none before it. `clipped` has `count` elements as in
 * `hysteron_step`, or is null.
 */
int32_t hysteron_run_in(uint64_t state,
                        const double *input,
                        const double *time,
                        double last_time,
                        const double *load,
                        double *output,
                        int32_t *clipped,
                        size_t count);

/**
 * Finds the input that gives `target` and moves the state there. `status` becomes
 * `HYSTERON_INSIDE` if the input gives the target, otherwise `HYSTERON_LOW`, `HYSTERON_HIGH`,
 * `HYSTERON_PASSED` or `HYSTERON_LIMITED`.
 *
 * `heading` is `HYSTERON_HOLD` to hold the target, or the direction in which the target goes next,
 * `HYSTERON_RISING` or `HYSTERON_FALLING`, to anticipate it. A target that goes back by up to
 * `tolerance`, in the output's unit, is held.
 */
int32_t hysteron_inverse_step(uint64_t state,
                              double target,
                              int32_t heading,
                              double tolerance,
                              double *input,
                              int32_t *status);

/**
 * As `hysteron_inverse_step`, for any model. `dt` and `load` are as for `hysteron_step_in`.
 *
 * With a thermal body `input` becomes the drive to hold since the sample before. `limits` may be
 * null for those of the model itself (`hysteron_model_limits`). `status` is `HYSTERON_LIMITED`
 * where the model can give the target, but not in this sample. The state goes where the drive
 * takes it.
 */
int32_t hysteron_inverse_step_in(uint64_t state,
                                 double target,
                                 int32_t heading,
                                 double tolerance,
                                 double dt,
                                 double load,
                                 const struct HysteronLimits *limits,
                                 double *input,
                                 int32_t *status);

/**
 * Finds the inputs for `count` targets, one after the other, and moves the state through them.
 * `heading` has `count` elements as in `hysteron_inverse_step`, or is null for `HYSTERON_HOLD`.
 * `status` has `count` elements, or is null. Arrays must not overlap. If a target or a heading is
 * not valid, the state stays as it is.
 */
int32_t hysteron_inverse_run(uint64_t state,
                             const double *target,
                             const int32_t *heading,
                             double tolerance,
                             double *input,
                             int32_t *status,
                             size_t count);

/**
 * As `hysteron_inverse_run`, for any model. `time`, `last_time` and `load` are as for
 * `hysteron_run_in`, `limits` as for `hysteron_inverse_step_in`. After any error the state stays
 * as it is.
 */
int32_t hysteron_inverse_run_in(uint64_t state,
                                const double *target,
                                const int32_t *heading,
                                double tolerance,
                                const double *time,
                                double last_time,
                                const double *load,
                                const struct HysteronLimits *limits,
                                double *input,
                                int32_t *status,
                                size_t count);

/**
 * Writes where each of `count` targets goes next, for `hysteron_inverse_run`: `HYSTERON_RISING` or
 * `HYSTERON_FALLING`, or `HYSTERON_HOLD` if the series never moves. Reversals of up to `tolerance`
 * are noise.
 */
int32_t hysteron_headings(const double *target, size_t count, double tolerance, int32_t *heading);

/**
 * Fills in the usual options, of the method that `method` names.
 *
 * Three cannot follow from a model here: `noise` is 0.01, `spread` 1 and `offset_share` 1. Set
 * them in the output's unit; `docs/options.md` says how the library chooses them.
 */
int32_t hysteron_adaptation_default(int32_t method, struct HysteronAdaptation *options);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HYSTERON_H */

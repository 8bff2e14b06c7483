/* The C interface of hysteron: models of hysteresis, their exact inverse, and adaptation.
 *
 * Made from the code by `cargo run -p hysteron-capi --example header`: not to be edited.
 *
 * Every function that can fail returns HYSTERON_OK or another of the codes below; outputs are written only with HYSTERON_OK, but
 * for counts that say how much room is needed, and arrays, which may then hold zeros. Pointers point to as many elements as the
 * count beside them says. No two of a call may share memory: HYSTERON_OVERLAP, and nothing is written.
 * Handles (uint64_t) are numbers: one that was freed, or never given, is refused.
 * Functions `hysteron_core_...` allocate nothing: their objects lie in the caller's memory, must not be moved, and
 * end with it. Where an initialisation fails in memory that holds an object, that object is as it was, or refused from
 * then on: HYSTERON_HANDLE. Their outputs are the sum over the operators, without offset and sign. An object that a call
 * changes belongs to one thread at a time there; handles may be used from any thread.
 */

#ifndef HYSTERON_H
#define HYSTERON_H

#include <stddef.h>
#include <stdint.h>

/**
 * All is well.
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
 * Not as many weights as `K(K + 1)/2`.
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
 * A state was used with another model than the one that made it.
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
 * A file cannot be read or written.
 */
#define HYSTERON_FILE 20

/**
 * A model file says something that cannot be.
 */
#define HYSTERON_MODEL_FILE 21

/**
 * A recording cannot be used as it is.
 */
#define HYSTERON_RECORDING 22

/**
 * Model or options do not allow this.
 */
#define HYSTERON_FIT 23

/**
 * A filter's arguments do not fit the data.
 */
#define HYSTERON_FILTER 24

/**
 * The virtual rig was asked for something outside its physics.
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
 * A thermal body cannot be run here.
 */
#define HYSTERON_THERMAL 28

/**
 * A scenario says something that cannot be.
 */
#define HYSTERON_SCENARIO 29

/**
 * A controller cannot be made as told.
 */
#define HYSTERON_CONTROL 30

/**
 * A model cannot be carried to where it should run.
 */
#define HYSTERON_EXPORT 31

/**
 * A null pointer was passed where there must be none.
 */
#define HYSTERON_NULL 100

/**
 * No such handle or object: never made, freed already, or of another kind.
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
 * Memory is not aligned to what it shall hold.
 */
#define HYSTERON_ALIGNMENT 104

/**
 * Arrays overlap that must not.
 */
#define HYSTERON_OVERLAP 105

/**
 * A defect of this library, caught at its boundary.
 */
#define HYSTERON_INTERNAL 106

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
 * Policy of the inverse: the input stands still while the target does.
 */
#define HYSTERON_HOLD 0

/**
 * Policy of the inverse: the target rises next, so that a dead band is crossed at once.
 */
#define HYSTERON_RISING 1

/**
 * Policy of the inverse: the target falls next, so that a dead band is crossed at once.
 */
#define HYSTERON_FALLING -1

/**
 * Within reach, or inside the plane.
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
 * The target lies inside a jump of a relay model: the output lies beyond it.
 */
#define HYSTERON_PASSED 2

/**
 * Method of adaptation: normalised gradient.
 */
#define HYSTERON_GRADIENT 0

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
 * Outcome of a sample: the error was within the dead zone, or an increment is not finished.
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
 * Outcome of a sample: the reading differs too much from what was expected, and has not done so
 * for long.
 */
#define HYSTERON_REJECTED 5

/**
 * An estimator in the caller's memory.
 */
typedef struct HysteronCoreEstimator HysteronCoreEstimator;

/**
 * A model in the caller's memory.
 */
typedef struct HysteronCoreModel HysteronCoreModel;

/**
 * A state in the caller's memory.
 */
typedef struct HysteronCoreState HysteronCoreState;

/**
 * Options of adaptation; `hysteron_adaptation_default` fills in the usual ones.
 */
typedef struct HysteronAdaptation {
  /**
   * `HYSTERON_GRADIENT`, `HYSTERON_INCREMENTS` or `HYSTERON_LEAST_SQUARES`.
   */
  int32_t method;
  /**
   * Samples learned from on which weights are judged, from 1.
   */
  uint32_t trial;
  /**
   * Gradient and increments: share of the error that is taken away, above 0 and below 2.
   */
  double gain;
  /**
   * Increments: levels from the beginning of one to its end, 1/8 to 8.
   */
  double span;
  /**
   * Least squares: above 0 and up to 1, which forgets nothing.
   */
  double forgetting;
  /**
   * Least squares: standard deviation of a reading's error, in the output's unit; above 0.
   */
  double noise;
  /**
   * Least squares: standard deviation of a weight from the one at the start; above 0.
   */
  double spread;
  /**
   * Least squares: levels over which deviations of weights go together, from 0.
   */
  double correlation;
  /**
   * How freely the offset moves, beside one weight, from 0.
   */
  double offset_share;
  /**
   * Errors up to this are noise, in the output's unit, from 0.
   */
  double dead_zone;
  /**
   * Share by which weights return to those at the start with each update, 0 to 1.
   */
  double leakage;
  /**
   * Levels between two samples that are learned from, from 0.
   */
  double movement;
  /**
   * How many times the usual surprise a reading may be off to be learned from, from 2; 0: any.
   */
  double gate;
  /**
   * Readings in a row beyond the gate that are learned from, where they agree, from 1.
   */
  uint32_t burst;
} HysteronAdaptation;

/**
 * What a sample taught.
 */
typedef struct HysteronLearning {
  /**
   * Output that was expected before anything was learned from the sample.
   */
  double output;
  /**
   * Measured less expected.
   */
  double error;
  /**
   * `HYSTERON_LEARNED` and so on.
   */
  int32_t outcome;
  /**
   * Where the input lay: `HYSTERON_INSIDE`, `HYSTERON_LOW` or `HYSTERON_HIGH`.
   */
  int32_t clipped;
} HysteronLearning;

/**
 * What a model is.
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
   * `K`.
   */
  size_t levels;
  /**
   * `N = K(K + 1)/2`.
   */
  size_t weights;
  /**
   * Lowest level, in the input's unit.
   */
  double min;
  /**
   * Highest level.
   */
  double max;
  /**
   * One step below the lowest level, where every operator is off.
   */
  double bottom;
  /**
   * What is added to the sum of the operators.
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
   * Reversals of a target that count as noise where nobody says otherwise: 1 % of the output's range.
   */
  double usual_tolerance;
} HysteronModelInfo;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Adapts all weights of `model`, and its offset; `options` may be null for the usual ones.
 */
int32_t hysteron_adaptive_new(uint64_t model, const struct HysteronAdaptation *options, uint64_t *adaptive);

/**
 * Frees it.
 */
int32_t hysteron_adaptive_free(uint64_t adaptive);

/**
 * Moves to `input`, tells the output expected there, and learns from the one `measured`.
 */
int32_t hysteron_adaptive_step(uint64_t adaptive, double input, double measured, struct HysteronLearning *learning);

/**
 * Moves to `input` and tells the output expected there, without learning.
 */
int32_t hysteron_adaptive_predict(uint64_t adaptive, double input, double *output);

/**
 * As `hysteron_inverse_step`, by the weights as they are now. It moves a state of its own, apart from the one that follows the
 * plant, which begins with all operators off.
 */
int32_t hysteron_adaptive_inverse_step(uint64_t adaptive,
                                       double target,
                                       int32_t heading,
                                       double tolerance,
                                       double *input,
                                       int32_t *status);

/**
 * The model as it is now: a model of its own, to be freed with `hysteron_model_free`.
 */
int32_t hysteron_adaptive_model(uint64_t adaptive, uint64_t *model);

/**
 * All operators off, those of the inverse too; the weights stay.
 */
int32_t hysteron_adaptive_reset(uint64_t adaptive);

/**
 * While frozen (not 0), nothing is learned.
 */
int32_t hysteron_adaptive_freeze(uint64_t adaptive, int32_t frozen);

/**
 * Takes the present weights as the last good ones.
 */
int32_t hysteron_adaptive_keep(uint64_t adaptive);

/**
 * Goes back to the last good weights.
 */
int32_t hysteron_adaptive_roll_back(uint64_t adaptive);

/**
 * The text of a status code: valid for ever, never null. What was wrong in particular says `hysteron_last_error`.
 */
const char *hysteron_error_message(int32_t code);

/**
 * The version of this library, for example "0.1.0".
 */
const char *hysteron_version(void);

/**
 * Bytes for an estimator of a model of `levels` levels; 0 where there is none. Aligned as a `uint64_t` is.
 */
size_t hysteron_core_estimator_size(size_t levels, const struct HysteronAdaptation *options);

/**
 * Makes an estimator of all weights of `model`, and of an offset beside it, from those given, which the model takes too:
 * states made before are to be brought up to date with `hysteron_core_state_rebase`, or made after this.
 */
int32_t hysteron_core_estimator_init(struct HysteronCoreModel *model,
                                     const struct HysteronAdaptation *options,
                                     const double *weights,
                                     size_t count,
                                     double offset,
                                     void *memory,
                                     size_t bytes,
                                     struct HysteronCoreEstimator **estimator);

/**
 * Moves `state` to `input`, tells the output that `model` and offset expect there, and learns from the one `measured`. A state
 * made before the weights changed is brought up to date; others of this model are refused until then.
 */
int32_t hysteron_core_estimator_step(struct HysteronCoreEstimator *estimator,
                                     struct HysteronCoreModel *model,
                                     struct HysteronCoreState *state,
                                     double input,
                                     double measured,
                                     struct HysteronLearning *learning);

/**
 * The offset as it is now.
 */
int32_t hysteron_core_estimator_offset(const struct HysteronCoreEstimator *estimator, double *offset);

/**
 * While frozen (not 0), nothing is learned.
 */
int32_t hysteron_core_estimator_freeze(struct HysteronCoreEstimator *estimator, int32_t frozen);

/**
 * Brings a state of `model` up to date with weights that an estimator has changed: for the state of an inverse beside the
 * one that follows the plant.
 */
int32_t hysteron_core_state_rebase(const struct HysteronCoreModel *model,
                                   struct HysteronCoreState *state);

/**
 * What was wrong with the last call that failed in this thread (functions `hysteron_core_…` leave no text).
 *
 * Copies as much as fits into `text`, of `size` bytes, with a zero byte at the end, and returns the bytes that the whole
 * takes with that zero. With a null pointer it only tells the size.
 */
size_t hysteron_last_error(char *text,
                           size_t size);

/**
 * Bytes for a model of `levels` levels with 1 table, or with the 2 that adaptation by increments needs; 0 where there is no
 * such model. The memory has to be aligned as a `uint64_t` is.
 */
size_t hysteron_core_model_size(size_t levels,
                                size_t tables);

/**
 * Makes a model in `memory`; the weights as for `hysteron_model_new`, and not needed afterwards.
 */
int32_t hysteron_core_model_init(void *memory,
                                 size_t bytes,
                                 int32_t operator_kind,
                                 double min,
                                 double max,
                                 size_t levels,
                                 const double *weights,
                                 size_t count,
                                 struct HysteronCoreModel **model);

/**
 * Bytes for a state of a model of `levels` levels; 0 where there is no such model. Aligned as a `uint64_t` is.
 */
size_t hysteron_core_state_size(size_t levels);

/**
 * Makes a state of `model` in `memory`, all operators off.
 */
int32_t hysteron_core_state_init(const struct HysteronCoreModel *model,
                                 void *memory,
                                 size_t bytes,
                                 struct HysteronCoreState **state);

/**
 * All operators off.
 */
int32_t hysteron_core_state_reset(const struct HysteronCoreModel *model, struct HysteronCoreState *state);

/**
 * Moves to `input` and gives `Σ μ γ`; `clipped` may be null.
 */
int32_t hysteron_core_step(const struct HysteronCoreModel *model,
                           struct HysteronCoreState *state,
                           double input,
                           double *output,
                           int32_t *clipped);

/**
 * As `hysteron_run`.
 */
int32_t hysteron_core_run(const struct HysteronCoreModel *model,
                          struct HysteronCoreState *state,
                          const double *input,
                          double *output,
                          size_t count);

/**
 * As `hysteron_inverse_step`.
 */
int32_t hysteron_core_inverse_step(const struct HysteronCoreModel *model,
                                   struct HysteronCoreState *state,
                                   double target,
                                   int32_t heading,
                                   double tolerance,
                                   double *input,
                                   int32_t *status);

/**
 * As `hysteron_state_save`.
 */
int32_t hysteron_core_state_save(const struct HysteronCoreState *state,
                                 double *points,
                                 size_t capacity,
                                 size_t *count,
                                 double *input);

/**
 * As `hysteron_state_restore`.
 */
int32_t hysteron_core_state_restore(const struct HysteronCoreModel *model,
                                    struct HysteronCoreState *state,
                                    const double *points,
                                    size_t count,
                                    double input);

/**
 * Reads a model file. The handle is to be freed with `hysteron_model_free`.
 */
int32_t hysteron_model_read(const char *path, uint64_t *model);

/**
 * Takes the text of a model file.
 */
int32_t hysteron_model_parse(const char *json, uint64_t *model);

/**
 * Writes the model file, whole or not at all; one that is there already is replaced.
 */
int32_t hysteron_model_write(uint64_t model, const char *path);

/**
 * A model of `count = K(K + 1)/2` weights, row by row: `j = 1…K`, within a row `i = 1…j`; `K` levels from `min` to `max`.
 * Its output is `offset + sign · Σ μ γ`, the sign 1 or −1.
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
 * The model at one load, of a model that depends on a load: a model of its own.
 */
int32_t hysteron_model_at_load(uint64_t model, double load, uint64_t *at_load);

/**
 * Frees a model. States made of it stay as they are.
 */
int32_t hysteron_model_free(uint64_t model);

/**
 * What the model is.
 */
int32_t hysteron_model_info(uint64_t model, struct HysteronModelInfo *info);

/**
 * Copies the weights. `count` becomes their number, also where `capacity` is too small for them.
 */
int32_t hysteron_model_weights(uint64_t model, double *weights, size_t capacity, size_t *count);

/**
 * Copies what the input (`quantity` 0) or the output (1) is: its name, and its unit in brackets where it has one, as in
 * `"temperature [degC]"`. As much as fits into `text`, of `size` bytes, with a zero byte at the end; `needed` becomes the bytes that
 * the whole takes with that zero, and `text` may be null with size 0.
 */
int32_t hysteron_model_quantity(uint64_t model,
                                int32_t quantity,
                                char *text,
                                size_t size,
                                size_t *needed);

/**
 * A state of `model`, all operators off. It keeps what it needs of the model, which may be freed before it.
 *
 * A model that depends on a load, or has a thermal body in front, has no state: take it at one load.
 */
int32_t hysteron_state_new(uint64_t model, uint64_t *state);

/**
 * Frees a state.
 */
int32_t hysteron_state_free(uint64_t state);

/**
 * All operators off, as at the bottom of the plane.
 */
int32_t hysteron_state_reset(uint64_t state);

/**
 * All operators on, as at the top of the plane.
 */
int32_t hysteron_state_saturate(uint64_t state);

/**
 * Moves to `input` and gives the output; `clipped`, which may be null, says whether the input lay outside the plane:
 * `HYSTERON_INSIDE`, `HYSTERON_LOW` or `HYSTERON_HIGH`.
 */
int32_t hysteron_step(uint64_t state, double input, double *output, int32_t *clipped);

/**
 * Moves through `count` inputs and writes as many outputs; the arrays must not overlap. Where one input is not finite, the state
 * stays as it was.
 */
int32_t hysteron_run(uint64_t state,
                     const double *input,
                     double *output,
                     size_t count);

/**
 * Finds the input that gives `target`, moves the state there, and says whether it reaches the target: `HYSTERON_INSIDE`,
 * `HYSTERON_LOW`, `HYSTERON_HIGH` or `HYSTERON_PASSED`.
 *
 * `heading` is the policy: `HYSTERON_HOLD`, or `HYSTERON_RISING` or `HYSTERON_FALLING` where the target goes next; `tolerance`
 * how far a target may go back and still stand still, in the output's unit.
 */
int32_t hysteron_inverse_step(uint64_t state,
                              double target,
                              int32_t heading,
                              double tolerance,
                              double *input,
                              int32_t *status);

/**
 * Finds the inputs for `count` targets, one after the other, and moves the state through them. `heading` has as many elements,
 * each as in `hysteron_inverse_step`, or is null for `HYSTERON_HOLD` throughout; so has `status`, which may be null. No array may
 * overlap another. Where one target or heading cannot be, the state stays as it was.
 */
int32_t hysteron_inverse_run(uint64_t state,
                             const double *target,
                             const int32_t *heading,
                             double tolerance,
                             double *input,
                             int32_t *status,
                             size_t count);

/**
 * Where each of `count` targets goes next, for `hysteron_inverse_run`: `HYSTERON_RISING` or `HYSTERON_FALLING`, `HYSTERON_HOLD` where
 * the series never moves. Reversals of up to `tolerance` are noise.
 */
int32_t hysteron_headings(const double *target,
                          size_t count,
                          double tolerance,
                          int32_t *heading);

/**
 * Saves the state: its turning points, at most `capacity`, and the last input. `count` becomes the number of turning points,
 * also where `capacity` is too small for them.
 */
int32_t hysteron_state_save(uint64_t state,
                            double *points,
                            size_t capacity,
                            size_t *count,
                            double *input);

/**
 * Puts back what `hysteron_state_save` gave, of a state of this model or of one with the same plane: bit for bit.
 */
int32_t hysteron_state_restore(uint64_t state, const double *points, size_t count, double input);

/**
 * Fills in the usual options, of the method that `method` names.
 */
int32_t hysteron_adaptation_default(int32_t method, struct HysteronAdaptation *options);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* HYSTERON_H */

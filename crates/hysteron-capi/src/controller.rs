//! Controllers by handle: those of the library, `hysteron::control::Controller`.

use crate::control::{HysteronAction, HysteronControl};
use crate::fault::{Result, guard};
use crate::handles::Table;
use crate::model::MODELS;
use crate::objects::{LEARNERS, Object};
use crate::pointer::Arguments;
use crate::types;
use crate::types::given;
use hysteron::control::{Compensator, Controller, Reading, Reference};

/// A controller, and whether a sensor measures the input.
struct Running {
    controller: Controller,
    input_measured: bool,
}

static CONTROLLERS: Table<Object<Running>> = Table::new(6);

/// Calls `work` with a controller, in a function without pointers.
fn with(controller: u64, work: impl FnOnce(&mut Running) -> Result<()>) -> i32 {
    guard(|| CONTROLLERS.with(controller, "controller", &mut Arguments::default(), work))
}

impl Running {
    fn dt(&self, dt: f64) -> f64 {
        given(dt).unwrap_or(self.controller.interval_s())
    }

    /// NaN stands for a sensor that gave nothing.
    fn reading(&self, output: f64, input: f64) -> Reading {
        Reading {
            output,
            input: self.input_measured.then_some(input),
        }
    }
}

/// What a controller is and knows beside its samples.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronControllerInfo {
    /// Time between samples, s.
    pub interval_s: f64,
    /// The safe drive: zero, or the one within the limits that is nearest.
    pub rest_drive: f64,
    /// How long the output has stood still where it has to move, s. `NAN` where its sensor works.
    pub stuck_s: f64,
    /// Samples until a drive moves the output that is read: how far ahead the reference is needed.
    pub due: usize,
    /// 1 while the predictions of a learner beside a fixed model are used, else 0.
    pub trusts_learner: i32,
}

/// Makes a controller: a model and its inverse, feedback, or both. It is at rest.
///
/// `model` is a fixed model, 0 for none. `learner` is one of `hysteron_adaptive_new` or
/// `hysteron_adaptive_load_new` in memory of the library, 0 for none. Both are copied and stay the
/// caller's. With both the learner is in the shadow of the model: it is used only while its
/// predictions have been the better ones. Free the handle with `hysteron_controller_free`.
///
/// Settings that no loop can run with are `HYSTERON_CONTROL`; the text names the field.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_controller_new(
    control: *const HysteronControl,
    model: u64,
    learner: u64,
    controller: *mut u64,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate; every bit pattern is a value of each field.
        let (out, control) = unsafe {
            (
                arguments.out(controller, "controller")?,
                arguments.value(control, "control")?,
            )
        };
        let model = match model {
            0 => None,
            model => Some(MODELS.get(model, "model")?),
        };
        let learner = match learner {
            0 => None,
            learner => Some(
                LEARNERS.with(learner, "learner", &mut arguments, |learner| {
                    learner.in_loop()
                })?,
            ),
        };
        let compensator = match (model, learner) {
            (None, learner) => learner,
            (Some(model), None) => Some(Compensator::fixed(&model)?),
            (Some(model), Some(learner)) => Some(Compensator::shadowed(&model, learner)?),
        };
        let mut scheme = control.scheme()?;
        scheme.compensator = compensator;
        let running = Box::new(Running {
            controller: Controller::new(scheme)?,
            input_measured: control.input_measured()?,
        });
        out.set(CONTROLLERS.insert(running.into())?);
        Ok(())
    })
}

/// Frees a controller.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_controller_free(controller: u64) -> i32 {
    guard(|| CONTROLLERS.remove(controller, "controller"))
}

/// One sample of a loop that is closed: takes reference and readings, writes the drive to give. The
/// drive is finite and within its limits, whatever the readings are.
///
/// `dt` is the measured time since the sample before, s, above 0; `NAN` for the interval of the
/// settings. `reference` is the output that is wanted now, `heading` the direction that the one
/// that is due takes next, as in `hysteron_inverse_step`. `next` has the references of the `count`
/// samples after this one; the inverse solves for the one that is due when this drive is seen to
/// act (`due` of `hysteron_controller_info`), or for the last one that it is told. It may be null
/// with `count` 0.
///
/// `output` and `input` are readings; `NAN` for a sensor that gave nothing. `input` counts only with
/// `input_measured`. A reference that is not finite is refused, and nothing is changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_controller_step(
    controller: u64,
    dt: f64,
    reference: f64,
    heading: i32,
    next: *const f64,
    count: usize,
    output: f64,
    input: f64,
    action: *mut HysteronAction,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let (next, action) = unsafe {
            (
                arguments.array(next, count, "next")?,
                arguments.out(action, "action")?,
            )
        };
        let target = types::target(reference, heading, 0.0)?;
        let target = Reference {
            output: target.output,
            heading: target.heading,
        };
        CONTROLLERS.with(controller, "controller", &mut arguments, |running| {
            let (dt, reading) = (running.dt(dt), running.reading(output, input));
            let answered = running.controller.step_after(dt, target, next, reading)?;
            action.set(answered.into());
            Ok(())
        })
    })
}

/// One sample of a loop that is open: gives a `command` without regard to the output. For manual
/// operation, recordings and step tests. Readings are as for `hysteron_controller_step`; limits and
/// slew hold.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_controller_command(
    controller: u64,
    dt: f64,
    command: f64,
    output: f64,
    input: f64,
    action: *mut HysteronAction,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let action = unsafe { arguments.out(action, "action")? };
        CONTROLLERS.with(controller, "controller", &mut arguments, |running| {
            let (dt, reading) = (running.dt(dt), running.reading(output, input));
            let answered = running
                .controller
                .step_command_after(dt, command, reading)?;
            action.set(answered.into());
            Ok(())
        })
    })
}

/// Goes on from `drive` at the next sample without a bump: from manual to automatic, and out of the
/// safe state. The integral begins so that the first drive is this one; what it cannot take fades
/// within ten samples.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_controller_go_on_from(controller: u64, drive: f64) -> i32 {
    with(controller, |running| {
        Ok(running.controller.go_on_from(drive)?)
    })
}

/// Tells that `drive` has acted up to the next reading, where that is not the drive of the last
/// sample: before the first sample, or where a drive was lost on its way.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_controller_applied(controller: u64, drive: f64) -> i32 {
    with(controller, |running| {
        Ok(running.controller.applied(drive)?)
    })
}

/// Lets the model follow a sample that somebody else has answered: `drive` acted up to `output`,
/// which may be `NAN`. A run that goes on begins so.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_controller_replay(
    controller: u64,
    dt: f64,
    drive: f64,
    output: f64,
) -> i32 {
    with(controller, |running| {
        let dt = running.dt(dt);
        Ok(running.controller.replay(dt, drive, output)?)
    })
}

/// Gives the loop the weights of `model`, which were learned elsewhere: those of its fixed model, or
/// of a learner in its shadow that does not learn itself. What the operators remember stays, and the
/// drive does not jump. A model on another plane is `HYSTERON_CONTROL`.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_controller_renew(controller: u64, model: u64) -> i32 {
    with(controller, |running| {
        let model = MODELS.get(model, "model")?;
        Ok(running.controller.renew(&model)?)
    })
}

/// Makes a model with the weights that the loop has learned. Free it with `hysteron_model_free`.
/// `HYSTERON_CONTROL` where nothing learns weights.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_controller_model(controller: u64, model: *mut u64) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let model = unsafe { arguments.out(model, "model")? };
        CONTROLLERS.with(controller, "controller", &mut arguments, |running| {
            let learned = running
                .controller
                .compensator()
                .and_then(Compensator::learned);
            let nothing = || hysteron::Error::Control("nothing learns weights in this loop".into());
            model.set(MODELS.insert(learned.ok_or_else(nothing)?)?);
            Ok(())
        })
    })
}

/// Writes what a controller is and knows.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_controller_info(
    controller: u64,
    info: *mut HysteronControllerInfo,
) -> i32 {
    guard(|| {
        let mut arguments = Arguments::default();
        // SAFETY: the contract of the crate.
        let info = unsafe { arguments.out(info, "info")? };
        CONTROLLERS.with(controller, "controller", &mut arguments, |running| {
            let controller = &running.controller;
            let trusts = |compensator: &Compensator| compensator.trusts_learner();
            info.set(HysteronControllerInfo {
                interval_s: controller.interval_s(),
                rest_drive: controller.rest_drive(),
                stuck_s: controller.stuck_s().unwrap_or(f64::NAN),
                due: controller.due(),
                trusts_learner: controller.compensator().is_some_and(trusts).into(),
            });
            Ok(())
        })
    })
}

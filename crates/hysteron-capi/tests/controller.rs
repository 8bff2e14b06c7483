//! A controller behind a handle does what the library's does, sample by sample and bit for bit.
#![allow(clippy::unwrap_used)]

mod whole;

use hysteron::control::{
    Compensator, Controller, Gains, InnerLoop, Reading, Reference, Safety, Scheme,
};
use hysteron::{Adaptation, Adaptive, AdaptiveLoad, Direction, Method, Model, Policy};
use hysteron_capi::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ffi::CString;
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use whole::WHOLE;

const NONE: f64 = f64::NAN;
const PLAIN: &str = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    "plane": {"min": 0.2, "max": 1.0, "levels": 5}, "output": {"offset": 1.0, "sign": -1},
    "weights": [1, 2, 1, 0.5, 0.25, 1, 0, 0.5, 1, 1, 1, 0.5, 0.75, 0.25, 1]}"#;
/// Behind a body, a creep and a dead time.
const STAGED: &str = r#"{"format": "hysteron-model", "version": 4, "operator": "kp",
    "plane": {"min": 30.0, "max": 60.0, "levels": 3}, "weights": [1, 2, 1, 0.5, 0.25, 1],
    "thermal": {"kind": "first-order", "ambient": 20.0, "gain": 100.0, "tau_heating": 0.4,
        "tau_cooling": 0.8},
    "creep": [{"coefficient": 0.02, "tau": 1.0}],
    "drive": {"min": 0.0, "max": 1.0}, "delay": {"samples": 3, "interval_s": 0.05}}"#;

fn ok(code: i32) {
    assert_eq!(code, HYSTERON_OK);
}

fn parsed(text: &str) -> u64 {
    let (text, mut handle) = (CString::new(text).unwrap(), 0);
    // SAFETY: live memory.
    ok(unsafe { hysteron_model_parse(text.as_ptr(), &mut handle) });
    handle
}

/// What learns in a loop.
#[derive(Clone, Copy, Debug)]
enum Learner {
    None,
    Alone,
    Shadow,
    Load,
}

/// The same controller twice: of the library, and behind a handle.
struct Pair {
    library: Controller,
    handle: u64,
    measured: bool,
    /// The range of the outputs, from the lowest.
    outputs: (f64, f64),
}

const LEAST_SQUARES: Method<f64> = Method::LeastSquares {
    forgetting: 0.999,
    noise: 0.01,
    spread: 1.0,
    correlation: 1.0,
};

fn learner_handle(model: u64, learner: Learner) -> u64 {
    let mut handle = 0;
    // SAFETY: all fields are numbers, and live memory.
    unsafe {
        let mut options: HysteronAdaptation = zeroed();
        ok(hysteron_adaptation_default(
            HYSTERON_LEAST_SQUARES,
            &mut options,
        ));
        match learner {
            Learner::None => return 0,
            Learner::Load => ok(hysteron_adaptive_load_new(model, NONE, null(), &mut handle)),
            _ => ok(hysteron_adaptive_new(model, &options, &mut handle)),
        }
    }
    handle
}

fn compensator(model: &Model, learner: Learner) -> Compensator {
    let options = Adaptation {
        method: LEAST_SQUARES,
        ..Adaptation::default()
    };
    let adaptive = || Compensator::adaptive(Adaptive::new(model, options).unwrap());
    match learner {
        Learner::None => Compensator::fixed(model).unwrap(),
        Learner::Alone => adaptive(),
        Learner::Shadow => Compensator::shadowed(model, adaptive()).unwrap(),
        Learner::Load => Compensator::load(AdaptiveLoad::new(model, None, None).unwrap()),
    }
}

fn number(value: Option<f64>) -> f64 {
    value.unwrap_or(NONE)
}

fn pair(random: &mut StdRng, text: Option<&str>, learner: Learner) -> Pair {
    let model = text.map(|text| Model::from_json(text).unwrap());
    let (off, on) = model.as_ref().map_or((0.0, 5.0), Model::output_range);
    let outputs = (off.min(on), off.max(on));
    let slope = 1.0 / (on - off);
    let some = |random: &mut StdRng, low: f64, high: f64| {
        let value = random.random_range(low..high);
        random.random_bool(0.5).then_some(value)
    };
    let gains = |random: &mut StdRng, scale: f64| Gains {
        gain: scale * random.random_range(0.0..1.0),
        integral_s: some(random, 0.1, 2.0).unwrap_or(0.0),
        derivative_s: some(random, 0.01, 0.2).unwrap_or(0.0),
    };
    // Where a sensor measures a temperature, the command is one.
    let inner = text.is_none() && random.random_bool(0.5);
    let commands = if inner { (20.0, 80.0) } else { (0.0, 1.0) };
    let scheme = Scheme {
        compensator: model.as_ref().map(|model| compensator(model, learner)),
        policy: [Policy::Hold, Policy::Anticipate][random.random_range(0..2)],
        tolerance: 0.01 * (outputs.1 - outputs.0),
        pid: random.random_bool(0.7).then(|| gains(random, slope)),
        bias: random.random_range(commands.0..commands.1),
        drives: (0.0, 1.0),
        inner: inner.then(|| InnerLoop {
            gains: gains(random, 0.05),
            square_root: random.random_bool(0.5),
        }),
        filter_s: some(random, 0.01, 0.3).unwrap_or(0.0),
        stuck_s: some(random, 0.1, 0.5),
        gate: some(random, 0.001, 0.2),
        slew: some(random, 0.2, 5.0),
        delay: random.random_bool(0.5).then(|| random.random_range(0..6)),
        safety: Safety {
            lost_s: some(random, 0.2, 0.5),
            stuck_s: some(random, 0.2, 0.5),
        },
        ..Scheme::new(0.05, commands)
    };
    let measured = inner || (model.is_none() && random.random_bool(0.3));
    let (pid, inner) = (scheme.pid, scheme.inner);
    let (pid_numbers, inner_numbers) = (numbers(pid), numbers(inner.map(|inner| inner.gains)));
    let control = HysteronControl {
        interval_s: 0.05,
        drive_min: 0.0,
        drive_max: 1.0,
        command_min: commands.0,
        command_max: commands.1,
        bias: scheme.bias,
        tolerance: scheme.tolerance,
        gain: pid_numbers[0],
        integral_s: pid_numbers[1],
        derivative_s: pid_numbers[2],
        inner_gain: inner_numbers[0],
        inner_integral_s: inner_numbers[1],
        inner_derivative_s: inner_numbers[2],
        filter_s: scheme.filter_s,
        repeats_s: number(scheme.stuck_s),
        gate: number(scheme.gate),
        slew: number(scheme.slew),
        lost_s: number(scheme.safety.lost_s),
        stuck_s: number(scheme.safety.stuck_s),
        delay: scheme.delay.map_or(-1, |delay| delay as i32),
        anticipate: (scheme.policy == Policy::Anticipate).into(),
        square_root: inner.is_some_and(|inner| inner.square_root).into(),
        input_measured: measured.into(),
    };
    let model = text.map_or(0, parsed);
    let learns = learner_handle(model, learner);
    let fixed = match learner {
        Learner::None | Learner::Shadow => model,
        Learner::Alone | Learner::Load => 0,
    };
    let mut handle = 0;
    // SAFETY: live memory.
    ok(unsafe { hysteron_controller_new(&control, fixed, learns, &mut handle) });
    // They are copied.
    if learns != 0 {
        ok(hysteron_adaptive_free(learns));
    }
    if model != 0 {
        ok(hysteron_model_free(model));
    }
    Pair {
        library: Controller::new(scheme).unwrap(),
        handle,
        measured,
        outputs,
    }
}

fn numbers(gains: Option<Gains>) -> [f64; 3] {
    gains.map_or([NONE, 0.0, 0.0], |gains| {
        [gains.gain, gains.integral_s, gains.derivative_s]
    })
}

/// Every number and flag, as bits; the sign of a NaN says nothing.
fn bits(action: &HysteronAction) -> ([u64; 5], i32) {
    let numbers = [
        action.command,
        action.drive,
        action.prediction,
        action.output,
        action.input,
    ];
    let bits = numbers.map(|x| if x.is_nan() { NONE } else { x }.to_bits());
    (bits, action.status)
}

impl Pair {
    /// One sample, closed or open. Both fail or both answer.
    fn sample(&mut self, sample: &Sample, what: &str) -> Option<HysteronAction> {
        // SAFETY: all fields are numbers.
        let mut action: HysteronAction = unsafe { zeroed() };
        let &Sample {
            dt,
            command,
            reference,
            heading,
            output,
            input,
            ..
        } = sample;
        let next = &sample.next;
        let reading = Reading {
            output,
            input: self.measured.then_some(input),
        };
        let after = if dt.is_nan() { 0.05 } else { dt };
        let (made, code) = match command {
            Some(command) => (
                self.library.step_command_after(after, command, reading),
                // SAFETY: live memory.
                unsafe {
                    hysteron_controller_command(
                        self.handle,
                        dt,
                        command,
                        output,
                        input,
                        &mut action,
                    )
                },
            ),
            None => {
                let target = Reference {
                    output: reference,
                    heading: match heading {
                        HYSTERON_RISING => Some(Direction::Rising),
                        HYSTERON_FALLING => Some(Direction::Falling),
                        _ => None,
                    },
                };
                (
                    self.library.step_after(after, target, next, reading),
                    // SAFETY: live memory of the sizes given.
                    unsafe {
                        hysteron_controller_step(
                            self.handle,
                            dt,
                            reference,
                            heading,
                            next.as_ptr(),
                            next.len(),
                            output,
                            input,
                            &mut action,
                        )
                    },
                )
            }
        };
        match made {
            Err(error) => {
                assert_eq!(code, error.code(), "{what}");
                None
            }
            Ok(made) => {
                assert_eq!(code, HYSTERON_OK, "{what}");
                assert_eq!(bits(&action), bits(&of(made)), "{what}");
                Some(action)
            }
        }
    }
}

/// The library's answer in the header's words.
fn of(action: hysteron::control::Action) -> HysteronAction {
    let status = action.status;
    let flags = [
        (status.saturated, 1),
        (status.out_of_reach, 2),
        (status.sensor_fault, 4),
        (status.stuck, 8),
        (status.safe, 16),
        (status.adapted, 32),
        (status.rejected, 64),
    ];
    HysteronAction {
        command: action.command,
        drive: action.drive,
        prediction: action.prediction,
        output: action.filtered.output,
        input: number(action.filtered.input),
        status: flags.iter().map(|(is, flag)| i32::from(*is) * flag).sum(),
    }
}

struct Sample {
    dt: f64,
    command: Option<f64>,
    reference: f64,
    next: Vec<f64>,
    heading: i32,
    output: f64,
    input: f64,
}

/// References that wander and jump; readings that are lost, spike or stand still; manual samples;
/// drives that somebody else gave. Returns the flags that were seen.
fn run(pair: &mut Pair, random: &mut StdRng, count: usize, what: &str) -> i32 {
    let (low, high) = pair.outputs;
    let width = high - low;
    let (mut reference, mut output, mut shown, mut drive) = (low, low, low, 0.0);
    let mut temperature = 20.0;
    let (mut mode, mut manual, mut seen) = (0, false, 0);
    for n in 0..count {
        if random.random_bool(0.05) {
            reference = random.random_range(low - 0.1 * width..high + 0.1 * width);
            mode = random.random_range(0..5);
            manual = random.random_bool(0.2);
        }
        if random.random_bool(0.02) {
            let at = random.random_range(0.0..1.0);
            let made = pair.library.go_on_from(at);
            assert!(made.is_ok());
            ok(hysteron_controller_go_on_from(pair.handle, at));
        }
        if random.random_bool(0.01) {
            pair.library.applied(0.3).unwrap();
            ok(hysteron_controller_applied(pair.handle, 0.3));
            pair.library.replay(0.05, 0.4, shown).unwrap();
            ok(hysteron_controller_replay(pair.handle, NONE, 0.4, shown));
        }
        // A plant of its own, with a lag, a drift and noise.
        output += 0.1 * (low + width * drive - output);
        temperature += 0.2 * (20.0 + 60.0 * drive - temperature);
        let noisy = output + 0.002 * width * random.random_range(-1.0..1.0);
        shown = match mode {
            0 if random.random_bool(0.5) => NONE,
            1 if random.random_bool(0.1) => noisy + 3.0 * width,
            2 => shown,
            3 => NONE,
            _ => noisy,
        };
        let sample = Sample {
            dt: [NONE, 0.05, random.random_range(0.02..0.2), 0.0][random.random_range(0..20) / 6],
            command: manual.then(|| random.random_range(0.0..1.0)),
            reference: if n % 97 == 96 { NONE } else { reference },
            next: vec![reference; random.random_range(0..8)],
            heading: [HYSTERON_HOLD, HYSTERON_RISING, HYSTERON_FALLING][random.random_range(0..3)],
            output: shown,
            input: if random.random_bool(0.1) {
                NONE
            } else {
                temperature
            },
        };
        if let Some(action) = pair.sample(&sample, &format!("{what}, sample {n}")) {
            drive = action.drive;
            seen |= action.status;
            assert!((0.0..=1.0).contains(&drive), "{what}, sample {n}: {drive}");
        }
        // SAFETY: all fields are numbers, and live memory.
        let info = unsafe {
            let mut info: HysteronControllerInfo = zeroed();
            ok(hysteron_controller_info(pair.handle, &mut info));
            info
        };
        let trusts = pair
            .library
            .compensator()
            .is_some_and(Compensator::trusts_learner);
        assert_eq!(info.due, pair.library.due());
        assert_eq!(
            info.stuck_s.to_bits(),
            number(pair.library.stuck_s()).to_bits()
        );
        assert_eq!(info.trusts_learner, i32::from(trusts));
        assert_eq!((info.interval_s, info.rest_drive), (0.05, 0.0));
    }
    seen
}

#[test]
fn the_answers_are_those_of_the_library() {
    let mut random = StdRng::seed_from_u64(7);
    // Miri takes a thousand times as long.
    let (rounds, count) = if cfg!(miri) { (1, 20) } else { (12, 400) };
    let mut seen = 0;
    for round in 0..rounds {
        for (text, learner) in [
            (None, Learner::None),
            (Some(PLAIN), Learner::None),
            (Some(PLAIN), Learner::Alone),
            (Some(PLAIN), Learner::Shadow),
            (Some(STAGED), Learner::None),
            (Some(STAGED), Learner::Shadow),
            (Some(STAGED), Learner::Load),
        ] {
            let mut pair = pair(&mut random, text, learner);
            let what = format!(
                "round {round}, {learner:?} of {}",
                text.unwrap_or("nothing")
            );
            seen |= run(&mut pair, &mut random, count, &what);
            learned(&pair, learner);
            ok(hysteron_controller_free(pair.handle));
        }
    }
    assert!(
        cfg!(miri) || seen == 127,
        "a flag that was never seen: {seen}"
    );
}

/// The weights that a loop has learned.
fn learned(pair: &Pair, learner: Learner) {
    let mut handle = 0;
    // SAFETY: live memory.
    let code = unsafe { hysteron_controller_model(pair.handle, &mut handle) };
    match learner {
        Learner::None | Learner::Load => assert_eq!(code, HYSTERON_CONTROL),
        Learner::Alone | Learner::Shadow => {
            ok(code);
            let model = pair.library.compensator().unwrap().learned().unwrap();
            let (mut weights, mut count) = ([0.0; 15], 0);
            // SAFETY: live memory of the sizes given.
            ok(unsafe { hysteron_model_weights(handle, weights.as_mut_ptr(), 15, &mut count) });
            assert_eq!(weights[..count], *model.weights());
            ok(hysteron_model_free(handle));
        }
    }
}

#[test]
fn a_loop_takes_weights_that_were_learned_elsewhere() {
    let mut random = StdRng::seed_from_u64(3);
    let mut pair = pair(&mut random, Some(PLAIN), Learner::None);
    run(&mut pair, &mut random, 100, "before");
    let text = PLAIN.replace("[1, 2, 1, 0.5", "[1.5, 1, 1, 0.5");
    let (model, other) = (parsed(&text), parsed(STAGED));
    pair.library
        .renew(&Model::from_json(&text).unwrap())
        .unwrap();
    ok(hysteron_controller_renew(pair.handle, model));
    assert_eq!(
        hysteron_controller_renew(pair.handle, other),
        HYSTERON_CONTROL
    );
    run(&mut pair, &mut random, 200, "after");
}

#[test]
fn what_cannot_be_is_refused() {
    let (model, loaded) = (parsed(PLAIN), parsed(WHOLE));
    // SAFETY: all fields are numbers.
    let mut control: HysteronControl = unsafe { zeroed() };
    let mut handle = 0;
    // SAFETY: live memory.
    ok(unsafe { hysteron_control_default(model, 0.05, 0.0, 1.0, &mut control) });
    let new = |control: &HysteronControl, model: u64, learner: u64, handle: &mut u64| {
        // SAFETY: live memory.
        unsafe { hysteron_controller_new(control, model, learner, handle) }
    };
    assert_eq!(
        control.tolerance,
        Model::from_json(PLAIN).unwrap().usual_tolerance()
    );
    ok(new(&control, model, 0, &mut handle));
    let changed = |change: fn(&mut HysteronControl)| {
        let mut control = control;
        change(&mut control);
        new(&control, model, 0, &mut 0)
    };
    type Change = fn(&mut HysteronControl);
    let of_the_library: [Change; 8] = [
        |control| control.interval_s = 0.0,
        |control| control.interval_s = NONE,
        |control| control.drive_max = -1.0,
        |control| control.tolerance = -1.0,
        |control| control.slew = 0.0,
        |control| control.lost_s = -1.0,
        |control| control.gain = f64::INFINITY,
        |control| control.delay = 1002,
    ];
    for change in of_the_library {
        assert_eq!(changed(change), HYSTERON_CONTROL);
    }
    let of_the_call: [Change; 4] = [
        |control| control.delay = -2,
        |control| control.anticipate = 2,
        |control| control.square_root = -1,
        |control| control.input_measured = 7,
    ];
    for change in of_the_call {
        assert_eq!(changed(change), HYSTERON_VALUE);
    }
    assert_eq!(new(&control, 77, 0, &mut 0), HYSTERON_HANDLE);
    assert_eq!(new(&control, model, model, &mut 0), HYSTERON_HANDLE);
    // The learner in memory of the caller stays there.
    let bytes = hysteron_adaptive_load_size(loaded);
    let (mut memory, mut placed) = (vec![0_u64; bytes / 8], 0);
    let at = memory.as_mut_ptr().cast();
    // SAFETY: live memory of the size given.
    ok(unsafe { hysteron_adaptive_load_place(loaded, NONE, null(), at, bytes, &mut placed) });
    assert_eq!(new(&control, 0, placed, &mut 0), HYSTERON_HANDLE);
    // A refused sample changes nothing.
    // SAFETY: live memory; null pointers are refused.
    unsafe {
        let mut action: HysteronAction = zeroed();
        let mut step = |dt: f64, reference: f64, heading: i32| {
            let next = null();
            hysteron_controller_step(
                handle,
                dt,
                reference,
                heading,
                next,
                0,
                1.0,
                NONE,
                &mut action,
            )
        };
        assert_eq!(step(NONE, NONE, HYSTERON_HOLD), HYSTERON_INPUT_NOT_FINITE);
        assert_eq!(step(0.0, 1.0, HYSTERON_HOLD), HYSTERON_CONTROL);
        assert_eq!(step(NONE, 1.0, 5), HYSTERON_VALUE);
        ok(step(NONE, 1.0, HYSTERON_HOLD));
        let code =
            hysteron_controller_step(handle, NONE, 1.0, 0, null(), 1, 1.0, NONE, &mut action);
        assert_eq!(code, HYSTERON_NULL);
        let code = hysteron_controller_command(handle, NONE, 0.5, NONE, NONE, null_mut());
        assert_eq!(code, HYSTERON_NULL);
    }
    assert_eq!(
        hysteron_controller_go_on_from(handle, NONE),
        HYSTERON_INPUT_NOT_FINITE
    );
    ok(hysteron_controller_free(handle));
    assert_eq!(hysteron_controller_free(handle), HYSTERON_HANDLE);
    assert_eq!(hysteron_controller_go_on_from(handle, 0.0), HYSTERON_HANDLE);
}

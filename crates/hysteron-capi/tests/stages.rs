//! The whole model through C: bit for bit what the library gives, in memory of the library and of
//! the caller.
#![allow(clippy::unwrap_used)]

mod whole;

use hysteron::{Model, Policy, Sample, State, Status, Surroundings, Target, Wanted};
use hysteron_capi::*;
use std::ffi::CString;
use std::ptr::{null, null_mut};
use whole::{BY_LOAD, Series, WHOLE, series};

const NONE: f64 = f64::NAN;

fn ok(code: i32) {
    let mut text = [0; 256];
    // SAFETY: live memory of the size given.
    unsafe { hysteron_last_error(text.as_mut_ptr(), text.len()) };
    // SAFETY: a text with a zero byte at its end.
    let text = unsafe { std::ffi::CStr::from_ptr(text.as_ptr()) };
    assert_eq!(code, HYSTERON_OK, "{text:?}");
}

/// Whose memory a state is in: the library's, or the caller's.
const WHOSE: [Whose; 2] = [Whose::Library, Whose::Caller];

#[derive(Clone, Copy, PartialEq)]
enum Whose {
    Library,
    Caller,
}

fn cases() -> impl Iterator<Item = (&'static str, Whose)> {
    let texts = [WHOLE, BY_LOAD].into_iter();
    texts.flat_map(|text| WHOSE.map(|whose| (text, whose)))
}

/// Handles of a model and of a state of it, and the same in the library.
struct Both {
    whose: Whose,
    memory: Vec<u64>,
    handle: u64,
    state: u64,
    model: Model,
    own: State,
}

impl Both {
    fn new(text: &str, whose: Whose) -> Self {
        let model = Model::from_json(text).unwrap();
        let text = CString::new(text).unwrap();
        let mut handle = 0;
        // SAFETY: live memory.
        ok(unsafe { hysteron_model_parse(text.as_ptr(), &mut handle) });
        let mut both = Self {
            whose,
            memory: vec![0; hysteron_state_size(handle) / 8],
            handle,
            state: 0,
            own: model.start(),
            model,
        };
        both.make();
        both
    }

    /// Makes the state, whose memory the one before leaves.
    fn make(&mut self) {
        let (memory, bytes) = (self.memory.as_mut_ptr().cast(), 8 * self.memory.len());
        // SAFETY: live memory of the size given.
        ok(unsafe {
            match self.whose {
                Whose::Library => hysteron_state_new(self.handle, &mut self.state),
                Whose::Caller => hysteron_state_place(self.handle, memory, bytes, &mut self.state),
            }
        });
    }

    /// The code of an error of the library; over memory of the caller, that of the core.
    fn code(&self, code: i32) -> i32 {
        match (self.whose, code) {
            (Whose::Caller, HYSTERON_THERMAL) => HYSTERON_TIME_STEP,
            (Whose::Caller, HYSTERON_FIT) => HYSTERON_LOAD,
            _ => code,
        }
    }

    fn limits(&self) -> HysteronLimits {
        // SAFETY: all fields are numbers.
        let mut limits = unsafe { std::mem::zeroed() };
        // SAFETY: live memory.
        ok(unsafe { hysteron_model_limits(self.handle, &mut limits) });
        limits
    }

    fn step(&mut self, input: f64, dt: f64, load: f64) -> f64 {
        let (mut output, mut clipped) = (0.0, 0);
        // SAFETY: live memory.
        ok(unsafe { hysteron_step_in(self.state, input, dt, load, &mut output, &mut clipped) });
        let (dt, load) = (Some(dt), Some(load).filter(|load| !load.is_nan()));
        let found = self
            .model
            .step(&mut self.own, Sample { input, dt, load })
            .unwrap();
        assert_eq!(output.to_bits(), found.output.to_bits());
        assert_eq!(clipped == HYSTERON_INSIDE, found.clipped.is_none());
        self.compare();
        output
    }

    fn compare(&self) {
        let mut temperature = 0.0;
        // SAFETY: live memory.
        ok(unsafe { hysteron_state_temperature(self.state, &mut temperature) });
        assert_eq!(temperature.to_bits(), self.own.temperature().to_bits());
        let mut half = 0.0;
        // SAFETY: live memory.
        ok(unsafe { hysteron_state_half_width(self.state, &mut half) });
        let bounds = self.model.bounds().unwrap();
        let expected = bounds.map_or(f64::NAN, |bounds| bounds.at(&self.own).unwrap());
        assert_eq!(half.to_bits(), expected.to_bits());
    }

    /// The output of one more sample, which shows where the state is. It moves it.
    fn probe(&self) -> f64 {
        let mut output = 0.0;
        // SAFETY: live memory.
        ok(unsafe { hysteron_step_in(self.state, 0.37, 0.21, 77.0, &mut output, null_mut()) });
        output
    }
}

impl Drop for Both {
    fn drop(&mut self) {
        assert_eq!(hysteron_state_free(self.state), HYSTERON_OK);
        assert_eq!(hysteron_model_free(self.handle), HYSTERON_OK);
    }
}

fn same(a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len());
    for (n, (a, b)) in a.iter().zip(b).enumerate() {
        assert_eq!(a.to_bits(), b.to_bits(), "sample {n}");
    }
}

#[test]
fn steps_are_those_of_the_library() {
    for (text, whose) in cases() {
        let mut both = Both::new(text, whose);
        let Series {
            input, load, step, ..
        } = series(1, 500);
        for n in 0..input.len() {
            both.step(input[n], step[n], load[n]);
        }
    }
}

#[test]
fn runs_are_those_of_the_library_at_once_and_in_pieces() {
    for (text, whose) in cases() {
        let both = Both::new(text, whose);
        let Series {
            input,
            load,
            step,
            time,
            ..
        } = series(2, 300);
        let around = Surroundings {
            time: Some(&time),
            load: Some(&load),
            rest: None,
        };
        let expected = both.model.simulate_in(&input, around).unwrap();
        let mut own = both.model.start();
        let sides = (0..300).map(|n| {
            let (dt, load) = (Some(step[n]), Some(load[n]));
            let sample = Sample {
                input: input[n],
                dt,
                load,
            };
            match both.model.step(&mut own, sample).unwrap().clipped {
                None => HYSTERON_INSIDE,
                Some(hysteron::Clipped::Low) => HYSTERON_LOW,
                Some(hysteron::Clipped::High) => HYSTERON_HIGH,
            }
        });
        let sides: Vec<i32> = sides.collect();
        assert!(sides.contains(&HYSTERON_HIGH) && sides.contains(&HYSTERON_INSIDE));
        let (mut output, mut clipped) = (vec![0.0; 300], vec![7; 300]);
        for pieces in [1, 3, 300] {
            ok(hysteron_state_start(both.state, HYSTERON_START_FITTED));
            let (count, mut last) = (300 / pieces, NONE);
            for from in (0..300).step_by(count) {
                // SAFETY: live memory of the sizes given.
                ok(unsafe {
                    hysteron_run_in(
                        both.state,
                        input[from..].as_ptr(),
                        time[from..].as_ptr(),
                        last,
                        load[from..].as_ptr(),
                        output[from..].as_mut_ptr(),
                        clipped[from..].as_mut_ptr(),
                        count,
                    )
                });
                last = time[from + count - 1];
            }
            same(&output, &expected);
            assert_eq!(clipped, sides);
        }
    }
}

#[test]
fn the_inverse_is_that_of_the_library() {
    for (text, whose) in cases() {
        let mut both = Both::new(text, whose);
        let Series {
            target,
            load,
            time,
            step,
            ..
        } = series(3, 400);
        let mut limits = both.limits();
        assert_eq!(
            (limits.drive_min, limits.drive_max),
            both.model.drive_range()
        );
        (limits.drive_max, limits.horizon) = (0.9, 0.5);
        let inverse = both.model.inverse().unwrap();
        let inverse = inverse.drive_range(limits.drive_min, 0.9).unwrap();
        let inverse = inverse.horizon(0.5).unwrap();
        let (mut input, mut status, mut limited) = (0.0, 0, 0);
        let mut own = both.own.clone();
        for n in 0..target.len() {
            let heading = n as i32 % 3 - 1;
            limits.temperature_max = if n % 2 == 0 { 50.0 } else { f64::INFINITY };
            // SAFETY: live memory.
            ok(unsafe {
                hysteron_inverse_step_in(
                    both.state,
                    target[n],
                    heading,
                    0.01,
                    step[n],
                    load[n],
                    &limits,
                    &mut input,
                    &mut status,
                )
            });
            let heading = match heading {
                0 => None,
                1 => Some(hysteron::Direction::Rising),
                _ => Some(hysteron::Direction::Falling),
            };
            let wanted = Wanted {
                target: Target {
                    output: target[n],
                    heading,
                    tolerance: 0.01,
                },
                dt: Some(step[n]),
                load: Some(load[n]),
                temperature: (f64::NEG_INFINITY, limits.temperature_max),
            };
            let found = inverse.step(&mut own, wanted).unwrap();
            assert_eq!(input.to_bits(), found.input.to_bits());
            assert_eq!(status, i32::from(found.status.number()));
            limited += usize::from(found.status == Status::Limited);
        }
        assert!(limited > 10, "{limited}");

        let around = Surroundings {
            time: Some(&time),
            load: Some(&load),
            rest: None,
        };
        let mut start = both.model.off();
        let expected = both.model.inverse().unwrap();
        let expected = expected.series_in(&mut start, &target, Policy::Hold, 0.0, around);
        let expected: Vec<f64> = expected.unwrap().iter().map(|found| found.input).collect();
        let mut inputs = vec![0.0; 400];
        ok(hysteron_state_start(both.state, HYSTERON_START_OFF));
        // SAFETY: live memory of the sizes given.
        ok(unsafe {
            hysteron_inverse_run_in(
                both.state,
                target.as_ptr(),
                null(),
                0.0,
                time.as_ptr(),
                NONE,
                load.as_ptr(),
                null(),
                inputs.as_mut_ptr(),
                null_mut(),
                400,
            )
        });
        same(&inputs, &expected);
        both.own = start;
        both.compare();
    }
}

#[test]
fn a_state_saved_and_restored_goes_on_to_the_last_bit() {
    for (text, whose) in cases() {
        let (mut whole, mut broken) = (Both::new(text, Whose::Library), Both::new(text, whose));
        let Series {
            input, load, step, ..
        } = series(4, 300);
        let mut points = [0.0; 64];
        let (mut count, mut last) = (0, 0.0);
        let mut stages = HysteronStageState::default();
        for n in 0..input.len() {
            let expected = whole.step(input[n], step[n], load[n]);
            assert_eq!(
                broken.step(input[n], step[n], load[n]).to_bits(),
                expected.to_bits()
            );
            if n % 20 == 19 {
                // SAFETY: live memory of the sizes given.
                unsafe {
                    let (at, size) = (points.as_mut_ptr(), points.len());
                    ok(hysteron_state_save(
                        broken.state,
                        at,
                        size,
                        &mut count,
                        &mut last,
                    ));
                    ok(hysteron_state_save_stages(broken.state, &mut stages));
                    ok(hysteron_state_free(broken.state));
                    broken.make();
                    ok(hysteron_state_restore(
                        broken.state,
                        points.as_ptr(),
                        count,
                        last,
                    ));
                    ok(hysteron_state_restore_stages(broken.state, &stages));
                }
            }
        }
        stages.temperature = f64::NAN;
        // SAFETY: live memory.
        let code = unsafe { hysteron_state_restore_stages(whole.state, &stages) };
        assert_eq!(code, HYSTERON_INPUT_NOT_FINITE);
    }
}

#[test]
fn a_state_starts_as_told() {
    for whose in WHOSE {
        let both = Both::new(WHOLE, whose);
        for (start, state) in [
            (HYSTERON_START_FITTED, both.model.fitted().unwrap()),
            (HYSTERON_START_OFF, both.model.off()),
            (HYSTERON_START_ON, both.model.saturated()),
        ] {
            both.probe();
            ok(hysteron_state_start(both.state, start));
            let (input, load) = (0.37, Some(77.0));
            let sample = Sample {
                input,
                dt: None,
                load,
            };
            let expected = both.model.step(&mut state.clone(), sample).unwrap().output;
            assert_eq!(both.probe().to_bits(), expected.to_bits());
        }
        for (reset, start) in [
            (
                hysteron_state_reset as extern "C" fn(u64) -> i32,
                HYSTERON_START_OFF,
            ),
            (hysteron_state_saturate, HYSTERON_START_ON),
        ] {
            ok(reset(both.state));
            let found = both.probe();
            ok(hysteron_state_start(both.state, start));
            assert_eq!(both.probe().to_bits(), found.to_bits());
        }
        assert_eq!(hysteron_state_start(both.state, 3), HYSTERON_VALUE);
    }
}

#[test]
fn a_model_says_what_it_needs() {
    let needs = |both: &Both| {
        // SAFETY: all fields are numbers.
        let mut needs: HysteronModelNeeds = unsafe { std::mem::zeroed() };
        // SAFETY: live memory.
        ok(unsafe { hysteron_model_needs(both.handle, &mut needs) });
        needs
    };
    let both = Both::new(WHOLE, Whose::Library);
    let found = needs(&both);
    assert_eq!(
        [found.time, found.load, found.body, found.fitted_start],
        [1; 4]
    );
    assert_eq!((found.load_min, found.load_max), (50.0, 200.0));
    assert_eq!((found.drive_min, found.drive_max), (0.0, 1.0));
    assert_eq!(
        (found.active_min, found.active_max),
        both.model.active_range()
    );
    let (mut text, mut needed) = ([0; 16], 0);
    // SAFETY: live memory of the size given.
    ok(unsafe { hysteron_model_quantity(both.handle, 2, text.as_mut_ptr(), 16, &mut needed) });
    // SAFETY: a text with a zero byte at its end.
    assert_eq!(
        unsafe { std::ffi::CStr::from_ptr(text.as_ptr()) },
        c"stress [MPa]"
    );

    let plain = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 1]}"#;
    let found = needs(&Both::new(plain, Whose::Library));
    assert_eq!(
        [found.time, found.load, found.body, found.fitted_start],
        [0; 4]
    );
    assert!(found.load_min.is_nan() && found.load_max.is_nan());
    assert_eq!(
        (found.drive_min, found.drive_max),
        (f64::NEG_INFINITY, f64::INFINITY)
    );
    assert_eq!((found.active_min, found.active_max), (-1.0, 1.0));
}

#[test]
fn what_is_missing_or_wrong_is_refused_and_nothing_moves() {
    WHOSE.into_iter().for_each(refuses);
}

fn refuses(whose: Whose) {
    let (both, twin) = (Both::new(WHOLE, whose), Both::new(WHOLE, whose));
    let (thermal, fit) = (both.code(HYSTERON_THERMAL), both.code(HYSTERON_FIT));
    let step = |input, dt, load| {
        let mut output = 7.0;
        // SAFETY: live memory.
        let code =
            unsafe { hysteron_step_in(both.state, input, dt, load, &mut output, null_mut()) };
        assert!(code == HYSTERON_OK || output == 7.0);
        code
    };
    let invert = |target, tolerance, dt, load, change: &dyn Fn(&mut HysteronLimits)| {
        let (mut input, mut status, mut limits) = (7.0, 0, both.limits());
        change(&mut limits);
        // SAFETY: live memory.
        let code = unsafe {
            hysteron_inverse_step_in(
                both.state,
                target,
                0,
                tolerance,
                dt,
                load,
                &limits,
                &mut input,
                &mut status,
            )
        };
        assert_eq!(input, 7.0);
        code
    };
    let inf = f64::INFINITY;
    assert_eq!(step(0.5, -1.0, 100.0), thermal, "even for the first sample");
    assert_eq!(step(0.5, NONE, NONE), fit);
    for state in [both.state, twin.state] {
        // SAFETY: live memory.
        ok(unsafe { hysteron_step_in(state, 0.5, NONE, 100.0, &mut 0.0, null_mut()) });
    }
    for (input, dt, load, code) in [
        (NONE, 0.1, 100.0, HYSTERON_INPUT_NOT_FINITE),
        (inf, 0.1, 100.0, HYSTERON_INPUT_NOT_FINITE),
        (0.5, NONE, 100.0, thermal),
        (0.5, -0.1, 100.0, thermal),
        (0.5, inf, 100.0, thermal),
        (0.5, 0.1, NONE, fit),
        (0.5, 0.1, 20.0, fit),
        (0.5, 0.1, 203.0, fit),
    ] {
        assert_eq!(step(input, dt, load), code, "{input} {dt} {load}");
        assert_eq!(
            invert(input, 0.0, dt, load, &|_| {}),
            code,
            "{input} {dt} {load}"
        );
    }
    assert_eq!(step(0.5, 0.1, inf), fit);
    let wrong: [&dyn Fn(&mut HysteronLimits); 9] = [
        &|l| l.drive_min = NONE,
        &|l| l.drive_max = NONE,
        &|l| l.drive_max = -1.0,
        &|l| l.drive_min = f64::INFINITY,
        &|l| l.horizon = -1.0,
        &|l| l.horizon = f64::NAN,
        &|l| l.horizon = f64::INFINITY,
        &|l| l.temperature_min = f64::NAN,
        &|l| (l.temperature_min, l.temperature_max) = (2.0, 1.0),
    ];
    for change in wrong {
        assert_eq!(invert(1.0, 0.0, 0.1, 100.0, change), HYSTERON_VALUE);
    }
    // The functions without time and load refuse what they cannot know.
    let (mut output, mut input, mut status) = ([7.0; 2], 0.0, 0);
    // SAFETY: live memory of the sizes given.
    unsafe {
        let inputs = [0.1, 0.2];
        assert_eq!(
            hysteron_step(both.state, 0.5, output.as_mut_ptr(), null_mut()),
            thermal
        );
        let code = hysteron_run(both.state, inputs.as_ptr(), output.as_mut_ptr(), 2);
        assert_eq!(code, thermal);
        let code = hysteron_inverse_step(both.state, 1.0, 0, 0.0, &mut input, &mut status);
        assert_eq!(code, thermal);
        // An error in the midst of a series: no part of it counts.
        let (time, back, load) = ([1.0, 2.0], [2.0, 1.0], [100.0, 100.0]);
        let (outside, bad) = ([100.0, 300.0], [0.1, NONE]);
        let mut run = |input: &[f64; 2], time: *const f64, last, load: *const f64| {
            let code = hysteron_run_in(
                both.state,
                input.as_ptr(),
                time,
                last,
                load,
                output.as_mut_ptr(),
                null_mut(),
                2,
            );
            assert!(output.iter().all(|y| *y == 0.0 || *y == 7.0));
            code
        };
        assert_eq!(run(&inputs, back.as_ptr(), 0.5, load.as_ptr()), thermal);
        assert_eq!(run(&inputs, time.as_ptr(), 3.0, load.as_ptr()), thermal);
        assert_eq!(run(&inputs, time.as_ptr(), NONE, load.as_ptr()), thermal);
        assert_eq!(run(&inputs, null(), 0.5, load.as_ptr()), thermal);
        assert_eq!(run(&inputs, time.as_ptr(), 0.5, null()), fit);
        assert_eq!(run(&inputs, time.as_ptr(), 0.5, outside.as_ptr()), fit);
        assert_eq!(
            run(&bad, time.as_ptr(), 0.5, load.as_ptr()),
            HYSTERON_INPUT_NOT_FINITE
        );
        let mut inverse = |target: &[f64; 2], time: *const f64, load: *const f64| {
            hysteron_inverse_run_in(
                both.state,
                target.as_ptr(),
                null(),
                0.0,
                time,
                0.5,
                load,
                null(),
                output.as_mut_ptr(),
                null_mut(),
                2,
            )
        };
        assert_eq!(inverse(&inputs, back.as_ptr(), load.as_ptr()), thermal);
        assert_eq!(inverse(&inputs, time.as_ptr(), outside.as_ptr()), fit);
        assert_eq!(
            inverse(&bad, time.as_ptr(), load.as_ptr()),
            HYSTERON_INPUT_NOT_FINITE
        );
        ok(hysteron_run_in(
            both.state,
            null(),
            null(),
            NONE,
            null(),
            null_mut(),
            null_mut(),
            0,
        ));
    }
    assert_eq!(
        both.probe().to_bits(),
        twin.probe().to_bits(),
        "nothing moved"
    );

    let plain = Both::new(
        r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 1]}"#,
        whose,
    );
    // SAFETY: live memory.
    let code = unsafe { hysteron_step_in(plain.state, 0.5, NONE, 1.0, &mut 0.0, null_mut()) };
    assert_eq!(code, fit, "a load that the model does not have");
}

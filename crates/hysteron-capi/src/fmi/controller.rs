//! The third block: a model and its inverse in a control loop, with PID feedback. It gives the
//! drives of `hysteron::control::Controller` with a fixed model, without an inner loop.

use super::block::{Block, Inputs, Outputs};
use super::settings::Settings;
use super::state::{Filters, Loop, State, Turning};
use super::{Problem, Result};
use crate::delay::{MOST, UnderWay};
use hysteron_core::control::{Cause, Gate, LowPass, Pid, Silence, Standstill, clamp};
use hysteron_core::{Direction, Status};

/// Samples within which a difference of the feedforward fades.
const FADE: u32 = 10;
/// While the target itself has not turned, the inverse crosses the dead band only if the difference
/// exceeds this many tolerances.
const NOT_TURNED: f64 = 8.0;

impl Turning {
    fn push(&mut self, y: f64, tolerance: f64) {
        (self.low, self.high) = (self.low.min(y), self.high.max(y));
        let falls = self.high - y > tolerance && self.branch != Some(Direction::Falling);
        let rises = y - self.low > tolerance && self.branch != Some(Direction::Rising);
        self.branch = match (falls, rises) {
            (true, _) => Some(Direction::Falling),
            (_, true) => Some(Direction::Rising),
            _ => return,
        };
        (self.low, self.high) = (y, y);
    }
}

impl Filters {
    fn new(filter_s: f64) -> Self {
        let filter = LowPass::new(filter_s);
        Self {
            reading: filter.clone(),
            gap: 0.0,
            drive: filter.clone(),
            reference: filter,
        }
    }

    fn set(&mut self, filter_s: f64) {
        for filter in [&mut self.reading, &mut self.drive, &mut self.reference] {
            filter.set(filter_s);
        }
    }
}

impl Loop {
    pub(crate) fn new(block: &Block, followed: State) -> Self {
        let settings = block.control.settings;
        Self {
            followed: Box::new(followed),
            aimed: false,
            pid: Pid::new(settings.terms),
            standstill: Standstill::default(),
            silence: Silence::default(),
            gate: Gate::new(settings.gate),
            filters: Filters::new(settings.filter_s),
            under_way: UnderWay::new(block.dead, vec![0.0; MOST]),
            from: None,
            fade: (0.0, 0),
            drive: None,
            acting: None,
            prediction: f64::NAN,
            held: (false, false),
            turning: Turning {
                low: f64::INFINITY,
                high: f64::NEG_INFINITY,
                branch: None,
            },
            manual: false,
        }
    }

    /// The outputs while no time passes.
    pub(crate) fn at_rest(&self, inputs: &Inputs) -> Outputs {
        Outputs {
            signal: self.drive.unwrap_or(inputs.settings.rest()),
            flag: 0,
            temperature: self.followed.stages.temperature(),
        }
    }
}

/// The flags of a sample, as in exported C and in the C interface.
const AT_LIMIT: i32 = 1;
const OUT_OF_REACH: i32 = 2;
const NO_READING: i32 = 4;
const STUCK: i32 = 8;
const SAFE: i32 = 16;
const OUTLIER: i32 = 64;

impl Block {
    /// One sample of the loop. `wanted` is the state of the inverse.
    pub(crate) fn control(
        &self,
        wanted: &mut State,
        own: &mut Loop,
        inputs: &Inputs,
        dt: f64,
    ) -> Result<Outputs> {
        let settings = &inputs.settings;
        if let Some(fault) = settings.fault() {
            return Err(Problem::new(fault));
        }
        for (what, number) in [
            ("ahead", inputs.ahead),
            ("manual_drive", inputs.manual_drive),
        ] {
            if !number.is_finite() {
                return Err(Problem(format!(
                    "`{what}` is {number}, not a finite number"
                )));
            }
        }
        if own.manual && !inputs.manual {
            own.go_on(settings);
        }
        own.manual = inputs.manual;
        let mut flag = 0;
        own.filters.set(settings.filter_s);
        let is_stuck = own.sense(self, settings, inputs, dt);
        let before = own.prediction;
        if let Some(signal) = own.acting {
            let acting = Inputs { signal, ..*inputs };
            own.prediction = self.forward(&mut own.followed, &acting, dt)?.output;
        }
        let measured = own.read(settings, inputs.measured, (is_stuck, before), dt, &mut flag);
        let asked = match inputs.manual {
            true => {
                own.aimed = false;
                inputs.manual_drive
            }
            false => {
                if own.silence.given_up() {
                    flag |= SAFE;
                }
                let (feedforward, status) = self.aim(wanted, own, inputs, dt)?;
                if status.is_out_of_reach() {
                    flag |= OUT_OF_REACH;
                }
                let reference = own.filters.reference.pass(inputs.signal, dt);
                own.answer(settings, feedforward, reference, measured, dt)
            }
        };
        let (low, high) = settings.drives;
        let within = clamp(asked, low, high);
        let drive = match (flag & SAFE > 0, own.drive) {
            (true, _) => settings.rest(),
            (false, Some(last)) if settings.slew > 0.0 => {
                let way = settings.slew * dt;
                clamp(within, last - way, last + way)
            }
            _ => within,
        };
        own.held = (
            drive <= low || drive > within,
            drive >= high || drive < within,
        );
        if own.held.0 || own.held.1 || asked <= low || asked >= high {
            flag |= AT_LIMIT;
        }
        own.drive = Some(drive);
        Ok(Outputs {
            signal: drive,
            flag,
            temperature: own.followed.stages.temperature(),
        })
    }

    /// The input for the reference that is due when it is seen to act.
    fn aim(
        &self,
        wanted: &mut State,
        own: &mut Loop,
        inputs: &Inputs,
        dt: f64,
    ) -> Result<(f64, Status)> {
        let signal = inputs.signal + inputs.ahead;
        if !own.aimed {
            *wanted = own.followed.as_ref().clone();
            own.aimed = true;
        }
        own.turning.push(signal, inputs.tolerance);
        let rises = wanted.operators.is_rising() == (self.sign > 0.0);
        let turned = own
            .turning
            .branch
            .is_some_and(|branch| rises != (branch == Direction::Rising));
        let tolerance = match inputs.heading {
            0 if !turned => NOT_TURNED * inputs.tolerance,
            _ => inputs.tolerance,
        };
        let aim = Inputs {
            signal,
            tolerance,
            ..*inputs
        };
        let solution = self.inverse(wanted, &aim, dt)?;
        Ok((solution.input, solution.status))
    }
}

impl Loop {
    /// Goes on from the last drive without a bump.
    fn go_on(&mut self, settings: &Settings) {
        self.from = self.drive;
        self.filters.reference = LowPass::new(settings.filter_s);
        if self.silence.given_up() {
            self.silence = Silence::default();
            self.standstill.forgive();
        }
    }

    /// Takes the drive that the reading answers, and tells whether that stands still where it has to
    /// move.
    fn sense(&mut self, block: &Block, settings: &Settings, inputs: &Inputs, dt: f64) -> bool {
        self.acting = self.drive.map(|drive| {
            let drive = self.filters.drive.pass(drive, dt);
            let acting = self.under_way.acting(drive, Some(dt));
            self.under_way.push(drive, Some(dt));
            acting
        });
        let (reading, expected) = (inputs.measured, self.prediction);
        let cause = Cause {
            expected: (expected.is_finite() && self.drive.is_some())
                .then_some((expected, (0.0, block.control.range))),
            wanted: inputs.signal,
            drive: self.drive.unwrap_or(settings.drives.0),
            drives: settings.drives,
        };
        let is_stuck = reading.is_finite() && self.standstill.push(reading, cause, dt).is_some();
        let stuck_s = self.standstill.stuck_s();
        self.silence.push(settings.safety(), reading, stuck_s, dt);
        is_stuck
    }

    /// The reading behind the filter, where there is a valid one. The model expected `before` for
    /// the last one.
    fn read(
        &mut self,
        settings: &Settings,
        reading: f64,
        (is_stuck, before): (bool, f64),
        dt: f64,
        flag: &mut i32,
    ) -> Option<f64> {
        if is_stuck {
            *flag |= STUCK;
        }
        if reading.is_finite() && settings.gate > 0.0 {
            let expected = self.acting.map_or(0.0, |_| self.prediction - before);
            self.gate.set(settings.gate);
            if !self.gate.passes(reading, || expected) {
                *flag |= OUTLIER;
            }
        }
        if !reading.is_finite() || *flag & (STUCK | OUTLIER) > 0 {
            *flag |= NO_READING;
            self.filters.gap += dt;
            return None;
        }
        let passed = self.filters.gap + dt;
        self.filters.gap = 0.0;
        Some(self.filters.reading.pass(reading, passed))
    }

    /// The drive for a measured output, or without one.
    fn answer(
        &mut self,
        settings: &Settings,
        feedforward: f64,
        reference: f64,
        measured: Option<f64>,
        dt: f64,
    ) -> f64 {
        let terms = settings.terms;
        let (low, high) = settings.drives;
        let feedback = terms.gain != 0.0;
        self.pid.set(terms);
        let error = measured.map(|measured| reference - measured);
        if let Some(from) = self.from {
            if feedback && measured.is_none() {
                // The loop is not closed before its first reading.
                return clamp(from, low, high);
            }
            self.from = None;
            let e = error.unwrap_or(0.0);
            let offset = match feedback && terms.integral_s <= 0.0 {
                true => from - feedforward - terms.gain * e,
                false => from - feedforward,
            };
            self.fade = (offset, FADE);
            if feedback {
                self.pid.begin(from, e, feedforward + offset);
            }
        }
        let (offset, left) = &mut self.fade;
        let bias = feedforward + *offset * f64::from(*left) / f64::from(FADE);
        *left = left.saturating_sub(1);
        let limits = match self.standstill.room() {
            Some(room) => (low.max(room.0), high.min(room.1)),
            None => (low, high),
        };
        match (feedback, measured, error) {
            (true, Some(measured), Some(error)) => self
                .pid
                .follow(error, measured, dt, bias, limits, self.held),
            (true, ..) => self.pid.relax(dt, bias, limits),
            (false, ..) => clamp(bias, limits.0, limits.1),
        }
    }
}

//! The core in the same number type: what every digit is compared with.

use hysteron::{Model, Sign};
use hysteron_core::{Direction, Plane, Real, State, Target, Turn, table_len, turn_capacity};
use std::fmt::Write;

/// A number type with its bits as text.
pub trait Number: Real {
    fn of(number: f64) -> Self;
    fn hex(self) -> String {
        format!("{:x}", self.bits())
    }
    fn wide(self) -> f64;
    fn from_bits(bits: u64) -> Self;
}

impl Number for f32 {
    fn of(number: f64) -> Self {
        number as f32
    }
    fn wide(self) -> f64 {
        f64::from(self)
    }
    fn from_bits(bits: u64) -> Self {
        f32::from_bits(bits as u32)
    }
}

impl Number for f64 {
    fn of(number: f64) -> Self {
        number
    }
    fn wide(self) -> f64 {
        self
    }
    fn from_bits(bits: u64) -> Self {
        f64::from_bits(bits)
    }
}

/// A command of the driver.
#[derive(Debug, Clone)]
pub enum Call {
    Step(f64),
    Inverse(f64, i32, f64),
    Save,
    Restore,
    RestoreGiven(f64, Vec<f64>),
    Off,
    On,
}

impl Call {
    pub fn line<T: Number>(&self) -> String {
        let hex = |x: f64| T::of(x).hex();
        match self {
            Call::Step(x) => format!("s {}", hex(*x)),
            Call::Inverse(y, heading, tolerance) => {
                format!("i {} {heading} {}", hex(*y), hex(*tolerance))
            }
            Call::Save => "v".into(),
            Call::Restore => "r".into(),
            Call::RestoreGiven(x, points) => {
                let points: Vec<String> = points.iter().map(|&x| hex(x)).collect();
                format!("R {} {} {}", hex(*x), points.len(), points.join(" "))
            }
            Call::Off => "0".into(),
            Call::On => "1".into(),
        }
    }
}

/// Offset and sign around a core model, in the number type.
pub struct Reference<T> {
    model: hysteron_core::Model<T, Vec<T>>,
    state: State<T, Vec<Turn<T>>>,
    offset: T,
    sign: Sign,
    saved: (Vec<T>, T),
}

impl<T: Number> Reference<T> {
    pub fn new(model: &Model) -> Self {
        let (plane, k) = (model.plane(), model.plane().levels());
        let plane = Plane::new(T::of(plane.min()), T::of(plane.max()), k).unwrap();
        let weights: Vec<T> = model.weights().iter().map(|&mu| T::of(mu)).collect();
        let table = vec![T::ZERO; table_len(k)];
        let core = hysteron_core::Model::new(plane, model.operator(), &weights, table).unwrap();
        let turn = Turn::default();
        let state = core.state(vec![turn; turn_capacity(k)]).unwrap();
        Self {
            model: core,
            state,
            offset: T::of(model.offset()),
            sign: model.sign(),
            saved: (Vec::new(), T::ZERO),
        }
    }

    fn sign(&self) -> T {
        T::of(self.sign.factor())
    }

    pub fn step(&mut self, input: T) -> Result<T, i32> {
        let output = self.model.step(&mut self.state, input);
        let output = output.map_err(|e| e.code())?.output;
        Ok(self.offset + self.sign() * output)
    }

    pub fn inverse(&mut self, target: T, heading: i32, tolerance: T) -> Result<(T, i32), i32> {
        let falls = self.sign == Sign::Negative;
        let heading = match if falls { -heading } else { heading } {
            0 => None,
            1 => Some(Direction::Rising),
            -1 => Some(Direction::Falling),
            _ => return Err(103),
        };
        let raw = Target {
            output: self.sign() * (target - self.offset),
            heading,
            tolerance,
        };
        let inverse = self.model.inverse().map_err(|e| e.code())?;
        let solution = inverse.step(&mut self.state, raw);
        let solution = solution.map_err(|e| e.code())?;
        let status = match falls {
            true => solution.status.mirrored(),
            false => solution.status,
        };
        Ok((solution.input, status.number().into()))
    }

    /// What the driver prints for the call.
    pub fn answer(&mut self, call: &Call, answers: &mut String) {
        let code = |result: Result<(), hysteron_core::Error>| match result {
            Ok(()) => 0,
            Err(error) => error.code(),
        };
        match call {
            Call::Step(x) => match self.step(T::of(*x)) {
                Ok(y) => writeln!(answers, "s 0 {}", y.hex()),
                Err(code) => writeln!(answers, "s {code} 0"),
            },
            Call::Inverse(y, heading, tolerance) => {
                match self.inverse(T::of(*y), *heading, T::of(*tolerance)) {
                    Ok((x, status)) => writeln!(answers, "i 0 {} {status}", x.hex()),
                    Err(code) => writeln!(answers, "i {code} 0 7"),
                }
            }
            Call::Save => {
                self.saved = (self.state.turning_points().collect(), self.state.input());
                let points: Vec<String> = self.saved.0.iter().map(|x| x.hex()).collect();
                writeln!(answers, "v 0 {} {}", self.saved.1.hex(), points.join(" "))
            }
            Call::Restore => {
                let (points, input) = &self.saved;
                let done = self.model.restore(&mut self.state, points, *input);
                writeln!(answers, "r {}", code(done))
            }
            Call::RestoreGiven(x, points) => {
                let points: Vec<T> = points.iter().map(|&x| T::of(x)).collect();
                let done = self.model.restore(&mut self.state, &points, T::of(*x));
                writeln!(answers, "R {}", code(done))
            }
            Call::Off => writeln!(answers, "0 {}", code(self.model.reset_off(&mut self.state))),
            Call::On => writeln!(answers, "1 {}", code(self.model.reset_on(&mut self.state))),
        }
        .unwrap();
    }
}

/// Commands for model number `n` and what the core answers.
pub fn script<T: Number>(n: usize, model: &Model, calls: &[Call]) -> (String, String) {
    let mut reference = Reference::<T>::new(model);
    let (mut commands, mut answers) = (format!("m {n}\n"), String::from("m 0\n"));
    for call in calls {
        commands += &call.line::<T>();
        commands.push('\n');
        reference.answer(call, &mut answers);
    }
    (commands, answers)
}

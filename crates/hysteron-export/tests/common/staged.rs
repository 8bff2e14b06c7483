//! Random models with stages, their calls, and the core that every digit is compared with.

use super::reference::Number;
use super::walks;
use hysteron::{LoadPart, Model, Operator, Sign, StageConstants};
use hysteron_core::{
    Constant, Direction, Plane, Rates, StageState, Stages, State, Target, Turn, Wanted, mix,
    table_len, turn_capacity,
};
use hysteron_export::{COptions, CReal, CSampling, c_texts};
use rand::RngExt;
use rand::rngs::StdRng;
use serde_json::{Value, json};
use std::fmt::Write;

/// A model with some of the stages, or all of them, and how it is sampled.
#[derive(Clone)]
pub struct Case {
    pub model: Model,
    pub sampling: CSampling,
    /// What the drive moves over.
    pub drives: (f64, f64),
    pub loads: (f64, f64),
}

fn sorted(rng: &mut StdRng, count: usize, low: f64, high: f64) -> Vec<f64> {
    let steps: Vec<f64> = (0..count).map(|_| rng.random_range(0.05..1.0)).collect();
    let sum: f64 = steps.iter().sum();
    let mut at = 0.0;
    let place = |step: &f64| {
        at += step;
        low + (high - low) * at / sum
    };
    steps.iter().map(place).collect()
}

fn curves(rng: &mut StdRng, width: f64) -> (Value, (f64, f64)) {
    let count = rng.random_range(1..6);
    let loads = sorted(rng, count, 0.0, 200.0);
    let range = (loads[0], loads[count - 1]);
    let mut curve = |low: f64, high: f64| -> Vec<f64> {
        match rng.random_bool(0.7) {
            true => (0..count).map(|_| rng.random_range(low..high)).collect(),
            false => Vec::new(),
        }
    };
    let shifts = curve(-0.3 * width, 0.3 * width);
    let scales = curve(0.5, 2.0);
    let gains = curve(0.3, 3.0);
    let offsets = curve(-2.0, 2.0);
    let all = json!({
        "loads": loads, "shifts": shifts, "scales": scales, "gains": gains, "offsets": offsets,
    });
    (all, range)
}

/// Knots of a registration, and a row for each load of temperatures on the way up and down.
fn registration(
    rng: &mut StdRng,
    loads: usize,
    (low, width): (f64, f64),
) -> (Vec<f64>, [Vec<f64>; 2]) {
    let count = rng.random_range(2..7);
    let (mut rising, mut falling) = (Vec::new(), Vec::new());
    for _ in 0..loads {
        let [a, b] = [0, 1].map(|_| {
            let from = low + width * rng.random_range(-0.3..0.2);
            sorted(rng, count, from, from + width)
        });
        rising.extend(a.iter().zip(&b).map(|(a, b)| f64::max(*a, *b)));
        falling.extend(a.iter().zip(&b).map(|(a, b)| f64::min(*a, *b)));
    }
    (sorted(rng, count, low, low + width), [rising, falling])
}

/// Weights and offset of the file are those in the middle of the parts.
fn at_middle(file: &mut Value, parts: &[Value]) {
    let mut factors = vec![0.0; parts.len()];
    hysteron_core::bernstein(0.5, &mut factors);
    let sum = |of: &dyn Fn(&Value) -> f64| -> f64 {
        factors
            .iter()
            .zip(parts)
            .map(|(f, part)| f * of(part))
            .sum()
    };
    let count = parts[0]["weights"].as_array().unwrap().len();
    let weight = |n: usize| sum(&|part| part["weights"][n].as_f64().unwrap());
    file["weights"] = (0..count).map(weight).collect();
    file["output"]["offset"] = sum(&|part| part["offset"].as_f64().unwrap()).into();
}

/// A start as fits find it.
fn start(rng: &mut StdRng, plain: &Model) -> Value {
    let (low, high) = (plain.plane().bottom(), plain.plane().max());
    let mut state = plain.start();
    let inputs: Vec<f64> = (0..9).map(|_| rng.random_range(low..high)).collect();
    plain.run(&mut state, &inputs, &mut [0.0; 9]).unwrap();
    let points: Vec<f64> = state.turning_points().collect();
    json!({"turning_points": points, "input": state.input()})
}

/// A model without stages, with a start or without.
pub fn bare(rng: &mut StdRng, operator: Operator, levels: usize) -> Case {
    let mut model = walks::model(rng, operator, levels);
    if rng.random_bool(0.6) {
        let mut file: Value = serde_json::from_str(&model.to_json()).unwrap();
        file["version"] = 2.into();
        file["start"] = start(rng, &model);
        model = Model::from_json(&file.to_string()).unwrap();
    }
    let (low, high) = (model.plane().bottom(), model.plane().max());
    let beyond = 0.3 * (high - low);
    Case {
        drives: (low - beyond, high + beyond),
        ..Case::of(model, CSampling::default())
    }
}

/// A model whose file says its stages; each is there as a coin falls, or all with `every`.
pub fn case(rng: &mut StdRng, operator: Operator, levels: usize, every: bool) -> Case {
    let plain = walks::model(rng, operator, levels);
    let (low, high) = (plain.plane().bottom(), plain.plane().max());
    let width = high - low;
    let mut file: Value = serde_json::from_str(&plain.to_json()).unwrap();
    file["version"] = 2.into();
    let coin = |rng: &mut StdRng| every || rng.random_bool(0.6);
    let dt: f64 = 10f64.powf(rng.random_range(-3.0..0.5));
    let tau = |rng: &mut StdRng| dt * 10f64.powf(rng.random_range(-1.0..3.0));
    let mut loads = (0.0, 1.0);
    if coin(rng) {
        let (curves, range) = curves(rng, width);
        loads = range;
        // The weights of half of the models depend on the load too, up to the third order.
        let count = [1, 1, 1, 2, 3, 4][rng.random_range(0..6)];
        let part = |n: usize| {
            let other = walks::model(rng, operator, levels);
            let part = if n == 0 { &plain } else { &other };
            json!({"offset": part.offset(), "weights": part.weights()})
        };
        let parts: Vec<Value> = (0..count).map(part).collect();
        at_middle(&mut file, &parts);
        file["load"] = json!({
            "name": "stress", "min": range.0 - 1.0, "max": range.1 + 1.0, "curves": curves,
            "parts": parts,
        });
    }
    if coin(rng) {
        let corners = sorted(rng, levels + 1, low - 0.1 * width, high + 0.2 * width);
        file["spacing"] = corners.into();
    }
    let mut drives = (low - 0.3 * width, high + 0.3 * width);
    if coin(rng) {
        let (ambient, gain) = (rng.random_range(-20.0..40.0), rng.random_range(0.2..80.0));
        drives = ((drives.0 - ambient) / gain, (drives.1 - ambient) / gain);
        file["thermal"] = json!({
            "kind": "first-order", "ambient": ambient, "gain": gain,
            "tau_heating": tau(rng), "tau_cooling": tau(rng),
        });
        if operator != Operator::Relay && coin(rng) {
            file["version"] = 3.into();
            file["stages"] = json!({"latent": [width * 10f64.powf(rng.random_range(-2.0..0.5))]});
        }
    }
    if coin(rng) {
        let terms = rng.random_range(1..=4);
        let term = |_| json!({"coefficient": rng.random_range(0.0..0.4), "tau": tau(rng)});
        file["creep"] = (0..terms).map(term).collect::<Vec<_>>().into();
    }
    if coin(rng) {
        file["lag"] = tau(rng).into();
    }
    if coin(rng) {
        let knots = rng.random_range(2..7);
        file["version"] = 3.into();
        file["stages"]["curve_sums"] = sorted(rng, knots, -1.0, 9.0).into();
        file["stages"]["curve_outputs"] = sorted(rng, knots, 2.0, 30.0).into();
    }
    if coin(rng) {
        let loads = file["load"]["curves"]["loads"]
            .as_array()
            .map_or(1, Vec::len);
        let (knots, [rising, falling]) = registration(rng, loads, (low, width));
        file["version"] = 3.into();
        if file["stages"].is_null() {
            file["stages"] = json!({});
        }
        (file["stages"]["knots"], file["stages"]["rising"]) = (knots.into(), rising.into());
        if rng.random_bool(0.8) {
            file["stages"]["falling"] = falling.into();
        }
    }
    if coin(rng) {
        file["version"] = 3.into();
        // From steps of a hundredth of a radian to beyond the Nyquist frequency.
        let turn = 10f64.powf(rng.random_range(-2.0..0.7));
        let damping = 10f64.powf(rng.random_range(-3.0..0.1)).min(1.0);
        file["stages"]["ring_frequency"] = json!([turn / (std::f64::consts::TAU * dt)]);
        file["stages"]["ring_damping"] = json!([damping]);
    }
    if coin(rng) {
        file["start"] = start(rng, &plain);
    }
    let model = Model::from_json(&file.to_string()).unwrap_or_else(|_| {
        // Weights below zero bind no heat.
        file["stages"].as_object_mut().unwrap().remove("latent");
        Model::from_json(&file.to_string()).unwrap()
    });
    let limited = !model.is_plain() && rng.random_bool(0.6);
    let sampling = CSampling {
        dt: model.is_timed().then_some(dt),
        drive: limited.then_some(drives),
        ..CSampling::default()
    };
    Case {
        model,
        sampling,
        drives,
        loads,
    }
}

impl Case {
    /// This model at this sampling, for calls of one's own.
    pub fn of(model: Model, sampling: CSampling) -> Self {
        Self {
            drives: model.drive_range(),
            loads: (0.0, 1.0),
            model,
            sampling,
        }
    }

    /// Whether the digits of the number type keep the model.
    pub fn is_kept(&self, real: CReal) -> bool {
        let options = COptions {
            real,
            name: Some("m"),
            source: "m.json".as_ref(),
            adaptation: false,
        };
        c_texts(&self.model, &options, &self.sampling).is_ok()
    }

    /// The same model sampled at up to 10 kHz, with a body that takes up to 10⁶ samples.
    pub fn fast(&mut self, rng: &mut StdRng) {
        let Some(body) = &mut self.model.thermal else {
            return;
        };
        let dt = 10f64.powf(rng.random_range(-4.0..-2.0));
        for tau in [&mut body.tau_heating, &mut body.tau_cooling] {
            *tau = dt * 10f64.powf(rng.random_range(-1.0..6.0));
        }
        self.sampling.dt = Some(dt);
    }

    /// The range of outputs, at the load where it is widest, behind all stages.
    pub fn widest(&self) -> f64 {
        let stages = self.model.stages();
        let gains = stages.axis.load.gains.iter().copied();
        let gain = gains.reduce(f64::max).unwrap_or(1.0);
        let sum = |weights: &[f64]| weights.iter().sum::<f64>();
        let parts = self.model.load.iter().flat_map(|load| load.parts());
        let own = sum(self.model.weights());
        let largest = parts.map(|part| sum(&part.weights)).fold(own, f64::max);
        let off = match self.model.operator() {
            Operator::Mkp => 0.0,
            _ => -largest,
        };
        let [low, high] = [off, largest].map(|sum| stages.behind.settled(gain * sum));
        high - low
    }
}

/// A command of the driver `staged.c`.
#[derive(Debug, Clone)]
pub enum Call {
    Step(f64, f64),
    Inverse(f64, i32, f64, f64),
    Save,
    Restore,
}

/// About `count` calls.
pub fn calls(rng: &mut StdRng, case: &Case, count: usize) -> Vec<Call> {
    let (a, b) = case.model.output_range();
    let (low, high) = (a.min(b) - 0.5, a.max(b) + 0.5);
    let not = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let mut calls = Vec::new();
    let mut load = case.loads.0;
    while calls.len() < count {
        if rng.random_bool(0.3) {
            load = rng.random_range(case.loads.0 - 5.0..case.loads.1 + 5.0);
        }
        let burst = rng.random_range(1..30);
        let (hold, kind) = (rng.random_bool(0.3), rng.random_range(0..12));
        let mut drive = rng.random_range(case.drives.0..case.drives.1);
        let mut target = rng.random_range(low..high);
        let tolerance = match rng.random_range(0..4) {
            0 => rng.random_range(0.0..0.1) * (high - low),
            1 => [f64::NAN, -1.0][rng.random_range(0..2)],
            _ => 0.0,
        };
        for _ in 0..burst {
            if !hold {
                drive = rng.random_range(case.drives.0..case.drives.1);
                target += rng.random_range(-0.1..0.1) * (high - low);
            }
            let heading = if kind == 8 {
                rng.random_range(-1..=1)
            } else {
                0
            };
            match kind {
                0..=4 => calls.push(Call::Step(drive, load)),
                5..=8 => calls.push(Call::Inverse(target, heading, tolerance, load)),
                _ => {}
            }
        }
        let wrong = not[rng.random_range(0..3)];
        match kind {
            9 => calls.extend([Call::Save, Call::Restore]),
            10 => calls.extend([Call::Step(wrong, load), Call::Inverse(wrong, 0, 0.0, load)]),
            11 => calls.extend([
                Call::Step(drive, wrong),
                Call::Inverse(target, 0, 0.0, wrong),
                Call::Inverse(target, 7, 0.0, load),
            ]),
            _ => {}
        }
    }
    calls.push(Call::Save);
    calls
}

/// The numbers of the stages in the number type.
struct Numbers<T> {
    constants: StageConstants<T>,
    offset: T,
    falling: bool,
}

impl<T: Number> Numbers<T> {
    fn of(model: &Model) -> Self {
        let convert = |_: &Constant, x| Ok::<_, ()>(T::of(x));
        Self {
            constants: model.constants().map(convert).unwrap(),
            offset: T::of(model.offset()),
            falling: model.sign() == Sign::Negative,
        }
    }

    fn stages(&self) -> Stages<'_, T> {
        Stages {
            offset: self.offset,
            falling: self.falling,
            ..self.constants.stages()
        }
    }
}

/// Weights that depend on the load, in the number type.
struct Parts<T> {
    tables: Vec<Vec<T>>,
    offsets: Vec<T>,
    range: (T, T),
    negative: bool,
}

impl<T: Number> Parts<T> {
    fn of(model: &Model, plane: Plane<T>) -> Option<Self> {
        let load = model.load.as_ref().filter(|load| load.parts().len() > 1)?;
        let core = |part: &LoadPart| {
            let weights: Vec<T> = part.weights.iter().map(|&mu| T::of(mu)).collect();
            let table = vec![T::ZERO; table_len(plane.levels())];
            hysteron_core::Model::new(plane, model.operator(), &weights, table).unwrap()
        };
        let cores: Vec<_> = load.parts().iter().map(core).collect();
        let (low, high) = load.range();
        Some(Self {
            negative: cores.iter().any(|core| core.negative_weights().is_some()),
            tables: cores.iter().map(|core| core.table().to_vec()).collect(),
            offsets: load.parts().iter().map(|part| T::of(part.offset)).collect(),
            range: (T::of(low), T::of(high)),
        })
    }

    /// The values of the Bernstein polynomials of the load, as the library computes them.
    fn factors(&self, load: T) -> Vec<T> {
        let (low, high) = self.range;
        let s = ((load - low) / (high - low)).clamp(T::ZERO, T::ONE);
        let mut values = vec![T::ONE];
        for _ in 1..self.tables.len() {
            let mut next = vec![T::ZERO; values.len() + 1];
            for (k, &value) in values.iter().enumerate() {
                next[k] = next[k] + (T::ONE - s) * value;
                next[k + 1] = next[k + 1] + s * value;
            }
            values = next;
        }
        values
    }
}

pub struct Reference<T> {
    model: hysteron_core::Model<T, Vec<T>>,
    parts: Option<Parts<T>>,
    numbers: Numbers<T>,
    rates: Rates<T>,
    drive: (T, T),
    state: State<T, Vec<Turn<T>>>,
    memory: StageState<T>,
    saved: (Vec<T>, T, StageState<T>),
}

impl<T: Number> Reference<T> {
    pub fn new(case: &Case) -> Self {
        let (model, plane) = (&case.model, case.model.plane());
        let k = plane.levels();
        let plane = Plane::new(T::of(plane.min()), T::of(plane.max()), k).unwrap();
        let weights: Vec<T> = model.weights().iter().map(|&mu| T::of(mu)).collect();
        let table = vec![T::ZERO; table_len(k)];
        let core = hysteron_core::Model::new(plane, model.operator(), &weights, table).unwrap();
        let mut state = core.state(vec![Turn::default(); turn_capacity(k)]).unwrap();
        if let Some(start) = model.fitted() {
            let points: Vec<T> = start.turning_points().map(T::of).collect();
            core.restore(&mut state, &points, T::of(start.input()))
                .unwrap();
        }
        let numbers = Numbers::<T>::of(model);
        let rates = numbers
            .stages()
            .rates(T::of(case.sampling.dt.unwrap_or(1.0)));
        let (low, high) = case.sampling.drive.unwrap_or_else(|| model.drive_range());
        Self {
            saved: (Vec::new(), state.input(), StageState::default()),
            parts: Parts::of(model, plane),
            model: core,
            numbers,
            rates,
            drive: (T::of(low), T::of(high)),
            state,
            memory: StageState::default(),
        }
    }

    /// Brings the operators to a load, where their weights depend on it.
    fn place(&mut self, load: T) {
        if let Some(parts) = self.parts.as_ref().filter(|_| load.is_finite()) {
            let factors = parts.factors(load);
            mix(&mut self.model, &mut self.state, &parts.tables, &factors).unwrap();
            let offsets = parts.offsets.iter().zip(factors);
            let sum = |sum: T, (&offset, factor): (&T, T)| sum + factor * offset;
            self.numbers.offset = offsets.fold(T::ZERO, sum);
        }
    }

    pub fn invert(&mut self, target: Target<T>, load: T) -> Result<(T, i8), i32> {
        if self.parts.as_ref().is_some_and(|parts| parts.negative) {
            return Err(5);
        }
        if self.parts.is_some() && target.output.is_finite() {
            if !load.is_finite() {
                return Err(13);
            }
            self.place(load);
        }
        let wanted = Wanted {
            load: Some(load),
            drive: self.drive,
            ..target.into()
        };
        let inverse = self.model.inverse().map_err(|e| e.code())?;
        let stages = self.numbers.stages();
        let (state, memory) = (&mut self.state, &mut self.memory);
        let found = stages.invert_at(&inverse, state, memory, &self.rates, wanted);
        let found = found.map_err(|e| e.code())?;
        Ok((found.input, found.status.number()))
    }

    fn answer(&mut self, call: &Call, answers: &mut String) {
        match call {
            Call::Step(drive, load) => {
                let (drive, load) = (T::of(*drive), T::of(*load));
                if drive.is_finite() {
                    self.place(load);
                }
                // Curves or none: weights alone need the load too.
                if self.parts.is_some() && drive.is_finite() && !load.is_finite() {
                    writeln!(answers, "s 13 0").unwrap();
                    return;
                }
                let load = Some(load);
                let stages = self.numbers.stages();
                let (state, memory) = (&mut self.state, &mut self.memory);
                let step = stages.step_at(&self.model, state, memory, &self.rates, drive, load);
                match step {
                    Ok(step) => writeln!(answers, "s 0 {}", step.output.hex()),
                    Err(error) => writeln!(answers, "s {} 0", error.code()),
                }
            }
            Call::Inverse(output, heading, tolerance, load) => {
                let target = Target {
                    output: T::of(*output),
                    heading: match heading {
                        -1 => Some(Direction::Falling),
                        1 => Some(Direction::Rising),
                        _ => None,
                    },
                    tolerance: T::of(*tolerance),
                };
                let found = match heading {
                    -1..=1 => self.invert(target, T::of(*load)),
                    _ => Err(103),
                };
                match found {
                    Ok((drive, status)) => writeln!(answers, "i 0 {} {status}", drive.hex()),
                    Err(code) => writeln!(answers, "i {code} 0 7"),
                }
            }
            Call::Save => {
                let points = self.state.turning_points().collect();
                self.saved = (points, self.state.input(), self.memory);
                let (points, input, memory) = &self.saved;
                let numbers = memory.to_numbers();
                let numbers = points.iter().chain(&numbers).map(|x| x.hex());
                let numbers: Vec<String> = numbers.collect();
                writeln!(answers, "v 0 {} {}", input.hex(), numbers.join(" "))
            }
            Call::Restore => {
                let (points, input, memory) = &self.saved;
                self.model.restore(&mut self.state, points, *input).unwrap();
                self.memory = StageState::from_numbers(&memory.to_numbers()).unwrap();
                writeln!(answers, "r 0")
            }
        }
        .unwrap();
    }
}

/// Commands for model number `n` and what the core answers.
pub fn script<T: Number>(n: usize, case: &Case, calls: &[Call]) -> (String, String) {
    let mut reference = Reference::<T>::new(case);
    let (mut commands, mut answers) = (format!("m {n}\n"), String::from("m 0\n"));
    let hex = |x: f64| T::of(x).hex();
    for call in calls {
        commands += &match call {
            Call::Step(drive, load) => format!("s {} {}\n", hex(*drive), hex(*load)),
            Call::Inverse(y, heading, tolerance, load) => {
                format!(
                    "i {} {heading} {} {}\n",
                    hex(*y),
                    hex(*tolerance),
                    hex(*load)
                )
            }
            Call::Save => "v\n".into(),
            Call::Restore => "r\n".into(),
        };
        reference.answer(call, &mut answers);
    }
    (commands, answers)
}

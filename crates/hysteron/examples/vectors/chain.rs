//! Expected numbers of a model with stages, from the plain formula of each stage. Where a stage has
//! to be inverted, its formula is searched by bisection.

use super::plain::{self, Search, Wanted};
use hysteron::{Model, Operator, Result, Sign};

/// What is given for one sample: drive or target, time since the sample before, load.
#[derive(Clone, Copy)]
pub struct Sample {
    pub value: f64,
    pub dt: f64,
    pub load: f64,
}

/// What is wanted in one sample of an inverse.
pub struct Aim {
    pub sample: Sample,
    pub heading: i8,
    pub tolerance: f64,
    pub drive_range: (f64, f64),
    pub horizon: f64,
}

/// What body, creep, lag and ring remember.
#[derive(Clone)]
struct Memory {
    temperature: f64,
    after: After,
    /// The output that was wanted of the ring; that of a step forward.
    wanted: f64,
}

/// What the stages behind the operators remember.
#[derive(Clone)]
struct After {
    crept: Vec<f64>,
    lagged: f64,
    /// Output of the ring, and its velocity over `ω`.
    swung: [f64; 2],
}

/// The curves at one load, and the offset of the weights there.
struct Loaded {
    scale: f64,
    shift: f64,
    gain: f64,
    offset: f64,
    base: f64,
    load: f64,
}

/// A model, and its operators alone: their output is `Σ μ γ`.
pub struct Chain<'m> {
    model: &'m Model,
    /// Operators and offset of each part; one part, where the weights do not depend on the load.
    parts: Vec<(Model, f64)>,
    memory: Option<Memory>,
}

impl<'m> Chain<'m> {
    pub fn new(model: &'m Model) -> Result<Self> {
        let part = |weights: &[f64], offset| Ok((operators(model, weights.to_vec())?, offset));
        let parts: Result<Vec<_>> = match &model.load {
            None => Ok(vec![part(model.weights(), model.offset())?]),
            Some(load) => load
                .parts()
                .iter()
                .map(|p| part(&p.weights, p.offset))
                .collect(),
        };
        Ok(Self {
            model,
            parts: parts?,
            memory: None,
        })
    }

    /// The factor of each part at a load: the Bernstein polynomials, as their formula is.
    fn factors(&self, load: f64) -> Vec<f64> {
        let degree = self.parts.len() - 1;
        let (low, high) = self
            .model
            .load
            .as_ref()
            .map_or((0.0, 1.0), |load| load.range());
        let s = (load - low) / (high - low);
        let binomial = |k: usize| (0..k).fold(1, |c, i| c * (degree - i) / (i + 1)) as f64;
        let power = |base: f64, exponent: usize| (0..exponent).fold(1.0, |p, _| p * base);
        (0..=degree)
            .map(|k| binomial(k) * power(s, k) * power(1.0 - s, degree - k))
            .collect()
    }

    /// The sum of the parts' numbers at a load.
    fn mixed(&self, load: f64, of: impl Fn(usize) -> f64) -> f64 {
        let factors = self.factors(load).into_iter().enumerate();
        factors.map(|(part, factor)| factor * of(part)).sum()
    }

    /// The operators with their weights at a load.
    fn at(&self, load: f64) -> Result<Model> {
        let weights = 0..self.model.weights().len();
        let weights = weights.map(|n| self.mixed(load, |part| self.parts[part].0.weights()[n]));
        operators(self.model, weights.collect())
    }

    /// The outputs for samples of the drive, from the first one on.
    pub fn forward(mut self, samples: &[Sample]) -> Result<Vec<f64>> {
        let (mut temperatures, mut seen) = (Vec::new(), Vec::new());
        let mut search = Search::new(&self.parts[0].0)?;
        let (mut last, mut held) = (None, f64::NEG_INFINITY);
        for sample in samples {
            let loaded = self.loaded(sample.load);
            search.weigh(&self.at(sample.load)?)?;
            let unbound = self.heated(last, sample.value, sample.dt);
            let temperature = self.bound(&search, &loaded, (held, last), unbound);
            held = self.seen(&loaded, held, temperature);
            search.travel(held)?;
            last = Some(temperature);
            temperatures.push(temperature);
            seen.push(held);
        }
        let sums = self
            .parts
            .iter()
            .map(|(part, _)| plain::forward(part, &seen));
        let sums = sums.collect::<Result<Vec<_>>>()?;
        let outputs = samples.iter().zip(temperatures).enumerate();
        let outputs = outputs.map(|(n, (sample, temperature))| {
            let sum = self.mixed(sample.load, |part| sums[part][n]);
            let loaded = self.loaded(sample.load);
            let after = self.settled(loaded.gain * sum, sample.dt);
            let settled = after.swung[0];
            self.memory = Some(Memory {
                temperature,
                after,
                wanted: settled,
            });
            self.outward(&loaded, settled)
        });
        Ok(outputs.collect())
    }

    /// Drive and status for each sample: −1 below reach at rest, 1 above, 3 not in this sample.
    pub fn inverse(mut self, aims: &[Aim]) -> Result<Vec<(f64, i8)>> {
        let mut search = Search::new(&self.parts[0].0)?;
        aims.iter().map(|aim| self.step(&mut search, aim)).collect()
    }

    fn step(&mut self, search: &mut Search, aim: &Aim) -> Result<(f64, i8)> {
        let Sample {
            value: target,
            dt,
            load,
        } = aim.sample;
        let loaded = self.loaded(load);
        let sign = self.model.sign().factor();
        let wanted = sign * (target - loaded.offset - loaded.base);
        let operators = self.at(load)?;
        search.weigh(&operators)?;
        let settled = |sum: f64| self.settled(loaded.gain * sum, dt).swung[0];
        let (off, on) = operators.output_range();
        // The steepest slope: as much of the sum the output may move within a tolerance.
        let slope = self.steepest()
            * (self.timed(1.0, dt).swung[0] - self.timed(0.0, dt).swung[0])
            * loaded.gain;
        let seen = if slope > 0.0 {
            let sum = match self.model.constants().get("ring_frequency") {
                [] => root(settled, wanted),
                _ => self.calm(&loaded, wanted, dt, (off, on)),
            };
            // Where the sum is what it was but for rounding, it is just that.
            let apart = (sum - search.output()).abs();
            let target = if apart <= SAME * (on - off) {
                search.output()
            } else {
                sum
            };
            let wanted = Wanted {
                target,
                heading: sign as i8 * aim.heading,
                tolerance: aim.tolerance / slope,
            };
            search.find(&wanted)?.0
        } else {
            // A lag in a step without length: the output cannot move.
            search.input()
        };
        let last = self.memory.as_ref().map(|memory| memory.temperature);
        let plane = self.model.plane();
        let held = search.input().clamp(plane.bottom(), plane.max());
        let by = |rising| root(|temperature| self.led(&loaded, rising, temperature), seen);
        let temperature = if seen > held {
            by(true)
        } else if seen < held {
            by(false)
        } else {
            // Every temperature between the two curves stays there.
            match sign as i8 * aim.heading {
                1 => by(true),
                -1 => by(false),
                _ => last.unwrap_or(0.0).max(by(false)).min(by(true)),
            }
        };
        let unbound = match last {
            None => temperature,
            Some(_) => temperature + self.taken(search, &loaded, held, temperature),
        };
        let drive = self.drive(aim, unbound);

        let unbound = self.heated(last, drive, dt);
        let temperature = self.bound(search, &loaded, (held, last), unbound);
        search.travel(self.seen(&loaded, held, temperature))?;
        let after = self.settled(loaded.gain * search.output(), dt);
        let settled = after.swung[0];
        self.memory = Some(Memory {
            temperature,
            after,
            wanted,
        });
        let rest = |sum: f64| self.gain_at_rest() * self.curved(loaded.gain * sum);
        let ends = [off, on].map(|sum| self.outward(&loaded, rest(sum)));
        let (least, greatest) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let same = SAME * (greatest - least);
        let reach = aim.tolerance.max(same);
        let status = if (self.outward(&loaded, settled) - target).abs() <= aim.tolerance + same {
            0
        } else if target > greatest + reach {
            1
        } else if target < least - reach {
            -1
        } else {
            3
        };
        Ok((drive, status))
    }

    /// The drive for a temperature, as far as the range of the drive goes.
    fn drive(&self, aim: &Aim, temperature: f64) -> f64 {
        let (low, high) = aim.drive_range;
        let last = self.memory.as_ref().map(|memory| memory.temperature);
        let dt = aim.sample.dt.max(aim.horizon);
        if self.model.thermal.is_none() {
            return temperature.clamp(low, high);
        }
        let heated = |drive| self.heated(last, drive, dt);
        if heated(high) <= temperature && heated(low) < temperature {
            high
        } else if heated(low) >= temperature {
            low
        } else {
            between(heated, temperature, low, high)
        }
    }

    /// The temperature after `dt` with the drive held; at rest before the first sample. The input
    /// itself without a body.
    fn heated(&self, last: Option<f64>, drive: f64, dt: f64) -> f64 {
        let Some(body) = self.model.thermal else {
            return drive;
        };
        let rest = body.ambient + body.gain * drive;
        match last {
            None => rest,
            Some(last) if rest > last => rest + (last - rest) * (-dt / body.tau_heating).exp(),
            Some(last) => rest + (last - rest) * (-dt / body.tau_cooling).exp(),
        }
    }

    /// The heat that is bound between here and a temperature, in degrees.
    fn taken(&self, search: &Search, loaded: &Loaded, held: f64, temperature: f64) -> f64 {
        if self.model.latent() == 0.0 {
            return 0.0;
        }
        let there = search.after(self.seen(loaded, held, temperature));
        let (least, greatest) = search.range();
        let share = (there.unwrap_or(f64::NAN) - search.output()) / (greatest - least);
        self.model.latent() * share
    }

    /// The temperature of a body that would come to `unbound` if nothing were bound; nothing is at
    /// the first sample.
    fn bound(
        &self,
        search: &Search,
        loaded: &Loaded,
        (held, last): (f64, Option<f64>),
        unbound: f64,
    ) -> f64 {
        if last.is_none() || self.model.latent() == 0.0 {
            return unbound;
        }
        let free = |temperature| temperature + self.taken(search, loaded, held, temperature);
        root(free, unbound)
    }

    fn loaded(&self, load: f64) -> Loaded {
        let curves = self
            .model
            .load
            .as_ref()
            .and_then(|load| load.curves.as_ref());
        let of = |values: fn(&hysteron::LoadCurves) -> &Vec<f64>, none: f64| match curves {
            Some(curves) if !values(curves).is_empty() => {
                let loads = &curves.loads;
                let load = load.clamp(loads[0], loads[loads.len() - 1]);
                line(loads, values(curves), load)
            }
            _ => none,
        };
        Loaded {
            scale: of(|curves| &curves.scales, 1.0),
            shift: of(|curves| &curves.shifts, 0.0),
            gain: of(|curves| &curves.gains, 1.0),
            offset: of(|curves| &curves.offsets, 0.0),
            load,
            base: self.mixed(load, |part| self.parts[part].1),
        }
    }

    /// What the operators see of a temperature, where they saw `held` before: a play between the two
    /// curves of the registration.
    fn seen(&self, loaded: &Loaded, held: f64, temperature: f64) -> f64 {
        let [up, down] = [true, false].map(|rising| self.led(loaded, rising, temperature));
        f64::max(up, f64::min(held, down))
    }

    /// The position behind one of the two curves, between the knots on a line and beyond them of slope
    /// one.
    fn registered(&self, load: f64, rising: bool, effective: f64) -> f64 {
        let registration = self.model.registration();
        let (knots, count) = (&registration.knots, registration.knots.len());
        let rows = match rising || registration.falling.is_empty() {
            true => &registration.rising,
            false => &registration.falling,
        };
        let curves = self
            .model
            .load
            .as_ref()
            .and_then(|load| load.curves.as_ref());
        let row: Vec<f64> = match curves {
            None => rows.clone(),
            Some(curves) => {
                let loads = &curves.loads;
                let load = load.clamp(loads[0], loads[loads.len() - 1]);
                let at = |m: usize| {
                    let column: Vec<f64> = rows.iter().skip(m).step_by(count).copied().collect();
                    line(loads, &column, load)
                };
                (0..count).map(at).collect()
            }
        };
        match effective {
            _ if count == 0 => effective,
            t if t < row[0] => knots[0] + (t - row[0]),
            t if t > row[count - 1] => knots[count - 1] + (t - row[count - 1]),
            t => line(&row, knots, t),
        }
    }

    /// What the operators see of a temperature that leads them from below, or from above.
    fn led(&self, loaded: &Loaded, rising: bool, temperature: f64) -> f64 {
        let effective = loaded.scale * temperature - loaded.shift;
        let effective = self.registered(loaded.load, rising, effective);
        let corners = self.model.spacing();
        let plane = self.model.plane();
        let levels: Vec<f64> = (0..corners.len()).map(|k| plane.level(k)).collect();
        match corners {
            [] => effective,
            _ => line(corners, &levels, effective),
        }
    }

    /// The sum that is wanted of the operators for an output behind a ring: the exact one where what
    /// alternates afterwards is within reach, and otherwise one that damps.
    fn calm(&self, loaded: &Loaded, wanted: f64, dt: f64, (off, on): (f64, f64)) -> f64 {
        let Some(memory) = &self.memory else {
            return root(|sum| self.settled(loaded.gain * sum, dt).swung[0], wanted);
        };
        let constants = self.model.constants();
        let zeta = constants.get("ring_damping")[0];
        let turn = std::f64::consts::TAU * constants.get("ring_frequency")[0] * dt;
        let [_, v] = memory.after.swung;
        // The sum for an input of the ring.
        let before = |input: f64| {
            let sum = |sum: f64| self.timed(self.curved(loaded.gain * sum), dt).lagged;
            root(sum, input)
        };
        let reach = |input: f64| (off..=on).contains(&before(input));
        // The ring's output and velocity at the end are straight lines over its input.
        let (none, one) = (self.swung(0.0, dt), self.swung(1.0, dt));
        let [y0, v0] = none;
        let [gain, b] = [one[0] - y0, one[1] - v0];
        let exact = (wanted - y0) / gain;
        // A ramp of this slope, at the samples: `v = d v + b (u − y)` and `y + rise = y + (1 − a)
        // (u − y) + b v`, where `d` is how much of the velocity is left.
        let d = self.left(turn, zeta);
        let rise = wanted - memory.wanted;
        let rate = rise * b / (b * b + gain * (1.0 - d));
        let follow = memory.wanted + rise * (1.0 - d) / (b * b + gain * (1.0 - d));
        let swing = (b / gain * (v0 + b * exact - rate)).abs();
        if [exact, follow - swing, follow + swing]
            .into_iter()
            .all(reach)
        {
            let alternates = before(follow + swing) - before(follow - swing);
            if alternates <= (on - off) / 128.0 {
                return before(exact);
            }
            // A little of the target for the velocity: the least of `(y − y*)² + (1 − a) δ²/2`.
            let weight = 0.5 * gain;
            let soft = gain * (wanted - y0) + weight * b * (rate - v0);
            return before(soft / (gain * gain + weight * b * b));
        }
        // Where the energy of what is left is least.
        let least = (gain * (wanted - y0) + b * (rate - v0)) / (gain * gain + b * b);
        let damped = follow + 2.0 * (1.0 - zeta) * (rate - v);
        before(damped.clamp(follow.min(least), follow.max(least)))
    }

    /// How much of a velocity of the ring is left after a step.
    fn left(&self, turn: f64, zeta: f64) -> f64 {
        let root = (1.0 - zeta * zeta).sqrt();
        let (sin, cos) = (root * turn).sin_cos();
        (-zeta * turn).exp() * (cos - zeta / root * sin)
    }

    /// Curve, creep, lag and ring for the operators' `h`.
    fn settled(&self, h: f64, dt: f64) -> After {
        self.timed(self.curved(h), dt)
    }

    /// The output curve.
    fn curved(&self, h: f64) -> f64 {
        let constants = self.model.constants();
        match constants.get("curve_sums") {
            [] => h,
            sums => line(sums, constants.get("curve_outputs"), h),
        }
    }

    /// The steepest slope of the output curve.
    fn steepest(&self) -> f64 {
        let constants = self.model.constants();
        let (sums, outputs) = (constants.get("curve_sums"), constants.get("curve_outputs"));
        let pieces = sums.windows(2).zip(outputs.windows(2));
        let slopes = pieces.map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]));
        slopes.reduce(f64::max).unwrap_or(1.0)
    }

    /// Output and velocity of the ring with its input held at `u` for `dt`: the solution of the
    /// differential equation. At the first sample it rests.
    fn swung(&self, u: f64, dt: f64) -> [f64; 2] {
        let constants = self.model.constants();
        let (&[frequency], Some(memory)) = (constants.get("ring_frequency"), &self.memory) else {
            return [u, 0.0];
        };
        let zeta = constants.get("ring_damping")[0];
        let turn = std::f64::consts::TAU * frequency * dt;
        let root = (1.0 - zeta * zeta).sqrt();
        let (fade, angle) = ((-zeta * turn).exp(), root * turn);
        let [y, v] = memory.after.swung;
        // `u + e^(−ζωt) (p cos + q sin)`, and its derivative over ω.
        let p = y - u;
        let q = (v + zeta * p) / root;
        let (sin, cos) = angle.sin_cos();
        [
            u + fade * (p * cos + q * sin),
            fade * ((root * q - zeta * p) * cos - (root * p + zeta * q) * sin),
        ]
    }

    /// Creep, lag and ring.
    fn timed(&self, h: f64, dt: f64) -> After {
        let faded = |last: Option<f64>, now: f64, tau: f64| match last {
            Some(last) if tau > 0.0 => now + (last - now) * (-dt / tau).exp(),
            _ => now,
        };
        let memory = self.memory.as_ref();
        let terms = self.model.creep();
        let crept: Vec<f64> = (terms.iter().enumerate())
            .map(|(k, term)| faded(memory.map(|memory| memory.after.crept[k]), h, term.tau))
            .collect();
        let crawl = terms.iter().zip(&crept);
        let sum = h + crawl
            .map(|(term, crept)| term.coefficient * crept)
            .sum::<f64>();
        let lagged = faded(
            memory.map(|memory| memory.after.lagged),
            sum,
            self.model.lag(),
        );
        // At the first sample the lag has rested at `h`, and nothing of that is left.
        After {
            crept,
            lagged,
            swung: self.swung(lagged, dt),
        }
    }

    fn gain_at_rest(&self) -> f64 {
        let terms = self.model.creep();
        1.0 + terms.iter().map(|term| term.coefficient).sum::<f64>()
    }

    fn outward(&self, loaded: &Loaded, sum: f64) -> f64 {
        loaded.offset + loaded.base + self.model.sign().factor() * sum
    }
}

/// Operators with these weights, alone.
fn operators(model: &Model, weights: Vec<f64>) -> Result<Model> {
    let (operator, plane) = (model.operator(), *model.plane());
    Model::new(operator, plane, weights, 0.0, Sign::Positive)
}

/// Outputs closer than this share of the range are the same: rounding, with room for the search.
const SAME: f64 = 1e-11;

/// The size of the output at most, for tolerances.
pub fn size(model: &Model) -> f64 {
    let parts = model.load.as_ref().map_or(&[][..], |load| load.parts());
    let parts = parts
        .iter()
        .map(|part| size_of(model, &part.weights, part.offset));
    parts.fold(size_of(model, model.weights(), model.offset()), f64::max)
}

fn size_of(model: &Model, weights: &[f64], offset: f64) -> f64 {
    let total: f64 = weights.iter().sum();
    let sure = if model.operator() == Operator::Mkp {
        1.0
    } else {
        2.0
    };
    sure * total + offset.abs()
}

/// The piecewise linear function through these points. Beyond the ends it goes on straight.
fn line(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    if xs.len() == 1 {
        return ys[0];
    }
    let mut k = 0;
    while k + 2 < xs.len() && x > xs[k + 1] {
        k += 1;
    }
    ys[k] + (x - xs[k]) * (ys[k + 1] - ys[k]) / (xs[k + 1] - xs[k])
}

/// Where a rising function has this value.
fn root(function: impl Fn(f64) -> f64, value: f64) -> f64 {
    between(function, value, -1e6, 1e6)
}

fn between(function: impl Fn(f64) -> f64, value: f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = low + (high - low) / 2.0;
        if middle == low || middle == high {
            return high;
        }
        if function(middle) >= value {
            high = middle;
        } else {
            low = middle;
        }
    }
}

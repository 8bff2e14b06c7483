//! What the band and the intervals of the weights hold where the truth is known.

use hysteron::{
    Excitation, Fit, INTERVAL, Model, Operator, Plane, Recording, Sign, Spacing, Start, operators,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::error::Error;

/// Random materials for each row of the table.
const MATERIALS: u64 = 12;
/// Levels of the materials that are of the kind that is fitted.
const LEVELS: usize = 12;
/// Levels of the relay materials: finer than a fit sees.
const FINE: usize = 80;
/// Branches fitted, few and many, and of a fresh input.
const BRANCHES: [usize; 2] = [6, 30];
const FRESH: usize = 60;
/// Samples of a branch.
const SAMPLES: usize = 30;
/// Standard deviation of the noise, as a share of the range of the output.
const NOISE: f64 = 0.005;

/// Prints the section of `docs/measured/coverage.md`.
pub fn print() -> Result<(), Box<dyn Error>> {
    println!("## Where the truth is known\n");
    println!(
        "{MATERIALS} random materials in each row: MKP of {LEVELS} levels, relays of {FINE} levels, \
         and sums of plays\n\
         (Prandtl-Ishlinskii). The input is a random zigzag of the branches named, with {SAMPLES} \
         samples each,\n\
         from the lowest input. On the output is noise of {} % of its range. The band of a fit \
         without\n\
         options is tested on another zigzag of {FRESH} branches with fresh noise. *Good* counts \
         materials with a\n\
         coverage between 90 and 99 %.\n",
        100.0 * NOISE
    );
    println!(
        "*Weights* is the share of the intervals of ±{INTERVAL:.2} standard errors that hold the \
         true weight, over\n\
         the operators that are well determined. It needs the true plane. So a second fit is told \
         it, and\n\
         only MKP materials have it.\n"
    );
    println!("| truth | branches | coverage | good | half width | error | weights |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for truth in [Truth::Mkp, Truth::Relay, Truth::Plays] {
        for branches in BRANCHES {
            let mut row = Row::default();
            for seed in 0..MATERIALS {
                eprintln!("{}, {branches} branches, {seed}", truth.name());
                row.add(truth, branches, seed)?;
            }
            println!("| {} | {branches} | {row} |", truth.name());
        }
    }
    println!();
    Ok(())
}

#[derive(Debug, Clone, Copy)]
enum Truth {
    Mkp,
    Relay,
    Plays,
}

impl Truth {
    fn name(self) -> &'static str {
        match self {
            Self::Mkp => "MKP",
            Self::Relay => "relay Preisach",
            Self::Plays => "Prandtl-Ishlinskii",
        }
    }

    fn material(self, rng: &mut ChaCha8Rng) -> Result<Material, Box<dyn Error>> {
        Ok(match self {
            Self::Mkp => Material::Model(Box::new(density(Operator::Mkp, LEVELS, rng)?)),
            Self::Relay => Material::Model(Box::new(density(Operator::Relay, FINE, rng)?)),
            Self::Plays => Material::Plays(
                (0..8)
                    .map(|_| [rng.random_range(0.0..0.5), rng.random_range(0.0..1.0)])
                    .collect(),
            ),
        })
    }
}

/// A model of the inputs from 0 to 1 whose weights are a bell at a random place of the plane, with
/// random factors. A fifth of them is zero.
fn density(operator: Operator, levels: usize, rng: &mut ChaCha8Rng) -> hysteron::Result<Model> {
    let step = 1.0 / levels as f64;
    let plane = Plane::new(step, 1.0, levels)?;
    let (centre, half) = (rng.random_range(0.35..0.65), rng.random_range(0.02..0.2));
    let spread = rng.random_range(0.1..0.3);
    let weights = operators(levels).map(|(i, j)| {
        let (alpha, beta) = (i as f64 * step, j as f64 * step);
        let distance = (alpha - centre + half).hypot(beta - centre - half) / spread;
        let factor = match rng.random_range(0.0..1.0) < 0.2 {
            true => 0.0,
            false => rng.random_range(0.5..1.5),
        };
        factor * (-0.5 * distance * distance).exp()
    });
    Model::new(operator, plane, weights.collect(), 0.0, Sign::Positive)
}

enum Material {
    Model(Box<Model>),
    /// Radius and weight of each play.
    Plays(Vec<[f64; 2]>),
}

impl Material {
    /// The output, from the lowest input.
    fn output(&self, input: &[f64]) -> hysteron::Result<Vec<f64>> {
        match self {
            Self::Model(model) => model.simulate(input),
            Self::Plays(plays) => {
                let mut at = vec![0.0_f64; plays.len()];
                let output = input.iter().map(|x| {
                    let each = at.iter_mut().zip(plays).map(|(at, [radius, weight])| {
                        *at = at.clamp(x - radius, x + radius);
                        weight * *at
                    });
                    each.sum()
                });
                Ok(output.collect())
            }
        }
    }

    /// A recording with noise.
    fn recording(
        &self,
        branches: usize,
        rng: &mut ChaCha8Rng,
    ) -> Result<Recording, Box<dyn Error>> {
        let input = zigzag(branches, rng);
        let mut output = self.output(&input)?;
        let (low, high) = hysteron::range(&output);
        for y in &mut output {
            let deviation: f64 = StandardNormal.sample(rng);
            *y += NOISE * (high - low) * deviation;
        }
        Ok(Recording::new(input, output)?)
    }
}

/// From 0 to 1, back to 0, then to random places.
fn zigzag(branches: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let mut input = vec![0.0];
    let mut from = 0.0;
    for branch in 0..branches {
        let to = match branch {
            0 => 1.0,
            1 => 0.0,
            _ if branch % 2 == 0 => rng.random_range(from..1.0),
            _ => rng.random_range(0.0..from),
        };
        let step = (to - from) / SAMPLES as f64;
        input.extend((1..=SAMPLES).map(|n| from + step * n as f64));
        from = to;
    }
    input
}

/// What was counted over the materials of a row.
#[derive(Default)]
struct Row {
    /// Coverage, half width and error of each material, in percent.
    found: Vec<[f64; 3]>,
    /// Intervals of determined weights that hold the truth, and all of them.
    intervals: [usize; 2],
}

impl Row {
    fn add(&mut self, truth: Truth, branches: usize, seed: u64) -> Result<(), Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(1000 * branches as u64 + seed);
        let material = truth.material(&mut rng)?;
        let recording = material.recording(branches, &mut rng)?;
        let fresh = material.recording(FRESH, &mut rng)?;
        let model = Fit::new().run(&recording)?;
        let judged = hysteron::evaluate(&model, &fresh)?;
        let (low, high) = fresh.ranges().1;
        if let Some(band) = judged.band {
            let width = band.half_width.iter().sum::<f64>() / fresh.len() as f64;
            self.found.push([
                band.coverage_percent,
                100.0 * width / (high - low),
                judged.forward.nrmse_percent.unwrap_or(f64::NAN),
            ]);
        }
        if let (Truth::Mkp, Material::Model(known)) = (truth, &material) {
            self.count_intervals(known, &recording)?;
        }
        Ok(())
    }

    fn count_intervals(
        &mut self,
        truth: &Model,
        recording: &Recording,
    ) -> Result<(), Box<dyn Error>> {
        let plane = truth.plane();
        let fit = Fit::new().levels(plane.levels());
        let fit = fit.range(plane.min(), plane.max());
        let fit = fit.spacing(Spacing::Uniform).start(Start::Off);
        let model = fit.run(recording)?;
        let confidence = model.fit.as_ref().and_then(|fit| fit.confidence.as_ref());
        let Some(confidence) = confidence else {
            return Ok(());
        };
        for (n, class) in confidence.excitation.iter().enumerate() {
            if *class == Excitation::Determined {
                let error = (model.weights()[n] - truth.weights()[n]).abs();
                self.intervals[0] += usize::from(error <= INTERVAL * confidence.standard_error[n]);
                self.intervals[1] += 1;
            }
        }
        Ok(())
    }
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.found.len();
        let mean = |n: usize| self.found.iter().map(|found| found[n]).sum::<f64>() / count as f64;
        let good = |found: &&[f64; 3]| (90.0..=99.0).contains(&found[0]);
        let good = self.found.iter().filter(good).count();
        let weights = match self.intervals {
            [_, 0] => "–".to_owned(),
            [held, all] => format!("{:.1} % of {all}", 100.0 * held as f64 / all as f64),
        };
        write!(
            f,
            "{:.1} % | {good} of {count} | {:.2} % | {:.2} % | {weights}",
            mean(0),
            mean(1),
            mean(2)
        )
    }
}

//! tmp
#![allow(missing_docs, clippy::unwrap_used)]
use hysteron::control::*;
use hysteron::rig::*;
use hysteron::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

fn rig() -> Rig { Rig { transformation: Transformation { martensite_slope_mpa_per_k: 12.0, austenite_slope_mpa_per_k: 12.0, ..Default::default() }, ..Default::default() } }
pub struct Spring {
    p: Plant,
    i: f64,
    tl: f64,
    rng: ChaCha8Rng,
}
impl Spring {
    fn new(seed: u64) -> Self {
        let p = Plant::new(rig()).unwrap();
        let tl = p.temperature_degc();
        Self {
            p,
            i: 0.0,
            tl,
            rng: ChaCha8Rng::seed_from_u64(seed),
        }
    }
}
impl Device for Spring {
    fn read(&mut self) -> Reading {
        let y = Sensor::LVDT.read(self.p.displacement_mm(), &mut self.rng);
        let t = Sensor::THERMOCOUPLE.read(self.tl, &mut self.rng);
        Reading {
            output: (y / 0.0122).round() * 0.0122,
            input: Some(t),
        }
    }
    fn write(&mut self, d: f64) {
        self.i = d.clamp(0.0, 2.0);
    }
}
impl SimulatedPlant for Spring {
    fn advance(&mut self, dt: f64) {
        let n = 5;
        for _ in 0..n {
            self.p.step(self.i, dt / n as f64).unwrap();
            let h = dt / n as f64;
            self.tl += (1.0 - (-h / std::env::var("LAG").ok().and_then(|v| v.parse().ok()).unwrap_or(0.7f64)).exp()) * (self.p.temperature_degc() - self.tl);
        }
    }
    fn truth(&self) -> Reading {
        Reading {
            output: self.p.displacement_mm(),
            input: Some(self.p.temperature_degc()),
        }
    }
    fn disturb(&mut self, d: Disturbance) -> Result<()> {
        if let Disturbance::Load(n) = d {
            self.p.set_load_n(n)?;
        }
        Ok(())
    }
}

pub fn run(
    plant: &mut dyn SimulatedPlant,
    c: &mut Controller,
    reference: &[f64],
    dt: f64,
    step_at: usize,
    band: f64,
) -> Trace {
    let heads = headings(reference, band);
    let mut t = Trace::default();
    for (n, &r) in reference.iter().enumerate() {
        if n == step_at {
            plant.disturb(Disturbance::Load(10.0)).unwrap();
        }
        let truth = plant.truth();
        let reading = plant.read();
        let a = c
            .step(
                Target {
                    output: r,
                    heading: heads[n],
                },
                reading,
            )
            .unwrap();
        plant.write(a.drive);
        plant.advance(dt);
        t.time.push(n as f64 * dt);
        t.reference.push(r);
        t.output.push(truth.output);
        t.measured.push(reading.output);
        t.input.push(truth.input.unwrap_or(f64::NAN));
        t.command.push(a.command);
        t.drive.push(a.drive);
        t.prediction.push(a.prediction);
        t.status.push(a.status);
    }
    t
}
fn rmse(t: &Trace, from: f64, to: f64) -> f64 {
    let e: Vec<f64> = t
        .time
        .iter()
        .zip(t.output.iter().zip(&t.reference))
        .filter(|(x, _)| **x >= from && **x < to)
        .map(|(_, (y, r))| (y - r) * (y - r))
        .collect();
    (e.iter().sum::<f64>() / e.len() as f64).sqrt()
}
fn pred(t: &Trace, from: f64, to: f64) -> f64 {
    let e: Vec<f64> = t
        .time
        .iter()
        .zip(t.output.iter().zip(&t.prediction))
        .filter(|(x, _)| **x >= from && **x < to)
        .map(|(_, (y, r))| (y - r) * (y - r))
        .collect();
    (e.iter().sum::<f64>() / e.len() as f64).sqrt()
}

fn main() {
    let dt = 0.2;
    // step tests
    for load in [6.0, 10.0] {
        let mut s = Spring::new(1);
        s.disturb(Disturbance::Load(load)).unwrap();
        s.write(2.0);
        let mut line = String::new();
        for n in 0..60 {
            if n % 4 == 0 {
                line += &format!(
                    "{}s {:.0}C {:.1}mm; ",
                    n,
                    s.truth().input.unwrap(),
                    s.truth().output
                );
            }
            s.advance(1.0);
        }
        println!("{load} N heat {line}");
        s.write(0.0);
        line.clear();
        for n in 0..120 {
            if n % 8 == 0 {
                line += &format!(
                    "{}s {:.0}C {:.1}mm; ",
                    n,
                    s.truth().input.unwrap(),
                    s.truth().output
                );
            }
            s.advance(1.0);
        }
        println!("{load} N cool {line}");
    }
    // identify: inner loop follows temperature profile
    let drives = (0.0, 2.0);
    let inner = Some(InnerLoop {
        gains: Gains {
            gain: 0.4,
            integral_s: 8.0,
            derivative_s: 0.0,
        },
        square_root: true,
    });
    let base = Scheme {
        interval_s: dt,
        compensator: None,
        rest: Rest::Hold,
        tolerance: 0.1,
        pid: None,
        bias: 22.0,
        commands: (22.0, 115.0),
        drives,
        inner,
        filter_s: 0.6,
    };
    let mut profile = vec![];
    let mut at = 22.0f64;
    for target in [
        112.0, 24.0, 50.0, 24.0, 56.0, 24.0, 62.0, 24.0, 70.0, 24.0, 80.0, 24.0, 100.0, 55.0,
        100.0, 48.0, 100.0, 42.0, 100.0, 36.0, 100.0, 30.0, 100.0, 24.0, 66.0, 38.0, 60.0, 42.0,
        56.0, 46.0f64, 24.0,
    ] {
        while (at - target).abs() > 1e-9 {
            let rate = if target > at {
                2.0
            } else {
                0.5 + 0.02 * (at - 22.0)
            };
            at += (target - at).clamp(-rate * dt, rate * dt);
            profile.push(at);
        }
        for _ in 0..25 {
            profile.push(at);
        }
    }
    let record = |seed: u64| {
        let mut s = Spring::new(seed);
        let mut c = Controller::new(base.clone());
        let (mut x, mut y) = (vec![], vec![]);
        let share = 1.0 - (-dt / 0.6f64).exp();
        let (mut fx, mut fy): (Option<f64>, Option<f64>) = (None, None);
        for &p in &profile {
            let r = s.read();
            let ti = r.input.unwrap();
            let a = fx.unwrap_or(ti);
            let a = a + share * (ti - a);
            fx = Some(a);
            let b = fy.unwrap_or(r.output);
            let b = b + share * (r.output - b);
            fy = Some(b);
            x.push(a);
            y.push(b);
            let act = c.step_command(p, r).unwrap();
            s.write(act.drive);
            s.advance(dt);
        }
        Recording::new(x, y).unwrap()
    };
    let rec = record(77);
    println!(
        "recording {} samples, {:.0} min, T {:.1}..{:.1}",
        rec.input.len(),
        rec.input.len() as f64 * dt / 60.0,
        rec.input.iter().fold(1e9f64, |a, b| a.min(*b)),
        rec.input.iter().fold(-1e9f64, |a, b| a.max(*b))
    );
    let model = fit(
        &rec,
        &FitOptions {
            levels: 30,
            range: Some((22.0, 112.0)),
            smooth: std::env::var("SM").ok().and_then(|v| v.parse().ok()).unwrap_or(1e-6),
            ..FitOptions::default()
        },
    )
    .unwrap();
    println!(
        "fit rmse {:?} range {:?}",
        model.fit.as_ref().map(|f| f.rmse),
        model.output_range()
    );
    let env = |k: &str, d: f64| std::env::var(k).ok().and_then(|v| v.parse().ok()).unwrap_or(d); let n = (2.0 * env("HALF", 1200.0) / dt) as usize;
    let reference: Vec<f64> = (0..n)
        .map(|k| {
            let t = k as f64 * dt;
            env("MID", 4.0) + (env("AMP", 2.0) * (t * std::f64::consts::TAU / env("PER", 300.0) - 1.57).sin())
        })
        .collect();
    let step_at = n / 2;
    let args: Vec<f64> = std::env::args()
        .skip(1)
        .map(|a| a.parse().unwrap())
        .collect();
    let gains = Gains {
        gain: args.first().copied().unwrap_or(4.0),
        integral_s: args.get(1).copied().unwrap_or(6.0),
        derivative_s: args.get(2).copied().unwrap_or(0.0),
    };
    let ls = Method::LeastSquares {
        forgetting: 0.995,
        noise: 0.3,
        spread: 0.05,
        correlation: 4.0,
    };
    let opts = Adaptation {
        method: ls,
        offset_share: env("OFF", 40.0),
        dead_zone: 0.0,
        movement: 0.1,
        ..Adaptation::default()
    };
    for (name, comp, rest) in [
        ("pid", 0, Rest::Hold),
        ("fixed hold", 1, Rest::Hold),
        ("fixed ant", 1, Rest::Anticipate),
        ("adaptive hold", 2, Rest::Hold),
        ("adaptive ant", 2, Rest::Anticipate),
    ] {
        let compensator = match comp {
            0 => None,
            1 => Some(Compensator::fixed(model.clone())),
            _ => Some(Compensator::adaptive(Adaptive::new(&model, opts).unwrap())),
        };
        let mut c = Controller::new(Scheme {
            compensator,
            rest,
            pid: Some(gains),
            ..base.clone()
        });
        let start = std::time::Instant::now();
        let t = run(&mut Spring::new(5), &mut c, &reference, dt, step_at, 0.1);
        let ts = step_at as f64 * dt;
        println!(
            "{name:14} rmse before {:.3} after {:.3} after+120 {:.3}; prediction before {:.3} after+120 {:.3}  {:?}",
            rmse(&t, 60.0, ts),
            rmse(&t, ts, 1e9),
            rmse(&t, ts + 120.0, 1e9),
            pred(&t, 60.0, ts),
            pred(&t, ts + 120.0, 1e9),
            start.elapsed()
        );
        if let Ok(f) = std::env::var("DUMP") {
            let mut s = String::from("t,r,y,T,c,d,p\n");
            for k in 0..n {
                s += &format!(
                    "{},{},{},{},{},{},{}\n",
                    t.time[k],
                    t.reference[k],
                    t.output[k],
                    t.input[k],
                    t.command[k],
                    t.drive[k],
                    t.prediction[k]
                );
            }
            std::fs::write(format!("{f}-{}.csv", name.replace(' ', "-")), s).unwrap();
        }
    }
}

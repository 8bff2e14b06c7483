//! A body that knows of the heat that is bound, identified on the simulated wire that binds it, and
//! what its inverse makes that wire do.

use hysteron::control::{Device, SimulatedPlant};
use hysteron::{Choice, Fit, FitOptions, Model, Policy, Recording, Surroundings, Thermal};
use hysteron_sim::plant::{LatentWirePlant, LatentWirePlantOptions};

const DT: f64 = 0.05;
/// The stroke of the drives below, mm.
const STROKE: f64 = 4.4;

fn wire(seed: u64) -> LatentWirePlant {
    let options = LatentWirePlantOptions {
        seed,
        ..LatentWirePlantOptions::default()
    };
    LatentWirePlant::new(&options).unwrap()
}

fn record(duty: &[f64], seed: u64) -> Recording {
    let mut wire = wire(seed);
    let output = duty.iter().map(|duty| {
        let y = wire.read().output;
        wire.write(*duty);
        wire.advance(DT);
        y
    });
    // The drive of a sample is the one that was held since the sample before.
    let output: Vec<f64> = output.collect();
    let held = duty[..1].iter().chain(duty).take(duty.len()).copied();
    let mut recording = Recording::new(held.collect(), output).unwrap();
    recording.time = Some((0..duty.len()).map(|n| DT * n as f64).collect());
    recording
}

fn held(levels: impl IntoIterator<Item = (f64, f64)>) -> Vec<f64> {
    let levels = levels.into_iter();
    let hold = |(duty, seconds): (f64, f64)| vec![duty; (seconds / DT) as usize];
    levels.flat_map(hold).collect()
}

/// Triangles that shrink, and steps, as the experiment of `track` has them.
fn experiment() -> [Recording; 2] {
    let (mut ramps, mut at) = (Vec::new(), 0.0);
    for n in 0..5 {
        for to in [0.6 * (1.0 - f64::from(n) / 5.0), 0.0] {
            let count = (f64::abs(to - at) / 0.03 / DT) as usize;
            ramps.extend((0..count).map(|n| at + (to - at) * n as f64 / count as f64));
            at = to;
        }
    }
    let steps = [0.0, 1.0, 0.0, 0.65, 0.2, 0.8, 0.4, 0.55, 0.0].map(|share| (0.6 * share, 10.0));
    [record(&ramps, 1), record(&held(steps), 2)]
}

/// Steps of any height and length.
fn random() -> Recording {
    let mut seed = 12_345_u64;
    let mut uniform = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f64 / (1_u64 << 24) as f64
    };
    let steps: Vec<(f64, f64)> = (0..24)
        .map(|_| (0.6 * uniform(), 1.0 + 5.0 * uniform()))
        .collect();
    record(&held(steps), 3)
}

fn fitted(thermal: Thermal) -> Model {
    let options = FitOptions {
        levels: std::env::var("K").map_or(20, |k| k.parse().unwrap()),
        smooth: 1e-6.into(),
        delay: Choice::Fixed(0),
        ..FitOptions::plain()
    };
    Fit::from(options)
        .thermal(thermal)
        .run(&experiment())
        .unwrap()
}

fn percent(errors: &[f64]) -> f64 {
    let sum: f64 = errors.iter().map(|e| e * e).sum();
    100.0 * (sum / errors.len() as f64).sqrt() / STROKE
}

fn predicted(model: &Model) -> f64 {
    let held_out = random();
    let around = Surroundings::from_recording(model, &held_out);
    let mut output = vec![0.0; held_out.len()];
    model
        .run_in(&mut model.start(), &held_out.input, around, &mut output)
        .unwrap();
    let errors: Vec<f64> = output
        .iter()
        .zip(&held_out.output)
        .map(|(h, y)| h - y)
        .collect();
    percent(&errors)
}

/// How far the wire is from a path after 20 s.
fn followed(model: &Model, preview: f64) -> f64 {
    led(model, preview, Policy::Anticipate, 0.0).0
}

fn led(model: &Model, preview: f64, policy: Policy, horizon: f64) -> (f64, usize) {
    let time: Vec<f64> = (0..2401).map(|n| DT * f64::from(n)).collect();
    let path = time[1..].iter().map(|t| {
        let turn = std::f64::consts::TAU * t;
        2.0 + 1.2 * (turn / 30.0).sin() + 0.2 * (turn / 19.0).sin()
    });
    let path: Vec<f64> = path.collect();
    let around = Surroundings {
        time: Some(&time),
        load: None,
    };
    let inverse = model.inverse().unwrap();
    let inverse = inverse
        .drive_range(0.0, 1.0)
        .unwrap()
        .horizon(horizon)
        .unwrap();
    let mut state = model.start();
    model.step(&mut state, 0.0).unwrap(); // the cold wire
    let tolerance = model.usual_tolerance();
    let found = inverse.previewed(&mut state, &path, policy, tolerance, around, preview);
    let found = found.unwrap();
    let mut wire = wire(9);
    let errors = path.iter().zip(&found).map(|(path, found)| {
        wire.write(found.input);
        wire.advance(DT);
        wire.truth().output - path
    });
    let errors: Vec<f64> = errors.collect();
    let ok = found.iter().filter(|s| s.status == hysteron::Status::Ok);
    if let Ok(file) = std::env::var("DUMP") {
        let row = |n: usize| {
            format!(
                "{},{},{},{}\n",
                time[n + 1],
                path[n],
                errors[n],
                found[n].input
            )
        };
        std::fs::write(file, (0..path.len()).map(row).collect::<String>()).unwrap();
    }
    (percent(&errors[400..]), ok.count())
}

#[test]
fn a_wire_that_binds_heat_is_predicted_and_led() {
    for thermal in [Thermal::FirstOrder, Thermal::Auto] {
        let start = std::time::Instant::now();
        let model = fitted(thermal);
        let fit = model.fit.as_ref().unwrap();
        println!(
            "{thermal:?}: {:?} latent {:.4}, fitted {:.2} %, held out {:.2} %, followed {:.2} % (preview {:.2} %) {:?} {:.1?}",
            model.thermal.unwrap(),
            model.latent(),
            fit.nrmse_percent,
            predicted(&model),
            followed(&model, 0.0),
            followed(&model, 6.0),
            fit.other.get("thermal"),
            start.elapsed(),
        );
    }
}

fn heated(recording: &Recording, taus: [f64; 2], per_mm: f64) -> Recording {
    let y = &recording.output;
    let smooth =
        |n: usize| 0.25 * y[n.saturating_sub(1)] + 0.5 * y[n] + 0.25 * y[(n + 1).min(y.len() - 1)];
    let mut t = recording.input[0];
    let input = (0..y.len()).map(|n| {
        if n > 0 {
            let u = recording.input[n];
            let tau = if u > t { taus[0] } else { taus[1] };
            t = u + (t - u) * f64::exp(-DT / tau) - per_mm * (smooth(n) - smooth(n - 1));
        }
        t
    });
    Recording {
        input: input.collect(),
        ..recording.clone()
    }
}

fn built(recordings: &[Recording], taus: [f64; 2], per_mm: f64, levels: usize) -> Model {
    let options = FitOptions {
        levels,
        smooth: 1e-6.into(),
        ..FitOptions::plain()
    };
    let seen: Vec<Recording> = recordings.iter().map(|r| heated(r, taus, per_mm)).collect();
    let mut model = Fit::from(options).run(&seen).unwrap();
    let (off, on) = model.output_range();
    model.thermal = Some(hysteron::FirstOrder {
        tau_heating: taus[0],
        tau_cooling: taus[1],
        ..hysteron::FirstOrder::default()
    });
    model.with_latent(per_mm * (on - off)).unwrap()
}

fn error(model: &Model, recordings: &[Recording]) -> f64 {
    let mut all = Vec::new();
    for recording in recordings {
        let around = Surroundings::from_recording(model, recording);
        let mut output = vec![0.0; recording.len()];
        model
            .run_in(&mut model.start(), &recording.input, around, &mut output)
            .unwrap();
        all.extend(output.iter().zip(&recording.output).map(|(h, y)| h - y));
    }
    percent(&all)
}

#[test]
#[ignore = "explores"]
fn explores() {
    let both = experiment();
    let levels = 20;
    for share in std::env::var("S").map_or(vec![0.0, 0.3, 0.4, 0.5, 0.6, 0.7], |s| {
        vec![s.parse().unwrap()]
    }) {
        let per_mm = share * 0.6 / 4.4;
        let mut best = (f64::INFINITY, [0.0; 2]);
        let mut grid = Vec::new();
        for n in 0..24 {
            for ratio in [0.9, 1.0, 1.1] {
                let tau = 1.2 + 0.1 * f64::from(n);
                grid.push([tau * ratio, tau / ratio]);
            }
        }
        for taus in grid {
            let e = error(&built(&both, taus, per_mm, levels), &both);
            if e < best.0 {
                best = (e, taus);
            }
        }
        let taus = best.1;
        let model = built(&both, taus, per_mm, levels);
        let [ramp, step] = [0, 1].map(|n| built(&both[n..=n], taus, per_mm, levels));
        println!(
            "share {share}: taus {taus:.2?} teacher {:.2} free {:.2}; ramp→step {:.2}, step→ramp {:.2}; held out {:.2}; followed {:.2} preview {:.2}; latent {:.3}",
            model.fit.as_ref().unwrap().nrmse_percent,
            best.0,
            error(&ramp, &both[1..]),
            error(&step, &both[..1]),
            predicted(&model),
            followed(&model, 0.0),
            followed(&model, 6.0),
            model.latent()
        );
        for policy in [Policy::Hold, Policy::Anticipate] {
            for horizon in [0.0, 0.5] {
                print!(
                    "  {policy:?} {horizon}: {:.2?}",
                    led(&model, 0.0, policy, horizon)
                );
            }
        }
        println!();
    }
}

/// Weights again, behind the temperatures that the model itself runs through.
fn again(model: &Model, recordings: &[Recording], per_mm: f64) -> Model {
    let options = FitOptions {
        levels: model.plane().levels(),
        smooth: 1e-6.into(),
        ..FitOptions::plain()
    };
    let seen: Vec<Recording> = recordings
        .iter()
        .map(|r| model.behind_body(r).unwrap().into_owned())
        .collect();
    let mut next = Fit::from(options).run(&seen).unwrap();
    let (off, on) = next.output_range();
    next.thermal = model.thermal;
    next.with_latent(per_mm * (on - off)).unwrap()
}

#[test]
#[ignore = "explores"]
fn crosses() {
    let both = experiment();
    let levels = 20;
    for share in [0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8] {
        let per_mm = share * 0.6 / 4.4;
        let mut best = (f64::INFINITY, [0.0; 2]);
        for n in 0..24 {
            for ratio in [0.9, 1.0, 1.1] {
                let tau = 1.2 + 0.1 * f64::from(n);
                let taus = [tau * ratio, tau / ratio];
                let [ramp, step] = [0, 1].map(|n| built(&both[n..=n], taus, per_mm, levels));
                let (a, b) = (error(&ramp, &both[1..]), error(&step, &both[..1]));
                let e = (a * a + b * b).sqrt();
                if e < best.0 {
                    best = (e, taus);
                }
            }
        }
        let taus = best.1;
        let mut model = built(&both, taus, per_mm, levels);
        print!("share {share}: taus {taus:.2?} cross {:.2}:", best.0);
        for _ in 0..4 {
            print!(
                " free {:.2} held {:.2} followed {:.2};",
                error(&model, &both),
                predicted(&model),
                followed(&model, 0.0)
            );
            model = again(&model, &both, per_mm);
        }
        println!();
    }
}

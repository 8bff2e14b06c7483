//! A body that knows of the heat that is bound, identified on the simulated wire that binds it, and
//! what its inverse makes that wire do.

use hysteron::control::{Device, SimulatedPlant};
use hysteron::{Dynamics, Fit, FitOptions, Model, Policy, Recording, Surroundings, Thermal};
use hysteron_sim::plant::{LatentWirePlant, LatentWirePlantOptions};

const DT: f64 = 0.05;
/// The stroke of the drives below, mm.
const STROKE: f64 = 4.4;

fn wire(options: LatentWirePlantOptions, seed: u64) -> LatentWirePlant {
    LatentWirePlant::new(&LatentWirePlantOptions { seed, ..options }).unwrap()
}

fn record(options: LatentWirePlantOptions, duty: &[f64], seed: u64) -> Recording {
    let mut wire = wire(options, seed);
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
fn experiment(options: LatentWirePlantOptions) -> [Recording; 2] {
    let (mut ramps, mut at) = (Vec::new(), 0.0);
    for n in 0..5 {
        for to in [0.6 * (1.0 - f64::from(n) / 5.0), 0.0] {
            let count = (f64::abs(to - at) / 0.03 / DT) as usize;
            ramps.extend((0..count).map(|n| at + (to - at) * n as f64 / count as f64));
            at = to;
        }
    }
    let steps = [0.0, 1.0, 0.0, 0.65, 0.2, 0.8, 0.4, 0.55, 0.0].map(|share| (0.6 * share, 10.0));
    [record(options, &ramps, 1), record(options, &held(steps), 2)]
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
    record(LatentWirePlantOptions::default(), &held(steps), 3)
}

fn fitted(thermal: Thermal) -> Model {
    fitted_to(thermal, &experiment(LatentWirePlantOptions::default()))
}

fn fitted_to(thermal: Thermal, recordings: &[Recording]) -> Model {
    let options = FitOptions {
        levels: 20,
        smooth: 1e-6.into(),
        ..FitOptions::plain()
    };
    Fit::from(options).thermal(thermal).run(recordings).unwrap()
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

/// How far the wire is from a path after 20 s, driven by the inverse alone.
fn followed(model: &Model) -> f64 {
    let time: Vec<f64> = (0..2401).map(|n| DT * f64::from(n)).collect();
    let path = time[1..].iter().map(|t| {
        let turn = std::f64::consts::TAU * t;
        2.0 + 1.2 * (turn / 30.0).sin() + 0.2 * (turn / 19.0).sin()
    });
    let path: Vec<f64> = path.collect();
    let around = Surroundings {
        time: Some(&time),
        load: None,
        rest: None,
    };
    let inverse = model.inverse().unwrap().drive_range(0.0, 1.0).unwrap();
    let mut state = model.start();
    model.step(&mut state, 0.0).unwrap(); // the cold wire
    let tolerance = model.usual_tolerance();
    let found = inverse.series_in(&mut state, &path, Policy::Anticipate, tolerance, around);
    let mut wire = wire(LatentWirePlantOptions::default(), 9);
    let errors = path.iter().zip(found.unwrap()).map(|(path, found)| {
        wire.write(found.input);
        wire.advance(DT);
        wire.truth().output - path
    });
    let errors: Vec<f64> = errors.collect();
    percent(&errors[400..])
}

/// With K = 20. Simulated.
#[test]
fn a_wire_that_binds_heat_is_predicted_and_led() {
    let [bare, bound] = [Thermal::FirstOrder, Thermal::Auto].map(|thermal| {
        let model = fitted(thermal);
        let fit = model.fit.as_ref().unwrap();
        let found = [fit.nrmse_percent, predicted(&model), followed(&model)];
        println!("{thermal:?}: fitted, held out, followed {found:.2?} %");
        println!("{:?}, latent {:.3}", model.thermal.unwrap(), model.latent());
        (model, found)
    });
    assert!(bare.0.latent() == 0.0 && bound.0.latent() > 0.0);
    let [fitted, held_out, followed] = [0, 1, 2].map(|n| bound.1[n] / bare.1[n]);
    assert!(fitted < 0.8 && held_out < 0.8 && followed < 0.5);
}

/// The wire without latent heat is a body of the first order, but for its loss.
#[test]
fn a_wire_that_binds_nothing_gets_no_heat() {
    let options = LatentWirePlantOptions {
        latent_heat_j_per_g: 0.0,
        ..LatentWirePlantOptions::default()
    };
    let model = fitted_to(Thermal::Auto, &experiment(options));
    assert_eq!(model.latent(), 0.0);
    let tried = &model.fit.unwrap().other["thermal"];
    assert!(tried.get("latent").is_none(), "{tried}");
}

/// Nobody asked for a body. Simulated.
#[test]
fn a_fit_without_options_finds_the_body() {
    let recordings = experiment(LatentWirePlantOptions::default());
    let [found, none] = [Dynamics::Auto, Dynamics::Off].map(|dynamics| {
        let fit = Fit::new().bootstrap(0).dynamics(dynamics);
        fit.run(&recordings).unwrap()
    });
    assert!(found.thermal.is_some() && none.thermal.is_none());
    let fit = found.fit.as_ref().unwrap();
    let left_out = fit.validation.as_ref().unwrap().nrmse_percent;
    let without = fit.error_without_body().unwrap();
    let [with, cold] = [&found, &none].map(predicted);
    println!("left out {left_out:.2} and {without:.2} %, held out {with:.2} and {cold:.2} %");
    assert!(left_out < 0.5 * without && with < 0.5 * cold);
}

/// The same steps from rest, and from a wire that had been heated for 20 s before anybody recorded.
#[test]
fn a_wire_that_was_warm_when_the_recording_began_is_fitted_as_well() {
    let options = LatentWirePlantOptions::default();
    let steps = [
        0.1, 0.9, 0.0, 1.0, 0.0, 0.65, 0.2, 0.8, 0.4, 0.55, 0.0, 0.9, 0.3, 0.7, 0.0,
    ];
    let steps = held(steps.map(|share| (0.6 * share, 10.0)));
    let before = held([(0.55, 20.0)]);
    let all = record(options, &[&before[..], &steps].concat(), 4);
    // The first row after it still has the drive held until then.
    let cut = |series: &[f64]| series[before.len() + 1..].to_vec();
    let warm = Recording {
        time: all.time.as_deref().map(cut),
        input: cut(&all.input),
        output: cut(&all.output),
        ..all
    };
    let model = |recording: &Recording| {
        let fit = Fit::new().bootstrap(0).levels(20);
        fit.run(std::slice::from_ref(recording)).unwrap()
    };
    let (warm, rested) = (model(&warm), model(&record(options, &steps, 4)));
    let errors = [predicted(&warm), predicted(&rested)];
    let rests = warm.fit.as_ref().unwrap().rests();
    println!("{errors:?} % of the stroke, {rests:?}");
    assert!(rests[0].is_some_and(|rest| rest > 0.3), "{rests:?}");
    assert!(rested.fit.as_ref().unwrap().rests().is_empty());
    // The rest is one more number to find. A body that takes the first drive for it errs nine times
    // as much.
    assert!(errors[0] < 2.0 * errors[1]);
}

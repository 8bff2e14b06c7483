//! Every number is the same, whatever the number of threads.

use crate::loops::{RELAYS, RELAYS_SINE, scenario};
use hysteron::{
    AdaptOptions, Auto, DesignOptions, Fit, FitOptions, Model, Operator, Plane, PrepareOptions,
    Progress, Rates, Recording, Solver, Start, adapt, design, evaluate, prepare,
};
use hysteron_sim::rig::{Experiment, prepared};
use hysteron_sim::track::track;
use rayon::ThreadPoolBuilder;

const THREADS: [usize; 4] = [1, 2, 3, 8];

/// The work in pools of different size gives the same text: `Debug` writes every bit of a number.
fn same(name: &str, work: impl Fn() -> String + Sync) {
    let in_pool = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(&work)
    };
    let texts = THREADS.map(in_pool);
    for (threads, text) in THREADS.iter().zip(&texts) {
        assert!(
            *text == texts[0],
            "{name}: {threads} threads give other digits"
        );
    }
}

/// A spring's recording, of which a fit leaves errors behind.
fn recording() -> Recording {
    prepared(&Experiment::default().record(1).unwrap()).unwrap()
}

fn options() -> FitOptions {
    FitOptions {
        levels: 20,
        range: Some((20.0, 80.0)),
        bootstrap: 4,
        ..FitOptions::plain()
    }
}

#[test]
fn fits_with_their_confidence() {
    let recording = recording();
    let usual = options();
    let smooth = FitOptions {
        smooth: (0.0, 1e-6).into(),
        ..options()
    };
    let unknown = FitOptions {
        start: Start::Unknown,
        ..options()
    };
    let ols = FitOptions {
        solver: Solver::Ols,
        smooth: (0.0, 1e-6).into(),
        ..options()
    };
    let relay = FitOptions {
        operator: Operator::Relay,
        ..options()
    };
    let all = [
        ("usual", usual),
        ("smooth", smooth),
        ("unknown", unknown),
        ("ols", ols),
        ("relay", relay),
    ];
    for (name, options) in all {
        same(name, || {
            Fit::from(&options).run(&recording).unwrap().to_json()
        });
    }
}

#[test]
fn levels_and_smoothness_chosen_on_branches_left_out() {
    let recordings = [recording()];
    let fit = Fit::from(options()).levels(Auto).smooth(Auto);
    let chosen = || fit.run(&recordings);
    same("auto", || chosen().unwrap().to_json());
}

#[test]
fn what_is_done_with_a_model() {
    let recording = recording();
    let model: Model = Fit::from(&FitOptions {
        bootstrap: 0,
        ..options()
    })
    .run(&recording)
    .unwrap();
    same("evaluate", || format!("{:?}", evaluate(&model, &recording)));
    same("adapt", || {
        format!(
            "{:?}",
            adapt(&model, &recording, &AdaptOptions::default(), Progress::NONE)
        )
    });
    same("prepare", || {
        format!(
            "{:?}",
            prepare(&recording, &PrepareOptions::default(), Progress::NONE)
        )
    });
    let rates = Rates {
        heating: 3.0,
        cooling: 0.8,
    };
    let plan = DesignOptions::new(Plane::new(20.0, 80.0, 20).unwrap(), rates);
    same("design", || format!("{:?}", design(&plan, &[])));
}

#[test]
fn comparisons_of_controllers() {
    let short = "duration_s = 8\nsettle_s = 1\nseeds = 2";
    let compared = scenario(&[RELAYS, short, RELAYS_SINE]);
    same("track", || {
        format!("{:?}", track(&compared, Progress::NONE).unwrap())
    });
}

//! A model that learns, sample by sample, while the plant changes.
//!
//! `cargo run --example adapt -p hysteron`

use hysteron::{AdaptOptions, Learner, Model, Operator, Plane, Result, Sign, Target};

fn main() -> Result<()> {
    // The model as it was identified, and the plant as it is now: worn, with a third less output.
    // The plant is a model, too, in place of your readings.
    let plane = Plane::new(20.0, 80.0, 8)?;
    let model = |weight: f64| {
        let weights = vec![weight; plane.operators()];
        Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive)
    };
    let (identified, plant) = (model(0.3)?, model(0.2)?);

    // What follows the error, and how fast: docs/options.md has all options and their defaults.
    let options = AdaptOptions {
        learner: Learner::LeastSquares,
        ..AdaptOptions::default()
    };
    let mut adaptive = options.adaptive(&identified)?;

    let mut state = plant.start();
    println!("sample    input    measured    expected    what was done");
    for n in 0..600 {
        let input = 50.0 - 35.0 * (0.05 * f64::from(n)).cos();
        let measured = plant.step(&mut state, input)?.output;
        // One call a sample. It gives the output that was expected before it learned.
        let learning = adaptive.step(input, measured)?;
        if n % 60 == 30 {
            let done = learning.outcome; // learned, at rest, rejected as a wrong reading, …
            let expected = learning.output;
            println!("{n:6} {input:8.2} {measured:11.3} {expected:11.3}    {done:?}");
        }
    }

    // The inverse follows the weights as they are now.
    let wanted = Target::new(3.0);
    println!("input for an output of 3:");
    let fixed = identified
        .inverse()?
        .step(&mut identified.start(), wanted)?;
    println!("  as identified {:.2} degC", fixed.input);
    adaptive.align(); // the inverse sets out from where the plant is
    println!("  as learned    {:.2} degC", adaptive.solve(wanted)?.input);

    // What was learned is a model like any other: `learned.write(path)` keeps it.
    let learned = adaptive.model()?;
    let sum = |model: &Model| model.weights().iter().sum::<f64>();
    println!(
        "sum of the weights: identified {:.2}, plant {:.2}, learned {:.2}",
        sum(&identified),
        sum(&plant),
        sum(&learned)
    );
    Ok(())
}

//! Compensates hysteresis: finds the inputs that make a wanted series of outputs.
//!
//! `cargo run --example invert -p hysteron`

use hysteron::{Model, Operator, Plane, Policy, Sign};

fn main() -> hysteron::Result<()> {
    // A model with 12 levels from 20 to 80 degC. Yours comes from a fit, or from a file with
    // `Model::read`. The weights stand row by row: j = 1…K, within a row i = 1…j. An operator with
    // i = j has no memory; without these, the inverse has a dead band after every reversal.
    let plane = Plane::new(20.0, 80.0, 12)?;
    let weights = (1..=12).flat_map(|j| (1..=j).map(move |i| if i == j { 0.0 } else { 0.2 }));
    let model = Model::new(Operator::Mkp, plane, weights.collect(), 0.0, Sign::Positive)?;

    // The wanted output: it rises, rests, falls, rests and rises again.
    let wanted = [2.0, 4.0, 6.0, 8.0, 8.0, 8.0, 6.0, 4.0, 4.0, 4.0, 6.0];
    let inverse = model.inverse()?;
    // Reversals smaller than this are noise, and are not followed.
    let tolerance = 0.01;

    // While the wanted output rests, *hold* keeps the input. *Anticipate* uses that time: it looks
    // ahead to where the wanted output goes next, and crosses the dead band at once.
    let solve = |policy| inverse.series(&mut model.start(), &wanted, policy, tolerance);
    let hold = solve(Policy::Hold)?;
    let anticipate = solve(Policy::Anticipate)?;

    println!("wanted    hold, degC    anticipate, degC    status");
    for ((wanted, hold), anticipate) in wanted.iter().zip(&hold).zip(&anticipate) {
        let status = hold.status.name(); // low and high: no input reaches the wanted output
        println!(
            "{wanted:6.2}    {:10.2}    {:16.2}    {status}",
            hold.input, anticipate.input
        );
    }

    // Both are exact: the model gives the wanted output for either series.
    for solutions in [&hold, &anticipate] {
        let inputs: Vec<f64> = solutions.iter().map(|solution| solution.input).collect();
        let reached = model.simulate(&inputs)?;
        let errors = reached.iter().zip(&wanted).map(|(a, b)| (a - b).abs());
        println!("largest error: {:.1e}", errors.fold(0.0, f64::max));
    }
    Ok(())
}

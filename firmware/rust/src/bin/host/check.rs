//! Checks the results against the plain definition in double and against the test vectors.

use crate::data::{FORWARD, Model, Run};
use crate::staged::StagedRun;
use crate::tables::is_measured;
use hysteron_core::{Definition, Operator, Plane};

/// Tolerances in single precision are `2⁻²³/2⁻⁵²` times those in double: the same number of
/// rounding units.
const COARSER: f64 = (1_u64 << 29) as f64;

pub fn digits(
    (models, runs): &(Vec<Model>, Vec<Run>),
    staged: Option<&Vec<StagedRun>>,
    text: &str,
) -> Result<(), String> {
    let plain = staged.is_none();
    let mut lines = text.lines();
    let mut seen = 0;
    while let Some(head) = lines.next() {
        let (number, name) = head.split_once(' ').unwrap_or((head, ""));
        let run = runs.iter().find(|run| run.name == name);
        let other = staged.into_iter().flatten().find(|run| run.name == name);
        let steps = run.map(|run| run.steps.len());
        let steps = steps.or(other.map(|run| run.steps.len()));
        let steps = steps.ok_or(format!("no run has the name of: {head}"))?;
        let rows: Vec<&str> = lines.by_ref().take(steps).collect();
        let rows = rows.iter().map(|row| result(row, number));
        let rows = rows
            .collect::<Result<Vec<_>, _>>()
            .map_err(|why| format!("{head}: {why}"))?;
        let coarser = if number == "float" { COARSER } else { 1.0 };
        let worst = match (run, other) {
            (Some(run), _) => one(&models[run.model], run, &rows, coarser, plain),
            (None, other) => other.map_or(Ok(0.0), |run| expected(run, &rows, coarser)),
        };
        let worst = worst.map_err(|why| format!("{head}: {why}"))?;
        if worst > 1.0 {
            return Err(format!("{head}: {worst:.3} of the tolerance"));
        }
        eprintln!("{head}: {worst:.3} of the tolerance");
        seen += 1;
    }
    let expected = runs
        .iter()
        .filter(|run| !plain || is_measured(&models[run.model]))
        .count()
        + staged.map_or(0, Vec::len);
    // Each file has the results of the plain loop in one number type.
    if seen != if plain { expected } else { 2 * expected } {
        return Err(format!(
            "{seen} runs instead of {expected} in each number type"
        ));
    }
    Ok(())
}

/// The largest difference of a run with stages from what its vector expects, relative to its
/// tolerance. A run without a vector has to have as many results as steps.
fn expected(run: &StagedRun, rows: &[(f64, i8)], coarser: f64) -> Result<f64, String> {
    let mut worst = 0.0_f64;
    if rows.len() != run.steps.len() {
        return Err(format!(
            "{} results for {} steps",
            rows.len(),
            run.steps.len()
        ));
    }
    let Some((results, statuses, tolerance)) = &run.expected else {
        return Ok(0.0);
    };
    for (n, &(result, status)) in rows.iter().enumerate() {
        if status != statuses[n] {
            let wanted = statuses[n];
            return Err(format!("step {n}: status {status} instead of {wanted}"));
        }
        // In single precision drives far apart can give a target where the output hardly changes:
        // the bits, which are the core's, say whether they are right.
        if run.steps[n].0 == FORWARD || coarser == 1.0 {
            let share = (result - results[n]).abs() / (coarser * tolerance);
            // NaN counts as wrong.
            worst = if share <= worst { worst } else { share };
        }
    }
    Ok(worst)
}

/// Bits and status of a step.
fn result(row: &str, number: &str) -> Result<(f64, i8), String> {
    let parse = || {
        let (bits, status) = row.split_once(' ')?;
        let value = match (number, bits.len()) {
            ("float", 8) => f64::from(f32::from_bits(u32::from_str_radix(bits, 16).ok()?)),
            ("double", 16) => f64::from_bits(u64::from_str_radix(bits, 16).ok()?),
            _ => return None,
        };
        Some((value, status.parse().ok()?))
    };
    parse().ok_or(format!("no result: {row}"))
}

/// The largest difference, relative to its tolerance.
fn one(
    model: &Model,
    run: &Run,
    rows: &[(f64, i8)],
    coarser: f64,
    plain: bool,
) -> Result<f64, String> {
    let total: f64 = model.weights.iter().sum();
    let (off, on) = match operator(model) {
        Operator::Mkp => (0.0, total),
        _ => (-total, total),
    };
    let ends = [off, on].map(|sum| model.offset + model.sign * sum);
    let (least, greatest) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let reach = run.tolerance.max(coarser * run.output_tolerance);

    let mut states = vec![0.0; model.weights.len()];
    let plane = Plane::new(model.min, model.max, model.levels).map_err(|why| why.to_string())?;
    let definition = Definition::new(plane, operator(model), &model.weights, &mut states);
    let mut definition = definition.map_err(|why| why.to_string())?;
    let mut worst = 0.0_f64;
    let mut judge = |difference: f64, tolerance: f64| {
        // NaN counts as wrong.
        let share = difference.abs() / (coarser * tolerance);
        worst = if share <= worst { worst } else { share };
    };
    for (n, (&(kind, value), &(result, status))) in run.steps.iter().zip(rows).enumerate() {
        let input = if kind == FORWARD { value } else { result };
        let sum = definition
            .step(input)
            .map_err(|why| format!("step {n}: {why}"))?;
        let output = model.offset + model.sign * sum;
        let expected = if kind == FORWARD {
            0
        } else {
            i8::from(value > greatest + reach) - i8::from(value < least - reach)
        };
        if kind == FORWARD {
            judge(result - output, run.output_tolerance);
        } else if expected == 0 && !(plain && (value < least || value > greatest)) {
            let beyond = (output - value).abs() - run.tolerance;
            judge(beyond.max(0.0), run.output_tolerance);
        }
        // The bisection gives no status.
        if !plain && status != expected {
            return Err(format!("step {n}: status {status} instead of {expected}"));
        }
        if let Some((results, statuses, tolerance)) = &run.expected {
            judge(result - results[n], *tolerance);
            if status != statuses[n] {
                return Err(format!(
                    "step {n}: status {status} instead of {}",
                    statuses[n]
                ));
            }
        }
    }
    Ok(worst)
}

pub fn operator(model: &Model) -> Operator {
    match model.operator.as_str() {
        "mkp" => Operator::Mkp,
        "kp" => Operator::Kp,
        _ => Operator::Relay,
    }
}

//! Estimates the state before a recording with a known model: how far each operator is on before
//! the first sample.

use crate::error::Result;
use crate::identify::weights::sparse::{Initial, OPEN, SparseForm};
use crate::model::Model;
use crate::progress::Progress;
use crate::recording::Recording;
use hysteron_core::Operator;

/// The iteration ends when no coordinate step moves the output by more than this share of the
/// model's range, or after this number of sweeps.
const ENOUGH: f64 = 1e-9;
const SWEEPS: usize = 10_000;

/// The outputs of `model` for the recording's input, from the initial state that explains its
/// output best.
///
/// An operator that the first sample does not determine contributes `ν (γ_on − γ_off)` more than
/// from off, with `ν` between 0 and its weight. These `ν` are found by bounded least squares, one
/// coordinate at a time (Hildreth 1957). For weights of either sign `ν` is not bounded, as in their
/// identification.
pub(crate) fn simulate_from_unknown(model: &Model, recording: &Recording) -> Result<Vec<f64>> {
    let form = SparseForm::new(*model.plane(), model.operator())?;
    let (count, input) = (form.operators(), &recording.input);
    super::problem::check_gram(count)?;
    // Converts to states in [0, 1]: μ (2γ − 1) = 2μ γ − μ.
    let factor = if model.operator() == Operator::Mkp {
        1.0
    } else {
        2.0
    };
    let weights: Vec<f64> = model.weights().iter().map(|mu| factor * mu).collect();
    let sign = model.sign().factor();
    let (off, _) = model.output_range();

    let from_off = form.forward(&weights, input, Initial::Off)?;
    let target = recording.output.iter().zip(&from_off);
    let target: Vec<f64> = target.map(|(y, h)| sign * (y - off) - h).collect();
    let open: Vec<usize> = form
        .open(input[0])?
        .into_iter()
        .enumerate()
        .filter(|(n, open)| *open > OPEN && weights[*n] != 0.0)
        .map(|(n, _)| n)
        .collect();
    // DᵀD and Dᵀy of D = Φ_on − Φ_off, for the operators that are not determined.
    let mut gram = vec![0.0; count * count];
    for (left, right, part) in [
        (Initial::On, Initial::On, 1.0),
        (Initial::On, Initial::Off, -1.0),
        (Initial::Off, Initial::On, -1.0),
        (Initial::Off, Initial::Off, 1.0),
    ] {
        form.add_outer(input, (left, right), |_| part, &mut gram, Progress::NONE)?;
    }
    form.gram_of(&mut gram);
    let mut right = vec![0.0; count];
    form.add_adjoint(input, Initial::On, |n| target[n], &mut right)?;
    form.add_adjoint(input, Initial::Off, |n| -target[n], &mut right)?;
    form.operators_of(&mut right);

    let signed = weights.iter().any(|mu| *mu < 0.0);
    let mut nu = vec![0.0; count];
    let mut descent = right;
    let size: f64 = weights.iter().map(|mu| mu.abs()).sum();
    for _ in 0..SWEEPS {
        let mut moved = 0.0_f64;
        for &n in &open {
            let curvature = gram[n * count + n];
            if curvature <= 0.0 {
                continue;
            }
            let (low, high) = match signed {
                true => (f64::NEG_INFINITY, f64::INFINITY),
                false => (0.0, weights[n]),
            };
            let next = (nu[n] + descent[n] / curvature).clamp(low, high);
            let step = next - nu[n];
            if step != 0.0 {
                nu[n] = next;
                moved = moved.max(step.abs());
                for &m in &open {
                    descent[m] -= step * gram[n * count + m];
                }
            }
        }
        if moved <= ENOUGH * size {
            break;
        }
    }
    let rest: Vec<f64> = weights.iter().zip(&nu).map(|(mu, nu)| mu - nu).collect();
    let rest = form.forward(&rest, input, Initial::Off)?;
    let on = form.forward(&nu, input, Initial::On)?;
    Ok(rest
        .iter()
        .zip(on)
        .map(|(a, b)| off + sign * (a + b))
        .collect())
}

//! The only place that touches the model: what the figures need of it, in their terms.

use hysteron::{FitSummary, LoadDependence, Model, Plane, Quantity, Surroundings};

/// A model's plane, weights and operator states on the half `α ≤ β`.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    model: &'a Model,
}

impl<'a> Source<'a> {
    pub(crate) fn new(model: &'a Model) -> Self {
        Self { model }
    }

    /// The plane.
    pub(crate) fn plane(self) -> &'a Plane {
        self.model.plane()
    }

    /// How the model was obtained, where it was identified.
    pub(crate) fn fit(self) -> Option<&'a FitSummary> {
        self.model.fit.as_ref()
    }

    /// The files that it was identified from, with their digests.
    pub(crate) fn fitted_to(self) -> Vec<(&'a str, Option<&'a str>)> {
        let Some(fit) = self.fit() else {
            return Vec::new();
        };
        let others = fit.other_files.iter().enumerate();
        let others = others.map(|(n, file)| (file, fit.other_sha256.get(n)));
        let first = fit.file.iter().map(|file| (file, fit.sha256.as_ref()));
        let all = first.chain(others);
        all.map(|(file, digest)| (file.as_str(), digest.map(String::as_str)))
            .collect()
    }

    /// How the weights depend on a load, where they do.
    pub(crate) fn load(self) -> Option<&'a LoadDependence> {
        self.model.load.as_ref()
    }

    /// `T_min`.
    pub(crate) fn min(self) -> f64 {
        self.model.plane().min()
    }

    /// `T_max`.
    pub(crate) fn max(self) -> f64 {
        self.model.plane().max()
    }

    /// `K`.
    pub(crate) fn levels(self) -> usize {
        self.model.plane().levels()
    }

    /// The smallest and the largest distance between neighbouring levels; both are `ΔT` where the
    /// distances are equal.
    pub(crate) fn steps(self) -> (f64, f64) {
        let corners = self.model.spacing();
        let step = self.model.plane().step();
        if corners.is_empty() {
            return (step, step);
        }
        let steps = corners.windows(2).map(|pair| pair[1] - pair[0]);
        steps.fold((f64::INFINITY, 0.0), |(low, high), step| {
            (low.min(step), high.max(step))
        })
    }

    /// All weights, row by row: `j = 1…K`, within a row `i = 1…j`.
    pub(crate) fn weights(self) -> &'a [f64] {
        self.model.weights()
    }

    /// The states `γ` after the inputs `history` from all-off, in the order of the weights.
    pub(crate) fn states(self, history: &[f64]) -> Vec<f64> {
        // Inputs that are not finite never come this far; were one to, the plane is drawn all off.
        let off = || vec![0.0; self.weights().len()];
        let operators = self.model.operators();
        let model = self.model.without_body();
        // Where they depend on a load, those of the middle of its range.
        let load = model.load.as_ref().map(|load| {
            let (low, high) = load.range();
            vec![0.5 * (low + high); history.len()]
        });
        let time = vec![0.0; history.len()];
        let around = Surroundings {
            time: Some(&time),
            load: load.as_deref(),
            rest: None,
        };
        let mut state = operators.start();
        let seen = model.seen(history, around);
        let run =
            seen.and_then(|seen| operators.run(&mut state, &seen, &mut vec![0.0; history.len()]));
        run.and_then(|_| operators.operator_states(&state))
            .unwrap_or_else(|_| off())
    }

    /// The inputs between which the operators move at `load`; `None` for a load out of range.
    pub(crate) fn active_range(self, load: f64) -> Option<(f64, f64)> {
        let model = self.model.without_body().at_load(load).ok()?;
        Some(model.active_range())
    }

    /// The outputs for `input` at `load`, from every operator off; `None` for a load out of range.
    pub(crate) fn at_load(self, load: f64, input: &[f64]) -> Option<Vec<f64>> {
        let model = self.model.without_body().at_load(load).ok()?;
        let mut output = vec![0.0; input.len()];
        let time = vec![0.0; input.len()];
        let around = Surroundings {
            time: Some(&time),
            load: None,
            rest: None,
        };
        model
            .run_in(&mut model.off(), input, around, &mut output)
            .ok()?;
        Some(output)
    }

    /// What the model's input is.
    pub(crate) fn input(self) -> &'a Quantity {
        &self.model.input
    }

    /// What the model's output is.
    pub(crate) fn output(self) -> &'a Quantity {
        &self.model.output
    }

    /// How many weights differ from zero, beyond rounding.
    pub(crate) fn weights_not_zero(self) -> usize {
        let zero = self.zero();
        self.weights().iter().filter(|μ| μ.abs() > zero).count()
    }

    /// The magnitude below which a weight counts as zero: rounding of a solver, not a contribution.
    pub(crate) fn zero(self) -> f64 {
        1e-9 * self
            .weights()
            .iter()
            .fold(0.0, |largest: f64, μ| largest.max(μ.abs()))
    }
}

//! What finds the weights of a model that learns: nothing, an estimator from sample to sample, a
//! refit over a window, or a mixture of these.

use super::mixture::Mixture;
use super::refit::{Core, Refit, Refitter};
use crate::error::{Error, Result};
use crate::model::{Model, OperatorState, Operators};
use hysteron_core::{
    Adaptation, Channel, Estimator, Learning, Method, Outcome, estimator_len,
    estimator_len_of_basis, table_len,
};

/// What finds the weights and the offset. Outputs are without the sign.
#[derive(Debug, Clone)]
pub(super) enum Learns {
    /// Nothing: these weights and this offset stay.
    Fixed(Vec<f64>, f64),
    /// From sample to sample.
    Estimator {
        estimator: Box<Estimator<f64, Vec<f64>>>,
        /// The basis that the parameters are coefficients of; empty if the parameters are the
        /// weights.
        basis: Vec<Vec<f64>>,
    },
    /// By refits over a window.
    Refitter(Box<Refitter>),
    /// By several of these side by side.
    Mixture(Box<Mixture>),
}

impl Learns {
    /// Nothing learns.
    pub(super) fn nothing(model: &Model) -> Result<(Core, Self)> {
        let core = operators(model)?.core.clone();
        Ok((core, Self::Fixed(model.weights().to_vec(), level(model))))
    }

    /// An estimator of all weights.
    pub(super) fn weights_of(model: &Model, options: Adaptation<f64>) -> Result<(Core, Self)> {
        let mut core = renewable(model, options.method)?;
        let memory = reserved(estimator_len(model.plane().levels(), options.method))?;
        let estimator = Estimator::new(options, &mut core, model.weights(), level(model), memory)?;
        let (estimator, basis) = (Box::new(estimator), Vec::new());
        Ok((core, Self::Estimator { estimator, basis }))
    }

    /// An estimator of the coefficients of a `basis`.
    pub(super) fn coefficients(
        model: &Model,
        basis: Vec<Vec<f64>>,
        coefficients: &[f64],
        options: Adaptation<f64>,
    ) -> Result<(Core, Self)> {
        let mut core = renewable(model, options.method)?;
        let (levels, count) = (model.plane().levels(), coefficients.len());
        let memory = reserved(estimator_len_of_basis(levels, options.method, count))?;
        let (all, level) = (basis.concat(), level(model));
        let estimator = Estimator::of_basis(options, &mut core, &all, coefficients, level, memory)?;
        let estimator = Box::new(estimator);
        Ok((core, Self::Estimator { estimator, basis }))
    }

    /// Refits over a window.
    pub(super) fn refits(model: &Model, options: Refit) -> Result<(Core, Self)> {
        check_memory(MATRICES * operators(model)?.plane().operators().pow(2))?;
        let core = writable(model)?;
        let refitter = Refitter::new(&model.within(), options)?;
        Ok((core, Self::Refitter(Box::new(refitter))))
    }

    /// Several learners of one model side by side.
    pub(super) fn mixture(
        model: &Model,
        learners: Vec<(&'static str, (Core, Self))>,
    ) -> Result<(Core, Self)> {
        let (core, mixture) = Mixture::new(model, learners)?;
        Ok((core, Self::Mixture(Box::new(mixture))))
    }

    /// Moves `state` to `input`, predicts the output there and learns from the `measured` one.
    pub(super) fn step(
        &mut self,
        core: &mut Core,
        state: &mut OperatorState,
        input: f64,
        measured: f64,
    ) -> Result<Learning<f64>> {
        match self {
            Self::Fixed(_, offset) => fixed(core, state, input, (measured, *offset)),
            Self::Estimator { estimator, .. } => Ok(estimator.step(core, state, input, measured)?),
            Self::Refitter(refitter) => refitter.step(core, state, input, measured),
            Self::Mixture(mixture) => mixture.step(core, state, input, measured),
        }
    }

    /// Others moved the state along its branches.
    pub(super) fn follow(&mut self, state: &OperatorState) -> Result<()> {
        match self {
            Self::Refitter(refitter) => refitter.follow(state),
            Self::Mixture(mixture) => mixture.follow(state)?,
            Self::Fixed(..) | Self::Estimator { .. } => {}
        }
        Ok(())
    }

    /// Others set the state.
    pub(super) fn realign(&mut self, state: &OperatorState) -> Result<()> {
        match self {
            Self::Estimator { estimator, .. } => estimator.realign(),
            Self::Refitter(refitter) => refitter.realign(),
            Self::Mixture(mixture) => mixture.realign(state)?,
            Self::Fixed(..) => {}
        }
        Ok(())
    }

    /// The weights, row by row.
    pub(super) fn weights(&self) -> Vec<f64> {
        let (estimator, basis) = match self {
            Self::Fixed(weights, _) => return weights.clone(),
            Self::Estimator { estimator, basis } => (estimator, basis),
            Self::Refitter(refitter) => return refitter.weights(),
            Self::Mixture(mixture) => return mixture.weights().to_vec(),
        };
        let parameters = estimator.parameters();
        let Some(first) = basis.first() else {
            return parameters.to_vec();
        };
        let mut weights = vec![0.0; first.len()];
        for (coefficient, member) in parameters.iter().zip(basis) {
            for (weight, member) in weights.iter_mut().zip(member) {
                *weight += coefficient * member;
            }
        }
        weights
    }

    /// The output with every operator off.
    pub(super) fn level(&self) -> f64 {
        match self {
            Self::Fixed(_, offset) => *offset,
            Self::Estimator { estimator, .. } => estimator.offset(),
            Self::Refitter(refitter) => refitter.offset(),
            Self::Mixture(mixture) => mixture.offset(),
        }
    }

    pub(super) fn freeze(&mut self, frozen: bool) {
        match self {
            Self::Estimator { estimator, .. } => estimator.freeze(frozen),
            Self::Refitter(refitter) => refitter.freeze(frozen),
            Self::Mixture(mixture) => mixture.freeze(frozen),
            Self::Fixed(..) => {}
        }
    }

    /// The channel that stands still.
    pub(super) fn stuck(&self) -> Option<Channel> {
        match self {
            Self::Estimator { estimator, .. } => estimator.stuck(),
            Self::Refitter(refitter) => refitter.stuck(),
            Self::Mixture(mixture) => mixture.stuck(),
            Self::Fixed(..) => None,
        }
    }

    /// Stores the present weights as the last good ones.
    pub(super) fn keep(&mut self) {
        match self {
            Self::Estimator { estimator, .. } => estimator.keep(),
            Self::Refitter(refitter) => refitter.keep(),
            Self::Mixture(mixture) => mixture.keep(),
            Self::Fixed(..) => {}
        }
    }

    /// Returns to the last good weights.
    pub(super) fn roll_back(&mut self, core: &mut Core) -> Result<()> {
        match self {
            Self::Estimator { estimator, .. } => estimator.roll_back(core),
            Self::Refitter(refitter) => refitter.roll_back(core)?,
            Self::Mixture(mixture) => mixture.roll_back(core)?,
            Self::Fixed(..) => {}
        }
        Ok(())
    }

    /// Uses what has come since the last refit. Returns whether the weights changed.
    pub(super) fn refit(&mut self, core: &mut Core) -> Result<bool> {
        match self {
            Self::Refitter(refitter) => refitter.refit(core),
            Self::Mixture(mixture) => mixture.refit(core),
            Self::Fixed(..) | Self::Estimator { .. } => Ok(false),
        }
    }
}

/// The offset without the sign.
fn level(model: &Model) -> f64 {
    model.sign().factor() * model.offset()
}

/// A step of a model that does not change. `measured` and `offset` are without the sign.
fn fixed(
    core: &Core,
    state: &mut OperatorState,
    input: f64,
    (measured, offset): (f64, f64),
) -> Result<Learning<f64>> {
    if !measured.is_finite() {
        return Err(hysteron_core::Error::InputNotFinite { index: 1 }.into());
    }
    let step = core.step(state, input)?;
    let output = step.output + offset;
    Ok(Learning {
        output,
        error: measured - output,
        outcome: Outcome::Frozen,
        clipped: step.clipped,
    })
}

/// The operators of a model at one load.
fn operators(model: &Model) -> Result<&Operators> {
    match &model.load {
        None => Ok(model.operators()),
        Some(load) => Err(load.one_is_needed()),
    }
}

/// Largest memory of an estimator, in bytes.
const MOST_BYTES: u128 = 4 << 30;

/// Matrices that a refit has at one time: the sums, those of the operators, the one to solve and its
/// factor.
const MATRICES: usize = 4;

/// The memory of an estimator.
fn reserved(numbers: usize) -> Result<Vec<f64>> {
    check_memory(numbers)?;
    Ok(vec![0.0; numbers])
}

fn check_memory(numbers: usize) -> Result<()> {
    let bytes = 8 * numbers as u128;
    if bytes > MOST_BYTES {
        return Err(Error::Fit(format!(
            "an estimator with this method and so many levels takes {:.1} GiB, more than the {} \
             GiB allowed: take another method, or a model with fewer levels",
            bytes as f64 / f64::from(1 << 30),
            MOST_BYTES >> 30
        )));
    }
    Ok(())
}

/// A core model with the memory that the method needs.
fn renewable(model: &Model, method: Method<f64>) -> Result<Core> {
    let tables = match method {
        Method::Increments { .. } => 2,
        _ => 1,
    };
    with_tables(model, tables)
}

/// A core model whose weights may be written at once. Its inverse exists only with weights of zero
/// or above: others are refused.
pub(super) fn writable(model: &Model) -> Result<Core> {
    let core = with_tables(model, 1)?;
    core.inverse()?;
    Ok(core)
}

fn with_tables(model: &Model, tables: usize) -> Result<Core> {
    let model = operators(model)?;
    let (plane, operator) = (*model.plane(), model.operator());
    let table = vec![0.0; tables * table_len(plane.levels())];
    Ok(Core::new(plane, operator, model.weights(), table)?)
}

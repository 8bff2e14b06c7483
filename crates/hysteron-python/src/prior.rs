//! `fleet.WeightPrior`.

use crate::error::Raise;
use crate::model::Model;
use pyo3::prelude::*;
use std::sync::Arc;

/// What other actuators of the same kind tell about the next one: mean and covariance of their
/// offsets and weights. For the argument `prior` of `pyhysteron.fit`.
///
/// Parameters
/// ----------
/// models : list of Model
///     Ten or more, fitted, with the same plane, spacing, operator and sign; without a load
///     and without stages that depend on time.
///
/// Raises
/// ------
/// FitError
///     For models that make no prior.
///
/// Examples
/// --------
/// >>> t = np.linspace(0, 20, 400)
/// >>> input = 50 - 30 * np.cos(t) * np.exp(-t / 20)
/// >>> def record(stroke):
/// ...     return stroke * pyhysteron.Model(np.full(15, 0.2), (30, 80)).simulate(input)
/// >>> def fit(count, stroke, **more):
/// ...     return pyhysteron.fit(input[:count], record(stroke)[:count], start='off', bootstrap=0, **more)
/// >>> plane = {'levels': 6, 'range': (25, 75), 'spacing': 'uniform', 'smooth': 0.0}
/// >>> models = [fit(400, 1 + 0.05 * n, **plane) for n in range(12)]
/// >>> model = fit(60, 1.3, prior=pyhysteron.fleet.WeightPrior(models))
/// >>> bool(np.max(np.abs(model.simulate(input) - record(1.3))) < 0.2)
/// True
#[pyclass(frozen, module = "pyhysteron.fleet")]
pub(crate) struct WeightPrior {
    pub(crate) inner: Arc<hysteron::WeightPrior>,
}

#[pymethods]
impl WeightPrior {
    #[new]
    fn new(models: Vec<PyRef<'_, Model>>) -> PyResult<Self> {
        let models: Vec<hysteron::Model> = models.iter().map(|m| (*m.inner).clone()).collect();
        let prior = hysteron::WeightPrior::from_models(&models).raise()?;
        Ok(prior.into())
    }

    fn __repr__(&self) -> String {
        format!("<WeightPrior of {} models>", self.inner.count())
    }
}

impl From<hysteron::WeightPrior> for WeightPrior {
    fn from(prior: hysteron::WeightPrior) -> Self {
        let inner = Arc::new(prior);
        Self { inner }
    }
}

//! `prepare`.

use crate::choices::{another_kind, none_left};
use crate::convert::{result, to_python};
use crate::inputs::recording_of;
use crate::progress::with_progress;
use crate::recording::Recording;
use hysteron::{PrepareOptions, RateDependence, Step};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// Prepare a recording for `fit`.
///
/// The steps: remove spikes, resample, smooth, undo a sensor's lag, remove false reversals of the
/// input. Each step is 'auto', 'off', or a number. An 'auto' step is taken only if a model then
/// errs less on parts of the recording that it did not see. A clean recording is returned unchanged.
///
/// Parameters
/// ----------
/// recording : Recording, or array_like of shape (n,)
///     An array is the input, and `output` is needed.
/// output : array_like, shape (n,), optional
/// spikes : 'auto', 'off' or float
///     A spike is this many median absolute deviations away from its neighbours.
/// resample : 'auto', 'off' or float
///     The time step, s. 'auto' resamples only where time is irregular and a filter needs it.
/// low_pass : 'auto', 'off' or float
///     Cut-off of a zero-phase low-pass, Hz; without time in cycles per sample. 'auto' follows
///     the noise.
/// lag : 'auto', 'off' or float
///     Time constant of the input's sensor, s. 'auto' is right only for a material that does not
///     depend on rate.
/// dead_band : 'auto', 'off' or float
///     Reversals of the input up to this size are noise, in its unit. 'auto' measures the noise.
/// signs : bool
///     Restore the signs of readings just below zero that lost them. It turns good readings over
///     where none was lost.
/// believe : bool
///     Prepare also a recording with a frozen channel, with rows that come twice, or with rows that
///     disagree with the others.
/// time, load : array_like, shape (n,), optional
///     For an input and an output given as arrays. `time` as in `Recording`.
/// progress : callable, bool or None
///     As for `fit`. Ctrl-C ends the work in any case.
///
/// Returns
/// -------
/// recording : Recording
/// report : results.Preparation
///     What each step did, and how much the output depends on the rate of the input.
///
/// Raises
/// ------
/// RecordingError, PreparationError, FilterError
///
/// Examples
/// --------
/// >>> input = 40 * np.sin(0.05 * np.arange(300))
/// >>> output = 0.5 * input
/// >>> input[100] = 0  # a reading that was lost
/// >>> prepared, report = pyhysteron.prepare(input, output)
/// >>> report.spikes.input.first  # counted from 1
/// (101,)
/// >>> bool(abs(prepared.input[100] + 38.36) < 0.1)
/// True
#[pyfunction]
#[pyo3(signature = (recording, output=None, *, spikes=None, resample=None, low_pass=None, lag=None, dead_band=None, signs=false, believe=false, time=None, load=None, progress=None, **unknown),
    text_signature = "(recording, output=None, *, spikes='auto', resample='auto', low_pass='auto', lag='off', dead_band='auto', signs=False, believe=False, time=None, load=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn prepare<'py>(
    py: Python<'py>,
    recording: &Bound<'py, PyAny>,
    output: Option<&Bound<'py, PyAny>>,
    spikes: Option<&Bound<'py, PyAny>>,
    resample: Option<&Bound<'py, PyAny>>,
    low_pass: Option<&Bound<'py, PyAny>>,
    lag: Option<&Bound<'py, PyAny>>,
    dead_band: Option<&Bound<'py, PyAny>>,
    signs: bool,
    believe: bool,
    time: Option<&Bound<'py, PyAny>>,
    load: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
    unknown: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Recording, Bound<'py, PyAny>)> {
    none_left("prepare", unknown, &NAMES)?;
    let usual = PrepareOptions::default();
    let options = PrepareOptions {
        signs,
        believe,
        spikes: step("spikes", spikes, usual.spikes)?,
        resample: step("resample", resample, usual.resample)?,
        low_pass: step("low_pass", low_pass, usual.low_pass)?,
        lag: step("lag", lag, usual.lag)?,
        dead_band: step("dead_band", dead_band, usual.dead_band)?,
    };
    let recording = recording_of(recording, output, time, load)?;
    let (prepared, report, rate) = with_progress(py, progress, |progress| {
        let (prepared, report) = hysteron::prepare(&recording.inner, &options, progress)?;
        progress.tell("dependence on rate", f64::NAN)?;
        let rate = hysteron::rate_dependence(&prepared)?;
        Ok((prepared, report, rate))
    })?;
    let found = to_python(py, &report)?;
    found.set_item("rate", to_python(py, &rate)?)?;
    let dependent = rate.as_ref().map(RateDependence::is_material);
    found.set_item("rate_dependent", dependent)?;
    Ok((prepared.into(), result(py, "Preparation", found)?))
}

const NAMES: [&str; 10] = [
    "spikes",
    "resample",
    "low_pass",
    "lag",
    "dead_band",
    "signs",
    "believe",
    "time",
    "load",
    "progress",
];

fn step(argument: &str, value: Option<&Bound<'_, PyAny>>, usual: Step) -> PyResult<Step> {
    let Some(value) = value else {
        return Ok(usual);
    };
    let text = value.cast::<PyString>().ok();
    match (
        value.extract(),
        text.map(|text| text.to_cow()).transpose()?.as_deref(),
    ) {
        (Ok(value), _) => Ok(Step::Value(value)),
        (_, Some("auto")) => Ok(Step::Auto),
        (_, Some("off")) => Ok(Step::Off),
        _ => Err(another_kind(argument, "'auto', 'off' or a number", value)),
    }
}

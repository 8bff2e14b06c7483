//! `prepare`.

use crate::given::recording_of;
use crate::recording::Recording;
use crate::said::told;
use crate::watched::watched;
use crate::word::another_kind;
use hysteron::{PrepareOptions, RateDependence, Step};
use pyo3::prelude::*;
use pyo3::types::PyString;

/// Prepare a recording for `fit`: give back lost signs, remove spikes, resample and smooth where noise asks for it, undo a
/// sensor's lag if told to, and take false reversals from the input.
///
/// A clean recording comes through unchanged. Each step is 'auto', 'off', or a number.
///
/// Parameters
/// ----------
/// recording : Recording, or array_like of shape (n,)
///     Or the input, with the output beside it.
/// output : array_like, shape (n,), optional
/// spikes : 'auto', 'off' or float
///     How many median absolute deviations make a spike.
/// resample : 'auto', 'off' or float
///     The step of time, s; 'auto' only where time is irregular and a filter needs it.
/// low_pass : 'auto', 'off' or float
///     Cut-off of a zero-phase low-pass, Hz, without time in cycles a sample; 'auto' as far as the noise goes.
/// lag : 'auto', 'off' or float
///     Time constant of the input's sensor, s; 'auto' is right only for a material that does not depend on rate.
/// band : 'auto', 'off' or float
///     Reversals of the input up to this are noise, in its unit; 'auto' as far as the noise reaches.
/// time, load : array_like, shape (n,), optional
///     With an input and an output.
/// progress : callable, bool or None
///     As for `fit`. Ctrl-C ends it in any case.
///
/// Returns
/// -------
/// recording : Recording
/// report : dict
///     What each step did; 'rate', how much the output depends on the rate of the input, None without time; and
///     'rate_dependent', whether that is more than a static model can follow.
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
/// >>> report['spikes']['input']['first']  # counted from 1
/// [101]
/// >>> bool(abs(prepared.input[100] + 38.36) < 0.1)
/// True
#[pyfunction]
#[pyo3(signature = (recording, output=None, *, spikes=None, resample=None, low_pass=None, lag=None, band=None, time=None, load=None, progress=None),
    text_signature = "(recording, output=None, *, spikes='auto', resample='auto', low_pass='auto', lag='off', band='auto', time=None, load=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn prepare<'py>(
    py: Python<'py>,
    recording: &Bound<'py, PyAny>,
    output: Option<&Bound<'py, PyAny>>,
    spikes: Option<&Bound<'py, PyAny>>,
    resample: Option<&Bound<'py, PyAny>>,
    low_pass: Option<&Bound<'py, PyAny>>,
    lag: Option<&Bound<'py, PyAny>>,
    band: Option<&Bound<'py, PyAny>>,
    time: Option<&Bound<'py, PyAny>>,
    load: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Recording, Bound<'py, PyAny>)> {
    let usual = PrepareOptions::default();
    let options = PrepareOptions {
        spikes: step("spikes", spikes, usual.spikes)?,
        resample: step("resample", resample, usual.resample)?,
        low_pass: step("low_pass", low_pass, usual.low_pass)?,
        lag: step("lag", lag, usual.lag)?,
        band: step("band", band, usual.band)?,
    };
    let recording = recording_of(recording, output, time, load)?;
    let (prepared, report, rate) = watched(py, progress, |watch| {
        let (prepared, report) = hysteron::prepare_watched(&recording.inner, &options, watch)?;
        watch("dependence on rate", f64::NAN)?;
        let rate = hysteron::rate_dependence(&prepared)?;
        Ok((prepared, report, rate))
    })?;
    let said = told(py, &report)?;
    said.set_item("rate", told(py, &rate)?)?;
    let dependent = rate.as_ref().map(RateDependence::is_material);
    said.set_item("rate_dependent", dependent)?;
    Ok((prepared.into(), said))
}

fn step(argument: &str, value: Option<&Bound<'_, PyAny>>, usual: Step) -> PyResult<Step> {
    let Some(value) = value else {
        return Ok(usual);
    };
    let word = value.cast::<PyString>().ok();
    match (
        value.extract(),
        word.map(|w| w.to_cow()).transpose()?.as_deref(),
    ) {
        (Ok(value), _) => Ok(Step::Value(value)),
        (_, Some("auto")) => Ok(Step::Auto),
        (_, Some("off")) => Ok(Step::Off),
        _ => Err(another_kind(argument, "'auto', 'off' or a number", value)),
    }
}

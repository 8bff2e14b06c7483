//! What goes with the samples of an input: time and load.

use crate::array::{series, times};
use crate::error::{finite, number};
use hysteron::{Model, Surroundings};
use pyo3::prelude::*;

/// Time and load, copied from Python.
pub(crate) struct Around {
    time: Option<Vec<f64>>,
    load: Option<Vec<f64>>,
}

impl Around {
    /// Those of `count` samples. One number is the load of all of them.
    pub(crate) fn of(
        model: &Model,
        count: usize,
        time: Option<&Bound<'_, PyAny>>,
        load: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        // Time is ignored where nothing depends on it.
        let time = times(time)?.filter(|_| model.is_timed());
        let load = load.map(|load| loads(load, count)).transpose()?;
        for (name, series) in [("time", &time), ("load", &load)] {
            if let Some(series) = series {
                finite(name, series)?;
            }
        }
        Ok(Self { time, load })
    }

    pub(crate) fn lent(&self) -> Surroundings<'_> {
        Surroundings {
            time: self.time.as_deref(),
            load: self.load.as_deref(),
        }
    }
}

fn loads(value: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<f64>> {
    match (value.len(), value.extract()) {
        (Err(_), Ok(load)) => Ok(vec![number("load", load)?; count]),
        _ => series(value, "load"),
    }
}

/// Time step and load of one sample.
pub(crate) fn step(dt: Option<f64>, load: Option<f64>) -> PyResult<(Option<f64>, Option<f64>)> {
    let finite = |name, value: Option<f64>| value.map(|value| number(name, value)).transpose();
    Ok((finite("dt", dt)?, finite("load", load)?))
}

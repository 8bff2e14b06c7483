//! What goes with the samples of an input: time and load.

use crate::array::{rows, series, times};
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
    pub(crate) fn new(
        model: &Model,
        count: usize,
        time: Option<&Bound<'_, PyAny>>,
        load: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        // Time is ignored where nothing depends on it.
        let time = times(time)?.filter(|_| model.reads_time());
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
            rest: None,
        }
    }
}

/// The loads of a series. One number is the load of all of its `count` samples.
pub(crate) fn loads(value: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<f64>> {
    match one_load(value)? {
        Some(load) => Ok(vec![load; count]),
        None => series(value, "load"),
    }
}

/// As [`loads`], in rows.
pub(crate) fn rows_of_loads(value: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<f64>> {
    match one_load(value)? {
        Some(load) => Ok(vec![load; count]),
        None => Ok(rows(value, "load")?.as_slice()?.to_vec()),
    }
}

fn one_load(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    match (value.len(), value.extract()) {
        (Err(_), Ok(load)) => number("load", load).map(Some),
        _ => Ok(None),
    }
}

/// Time step and load of one sample.
pub(crate) fn step(dt: Option<f64>, load: Option<f64>) -> PyResult<(Option<f64>, Option<f64>)> {
    let finite = |name, value: Option<f64>| value.map(|value| number(name, value)).transpose();
    Ok((finite("dt", dt)?, finite("load", load)?))
}

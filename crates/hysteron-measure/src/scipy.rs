//! Runs `docs/scipy-baseline.py` on a recording.

use crate::result::Result;
use hysteron::{Plane, Recording};
use serde::Deserialize;
use serde_json::json;
use std::io::Write;
use std::process::{Command, Stdio};

/// What SciPy found.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Found {
    pub squares: f64,
    pub seconds_regressor: f64,
    pub seconds_fit: f64,
    pub training_rmse: f64,
    pub left_out_rmse: f64,
    pub predicted: Vec<f64>,
}

/// `None` where Python or SciPy is not installed.
pub fn run(recording: &Recording, plane: Plane, fold: Option<&[usize]>) -> Result<Option<Found>> {
    ask(json!({
        "min": plane.min(), "max": plane.max(), "levels": plane.levels(),
        "input": recording.input, "output": recording.output, "fold": fold,
    }))
}

/// The output for another input, from a fit to the recording; `None` where Python or SciPy is not
/// installed.
pub fn predict(recording: &Recording, plane: Plane, test: &[f64]) -> Result<Option<Vec<f64>>> {
    let found = ask(json!({
        "min": plane.min(), "max": plane.max(), "levels": plane.levels(),
        "input": recording.input, "output": recording.output, "test": test,
    }))?;
    Ok(found.map(|found| found.predicted))
}

fn ask(job: serde_json::Value) -> Result<Option<Found>> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let installed = Command::new(&python)
        .args(["-c", "import scipy"])
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if !installed {
        return Ok(None);
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scipy-baseline.py");
    let mut child = Command::new(python)
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()?;
    let mut stdin = child.stdin.take().ok_or("no pipe")?;
    stdin.write_all(job.to_string().as_bytes())?;
    drop(stdin);
    let output = child.wait_with_output()?;
    if !output.status.success() {
        return Err(format!("{script} failed").into());
    }
    Ok(Some(serde_json::from_slice(&output.stdout)?))
}

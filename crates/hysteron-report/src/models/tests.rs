#![allow(clippy::unwrap_used)]

use super::NamedForward;
use crate::error::ReportError;
use crate::made::Made;
use crate::report::{Report, Shown};
use hysteron::{Errors, Forward, Recording};

fn forward(recording: &Recording, error: f64) -> Forward {
    let wiggle = |(n, y): (usize, &f64)| y + error * (n as f64 * 0.7).sin();
    let output_model: Vec<f64> = recording.output.iter().enumerate().map(wiggle).collect();
    Forward {
        errors: Errors::between(&recording.output, &output_model, |_| true).unwrap(),
        output_model,
        was_fitted: error < 0.1,
        seen_for_band: false,
    }
}

fn recording() -> Recording {
    let input: Vec<f64> = (0..300).map(|n| (f64::from(n) * 0.1).sin()).collect();
    Recording::new(input.clone(), input).unwrap()
}

#[test]
fn every_model_has_its_panel_and_its_row() {
    let recording = recording();
    let runs: Vec<Forward> = [0.01, 0.2, 0.0].map(|e| forward(&recording, e)).to_vec();
    let names = ["good <model>", "bad model", "exact"];
    let named = names.iter().zip(&runs);
    let models: Vec<NamedForward<'_>> = named
        .map(|(name, forward)| NamedForward {
            name,
            forward,
            verdict: None,
        })
        .collect();
    for count in 1..=models.len() {
        let folder = tempfile::tempdir().unwrap();
        let report = Report {
            title: "models",
            shown: Shown::Models {
                recording: &recording,
                models: &models[..count],
            },
            made: Made::default(),
        };
        let written = report.write(folder.path()).unwrap();
        // A page, and three figures as SVG and PNG.
        assert_eq!(written.len(), 7);
        let page = std::fs::read_to_string(&written[0]).unwrap();
        assert!(page.contains("good &lt;model&gt;") && !page.contains("<model>"));
        assert!(page.contains("fitted to this recording"));
        assert_eq!(page.contains("bad model"), count > 1);
        for path in &written[1..] {
            let bytes = std::fs::read(path).unwrap();
            assert!(bytes.len() > 1000, "{}", path.display());
        }
    }
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let recording = recording();
    let mut short = forward(&recording, 0.1);
    short.output_model.pop();
    let one = [NamedForward {
        name: "short",
        forward: &short,
        verdict: None,
    }];
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("report");
    let write = |models: &[NamedForward<'_>]| {
        let report = Report {
            title: "models",
            shown: Shown::Models {
                recording: &recording,
                models,
            },
            made: Made::default(),
        };
        report.write(place.as_path()).unwrap_err()
    };
    assert!(matches!(
        write(&one),
        ReportError::Length { found: 299, .. }
    ));
    assert!(matches!(write(&[]), ReportError::NoModel));
    assert!(!place.exists());
}

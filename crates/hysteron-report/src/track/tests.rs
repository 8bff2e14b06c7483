//! Comparisons as a whole, of good runs and of poor ones.
#![allow(clippy::unwrap_used)]

use super::fixture::{Controller, FOUR, Fixture, report};
use crate::report::Report;
use hysteron::Quantity;
use std::fs;

/// All figures, by their stems. Each must be well-formed, without NaN or infinite numbers.
fn figures(fixture: &Fixture) -> Vec<(&'static str, String)> {
    let drawn = fixture.report(true, drawn);
    for (stem, svg) in &drawn {
        let document = roxmltree::Document::parse(svg).unwrap();
        for node in document.descendants().flat_map(|node| node.attributes()) {
            let value = node.value();
            assert!(
                !value.contains("NaN") && !value.contains("inf"),
                "{stem}: {value}"
            );
        }
    }
    drawn
}

fn drawn(report: &Report<'_>) -> Vec<(&'static str, String)> {
    let drawn = |stem| Some((stem, report.svg(stem).unwrap()?));
    stems().into_iter().filter_map(drawn).collect()
}

fn stems() -> Vec<&'static str> {
    Fixture::new(&FOUR, 1).report(true, |report| report.stems().unwrap())
}

fn names(fixture: &Fixture) -> Vec<&'static str> {
    let drawn = figures(fixture).into_iter();
    drawn.map(|(stem, _)| stem).collect()
}

fn figure(fixture: &Fixture, stem: &str) -> String {
    let svg = |report: &Report<'_>| report.svg(stem).unwrap().unwrap();
    fixture.report(true, svg)
}

/// Subpaths of the curves drawn with `colour`.
fn pieces(svg: &str, colour: &str) -> usize {
    let document = roxmltree::Document::parse(svg).unwrap();
    let strokes = document
        .descendants()
        .filter(|node| node.attribute("stroke") == Some(colour));
    strokes
        .filter(|node| {
            node.attribute("d")
                .is_some_and(|d| d.matches('L').count() > 1)
        })
        .count()
}

#[test]
fn a_report_has_every_figure_twice_and_one_page() {
    let fixture = Fixture::new(&FOUR, 2000);
    let folder = tempfile::tempdir().unwrap();
    let written = fixture.report(true, |report| report.write(folder.path()).unwrap());
    assert_eq!(written.len(), 1 + 2 * stems().len());
    let page = fs::read_to_string(&written[0]).unwrap();
    assert_eq!(page.matches("<svg").count(), stems().len());
    for load in ["src=\"http", "href=\"http", "url(http", "@import", "<link"] {
        assert!(!page.contains(load), "{load}");
    }
    // The numbers of the figures, plotly.js and our script.
    assert_eq!(page.matches("<script").count(), 3);
    assert!(page.contains("content-security-policy"));
    // The table comes before the figures, with a dash where there is no number.
    assert!(page.find("RMSE before [mm]").unwrap() < page.find("<svg").unwrap());
    assert!(page.contains("<td>0.900</td><td>–</td>"));
    assert!(page.contains("at 450\u{a0}s: load 10 N"));
    let mut ids: Vec<&str> = page
        .split(" id=\"")
        .skip(1)
        .filter_map(|s| s.split('"').next())
        .collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
}

#[test]
fn simulated_runs_say_so_in_every_figure() {
    let fixture = Fixture::new(&FOUR, 300);
    for simulated in [true, false] {
        fixture.report(simulated, |report| {
            let drawn = drawn(report);
            assert_eq!(drawn.len(), stems().len());
            for (stem, svg) in drawn {
                let says = svg.contains("simulated, not measured");
                assert_eq!(says, simulated, "{stem}");
            }
        });
    }
}

#[test]
fn what_no_run_has_is_left_out() {
    let without = |change: &dyn Fn(&mut Fixture)| {
        let mut fixture = Fixture::new(&FOUR, 300);
        change(&mut fixture);
        let drawn = names(&fixture);
        let missing = stems().into_iter().filter(|stem| !drawn.contains(stem));
        missing.collect::<Vec<_>>()
    };
    assert!(without(&|_| ()).is_empty());
    assert_eq!(
        without(&|f| f.traces.iter_mut().for_each(|t| t.snapshots.truncate(1))),
        ["track-weights", "track-plane"]
    );
    assert_eq!(
        without(&|f| f
            .traces
            .iter_mut()
            .for_each(|t| t.prediction.fill(f64::NAN))),
        ["track-prediction"]
    );
    assert_eq!(
        without(&|f| f.traces.iter_mut().for_each(|t| t.reference.fill(1.0))),
        ["track-reversal"]
    );
}

#[test]
fn a_drive_that_is_the_input_has_no_figure_of_its_own() {
    let fixture = Fixture::new(&FOUR, 300);
    fixture.tracking(true, |tracking| {
        let mut tracking = tracking.clone();
        tracking.drive = tracking.input.clone();
        let svg = |stem| report(&tracking).svg(stem).unwrap();
        assert_eq!(svg("track-drive"), None);
        // The status goes with the input then.
        let input = svg("track-input").unwrap();
        assert!(input.contains("sensor fault") && input.contains("reading rejected"));
    });
}

#[test]
fn one_controller_and_twelve() {
    assert_eq!(names(&Fixture::new(&FOUR[3..], 300)), stems());
    let twelve: Vec<Controller> = FOUR.iter().copied().cycle().take(12).collect();
    let fixture = Fixture::new(&twelve, 300);
    assert_eq!(names(&fixture), stems());
    assert_eq!(pieces(&figure(&fixture, "track-output"), "#12385f"), 12);
}

#[test]
fn samples_that_are_no_numbers_break_the_curve() {
    let mut fixture = Fixture::new(&FOUR[..1], 400);
    assert_eq!(pieces(&figure(&fixture, "track-error"), "#12385f"), 1);
    fixture.traces[0].output[150..200].fill(f64::NAN);
    fixture.traces[0].reference[300] = f64::INFINITY;
    assert_eq!(pieces(&figure(&fixture, "track-error"), "#12385f"), 3);
    for series in [f64::NAN, f64::INFINITY, 1e308] {
        let mut fixture = Fixture::new(&FOUR, 50);
        for trace in &mut fixture.traces {
            for values in [
                &mut trace.reference,
                &mut trace.output,
                &mut trace.input,
                &mut trace.command,
                &mut trace.drive,
                &mut trace.prediction,
            ] {
                values.fill(series);
            }
            trace.time[3] = f64::NAN;
            for snapshot in &mut trace.snapshots {
                snapshot.weights[0] = series;
                snapshot.offset = series;
            }
        }
        assert!(figures(&fixture).len() >= 4);
    }
}

#[test]
fn a_single_sample_is_drawn() {
    assert!(!names(&Fixture::new(&FOUR, 1)).is_empty());
}

#[test]
fn many_samples_stay_small() {
    let fixture = Fixture::new(&FOUR, 100_000);
    for (stem, svg) in figures(&fixture) {
        assert!(svg.len() < 400_000, "{stem}: {} bytes", svg.len());
    }
}

#[test]
fn a_large_error_that_does_not_last_does_not_set_the_scale() {
    let mut errors = vec![0.1; 1000];
    errors[..5].fill(-40.0);
    let (span, cut) = super::figures::cut::robust([errors.as_slice()].into_iter());
    assert!(cut && span.low > -0.2 && span.high < 0.2, "{span:?}");
    errors[..5].fill(-0.12);
    assert!(!super::figures::cut::robust([errors.as_slice()].into_iter()).1);
    // Marked where it is cut off.
    let mut fixture = Fixture::new(&FOUR, 1000);
    fixture.traces[1].output[500] = 60.0;
    assert!(figure(&fixture, "track-error").contains("beyond the axis"));
}

#[test]
fn names_are_escaped() {
    let mut fixture = Fixture::new(&FOUR, 100);
    fixture.names[0] = "<b>P & \"D\"</b>";
    fixture.events[0].1 = "<i>load</i>".into();
    fixture.tracking(true, |tracking| {
        let mut tracking = tracking.clone();
        tracking.output = Quantity::with_unit("<u>lift</u>", "µm");
        let folder = tempfile::tempdir().unwrap();
        let page = fs::read_to_string(&report(&tracking).write(folder.path()).unwrap()[0]).unwrap();
        for raw in ["<b>P &", "<i>load", "<u>lift"] {
            assert!(!page.contains(raw), "{raw}");
        }
    });
}

#[test]
fn parts_that_do_not_fit_are_refused_before_anything_is_written() {
    let refused = |change: &dyn Fn(&mut Fixture), said: &str| {
        let mut fixture = Fixture::new(&FOUR, 100);
        change(&mut fixture);
        let folder = tempfile::tempdir().unwrap();
        let error = fixture.report(true, |report| report.write(folder.path()).unwrap_err());
        assert!(error.to_string().contains(said), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    };
    refused(&|f| f.traces.clear(), "no run");
    refused(
        &|f| f.traces[2] = Default::default(),
        "inverse and PID, hold has no samples",
    );
    refused(
        &|f| f.traces[1].drive.truncate(99),
        "drive of inverse has 99 values",
    );
    refused(
        &|f| f.traces[1].time.truncate(99),
        "time of inverse has 99 values",
    );
    refused(
        &|f| f.traces[3].snapshots[4].weights.truncate(7),
        "has 7 weights",
    );
    refused(&|f| f.table.rows[0].1.truncate(1), "row PID has 1 values");
}

#[test]
fn figures_of_an_earlier_report_are_removed() {
    let mut fixture = Fixture::new(&FOUR, 100);
    let folder = tempfile::tempdir().unwrap();
    fixture.report(true, |report| report.write(folder.path()).unwrap());
    fixture.traces.iter_mut().for_each(|t| t.snapshots.clear());
    let written = fixture.report(true, |report| report.write(folder.path()).unwrap());
    // With the list of files.
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        written.len() + 1
    );
    assert_eq!(written.len(), 1 + 2 * (stems().len() - 2));
}

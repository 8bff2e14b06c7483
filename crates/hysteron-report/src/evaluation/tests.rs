//! Reports as a whole, of good recordings and of poor ones.
#![allow(clippy::unwrap_used)]

use crate::draw::style::{MEASURED, POINTED};
use crate::evaluation::fixture::{Fixture, sma};
use crate::made::Made;
use crate::report::{Report, Shown};
use hysteron::{Origin, Quantity, Recording, Verdict, evaluate};

fn report<'a>(fixture: &'a Fixture, title: &'a str) -> Report<'a> {
    Report {
        title,
        shown: Shown::Evaluation {
            model: &fixture.model,
            recordings: fixture.recording.as_ref(),
            evaluation: &fixture.evaluation,
            verdict: Some(&fixture.verdict),
        },
        made: Made::default(),
    }
}

/// All figures, by their stems. Each must be well-formed, without NaN or infinite numbers.
fn figures(fixture: &Fixture) -> Vec<(&'static str, String)> {
    let report = report(fixture, "");
    let draw = |stem| Some((stem, report.svg(stem).unwrap()?));
    let drawn: Vec<_> = stems().into_iter().filter_map(draw).collect();
    for (stem, svg) in &drawn {
        let document = roxmltree::Document::parse(svg).unwrap();
        let root = document.root_element();
        assert!(root.has_tag_name("svg"), "{stem}");
        let number = |node: &roxmltree::Node<'_, '_>, name: &str| -> f64 {
            node.attribute(name)
                .map_or(0.0, |text| text.parse().unwrap())
        };
        let page = number(&root, "width");
        for rect in document
            .descendants()
            .filter(|node| node.has_tag_name("rect"))
        {
            let right = number(&rect, "x")
                + rect.attribute("width").map_or(0.0, |text| {
                    text.strip_suffix('%').map_or_else(
                        || text.parse().unwrap(),
                        |share| page * share.parse::<f64>().unwrap() / 100.0,
                    )
                });
            assert!(right <= page, "{stem}: a panel ends at {right} of {page}");
        }
        for node in document.descendants() {
            for attribute in node.attributes() {
                let value = attribute.value();
                assert!(
                    !value.contains("NaN") && !value.contains("inf"),
                    "{stem}: {value}"
                );
            }
        }
    }
    drawn
}

fn stems() -> Vec<&'static str> {
    report(&sma(10), "").stems().unwrap()
}

/// Figures of a model that depends on a load.
const OF_LOADS: [&str; 3] = ["load-shift", "load-measured", "fig02-load-loops"];

/// Figures of a model that tells how it was fitted.
const OF_FITS: [&str; 3] = ["excitation", "standard-errors", "cross-validation"];

/// The number of figures of any model.
fn plain() -> usize {
    stems().len() - OF_FITS.len() - OF_LOADS.len()
}

#[test]
fn a_model_that_says_more_has_more_figures() {
    let mut fixture = sma(600);
    let drawn = |fixture: &Fixture| -> Vec<&str> {
        let drawn = figures(fixture).into_iter();
        drawn.map(|(stem, _)| stem).collect()
    };
    let mut expected = stems();
    expected.retain(|stem| !OF_LOADS.contains(stem));
    let plain = expected.iter().filter(|stem| !OF_FITS.contains(stem));
    assert!(drawn(&fixture).iter().eq(plain));
    fixture.identify();
    assert_eq!(drawn(&fixture), expected);
    let load = (0..600).map(|n| 6.0 + 0.01 * f64::from(n % 5));
    fixture.recording.load = Some(load.collect());
    fixture.identify();
    let found = drawn(&fixture);
    assert!(found.contains(&"fig02-load-loops"));
    // A load that changes with every sample has no loops of its own.
    assert!(!found.contains(&"load-measured"));
    // There is an inverse under a load that changes, too.
    assert!(found.contains(&"fig13-input-time"));
}

/// A model with a shift on a recording at these loads, one after the other, of 200 samples each.
fn loaded(loads: &[f64]) -> Fixture {
    let mut fixture = sma(200 * loads.len());
    let weights = fixture.model.weights();
    let load = format!(
        r#", "load": {{"name": "stress", "unit": "MPa", "min": 0, "max": 200,
            "parts": [{{"offset": 0, "weights": {weights:?}}}],
            "curves": {{"loads": [0, 100, 200], "shifts": [0, 10, 30]}}}}}}"#
    );
    let text = fixture
        .model
        .to_json()
        .replace("\"version\":1,", "\"version\":2,");
    let text = text.trim_end().strip_suffix('}').unwrap().to_owned() + &load;
    fixture.model = hysteron::Model::from_json(&text).unwrap();
    let load = loads.iter().flat_map(|load| [*load; 200]).collect();
    fixture.recording.load = Some(load);
    fixture.evaluate();
    fixture
}

fn figure(fixture: &Fixture, stem: &str) -> Option<String> {
    report(fixture, "a wire").svg(stem).unwrap()
}

#[test]
fn a_figure_that_is_never_there_is_an_error_that_names_those_that_are() {
    let error = report(&sma(10), "").svg("fig99").unwrap_err().to_string();
    assert!(
        error.contains("fig99") && error.contains("fig11-loops"),
        "{error}"
    );
}

#[test]
fn a_shift_is_drawn_with_its_slope_in_the_units_of_the_field() {
    let fixture = loaded(&[50.0, 150.0]);
    let shift = figure(&fixture, "load-shift").unwrap();
    assert!(shift.contains("shift s [K]") && shift.contains("stress [MPa]"));
    let folder = tempfile::tempdir().unwrap();
    let written = report(&fixture, "a wire").write(folder.path()).unwrap();
    let page = std::fs::read_to_string(&written[0]).unwrap();
    // 30 K over 200 MPa; the pieces have 10 and 20 K over 100 MPa.
    assert!(
        page.contains("0.150 K/MPa on average, or 6.67 MPa/K"),
        "{page}"
    );
    assert!(page.contains("0.100 to 0.200 K/MPa"));
    assert_eq!(figure(&sma(200), "load-shift"), None);
}

#[test]
fn loops_of_each_load_are_drawn_where_it_rests() {
    let measured = |loads: &[f64]| figure(&loaded(loads), "load-measured");
    // Loads of the fit are 0, 100 and 200; measured ones waver.
    let two = measured(&[3.0, 196.0, 1.0]).unwrap();
    assert!(two.contains("measured 0") && two.contains("measured 200"));
    assert!(!two.contains("measured 100"), "it was never there");
    assert!(measured(&[100.0]).is_some());
    assert_eq!(measured(&[50.0, 150.0]), None, "the fit knows no such load");
    let mut moves = loaded(&[0.0]);
    moves.recording.load = Some((0..200).map(f64::from).collect());
    moves.evaluate();
    assert_eq!(figure(&moves, "load-measured"), None);
}

#[test]
fn a_report_has_every_figure_twice_and_one_page() {
    let fixture = sma(2000);
    let folder = tempfile::tempdir().unwrap();
    let written = report(&fixture, "a spring").write(folder.path()).unwrap();
    assert_eq!(written.len(), 1 + 2 * plain());
    for path in &written {
        assert!(
            std::fs::metadata(path).unwrap().len() > 1000,
            "{}",
            path.display()
        );
    }
    // Nothing else but the list of them, no leftovers of writing beside.
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        written.len() + 1
    );
    let page = std::fs::read_to_string(&written[0]).unwrap();
    assert_eq!(page, report(&fixture, "a spring").page().unwrap());
    assert_eq!(page.matches("<svg").count(), plain());
    for load in ["src=\"http", "href=\"http", "url(http", "@import", "<link"] {
        assert!(!page.contains(load), "{load}");
    }
    // The numbers of the figures, plotly.js and our script.
    assert_eq!(page.matches("<script").count(), 3);
    assert!(page.contains("content-security-policy"));
    // Ids of figures on one page must differ.
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
fn simulated_recordings_say_so_in_every_figure() {
    let mut fixture = sma(500);
    let says = |fixture: &Fixture| {
        let says = |(_, svg): &(&str, String)| svg.contains("simulated");
        figures(fixture).iter().map(says).collect::<Vec<_>>()
    };
    assert!(says(&fixture).iter().all(|said| !said));
    fixture.recording.origin = Origin::Simulated;
    assert!(says(&fixture).iter().all(|said| *said));
}

#[test]
fn names_are_escaped() {
    let mut fixture = sma(200);
    fixture.recording.output_quantity = Quantity::with_unit("<b>lift & \"drop\"</b>", "µm");
    fixture.recording.input_quantity = Quantity::named("T < 80 & > 20");
    assert_eq!(figures(&fixture).len(), plain());
    let folder = tempfile::tempdir().unwrap();
    report(&fixture, "<i>&").write(folder.path()).unwrap();
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(!page.contains("<b>lift") && !page.contains("<i>&"));
}

#[test]
fn poor_recordings_are_drawn_all_the_same() {
    let constant = vec![50.0; 10];
    let poor = [
        Recording::new(vec![50.0], vec![1.0]),
        Recording::new(vec![20.0, 80.0], vec![0.0, 14.0]),
        Recording::new(constant.clone(), constant.clone()),
        Recording::new(constant, (0..10).map(f64::from).collect()),
        Recording::new(vec![-1e9, 1e9, 0.0], vec![1e-12, -1e12, 0.0]),
    ];
    for recording in poor {
        let mut fixture = sma(10);
        fixture.recording = recording.unwrap();
        fixture.evaluate();
        assert!(figures(&fixture).len() >= 6);
    }
}

#[test]
fn without_an_inverse_its_figures_are_left_out_and_the_reason_given() {
    let mut fixture = sma(300);
    let folder = tempfile::tempdir().unwrap();
    report(&fixture, "").write(folder.path()).unwrap();
    fixture.evaluation.inverse = Err("3 weights are below zero".into());
    let written = report(&fixture, "").write(folder.path()).unwrap();
    assert_eq!(written.len(), 1 + 2 * 8);
    // Figures of the earlier report are gone; there is the list of files.
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        written.len() + 1
    );
    let page = std::fs::read_to_string(&written[0]).unwrap();
    assert!(page.contains("3 weights are below zero"));
}

#[test]
fn an_evaluation_of_another_recording_is_refused() {
    let mut fixture = sma(300);
    fixture.recording = sma(299).recording;
    let folder = tempfile::tempdir().unwrap();
    let error = report(&fixture, "").write(folder.path()).unwrap_err();
    assert!(error.to_string().contains("299 samples"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn the_page_says_how_it_was_made() {
    let mut fixture = sma(300);
    fixture.model.fit = None;
    let command = "hysteron evaluate 'my <model>.json' data.csv --report here";
    let made = Made {
        command: Some(command),
        date: Some("2026-11-23"),
    };
    let page = |made| {
        Report {
            made,
            ..report(&fixture, "")
        }
        .page()
        .unwrap()
    };
    let told = page(made);
    for part in [
        env!("CARGO_PKG_VERSION"),
        "2026-11-23",
        "my &lt;model&gt;.json",
    ] {
        assert!(told.contains(part), "{part}");
    }
    let silent = page(Made::default());
    assert!(silent.contains(env!("CARGO_PKG_VERSION")) && !silent.contains("<pre"));
}

#[test]
fn all_figures_of_a_page_have_one_scale() {
    let fixture = sma(300);
    let page = report(&fixture, "").page().unwrap();
    let figures = page.matches("<figure ").count();
    assert!(figures > 5);
    for svg in page.split("<figure ").skip(1) {
        let width = svg
            .split("--width:")
            .nth(1)
            .and_then(|rest| rest.split('"').next());
        let drawn = svg
            .split("viewBox=\"0 0 ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        assert_eq!(width, drawn);
    }
}

/// The sample of the verdict has a ring in the loop and over the time, and is named beside it; that
/// of a second recording too.
#[test]
fn the_worst_sample_has_a_ring() {
    let fixture = sma(400);
    let mut second = fixture.recording.clone();
    second.output[123] += 3.0;
    let recordings = [fixture.recording.clone(), second];
    let evaluation = evaluate(&fixture.model, &recordings).unwrap();
    let verdict = Verdict::of_evaluation(&fixture.model, &recordings, &evaluation).unwrap();
    let report = Report {
        title: "",
        shown: Shown::Evaluation {
            model: &fixture.model,
            recordings: &recordings,
            evaluation: &evaluation,
            verdict: Some(&verdict),
        },
        made: Made::default(),
    };
    for stem in [
        "fig10-output-time",
        "fig11-loops",
        "fig12-output-discrepancy",
    ] {
        let svg = report.svg(stem).unwrap().unwrap();
        assert!(svg.contains("worst: recording 2, sample 124"), "{stem}");
        // One in the legend, one in the panel.
        let ring = format!("stroke=\"{}\"", POINTED.colour);
        assert_eq!(svg.matches(&ring).count(), 2, "{stem}");
    }
    let page = report.page().unwrap();
    assert!(
        page.contains("<b>Displacement over temperature.</b>"),
        "a title alone"
    );
    assert!(page.contains("fig11-loops, beside Fig. 11 of the chapter."));
}

#[test]
fn a_line_breaks_where_a_recording_begins() {
    let fixture = sma(400);
    let pieces = |recordings: &[Recording]| {
        let report = Report {
            title: "",
            shown: Shown::Evaluation {
                model: &fixture.model,
                recordings,
                evaluation: &evaluate(&fixture.model, recordings).unwrap(),
                verdict: None,
            },
            made: Made::default(),
        };
        ["fig10-output-time", "fig11-loops"].map(|stem| {
            let svg = report.svg(stem).unwrap().unwrap();
            svg.matches(&format!("stroke=\"{}\"", MEASURED.colour))
                .count()
        })
    };
    let one = std::slice::from_ref(&fixture.recording);
    let [over_time, looped] = pieces(one);
    assert_eq!(pieces(&[one, one].concat()), [over_time + 1, looped + 1]);
}

//! Reports as a whole, of good recordings and of poor ones.
#![allow(clippy::unwrap_used)]

use crate::evaluation::fixture::{Fixture, sma};
use crate::evaluation::{Figure, Report};
use hysteron::{Origin, Quantity, Recording};

fn report<'a>(fixture: &'a Fixture, title: &'a str) -> Report<'a> {
    Report {
        title,
        model: &fixture.model,
        recording: &fixture.recording,
        evaluation: &fixture.evaluation,
    }
}

/// All figures. Each must be well-formed, without NaN or infinite numbers.
fn figures(fixture: &Fixture) -> Vec<(Figure, String)> {
    let draw = |figure| Some((figure, report(fixture, "").svg(figure).unwrap()?));
    let drawn: Vec<(Figure, String)> = Figure::ALL.into_iter().filter_map(draw).collect();
    for (figure, svg) in &drawn {
        let document = roxmltree::Document::parse(svg).unwrap();
        assert!(document.root_element().has_tag_name("svg"), "{figure}");
        for node in document.descendants() {
            for attribute in node.attributes() {
                let value = attribute.value();
                assert!(
                    !value.contains("NaN") && !value.contains("inf"),
                    "{figure}: {value}"
                );
            }
        }
    }
    drawn
}

/// Figures that need a model to say more than its weights.
const OF_FITS: [Figure; 4] = [
    Figure::LoadLoops,
    Figure::Excitation,
    Figure::StandardErrors,
    Figure::CrossValidation,
];

/// Figures of any model.
const PLAIN: usize = Figure::ALL.len() - OF_FITS.len();

#[test]
fn a_model_that_says_more_has_more_figures() {
    let mut fixture = sma(600);
    let drawn = |fixture: &Fixture| -> Vec<Figure> {
        figures(fixture)
            .into_iter()
            .map(|(figure, _)| figure)
            .collect()
    };
    assert!(
        OF_FITS
            .iter()
            .all(|figure| !drawn(&fixture).contains(figure))
    );
    fixture.identify();
    let expected = Figure::ALL.into_iter().filter(|f| *f != Figure::LoadLoops);
    assert_eq!(drawn(&fixture), expected.collect::<Vec<_>>());
    let load = (0..600).map(|n| 6.0 + 0.01 * f64::from(n % 5));
    fixture.recording.load = Some(load.collect());
    fixture.identify();
    let found = drawn(&fixture);
    assert!(OF_FITS.iter().all(|figure| found.contains(figure)));
    // There is an inverse under a load that changes, too.
    assert!(found.contains(&Figure::InputTime));
}

#[test]
fn a_report_has_every_figure_twice_and_one_page() {
    let fixture = sma(2000);
    let folder = tempfile::tempdir().unwrap();
    let written = report(&fixture, "a spring").write(folder.path()).unwrap();
    assert_eq!(written.len(), 1 + 2 * PLAIN);
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
    assert_eq!(page.matches("<svg").count(), PLAIN);
    for load in [
        "src=\"http",
        "href=\"http",
        "url(http",
        "@import",
        "<script",
        "<link",
    ] {
        assert!(!page.contains(load), "{load}");
    }
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
        let says = |(_, svg): &(Figure, String)| svg.contains("simulated");
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
    assert_eq!(figures(&fixture).len(), PLAIN);
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
    assert_eq!(written.len(), 1 + 2 * 6);
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

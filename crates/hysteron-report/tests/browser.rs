//! The page of a report in a real browser: figures that zoom together.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../../hysteron-studio/tests/common/chromium.rs"]
mod chromium;
#[allow(dead_code)]
#[path = "../../hysteron/tests/common/mod.rs"]
mod recordings;

use chromium::{Chromium, Tab, browser, keep};
use hysteron::{Fit, Quantity, Recording, evaluate};
use hysteron_report::{Made, Report, Shown};
use serde_json::json;
use std::path::Path;

/// The output of a play that is driven through loops of falling height, over time.
fn play(samples: usize) -> Recording {
    let time: Vec<f64> = (0..samples)
        .map(|k| 100.0 * k as f64 / samples as f64)
        .collect();
    let wave = |t: f64| 50.0 + 30.0 * (1.0 - t / 150.0) * (t / 3.0).sin();
    let input: Vec<f64> = time.iter().map(|t| wave(*t)).collect();
    let mut state = input[0];
    let output = input.iter().map(|x| {
        state = state.clamp(x - 6.0, x + 6.0);
        0.1 * state
    });
    let output = output.collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    recording.input_quantity =
        Quantity::with_unit("<img src=x onerror=hacked()> temperature", "degC");
    recording.output_quantity = Quantity::with_unit("displacement", "mm");
    recording
}

/// Writes the report of a play and opens it.
fn open(browser: &mut Chromium, samples: usize, folder: &Path, width: u32) -> Tab {
    let recording = play(samples);
    let fit = Fit::new().levels(12).smooth(0.0).bootstrap(0);
    let model = fit.run(&recording).unwrap();
    let report = Report {
        title: "a play",
        shown: Shown::Evaluation {
            model: &model,
            recordings: recording.as_ref(),
            evaluation: &evaluate(&model, &recording).unwrap(),
            verdict: None,
        },
        made: Made::default(),
    };
    let page = report.write(folder).unwrap().remove(0);
    let tab = browser.open(&format!("file://{}", page.display()), width, 900);
    browser.wait(&tab, "document.querySelector('#fig10-output-time .plot')");
    browser.wait(&tab, "globalThis.Plotly");
    tab
}

/// Brings a figure into view, until it is drawn.
fn show(browser: &mut Chromium, tab: &Tab, figure: &str) {
    let node = format!("document.querySelector('#{figure} .plot')");
    browser.value(tab, &format!("{node}.scrollIntoView({{block: 'center'}})"));
    let drawn =
        format!("{node}.querySelector('.scatterlayer path') && {node}.dataset.stale === 'false'");
    browser.wait(tab, &drawn);
}

/// The range of an axis of a figure, as it is shown.
fn range(browser: &mut Chromium, tab: &Tab, figure: &str, axis: &str) -> [f64; 2] {
    show(browser, tab, figure);
    let code = format!("document.querySelector('#{figure} .plot').layout.{axis}.range");
    serde_json::from_value(browser.value(tab, &code)).unwrap()
}

/// How many samples a line of a figure has.
fn samples(browser: &mut Chromium, tab: &Tab, figure: &str, line: usize) -> u64 {
    show(browser, tab, figure);
    let code = format!("document.querySelector('#{figure} .plot').data[{line}].x.length");
    browser.value(tab, &code).as_u64().unwrap()
}

const TIME: &str = "fig10-output-time";
const LOOPS: &str = "fig11-loops";
const RESIDUALS: &str = "fig12-output-discrepancy";

#[test]
fn figures_zoom_together() {
    let Some(mut browser) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let tab = open(&mut browser, 3000, folder.path(), 1360);
    show(&mut browser, &tab, TIME);
    keep(&mut browser, &tab, "report-light");
    let [whole, loops] = [(TIME, "xaxis"), (LOOPS, "yaxis")]
        .map(|(figure, axis)| range(&mut browser, &tab, figure, axis));
    assert_eq!(samples(&mut browser, &tab, LOOPS, 0), 3000);

    // A drag along the time.
    show(&mut browser, &tab, TIME);
    let along = browser.points(
        &tab,
        &format!("#{TIME} .nsewdrag"),
        &[(0.25, 0.5), (0.4, 0.5), (0.5, 0.5)],
    );
    browser.drag(&tab, &along);
    browser.wait(
        &tab,
        "document.querySelector('.tools .all').ariaDisabled === 'false'",
    );
    let part = range(&mut browser, &tab, TIME, "xaxis");
    let share = |at: f64| whole[0] + at * (whole[1] - whole[0]);
    // A pixel of some 1,000.
    for (end, at) in part.iter().zip([0.25, 0.5]) {
        assert!((end - share(at)).abs() < 0.005 * share(1.0), "{part:?}");
    }
    assert_eq!(range(&mut browser, &tab, RESIDUALS, "xaxis"), part);
    // The loops keep the samples of that part of the time: a quarter, and one beside at each end.
    let shown = samples(&mut browser, &tab, LOOPS, 0);
    assert!((735..770).contains(&shown), "{shown}");
    assert_eq!(range(&mut browser, &tab, LOOPS, "yaxis"), loops);

    // A sample that is pointed at is marked where it is, also in a loop that shows a part.
    show(&mut browser, &tab, TIME);
    let inside = format!("#{TIME} .nsewdrag");
    let mark = |figure: &str| {
        format!(
            "document.querySelector('#{figure} .plot').layout.shapes
                .find(({{type}}) => type === 'circle')"
        )
    };
    // A hand never rests: plotly leaves out moves that come too soon after others. Figures above may
    // still grow.
    let both = format!("Boolean({} && {})", mark(TIME), mark(LOOPS));
    let marked = (0..200).any(|n| {
        let at = browser.points(&tab, &inside, &[(0.3, 0.5)])[0];
        browser.point(&tab, (at.0 + f64::from(n % 2), at.1));
        std::thread::sleep(std::time::Duration::from_millis(100));
        browser.value(&tab, &both) == true
    });
    assert!(marked, "{:?}", browser.errors);
    let mut place = |figure: &str| -> [f64; 2] {
        let code = format!("[{0}.xanchor, {0}.yanchor]", mark(figure));
        serde_json::from_value(browser.value(&tab, &code)).unwrap()
    };
    let recording = play(3000);
    // Figures are marked one after the other. The page has seven digits of a range.
    let mut found = Vec::new();
    let agree = (0..100).any(|_| {
        let ([time, output], looped) = (place(TIME), place(LOOPS));
        let sample = (time * 30.0).round() as usize;
        let (x, y) = (recording.input[sample], recording.output[sample]);
        found = vec![(output, y), (looped[0], x), (looped[1], y)];
        std::thread::sleep(std::time::Duration::from_millis(50));
        found
            .iter()
            .all(|(found, value)| (found - value).abs() < 1e-5)
    });
    assert!(agree, "{found:?}");

    // A part of the output, from the loops.
    let up = browser.points(
        &tab,
        &format!("#{LOOPS} .nsewdrag"),
        &[(0.3, 0.2), (0.5, 0.4), (0.6, 0.7)],
    );
    browser.drag(&tab, &up);
    browser.wait(
        &tab,
        &format!(
            "document.querySelector('#{LOOPS} .plot').layout.yaxis.range[0] > {}",
            loops[0]
        ),
    );
    let heights = range(&mut browser, &tab, LOOPS, "yaxis");
    assert_eq!(range(&mut browser, &tab, TIME, "yaxis"), heights);

    // All again, by a key; then a part of the time by buttons.
    browser.value(
        &tab,
        "dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}))",
    );
    assert_eq!(range(&mut browser, &tab, TIME, "xaxis"), whole);
    assert_eq!(range(&mut browser, &tab, LOOPS, "yaxis"), loops);
    assert_eq!(samples(&mut browser, &tab, LOOPS, 0), 3000);
    browser.value(
        &tab,
        "document.querySelector('.tools [title=\"Zoom in\"]').click()",
    );
    let [low, high] = range(&mut browser, &tab, TIME, "xaxis");
    assert!(((high - low) / (whole[1] - whole[0]) - 0.5).abs() < 1e-9);
    browser.value(
        &tab,
        "document.querySelector('.tools [title=\"Show all\"]').click()",
    );
    assert_eq!(range(&mut browser, &tab, TIME, "xaxis"), whole);

    // Names from files are text, and nothing was asked of anywhere.
    assert_eq!(
        browser.value(&tab, "document.querySelectorAll('img').length"),
        json!(0)
    );
    assert!(browser.errors.is_empty(), "{:?}", browser.errors);
}

#[test]
fn paper_has_the_pictures_and_a_phone_the_whole_width() {
    let Some(mut browser) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let tab = open(&mut browser, 500, folder.path(), 390);
    show(&mut browser, &tab, TIME);
    keep(&mut browser, &tab, "report-phone");
    let fits = "document.documentElement.scrollWidth <= innerWidth && [...document.querySelectorAll('.plot')].every(({clientWidth}) => clientWidth <= innerWidth)";
    assert_eq!(browser.value(&tab, fits), json!(true));
    let seen = |what: &str| {
        format!("getComputedStyle(document.querySelector('#{TIME} {what}')).display !== 'none'")
    };
    let both = format!("[{}, {}]", seen(".wide > svg"), seen(".plot"));
    assert_eq!(browser.value(&tab, &both), json!([false, true]));
    browser.media(&tab, "print");
    assert_eq!(browser.value(&tab, &both), json!([true, false]));
    assert!(browser.errors.is_empty(), "{:?}", browser.errors);
}

#[test]
fn titles_stay_and_a_page_in_the_dark_is_dark() {
    let Some(mut browser) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let tab = open(&mut browser, 500, folder.path(), 1280);
    for figure in [TIME, LOOPS, RESIDUALS, "residuals-input"] {
        // A long one is cut short above the figure.
        show(&mut browser, &tab, figure);
        let title = format!(
            "(() => {{ const figure = document.querySelector('#{figure}');
             const title = figure.querySelector('figcaption b').textContent.replace(/^Figure \\d+\\. |\\.$/g, '');
             return [...figure.querySelectorAll('.plot .annotation-text')].some((words) => words.textContent.startsWith(title.slice(0, 24))); }})()"
        );
        assert_eq!(browser.value(&tab, &title), json!(true), "{figure}");
    }
    // What is over time has the width of the page.
    let width = format!("document.querySelector('#{TIME} .plot').clientWidth > 1150");
    assert_eq!(browser.value(&tab, &width), json!(true));
    let ground = "getComputedStyle(document.body).backgroundColor";
    assert_eq!(browser.value(&tab, ground), json!("rgb(255, 255, 255)"));
    browser.scheme(&tab, "dark");
    assert_ne!(browser.value(&tab, ground), json!("rgb(255, 255, 255)"));
    // Paper is white.
    browser.media(&tab, "print");
    assert_eq!(browser.value(&tab, ground), json!("rgb(255, 255, 255)"));
    assert!(browser.errors.is_empty(), "{:?}", browser.errors);
}

#[test]
fn a_long_recording_keeps_its_peaks_and_its_page_small() {
    let Some(mut browser) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let tab = open(&mut browser, 200_000, folder.path(), 1000);
    let shown = samples(&mut browser, &tab, TIME, 0);
    // As many as a page holds of a line, and its ends.
    assert!((5_000..=20_002).contains(&shown), "{shown}");
    let size = std::fs::metadata(folder.path().join("index.html"))
        .unwrap()
        .len();
    // plotly.js takes 1.9 MB; the numbers and the figures on paper the rest.
    assert!(size < 8_000_000, "{size}");
    assert!(browser.errors.is_empty(), "{:?}", browser.errors);
}

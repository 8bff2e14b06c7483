//! The sample pointed at, on the page in a real browser.
#![cfg(feature = "server")]

use crate::browser::{play, show_play};
use crate::chromium::{Chromium, Tab};
use crate::place::Way;

fn fit(browser: &mut Chromium, tab: &Tab, thermal: &str, hold_out: &str) {
    let options = [
        ("levels", "8"),
        ("bootstrap", "0"),
        ("thermal", thermal),
        ("hold_out", hold_out),
    ];
    for (name, value) in options {
        let code = format!("document.querySelector('[name={name}]').value = '{value}'");
        browser.value(tab, &code);
    }
    browser.value(tab, "document.querySelector('#begin').click()");
    browser.wait(tab, "document.querySelector('#fits .card')");
    browser.wait(tab, "document.body.dataset.shown === '1'");
}

const POINT: &str = "{ const at = document.querySelector('#play-at'); at.value = at.max / 2;
     at.dispatchEvent(new Event('input')); }";

/// A fit that cannot be run on the file that is shown is left out, in words and without an error.
#[test]
fn a_fit_that_is_left_out_is_no_error_of_the_page() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 900)) else {
        return;
    };
    show_play(&mut browser, &tab);
    fit(&mut browser, &tab, "first-order", "nothing");
    let staircase =
        "document.querySelector('#plane-text').textContent.includes('staircase at sample')";
    browser.value(&tab, POINT);
    browser.wait(&tab, staircase);
    let mut text = "temperature [degC],displacement [mm]\n".to_owned();
    for line in play().lines().skip(1) {
        let columns: Vec<&str> = line.split(',').collect();
        text += &format!("{},{}\n", columns[1], columns[2]);
    }
    browser.drop_file(&tab, "no time.csv", &text);
    browser.wait(
        &tab,
        "document.querySelectorAll('#files article').length === 2",
    );
    browser.value(
        &tab,
        "[...document.querySelectorAll('#files h3 button')].at(-1).click()",
    );
    browser.wait(&tab, "!document.querySelector('#look-left-out').hidden");
    browser.value(&tab, POINT);
    let told = "document.querySelector('#plane-text').textContent.includes('cannot be run')";
    browser.wait(&tab, told);
    browser.value(&tab, "document.querySelector('[data-key=zoom-in]').click()");
    // The bar has the new part of the time once all pictures have it; the plane is asked for then.
    browser.wait(
        &tab,
        "Number(document.querySelector('#play-at').max) < 1400",
    );
    std::thread::sleep(std::time::Duration::from_millis(500));
    // The file whose sample was pointed at is closed.
    browser.value(
        &tab,
        "[...document.querySelectorAll('#files [title=Close]')].at(-1).click()",
    );
    browser.wait(
        &tab,
        "document.querySelectorAll('#files article').length === 1",
    );
    browser.value(&tab, POINT);
    browser.wait(&tab, staircase);
    assert!(browser.errors.is_empty(), "{:#?}", browser.errors);
    studio.end();
}

/// On a phone the list of fits hides the pictures: they come into view, and the keys with them.
#[test]
fn the_worst_sample_comes_into_view() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (390, 844)) else {
        return;
    };
    show_play(&mut browser, &tab);
    fit(&mut browser, &tab, "", "usual");
    let begin = "{ scrollTo(0, 0); document.querySelector('[data-key^=worst]').focus({preventScroll: true}); }";
    browser.value(&tab, begin);
    let top = "document.querySelector('#plot-loop').getBoundingClientRect().top";
    assert!(browser.value(&tab, top).as_f64().unwrap() > 844.0);
    browser.value(&tab, "document.querySelector('[data-key^=worst]').click()");
    browser.wait(&tab, &format!("{top} > 0 && {top} < 500"));
    browser.wait(&tab, "document.activeElement.id === 'play-at'");
    // Where the pictures are beside the list, the keys stay in it.
    browser.size(&tab, 1280, 900);
    browser.wait(
        &tab,
        "document.querySelector('#plot-loop').clientWidth > 390",
    );
    browser.value(&tab, begin);
    // The middle of 149.9 s, which is told a moment after it is pointed at.
    let middle = "/at 7[45]/.test(document.querySelector('#play-sample').textContent)";
    browser.value(&tab, POINT);
    browser.wait(&tab, middle);
    browser.value(&tab, "document.querySelector('[data-key^=worst]').click()");
    browser.wait(&tab, &format!("!{middle}"));
    std::thread::sleep(std::time::Duration::from_millis(500));
    let key = "document.activeElement.dataset.key";
    assert!(
        browser
            .value(&tab, key)
            .as_str()
            .unwrap()
            .starts_with("worst")
    );
    studio.end();
}

/// A sample off the scale is marked at the edge, until all samples are shown.
#[test]
fn a_sample_off_the_scale_has_its_mark() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 900)) else {
        return;
    };
    browser.drop_file(
        &tab,
        "play.csv",
        &play().replace("\n70,", "\n70,1e3,1e3,1\n70.05,"),
    );
    browser.wait(&tab, "document.querySelector('[data-key=everything]')");
    let point = POINT.replace("at.max / 2", "70");
    browser.value(&tab, &point);
    let place = "(() => { const [mark] = document.querySelector('#plot-loop').layout.shapes.filter(({ name }) => name === 'now');
         const { xaxis, yaxis } = document.querySelector('#plot-loop').layout;
         return mark && [xaxis.range[1] - mark.xanchor, yaxis.range[1] - mark.yanchor, mark.xanchor, mark.yanchor]; })()";
    browser.wait(&tab, place);
    let at = |browser: &mut Chromium| browser.value(&tab, place);
    assert_eq!(at(&mut browser).as_array().unwrap()[..2], [0.0, 0.0]);
    browser.value(
        &tab,
        "document.querySelector('[data-key=everything]').click()",
    );
    browser.wait(&tab, &format!("{place}[2] === 1000 && {place}[3] === 1000"));
    studio.end();
}

/// Legends take more rows on a narrow page, and never lie over the curves.
#[test]
fn legends_stay_above_the_curves_in_every_width() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 900)) else {
        return;
    };
    show_play(&mut browser, &tab);
    browser.value(
        &tab,
        "document.querySelector('[name=bootstrap]').value = '20'",
    );
    browser.value(&tab, "document.querySelector('[name=levels]').value = '8'");
    browser.value(&tab, "document.querySelector('#begin').click()");
    browser.wait(&tab, "document.body.dataset.shown === '1'");
    let over = "[...document.querySelectorAll('.js-plotly-plot')].filter((node) => {
         const [legend, area] = ['.legend .bg', '.nsewdrag'].map((part) => node.querySelector(part)?.getBoundingClientRect());
         return legend && area && legend.bottom > area.top + 1; }).map(({ id }) => id)";
    for width in [1280, 390, 1280, 760, 1600] {
        browser.size(&tab, width, 900);
        let follows = "[...document.querySelectorAll('#look figure:not([hidden]) .js-plotly-plot')]
            .every((node) => Math.abs(node.clientWidth - node._fullLayout.width) <= 1)";
        browser.wait(&tab, follows);
        std::thread::sleep(std::time::Duration::from_millis(300));
        assert_eq!(browser.value(&tab, over), serde_json::json!([]), "{width}");
    }
    studio.end();
}

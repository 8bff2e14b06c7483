//! The page in a real browser: from a file that is dropped to a model that is taken home.
#![allow(clippy::unwrap_used, clippy::panic)]
#![cfg(feature = "server")]

#[path = "common/chromium.rs"]
mod chromium;
mod common;
#[path = "../../hysteron/tests/common/mod.rs"]
mod recordings;

use chromium::{browser, keep};
use common::Studio;

fn whole_way(name: &str, text: &str, pictures: &str) {
    let Some(mut browser) = browser() else { return };
    let studio = Studio::start(1 << 28, &[]);
    let tab = browser.open(&studio.address, 1280, 900);
    browser.wait(&tab, "document.querySelector('#drop.empty')");
    if !pictures.is_empty() {
        keep(&mut browser, &tab, "empty-light");
    }
    browser.drop_file(&tab, name, text);
    browser.wait(
        &tab,
        "document.querySelectorAll('.column.used').length >= 2",
    );
    browser.wait(
        &tab,
        "document.querySelectorAll('#plot-loop .scatterlayer path').length > 0",
    );

    // Fit, with few levels, so that the test is short.
    browser.value(&tab, "document.querySelector('[name=levels]').value = '12'");
    browser.value(
        &tab,
        "document.querySelector('[name=bootstrap]').value = '20'",
    );
    browser.value(&tab, "document.querySelector('#begin').click()");
    browser.wait(&tab, "document.querySelector('#fits .badge')");
    browser.wait(
        &tab,
        "document.querySelectorAll('#plot-plane .heatmaplayer image').length > 0",
    );
    browser.wait(&tab, "document.querySelector('#plot-drive .scatterlayer')");

    // A zoom over time is followed by the loop.
    let points = "document.querySelector('#plot-loop').data[0].x.length";
    let before = browser.value(&tab, points).as_f64().unwrap();
    browser.value(&tab, "document.querySelector('[data-key=zoom-in]').click()");
    browser.value(&tab, "document.querySelector('[data-key=zoom-in]').click()");
    let samples = "document.querySelector('#plot-loop').layout.meta.samples";
    browser.wait(&tab, &format!("{points} !== {before} || {samples} < 400"));
    browser.value(&tab, "document.querySelector('[data-key=all]').click()");

    // Drive: the input to its middle, then the output a tenth of its way back.
    let slide = |id: &str, share: f64| {
        format!(
            "(() => {{ const s = document.querySelector('#{id}');
             s.value = Number(s.min) + {share} * (Number(s.max) - Number(s.min));
             s.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
        )
    };
    browser.value(&tab, &slide("drive-input", 0.8));
    browser.wait(
        &tab,
        "document.querySelector('#drive-status').textContent.includes('Dead band')",
    );
    browser.value(&tab, &slide("drive-output", 0.5));
    browser.wait(
        &tab,
        "document.querySelector('#drive-status').textContent.includes('reached')",
    );

    // Take home: the model is one that the library reads.
    let model = browser.value(
        &tab,
        "import('./api.js').then(async ({ ask, take }) => {
            const { response, ...seen } = await ask('overview');
            return (await take({ what: 'model', fit: seen.best })).text();
        })",
    );
    let model = hysteron::Model::from_json(model.as_str().unwrap()).unwrap();
    assert_eq!(model.plane().levels(), 12);
    browser.wait(
        &tab,
        "document.querySelector('#home pre').textContent.includes('--levels 12')",
    );

    // No view is wider than the page, and nothing was thrown.
    for width in [1280, 390] {
        browser.size(&tab, width, 900);
        let wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth";
        browser.wait(&tab, &format!("{wide} <= 0"));
    }
    assert!(browser.errors.is_empty(), "{:#?}", browser.errors);

    if !pictures.is_empty() {
        for (theme, width) in [
            ("light", 1280),
            ("dark", 1280),
            ("light", 390),
            ("dark", 390),
        ] {
            browser.size(&tab, width, 900);
            browser.value(&tab, &format!("document.documentElement.dataset.theme === '{theme}' || (document.documentElement.dataset.theme = '{theme}' === 'dark' ? 'light' : 'dark', document.querySelector('#theme').click())"));
            std::thread::sleep(std::time::Duration::from_millis(1500));
            keep(&mut browser, &tab, &format!("{pictures}-{theme}-{width}"));
        }
    }
    studio.end();
}

#[test]
fn a_measured_recording_goes_the_whole_way() {
    let [Some(path)] = recordings::shared(["sma_basaeri_train.csv"]) else {
        return;
    };
    let text = std::fs::read_to_string(path).unwrap();
    whole_way("sma_basaeri_train.csv", &text, "basaeri");
}

#[test]
fn a_recording_with_time_goes_the_whole_way() {
    // Loops of a play in a recording as the demo writes it.
    let mut text = "time [s],temperature [degC],displacement [mm],simulated\n".to_owned();
    let mut y = 20.0_f64;
    for n in 0..1500 {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.02).cos() * (1.0 - f64::from(n) / 2500.0);
        y = y.clamp(t - 4.0, t + 4.0);
        text += &format!("{},{t},{},1\n", f64::from(n) * 0.1, 0.2 * y);
    }
    whole_way("play.csv", &text, "play");
}

#[test]
fn names_from_files_are_text_only() {
    let Some(mut browser) = browser() else { return };
    let studio = Studio::start(1 << 24, &[]);
    let tab = browser.open(&studio.address, 800, 600);
    browser.wait(&tab, "document.querySelector('#drop.empty')");
    let evil = "<img src=x onerror=window.hit=1>";
    let text = format!("{evil},<b>b</b> [<i onmouseover=window.hit=1>]\n1,2\n2,3\n3,4\n2,2\n1,1\n");
    browser.drop_file(&tab, &format!("{evil}.csv"), &text);
    browser.wait(&tab, "document.querySelectorAll('.column').length === 2");
    browser.wait(
        &tab,
        "document.querySelectorAll('#plot-loop .scatterlayer path').length > 0",
    );
    let shown = browser.value(&tab, "document.querySelector('.column strong').textContent");
    assert_eq!(shown, evil);
    let found = "document.querySelectorAll('main img, main b, main i, main [onmouseover], main [onerror]').length + (window.hit ?? 0)";
    assert_eq!(browser.value(&tab, found), 0.0);
    studio.end();
}

#[test]
fn two_pages_show_the_same_and_a_fit_is_cancelled() {
    let Some(mut browser) = browser() else { return };
    let studio = Studio::start(1 << 26, &[]);
    let one = browser.open(&studio.address, 900, 700);
    let two = browser.open(&studio.address, 900, 700);
    for tab in [&one, &two] {
        browser.wait(tab, "document.querySelector('#drop.empty')");
    }
    let mut text = "u,y\n".to_owned();
    for n in 0..4000 {
        let u = (f64::from(n) * 0.01).sin() * (1.0 + 0.3 * (f64::from(n) * 0.0037).cos());
        text += &format!("{u},{}\n", u.powi(3));
    }
    browser.drop_file(&one, "wave.csv", &text);
    browser.wait(
        &two,
        "document.querySelector('#files h3')?.textContent === 'wave.csv'",
    );
    browser.value(&one, "document.querySelector('[name=levels]').value = '60'");
    browser.value(&one, "document.querySelector('#begin').click()");
    browser.wait(&two, "document.querySelector('#jobs button')");
    browser.value(&two, "document.querySelector('#jobs button').click()");
    for tab in [&one, &two] {
        browser.wait(tab, "!document.querySelector('#jobs button')");
        assert_eq!(
            browser.value(tab, "document.querySelectorAll('#fits tr').length"),
            0
        );
    }
    // A broken file is refused with words, and the page goes on.
    browser.drop_file(&one, "broken.parquet", "PAR1 is not enough");
    browser.wait(
        &one,
        "document.querySelector('#fault').textContent.includes('broken.parquet')",
    );
    assert_eq!(
        browser.value(&one, "document.querySelectorAll('#files article').length"),
        1
    );
    studio.end();
    // The server is gone: the page says so.
    browser.value(&one, "document.querySelector('[data-key^=mend]').click()");
    browser.wait(
        &one,
        "document.querySelector('#fault').textContent.includes('does not answer')",
    );
}

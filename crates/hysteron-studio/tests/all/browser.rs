//! The page in a real browser: from a file that is dropped to a model that is taken home.
#![cfg(feature = "server")]

use crate::recordings;

use crate::chromium::{Chromium, Tab, browser, keep};
use crate::common::Studio;
use crate::place::{EMPTY, Way, both_ways};

both_ways! {
    a_measured_recording_goes_the_whole_way,
    a_recording_with_time_goes_the_whole_way,
    names_from_files_are_text_only,
    a_fit_is_cancelled_and_the_page_goes_on,
    a_session_that_was_taken_home_goes_on,
    matlab_files_are_read,
    a_call_that_fails_leaves_the_session_as_it_was,
}

fn whole_way(way: Way, name: &str, text: &str, pictures: &str) {
    let Some((mut browser, studio, tab)) = way.open(1 << 28, (1280, 900)) else {
        return;
    };
    // The page says which it is.
    let says = browser.value(&tab, "document.querySelector('#where').textContent");
    let (says, expected) = (says.as_str().unwrap(), way.says());
    assert!(says.starts_with(expected), "{says}");
    let pictures = &format!("{}-{pictures}", way.name());
    keep(&mut browser, &tab, &format!("{}-empty-light", way.name()));
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
    browser.wait(&tab, "document.querySelector('#fits .card')");
    browser.wait(
        &tab,
        "document.querySelectorAll('#plot-plane .heatmaplayer image').length > 0",
    );

    // A zoom over time is followed by the loop.
    let points = "document.querySelector('#plot-loop').data[0].x.length";
    let before = browser.value(&tab, points).as_f64().unwrap();
    browser.value(&tab, "document.querySelector('[data-key=zoom-in]').click()");
    browser.value(&tab, "document.querySelector('[data-key=zoom-in]').click()");
    let samples = "document.querySelector('#plot-loop').layout.meta.samples";
    browser.wait(&tab, &format!("{points} !== {before} || {samples} < 400"));
    browser.value(&tab, "document.querySelector('[data-key=all]').click()");

    // Drive: the input to its middle, then the output a tenth of its way back.
    open_task(&mut browser, &tab, "drive");
    browser.wait(&tab, "document.querySelector('#plot-drive .scatterlayer')");
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

    if std::env::var_os("HYSTERON_PICTURES").is_some() {
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

fn a_measured_recording_goes_the_whole_way(way: Way) {
    let [Some(path)] = recordings::shared(["sma_basaeri_train.csv"]) else {
        return;
    };
    let text = std::fs::read_to_string(path).unwrap();
    whole_way(way, "sma_basaeri_train.csv", &text, "basaeri");
}

fn a_recording_with_time_goes_the_whole_way(way: Way) {
    whole_way(way, "play.csv", &play(), "play");
}

/// Drops [`play`] onto the page, and waits for its picture.
pub fn show_play(browser: &mut Chromium, tab: &Tab) {
    browser.drop_file(tab, "play.csv", &play());
    browser.wait(
        tab,
        "document.querySelector('#plot-loop .scatterlayer path')",
    );
}

/// Loops of a play in a recording as the demo writes it.
pub fn play() -> String {
    let mut text = "time [s],temperature [degC],displacement [mm],simulated\n".to_owned();
    let mut y = 20.0_f64;
    for n in 0..1500 {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.02).cos() * (1.0 - f64::from(n) / 2500.0);
        y = y.clamp(t - 4.0, t + 4.0);
        text += &format!("{},{t},{},1\n", f64::from(n) * 0.1, 0.2 * y);
    }
    text
}

fn names_from_files_are_text_only(way: Way) {
    let Some((mut browser, studio, tab)) = way.open(1 << 24, (800, 600)) else {
        return;
    };
    let evil = "<img src=x onerror=window.hit=1>";
    // A name with `error` in it is none of an input.
    let input = "temperature <img src=x>";
    let text = format!(
        "{input},displacement <b>b</b> [<i onmouseover=window.hit=1>]\n1,2\n2,3\n3,4\n2,2\n1,1\n"
    );
    browser.drop_file(&tab, &format!("{evil}.csv"), &text);
    browser.wait(&tab, "document.querySelectorAll('.column').length === 2");
    browser.wait(
        &tab,
        "document.querySelectorAll('#plot-loop .scatterlayer path').length > 0",
    );
    let shown = browser.value(&tab, "document.querySelector('.column strong').textContent");
    assert_eq!(shown, input);
    let found = "document.querySelectorAll('main img, main b, main i, main [onmouseover], main [onerror]').length + (window.hit ?? 0)";
    assert_eq!(browser.value(&tab, found), 0.0);
    studio.end();
}

/// A recording whose fit with many levels takes longer than a busy browser.
fn wave() -> String {
    let mut text = "u,y\n".to_owned();
    for n in 0..4000 {
        let u = (f64::from(n) * 0.01).sin() * (1.0 + 0.3 * (f64::from(n) * 0.0037).cos());
        text += &format!("{u},{}\n", u.powi(3));
    }
    text
}

fn a_fit_is_cancelled_and_the_page_goes_on(way: Way) {
    let Some((mut browser, studio, tab)) = way.open(1 << 26, (900, 700)) else {
        return;
    };
    browser.drop_file(&tab, "wave.csv", &wave());
    browser.wait(
        &tab,
        "document.querySelector('#plot-loop .scatterlayer path')",
    );
    // Two fits: one runs, the other waits. With so many replicates neither ends before it is
    // cancelled, however slow the browser is.
    browser.value(&tab, "document.querySelector('[name=levels]').value = '50'");
    browser.value(
        &tab,
        "document.querySelector('[name=bootstrap]').value = '10000'",
    );
    browser.value(&tab, "document.querySelector('#begin').click()");
    browser.value(&tab, "document.querySelector('#begin').click()");
    browser.wait(
        &tab,
        "document.querySelectorAll('#jobs button').length === 2",
    );
    browser.wait(
        &tab,
        // Either may be the first to be worked on.
        "[...document.querySelectorAll('#jobs strong')].some((job) => job.textContent.includes(':'))",
    );
    // The session answers meanwhile.
    let samples = "document.querySelector('#plot-loop').layout.meta.samples";
    browser.wait(&tab, &format!("{samples} === 4000"));
    browser.value(&tab, "document.querySelector('[data-key=zoom-in]').click()");
    browser.wait(&tab, &format!("{samples} < 4000"));
    assert_eq!(
        browser.value(&tab, "document.querySelectorAll('#jobs button').length"),
        2
    );
    for left in [1, 0] {
        let buttons = "[...document.querySelectorAll('#jobs button')]";
        browser.value(&tab, &format!("{buttons}.at(0).click()"));
        browser.wait(&tab, &format!("{buttons}.length === {left}"));
    }
    assert_eq!(
        browser.value(&tab, "document.querySelectorAll('#fits article').length"),
        0
    );
    assert_eq!(
        browser.value(&tab, "document.querySelector('#fault').hidden"),
        true
    );
    // A broken file is refused with words, and the page goes on.
    browser.drop_file(&tab, "broken.parquet", "PAR1 is not enough");
    browser.wait(
        &tab,
        "document.querySelector('#fault').textContent.includes('broken.parquet')",
    );
    assert_eq!(
        browser.value(&tab, "document.querySelectorAll('#files article').length"),
        1
    );
    fit(&mut browser, &tab);
    studio.end();
}

/// Opens a task beside the pictures.
pub fn open_task(browser: &mut Chromium, tab: &Tab, name: &str) {
    let button = format!("document.querySelector('[data-task={name}]')");
    browser.value(tab, &format!("{button}.click()"));
    browser.wait(
        tab,
        &format!("{button}.ariaExpanded === 'true' && !document.querySelector('#task').hidden"),
    );
}

fn fit(browser: &mut Chromium, tab: &Tab) {
    browser.value(tab, "document.querySelector('[name=levels]').value = '12'");
    browser.value(
        tab,
        "document.querySelector('[name=bootstrap]').value = '20'",
    );
    browser.value(tab, "document.querySelector('#begin').click()");
    browser.wait(tab, "document.querySelector('#fits .card')");
}

/// All that the session says of itself.
/// All that is open. Its memory is left out: what an answer just took may still be held.
const OVERVIEW: &str = "import('./api.js').then(({ ask }) => ask('overview')) \
     .then(({ memory, ...all }) => JSON.stringify(all))";

fn a_session_that_was_taken_home_goes_on(way: Way) {
    let Some((mut browser, studio, tab)) = way.open(1 << 26, (900, 700)) else {
        return;
    };
    show_play(&mut browser, &tab);
    fit(&mut browser, &tab);
    let seen = browser.value(&tab, OVERVIEW);
    let taken =
        "import('./api.js').then(({ take }) => take({ what: 'session' })).then((t) => t.text())";
    let taken = browser.value(&tab, taken);
    studio.end();

    // Another studio, which knows nothing of the first.
    let Some(studio) = way.start(1 << 26) else {
        return;
    };
    let tab = browser.open(&studio.address, 900, 700);
    browser.wait(&tab, EMPTY);
    browser.drop_file(&tab, "mine.session.json", taken.as_str().unwrap());
    browser.wait(&tab, "document.querySelector('#fits .card')");
    assert_eq!(browser.value(&tab, OVERVIEW), seen);
    studio.end();
}

fn matlab_files_are_read(way: Way) {
    let Some((mut browser, studio, tab)) = way.open(1 << 26, (900, 700)) else {
        return;
    };
    let (mut input, mut output) = (Vec::new(), Vec::new());
    for n in 0..300 {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.1).cos();
        input.push(t);
        output.push(0.1 * t + (t * 0.3).sin());
    }
    browser.drop_bytes(
        &tab,
        "run.mat",
        &matlab(&[("temperature", &input), ("lift", &output)]),
    );
    browser.wait(
        &tab,
        "document.querySelector('#plot-loop .scatterlayer path')",
    );
    let names = "[...document.querySelectorAll('.column.used strong')].map(e => e.textContent)";
    assert_eq!(
        browser.value(&tab, names),
        serde_json::json!(["temperature", "lift"])
    );
    let samples = browser.value(
        &tab,
        "document.querySelector('#plot-loop').layout.meta.samples",
    );
    assert_eq!(samples, 300);
    studio.end();
}

/// A MATLAB file of version 5 with vectors, as `save -v6` writes it.
fn matlab(vectors: &[(&str, &[f64])]) -> Vec<u8> {
    let element = |kind: u32, data: &[u8]| {
        let mut bytes = [
            kind.to_le_bytes(),
            u32::try_from(data.len()).unwrap().to_le_bytes(),
        ]
        .concat();
        bytes.extend_from_slice(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let mut file = format!("{:124}", "MATLAB 5.0 MAT-file").into_bytes();
    file.extend([0, 1, b'I', b'M']);
    for (name, vector) in vectors {
        let words = |all: [u32; 2]| all.map(u32::to_le_bytes).concat();
        // mxDOUBLE_CLASS is 6. Types are 6 for uint32, 5 for int32, 1 for int8, 9 for double.
        let size = [u32::try_from(vector.len()).unwrap(), 1];
        let numbers: Vec<u8> = vector.iter().flat_map(|x| x.to_le_bytes()).collect();
        let parts = [
            element(6, &words([6, 0])),
            element(5, &words(size)),
            element(1, name.as_bytes()),
            element(9, &numbers),
        ];
        file.extend(element(14, &parts.concat()));
    }
    file
}

/// A session file that is opened in both gives the same files to take home.
#[test]
fn both_ways_give_the_same_to_take_home() {
    let Some(mut browser) = browser() else { return };
    let mut kept = String::new();
    let mut found = Vec::new();
    for way in [Way::Server, Way::Folder] {
        let Some(studio) = way.start(1 << 26) else {
            return;
        };
        let tab = browser.open(&studio.address, 900, 700);
        browser.wait(&tab, EMPTY);
        if kept.is_empty() {
            browser.drop_file(&tab, "play.csv", &play());
            browser.wait(
                &tab,
                "document.querySelector('#plot-loop .scatterlayer path')",
            );
            fit(&mut browser, &tab);
            let session = "import('./api.js').then(({ take }) => take({ what: 'session' })).then((t) => t.text())";
            kept = browser.value(&tab, session).as_str().unwrap().to_owned();
        } else {
            browser.drop_file(&tab, "kept.session.json", &kept);
            browser.wait(&tab, "document.querySelector('#fits .card')");
        }
        let taken = "import('./api.js').then(async ({ ask, take }) => {
            const { files: [{ id: file }], fits: [{ id: fit }] } = await ask('overview');
            const view = { file, fits: [fit], picture: 'output', pixels: [900, 300] };
            const all = [{ what: 'session' }, { what: 'model', fit }, { what: 'c', fit }, { what: 'fmu', fit },
                { what: 'fmu', fit, inverse: true }, { what: 'report', fit, file }, { what: 'csv', ...view },
                { what: 'table', ...view }, { what: 'parquet', ...view }, { what: 'command', fit },
                { what: 'python', fit }, { what: 'rust', fit }, { what: 'profile', fit, heating: 1, cooling: 1 }];
            const found = [];
            for (const what of all) {
                const { name, blob } = await take(what);
                const digest = await crypto.subtle.digest('SHA-256', await blob.arrayBuffer());
                found.push([name, blob.size, [...new Uint8Array(digest)].join(' ')]);
            }
            return found;
        })";
        found.push(browser.value(&tab, taken));
        studio.end();
    }
    assert_eq!(found[0], found[1]);
}

/// In the browser a panic ends the instance of the session; a new one takes the same steps.
fn a_call_that_fails_leaves_the_session_as_it_was(way: Way) {
    let Some((mut browser, studio, tab)) = way.open(1 << 26, (900, 700)) else {
        return;
    };
    browser.drop_file(&tab, "wave.csv", &wave());
    browser.wait(
        &tab,
        "document.querySelector('#files h3')?.textContent === 'wave.csv'",
    );
    browser.drop_file(&tab, "play.csv", &play());
    browser.wait(
        &tab,
        "document.querySelectorAll('#files article').length === 2",
    );
    browser.value(
        &tab,
        "document.querySelector('#files article button[aria-label]').click()",
    );
    browser.wait(
        &tab,
        "document.querySelectorAll('#files article').length === 1",
    );
    fit(&mut browser, &tab);
    let seen = browser.value(&tab, OVERVIEW);
    let call = match way {
        Way::Server => "http",
        Way::Folder => "local",
    };
    let call = format!("import('./{call}.js').then(({{ call }}) => call('session', 'no JSON'))");
    let answer = browser.value(
        &tab,
        &format!("{call}.then(({{ ok, text }}) => [ok, JSON.parse(text).code])"),
    );
    assert_eq!(answer, serde_json::json!([false, 104]));
    assert_eq!(browser.value(&tab, OVERVIEW), seen);
    studio.end();
}

/// The page is as the system has it, until a person chooses; a click is enough.
#[test]
fn dark_and_light_are_of_the_whole_page() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 26, (900, 700)) else {
        return;
    };
    browser.drop_file(&tab, "play.csv", &play());
    let drawn = "document.querySelector('#plot-loop .scatterlayer path')";
    browser.wait(&tab, drawn);
    let shade = |browser: &mut Chromium| {
        let ground = "getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g)";
        let line = "getComputedStyle(document.querySelector('#plot-loop .js-line')).stroke.match(/[0-9]+/g)";
        let bright = |of: &str| format!("{of}.slice(0, 3).reduce((a, b) => a + Number(b), 0) / 3");
        let both = format!("[{}, {}]", bright(ground), bright(line));
        serde_json::from_value::<[f64; 2]>(browser.value(&tab, &both)).unwrap()
    };
    let is_dark = |[ground, line]: [f64; 2]| {
        // What is drawn stands out from the page.
        assert!((ground - line).abs() > 90.0, "{ground} {line}");
        ground < 60.0
    };
    assert!(!is_dark(shade(&mut browser)));
    browser.scheme(&tab, "dark");
    browser.wait(&tab, "document.documentElement.dataset.theme === 'dark'");
    browser.wait(
        &tab,
        "document.querySelector('#theme').textContent === 'Light'",
    );
    std::thread::sleep(std::time::Duration::from_millis(500));
    assert!(is_dark(shade(&mut browser)));
    browser.value(&tab, "document.querySelector('#theme').click()");
    browser.wait(
        &tab,
        "document.querySelector('#theme').textContent === 'Dark'",
    );
    std::thread::sleep(std::time::Duration::from_millis(500));
    assert!(!is_dark(shade(&mut browser)));
    // The choice stays.
    browser.value(&tab, "{ window.before = true; location.reload(); }");
    browser.wait(&tab, &format!("!window.before && {drawn}"));
    assert!(!is_dark(shade(&mut browser)));
    studio.end();
}

/// The browser keeps the session of a folder. One page has it; another one has a session of its own.
#[test]
fn a_page_of_a_folder_that_is_loaded_again_goes_on() {
    let Some((mut browser, studio, tab)) = Way::Folder.open(1 << 26, (900, 700)) else {
        return;
    };
    show_play(&mut browser, &tab);
    fit(&mut browser, &tab);
    let seen = browser.value(&tab, OVERVIEW);
    let again = "{ window.before = true; location.reload(); }";
    browser.value(&tab, again);
    browser.wait(
        &tab,
        "!window.before && document.querySelector('#fits .card')",
    );
    assert_eq!(browser.value(&tab, OVERVIEW), seen);
    // A fit that is under way when the page goes begins anew.
    browser.value(&tab, "document.querySelector('#begin').click()");
    browser.wait(&tab, "document.querySelector('#jobs').children.length > 0");
    browser.value(&tab, again);
    let fits = "import('./api.js').then(({ ask }) => ask('overview')).then(({ fits }) => fits.length === 2)";
    browser.wait(&tab, &format!("!window.before && {fits}"));

    let other = browser.open(&studio.address, 900, 700);
    browser.wait(&other, EMPTY);
    browser.wait(
        &other,
        "document.querySelector('#where').textContent.includes('ends with the page')",
    );

    let anew = "{ window.before = true; window.confirm = () => true; document.querySelector('#anew').click(); }";
    browser.value(&tab, anew);
    browser.wait(
        &tab,
        "!window.before && document.querySelector('#drop.empty')",
    );
    browser.value(&tab, again);
    browser.wait(
        &tab,
        "!window.before && document.querySelector('#drop.empty')",
    );
    studio.end();
}

/// Pages of one server share its session. In a folder each page has a session of its own, and no
/// server can go away.
#[test]
fn two_pages_show_the_same_and_a_fit_is_cancelled() {
    let Some(mut browser) = browser() else { return };
    let studio = Studio::start(1 << 26, &[]);
    let one = browser.open(&studio.address, 900, 700);
    let two = browser.open(&studio.address, 900, 700);
    for tab in [&one, &two] {
        browser.wait(tab, EMPTY);
    }
    browser.drop_file(&one, "wave.csv", &wave());
    browser.wait(
        &two,
        "document.querySelector('#files h3')?.textContent === 'wave.csv'",
    );
    browser.value(&one, "document.querySelector('[name=levels]').value = '50'");
    browser.value(&one, "document.querySelector('#begin').click()");
    browser.wait(&two, "document.querySelector('#jobs button')");
    browser.value(&two, "document.querySelector('#jobs button').click()");
    for tab in [&one, &two] {
        browser.wait(tab, "!document.querySelector('#jobs button')");
        assert_eq!(
            browser.value(tab, "document.querySelectorAll('#fits article').length"),
            0
        );
    }
    studio.end();
    // The server is gone: the page says so.
    browser.value(
        &one,
        "document.querySelector('#files [title=Close]').click()",
    );
    browser.wait(
        &one,
        "document.querySelector('#fault').textContent.includes('does not answer')",
    );
}

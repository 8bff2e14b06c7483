//! The views of the page in a real browser: zoom, play, preparation, drive by hand, profiles, and a
//! studio that starts again.
#![cfg(feature = "server")]

use crate::browser::open_task;
use crate::chromium::{Chromium, Tab, browser, keep};
use crate::common::Studio;
use crate::place::{EMPTY, Way, both_ways};

both_ways!(every_view_answers_the_hand);

/// Loops of a play that shrink, with a spike.
fn table() -> String {
    let mut text = "time [s],temperature [degC],displacement [mm]\n".to_owned();
    let mut y = 20.0_f64;
    for n in 0..1500 {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.02).cos() * (1.0 - f64::from(n) / 2500.0);
        y = y.clamp(t - 4.0, t + 4.0);
        let read = if n == 700 { 300.0 } else { t };
        text += &format!("{},{read},{}\n", f64::from(n) * 0.1, 0.2 * y);
    }
    text
}

fn fit(browser: &mut Chromium, tab: &Tab) {
    browser.value(tab, "document.querySelector('[name=levels]').value = '12'");
    browser.value(
        tab,
        "document.querySelector('[name=bootstrap]').value = '0'",
    );
    browser.value(tab, "document.querySelector('#begin').click()");
    browser.wait(tab, "document.querySelector('#fits .card')");
    browser.wait(tab, "document.body.dataset.shown === '1'");
}

fn every_view_answers_the_hand(way: Way) {
    let name = way.name();
    let Some((mut browser, studio, tab)) = way.open(1 << 28, (1280, 900)) else {
        return;
    };
    browser.drop_file(&tab, "play.csv", &table());
    browser.wait(
        &tab,
        "document.querySelectorAll('.column.used').length >= 2",
    );

    // Prepare: the spike goes, its line is told, and the raw line stays beside the prepared one.
    browser.wait(&tab, "document.querySelector('#plot-input .scatterlayer')");
    browser.value(
        &tab,
        "document.querySelector('[data-key^=prepare]').click()",
    );
    browser.wait(
        &tab,
        "document.querySelector('.report')?.textContent.includes('(line 702 of the file)')",
    );
    browser.wait(
        &tab,
        "document.querySelector('#plot-input').data.length === 2",
    );
    let most = "document.querySelector('#plot-input').data.map(d => Math.max(...d.y))";
    assert_eq!(browser.value(&tab, most)[0], 300.0);
    assert!(browser.value(&tab, most)[1].as_f64().unwrap() < 100.0);
    keep(&mut browser, &tab, &format!("{name}-prepared"));
    browser.value(&tab, "document.querySelector('[data-key=as-read]').click()");
    browser.wait(
        &tab,
        "document.querySelector('#plot-loop').data.length === 1",
    );
    fit(&mut browser, &tab);

    // A zoom in the loop, with the mouse: all views show the samples inside.
    let samples = "document.querySelector('#plot-residuals').layout.meta.samples";
    browser.wait(&tab, &format!("{samples} === 1500"));
    let way = browser.points(
        &tab,
        "#plot-loop .nsewdrag",
        &[(0.3, 0.3), (0.5, 0.6), (0.6, 0.7)],
    );
    browser.drag(&tab, &way);
    browser.wait(&tab, &format!("{samples} < 1500 && {samples} > 10"));
    let gaps = "document.querySelector('#plot-output').data.every(d => d.y.includes(null))";
    browser.wait(&tab, gaps);
    keep(&mut browser, &tab, &format!("{name}-zoom-loop"));
    browser.value(&tab, "document.querySelector('[data-key=all]').click()");
    browser.wait(&tab, &format!("{samples} === 1500"));

    // Play, by the keyboard: the sample moves, with its mark and the staircase.
    browser.value(&tab, "document.querySelector('[data-key=play-speed]').value = '3'; document.querySelector('[data-key=play-speed]').dispatchEvent(new Event('change'))");
    let space =
        "document.body.dispatchEvent(new KeyboardEvent('keydown', {key: ' ', bubbles: true}))";
    browser.value(&tab, space);
    let row =
        "Number(document.querySelector('#play-sample').textContent.match(/[Ss]ample (\\d+)/)?.[1])";
    browser.wait(&tab, &format!("{row} > 600"));
    browser.value(&tab, space);
    browser.wait(
        &tab,
        "document.querySelector('#play-button').textContent.includes('Play')",
    );
    browser.wait(
        &tab,
        "document.querySelector('#plot-plane').data.length === 3",
    );
    // A click on a cell of the plane goes to a sample at which its operator switches.
    let before = browser.value(&tab, row);
    // Plotly takes a click for one on what it hovers over, and a plane that is drawn anew drops that.
    // What comes late on the page may move it. Where an operator switches at the sample that play
    // ended at, another one does not.
    let chosen = (0..10).any(|n| {
        let place = [(0.2, 0.6), (0.2, 0.3)][n % 2];
        let cell = browser.points(&tab, "#plot-plane .nsewdrag", &[place])[0];
        browser.point(&tab, cell);
        browser.wait(&tab, "document.querySelector('#plot-plane .hovertext')");
        browser.drag(&tab, &[cell]);
        std::thread::sleep(std::time::Duration::from_millis(250));
        browser.value(&tab, row) != before
    });
    assert!(chosen, "{:?}", browser.errors);
    for place in ["output", "input", "residuals", "loop"] {
        let mark = format!(
            "document.querySelector('#plot-{place}').layout.shapes.some(s => s.name === 'now')"
        );
        browser.wait(&tab, &mark);
    }

    // Drive: a drag in the picture, a path drawn, a path of outputs by number.
    open_task(&mut browser, &tab, "drive");
    browser.wait(&tab, "document.querySelector('#plot-drive .scatterlayer')");
    let status = "document.querySelector('#drive-status').textContent";
    let before = browser.value(&tab, "document.querySelector('#value-input').textContent");
    let way = browser.points(
        &tab,
        "#plot-drive .nsewdrag",
        &[(0.2, 0.5), (0.4, 0.5), (0.7, 0.5)],
    );
    browser.drag(&tab, &way);
    browser.wait(
        &tab,
        &format!("document.querySelector('#value-input').textContent !== {before}"),
    );
    browser.wait(&tab, &format!("{status}.includes('Dead band')"));
    let choose = |what: &str, value: &str| {
        format!(
            "(() => {{ const s = document.querySelector('[data-key={what}]'); s.value = '{value}';
             s.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"
        )
    };
    browser.value(&tab, &choose("hand-moves", "output"));
    let way = browser.points(
        &tab,
        "#plot-drive .nsewdrag",
        &[(0.5, 0.5), (0.5, 0.4), (0.5, 0.6)],
    );
    browser.drag(&tab, &way);
    browser.wait(&tab, &format!("{status}.includes('anticipate')"));
    let shares: Vec<(f64, f64)> = (0..30)
        .map(|n| f64::from(n) / 30.0)
        .map(|x| (0.02 + 0.96 * x, 0.5 - 0.3 * (x * 9.0).sin()))
        .collect();
    let way = browser.points(&tab, "#path", &shares);
    browser.drag(&tab, &way);
    browser.wait(&tab, "document.querySelector('#plot-moves').hidden");
    browser.value(&tab, &choose("hand-path", "outputs"));
    let way = browser.points(&tab, "#path", &shares);
    browser.drag(&tab, &way);
    browser.wait(
        &tab,
        "document.querySelector('#plot-moves').data?.[0].y.length === 200",
    );

    // Design: the profile, the planes before and with it, and the file.
    open_task(&mut browser, &tab, "design");
    browser.value(&tab, "document.querySelector('#design-begin').click()");
    browser.wait(
        &tab,
        "document.querySelector('#plot-after .heatmaplayer image')",
    );
    browser.wait(
        &tab,
        "document.querySelector('#design-text').textContent.includes('78 well determined')",
    );
    let taken = "import('./api.js').then(async ({ ask, take }) => {
        const { fits, files } = await ask('overview');
        const profile = await take({ what: 'profile', fit: fits[0].id, heating: 1, cooling: 1 });
        const all = await take({ what: 'table', file: files[0].id, fits: [fits[0].id], picture: 'output', pixels: [1, 1] });
        const parquet = await take({ what: 'parquet', file: files[0].id, picture: 'output', pixels: [1, 1] });
        return [profile.text().split('\\n').length > 100, all.text().trim().split('\\n').length, parquet.text().slice(0, 4)]; })";
    let taken = browser.value(&tab, taken);
    assert_eq!(taken, serde_json::json!([true, 1501, "PAR1"]));

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
            std::thread::sleep(std::time::Duration::from_millis(4000));
            keep(&mut browser, &tab, &format!("{name}-views-{theme}-{width}"));
        }
    }
    studio.end();
}

/// Only a server keeps a session on the disk. In a folder the user takes it home, which the test of
/// the whole way does; there is no file on the disk to be read again either.
#[test]
fn a_studio_that_was_killed_goes_on() {
    let Some(mut browser) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("kept.session.json");
    let studio = Studio::keeping(1 << 28, &[], Some(&kept));
    let tab = browser.open(&studio.address, 1280, 900);
    browser.wait(&tab, EMPTY);
    browser.drop_file(&tab, "play.csv", &table());
    browser.wait(
        &tab,
        "document.querySelectorAll('.column.used').length >= 2",
    );
    fit(&mut browser, &tab);
    // Nothing is told to the first studio: what it wrote by then is all there is.
    let has_fit = || {
        let text = std::fs::read_to_string(&kept).unwrap_or_default();
        text.contains("\"model\":{")
    };
    let begin = std::time::Instant::now();
    while !has_fit() {
        assert!(begin.elapsed().as_secs() < 60, "the session is not written");
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let copy = folder.path().join("copy.session.json");
    std::fs::copy(&kept, &copy).unwrap();
    let again = Studio::keeping(1 << 28, &[], Some(&copy));
    let tab = browser.open(&again.address, 1280, 900);
    browser.wait(
        &tab,
        "document.querySelector('#files h3')?.textContent === 'play.csv'",
    );
    browser.wait(&tab, "document.querySelector('#fits .card')");
    studio.end();
    again.end();
}

#[test]
#[ignore = "a measurement; run it alone"]
fn a_million_samples() {
    million_samples(Way::Server);
}

#[test]
#[ignore = "a measurement; run it alone"]
fn a_million_samples_in_a_folder() {
    million_samples(Way::Folder);
}

/// Prints how long the page takes with a million samples.
fn million_samples(way: Way) {
    let Some((mut browser, studio, tab)) = way.open(1 << 30, (1280, 900)) else {
        return;
    };
    let code = "(() => { const rows = ['time [s],temperature [degC],displacement [mm]']; let y = 20;
        for (let n = 0; n < 1e6; n++) { const t = 50 - 30 * Math.cos(n * 2e-4) * (1 - n / 2e6);
            y = Math.min(t + 4, Math.max(t - 4, y)); rows.push((n * 0.001).toFixed(3) + ',' + t.toFixed(5) + ',' + (0.2 * y).toFixed(5)); }
        window.big = new File([rows.join('\\n')], 'big.csv'); return window.big.size; })()";
    println!("bytes: {}", browser.value(&tab, code));
    let first = "(async () => { const begin = performance.now(); const data = new DataTransfer(); data.items.add(window.big);
        document.querySelector('#drop').dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));
        while (!document.querySelector('#plot-loop .scatterlayer path')) await new Promise(r => setTimeout(r, 5));
        return performance.now() - begin; })()";
    println!("first picture: {} ms", browser.value(&tab, first));
    let calls = "performance.getEntriesByType('resource').filter(({ name }) => name.includes('/api/')).map(({ name, startTime, responseStart, duration }) => [name.split('/').pop(), startTime, responseStart - startTime, duration].map((n) => typeof n === 'number' ? Math.round(n) : n))";
    println!(
        "calls, their begin, wait and time in ms: {}",
        browser.value(&tab, calls)
    );
    let asked = "(async () => { const { ask } = await import('./api.js'); const { files } = await ask('overview'); const found = {};
        for (const picture of ['output', 'input', 'loop']) for (const window of [null, [300, 320]]) { const begin = performance.now();
            const { lines } = await ask('curves', { file: files[0].id, picture, window, pixels: [1200, 400] }); found[picture + (window ? ' part' : ' all')] = [Math.round(performance.now() - begin), lines[0].x.length]; }
        return found; })()";
    println!("session: {}", browser.value(&tab, asked));
    let zoom = "(async () => { const times = []; for (let n = 0; n < 8; n++) { const begin = performance.now(); const was = document.querySelector('#plot-loop').layout.meta.samples;
        document.querySelector('[data-key=zoom-in]').click();
        while (document.querySelector('#plot-loop').layout.meta.samples === was) await new Promise(r => setTimeout(r, 2));
        times.push(Math.round(performance.now() - begin)); } return times; })()";
    println!("zooms: {} ms", browser.value(&tab, zoom));
    browser.value(&tab, "document.querySelector('[data-key=all]').click()");
    fit(&mut browser, &tab);
    let drag = "(async () => { const { ask } = await import('./api.js'); const { fits, best } = await ask('overview'); let view = await ask('drive', { fit: best }); const times = [];
        const [low, high] = view.outputs; for (let n = 0; n < 60; n++) { const begin = performance.now();
            view = await ask('pull', { drive: view.drive, output: low + (high - low) * (0.5 + 0.3 * Math.sin(n / 5)) }); times.push(performance.now() - begin); }
        times.sort((a, b) => a - b); return [times[30], times[57]]; })()";
    println!(
        "answers of the inverse, median and 95 %: {} ms",
        browser.value(&tab, drag)
    );
    let point = "(async () => { const { ask } = await import('./api.js'); const { best, files } = await ask('overview'); const times = [];
        for (let n = 0; n < 20; n++) { const begin = performance.now(); await ask('plane', { fit: best, kind: 'states', at: [files[0].id, 50 * n] }); times.push(Math.round(performance.now() - begin)); } return times; })()";
    println!("plane at a sample: {} ms", browser.value(&tab, point));
    studio.end();
}

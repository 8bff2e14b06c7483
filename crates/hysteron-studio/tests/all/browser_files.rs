//! Several files on the page, in a real browser: one step for all, errors of a file that changed, a
//! path in a file, and files that go.
#![cfg(feature = "server")]

use crate::browser::{open_task, play, show_play};
use crate::chromium::{Chromium, Tab, keep};
use crate::place::Way;

const CARDS: &str = "document.querySelectorAll('#files article').length";

fn click(browser: &mut Chromium, tab: &Tab, selector: &str) {
    browser.wait(tab, &format!("document.querySelector('{selector}')"));
    browser.value(
        tab,
        &format!("document.querySelector('{selector}').click()"),
    );
}

/// Sets a field or a choice by its selector.
fn set(browser: &mut Chromium, tab: &Tab, selector: &str, value: &str) {
    let code = format!(
        "(() => {{ const node = [...document.querySelectorAll('{selector}')].at(-1); node.value = '{value}';
         node.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"
    );
    browser.value(tab, &code);
}

fn fit(browser: &mut Chromium, tab: &Tab) {
    for (name, value) in [("levels", "8"), ("bootstrap", "0")] {
        let code = format!("document.querySelector('[name={name}]').value = '{value}'");
        browser.value(tab, &code);
    }
    browser.value(tab, "document.querySelector('#begin').click()");
    browser.wait(tab, "document.body.dataset.shown === '1'");
}

/// Four pictures for people: both themes and widths.
fn pictures(browser: &mut Chromium, tab: &Tab, name: &str) {
    if std::env::var_os("HYSTERON_PICTURES").is_none() {
        return;
    }
    for (theme, width) in [
        ("light", 1280),
        ("dark", 1280),
        ("dark", 390),
        ("light", 390),
    ] {
        browser.size(tab, width, 900);
        browser.value(tab, &format!("document.documentElement.dataset.theme === '{theme}' || document.querySelector('#theme').click()"));
        std::thread::sleep(std::time::Duration::from_millis(1500));
        keep(browser, tab, &format!("{name}-{theme}-{width}"));
    }
    browser.size(tab, 1280, 900);
}

/// Loops with a reading that is missing on line 302, and with a spike of the output.
fn messy(spike: f64) -> String {
    let rows = play();
    let rows = rows.lines().enumerate().map(|(n, row)| {
        let cells: Vec<&str> = row.split(',').collect();
        match n + 1 {
            302 => format!("{},,{},1\n", cells[0], cells[2]),
            702 => {
                let output = cells[2].parse::<f64>().unwrap() + spike;
                format!("{},{},{output},1\n", cells[0], cells[1])
            }
            _ => format!("{row}\n"),
        }
    });
    rows.collect()
}

/// Two files with the same faults: one click repairs both, one prepares the second as the first.
/// The fit says that its test has changed, and its worst sample is of the file that tested it.
#[test]
fn one_step_serves_all_files_and_old_errors_are_told() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 900)) else {
        return;
    };
    for (name, spike) in [("first.csv", 3.0), ("second.csv", 5.0)] {
        browser.drop_file(&tab, name, &messy(spike));
    }
    browser.wait(&tab, &format!("{CARDS} === 2"));
    pictures(&mut browser, &tab, "files-repair");
    click(&mut browser, &tab, "[data-key^=repair-all]");
    browser.wait(
        &tab,
        "document.querySelectorAll('[data-key^=mend]').length === 2",
    );
    set(&mut browser, &tab, "[data-key^=purpose]", "validate");
    browser.wait(
        &tab,
        "[...document.querySelectorAll('[data-key^=purpose]')].at(-1).value === 'validate'",
    );
    fit(&mut browser, &tab);

    click(&mut browser, &tab, "[data-key^=worst]");
    let told = "document.querySelector('#play-sample').textContent";
    browser.wait(&tab, &format!("{told}.startsWith('second.csv, sample ')"));
    let line = browser.value(
        &tab,
        &format!(
            "{told}.match(/sample (\\d+) \\(line (\\d+) of the file\\)/).slice(1).map(Number)"
        ),
    );
    // Of the file, the header is one line; the row without a reading is before or behind it.
    let (sample, line) = (line[0].as_u64().unwrap(), line[1].as_u64().unwrap());
    assert_eq!(line, sample + if sample > 300 { 2 } else { 1 });
    let card = "document.querySelector('[data-worst]').textContent";
    browser.wait(
        &tab,
        &format!(
            "{card}.startsWith('second.csv, sample {sample} (line {line} of the file): off by ')"
        ),
    );

    open_task(&mut browser, &tab, "prepare");
    let error = "document.querySelector('.errors td').textContent";
    let before = browser.value(&tab, error);
    click(&mut browser, &tab, "#prepare form button.first");
    let warned = "document.querySelector('#fits .warn')?.textContent ?? ''";
    browser.wait(
        &tab,
        &format!("({warned}).startsWith('second.csv has changed since')"),
    );
    assert_eq!(browser.value(&tab, error), before);
    pictures(&mut browser, &tab, "files-changed");
    click(&mut browser, &tab, "[data-key^=anew]");
    browser.wait(
        &tab,
        &format!("{error} !== {before} && !({warned}).includes('changed since')"),
    );
    // The same for the other file: now the fit is of what is not there any more.
    click(&mut browser, &tab, "[data-key^=prepare-others]");
    browser.wait(&tab, &format!("({warned}).includes('first.csv has changed since') && !document.querySelector('[data-key^=anew]')"));
    browser.wait(
        &tab,
        "!document.querySelector('[data-key^=prepare-others]')",
    );
    let prepared = "[...document.querySelectorAll('#files article')].every((card) => card.textContent.includes(', prepared'))";
    assert_eq!(browser.value(&tab, prepared), true);
    assert!(browser.errors.is_empty(), "{:#?}", browser.errors);
    studio.end();
}

/// A staircase in a file is opened in the drive, its column is found, and what came of it is
/// offered.
#[test]
fn a_staircase_in_a_file_is_followed() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 900)) else {
        return;
    };
    show_play(&mut browser, &tab);
    fit(&mut browser, &tab);
    open_task(&mut browser, &tab, "drive");
    browser.wait(&tab, "document.querySelector('#path-choose')");
    let give = "(() => { const data = new DataTransfer();
        data.items.add(new File(['time [s],wanted [mm]\\n0,8\\n1,8\\n2,12\\n3,12\\n4,60\\n'], 'stairs.csv'));
        const at = document.querySelector('#path-choose'); at.files = data.files;
        at.dispatchEvent(new Event('change', {bubbles: true})); })()";
    browser.value(&tab, give);
    let column = "document.querySelector('[data-key=path-column]')?.value";
    browser.wait(&tab, &format!("{column} === 'wanted [mm]'"));
    // It is no recording, and nothing is wrong with it.
    assert_eq!(
        browser.value(&tab, "document.querySelectorAll('#files .problem').length"),
        0
    );
    assert_eq!(
        browser.value(&tab, "document.querySelector('#fit-now').disabled"),
        false
    );
    click(&mut browser, &tab, "[data-key=path-outputs]");
    let came = "document.querySelector('#drive-path').textContent";
    browser.wait(
        &tab,
        &format!("{came}.startsWith('Of 5 outputs wanted 4 were reached. The others: 1 above')"),
    );
    browser.wait(
        &tab,
        "document.querySelector('#plot-moves').data?.[0].y.length === 5",
    );
    browser.value(&tab, "{ window.saved = null; const made = URL.createObjectURL; URL.createObjectURL = (blob) => { window.saved = blob; return made(blob); }; }");
    click(&mut browser, &tab, "#drive-way:not([hidden])");
    browser.wait(&tab, "window.saved");
    let text = browser.value(&tab, "window.saved.text()");
    let text = text.as_str().unwrap();
    assert_eq!(text.lines().count(), 6, "{text}");
    assert!(text.lines().last().unwrap().ends_with(",high"), "{text}");
    // Nothing but the task scrolls.
    let beyond = "document.documentElement.scrollHeight - document.documentElement.clientHeight";
    assert_eq!(browser.value(&tab, beyond), 0);
    browser.value(
        &tab,
        "document.querySelector('#drive-way').scrollIntoView({block: 'center'})",
    );
    pictures(&mut browser, &tab, "files-path");
    // A move by hand is no path.
    set(&mut browser, &tab, "#drive-input-number", "50");
    browser.wait(&tab, "document.querySelector('#drive-way').hidden");
    assert!(browser.errors.is_empty(), "{:#?}", browser.errors);
    studio.end();
}

/// A file that is closed while it is drawn, and an operator that never switches, are no errors.
/// Where the only fit cannot be run there are no empty axes.
#[test]
fn what_is_not_there_is_not_drawn() {
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 900)) else {
        return;
    };
    show_play(&mut browser, &tab);
    browser.value(
        &tab,
        "document.querySelector('[name=thermal]').value = 'first-order'",
    );
    set(&mut browser, &tab, "[name=hold_out]", "nothing");
    fit(&mut browser, &tab);
    let shown =
        "[...document.querySelectorAll('#look .fitted')].filter((figure) => !figure.hidden).length";
    browser.wait(&tab, &format!("{shown} === 4"));
    let plain: Vec<String> = play()
        .lines()
        .map(|row| row.split_once(',').unwrap().1.to_owned())
        .collect();
    browser.drop_file(&tab, "no time.csv", &plain.join("\n"));
    browser.wait(&tab, &format!("{CARDS} === 2"));
    browser.value(
        &tab,
        "[...document.querySelectorAll('#files h3 button')].at(-1).click()",
    );
    browser.wait(
        &tab,
        &format!("!document.querySelector('#look-left-out').hidden && {shown} === 1"),
    );
    pictures(&mut browser, &tab, "files-left-out");
    // Back to the file that was fitted, the residuals are there in their full width.
    browser.value(&tab, "document.querySelector('#files h3 button').click()");
    browser.wait(&tab, &format!("{shown} === 4"));
    let points = "document.querySelector('#plot-residuals').data[0].x.length";
    browser.wait(&tab, &format!("{points} > 300"));

    // Requests of the page that come after another one closed the file.
    let late = "import('./api.js').then(async ({ ask }) => {
        const { files } = await ask('overview');
        const { id } = files.at(-1);
        const drawn = [1, 2, 3].map(() => ask('curves', { file: id, picture: 'loop', pixels: [600, 400] }));
        await ask('close', { file: id });
        drawn.push(ask('sample', { file: id, at: 1 }));
        return (await Promise.all(drawn)).at(-1); })";
    assert!(browser.value(&tab, late).is_null());
    // On the way up to a part of the range some operators never switch.
    let short: Vec<String> = play().lines().take(80).map(str::to_owned).collect();
    browser.drop_file(&tab, "short.csv", &short.join("\n"));
    browser.wait(&tab, &format!("{CARDS} === 2"));
    // The card of a file that was closed by hand is there too: it is the name that tells.
    let never = "import('./api.js').then(async ({ ask }) => {
        let files, fits;
        do ({ files, fits } = await ask('overview')); while (files.at(-1).name !== 'short.csv');
        const found = [];
        for (let on = 1; on <= 8; on++) for (let off = 1; off <= on; off++)
            found.push((await ask('switch', { fit: fits[0].id, file: files.at(-1).id, operator: [off, on] })).response);
        return [...new Set(found)].sort(); })";
    assert_eq!(
        browser.value(&tab, never),
        serde_json::json!(["never", "sample"])
    );
    assert!(browser.errors.is_empty(), "{:#?}", browser.errors);
    studio.end();
}

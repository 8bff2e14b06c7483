//! What axe-core finds on the page: contrast, names of what can be pressed, order of headings.
#![cfg(feature = "server")]

use crate::browser::show_play;
use crate::chromium::{Chromium, Tab};
use crate::place::Way;
use crate::recordings::skip::skipped;
use serde_json::{Value, json};
use std::path::Path;

/// The script of axe-core, which `tools/install` puts into the build folder.
fn axe() -> Option<String> {
    let built = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let script = built.join("axe-core/node_modules/axe-core/axe.min.js");
    let found = std::fs::read_to_string(script).ok();
    if found.is_none() {
        assert!(
            std::env::var_os("HYSTERON_NO_SKIP").is_none(),
            "there is no axe-core: run tools/install"
        );
        skipped("there is no axe-core: run tools/install");
    }
    found
}

/// What is wrong on the page as it is now.
fn violations(browser: &mut Chromium, tab: &Tab) -> Value {
    let run = "axe.run(document, { resultTypes: ['violations'] }).then(({ violations }) => \
               violations.map(({ id, nodes }) => [id, ...nodes.map(({ html, failureSummary }) => \
               html.slice(0, 160) + ' ' + failureSummary)]))";
    browser.value(tab, run)
}

#[test]
fn everybody_can_use_the_page() {
    let Some(axe) = axe() else { return };
    let Some((mut browser, studio, tab)) = Way::Server.open(1 << 28, (1280, 800)) else {
        return;
    };
    browser.value(&tab, &format!("{axe}; 0"));
    assert_eq!(violations(&mut browser, &tab), json!([]), "empty");
    show_play(&mut browser, &tab);
    browser.value(&tab, "document.querySelector('[name=levels]').value = '12'");
    browser.value(&tab, "document.querySelector('#begin').click()");
    browser.wait(&tab, "document.querySelector('#fits .card')");
    browser.wait(
        &tab,
        "document.querySelector('#plot-plane .heatmaplayer image')",
    );
    for theme in ["light", "dark"] {
        let choose = format!(
            "document.documentElement.dataset.theme === '{theme}' || document.querySelector('#theme').click()"
        );
        browser.value(&tab, &choose);
        for width in [1280, 390] {
            browser.size(&tab, width, 800);
            for task in ["", "prepare", "split", "fit", "drive", "design", "home"] {
                let show = format!(
                    "document.querySelector('#task-close').click(); document.querySelector('[data-task={task}]')?.click()"
                );
                if !task.is_empty() {
                    browser.value(&tab, &show);
                }
                let found = violations(&mut browser, &tab);
                assert_eq!(found, json!([]), "{theme}, {width}, “{task}”");
            }
        }
    }
    studio.end();
}

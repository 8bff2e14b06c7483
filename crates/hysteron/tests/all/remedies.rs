//! Options in what the libraries say: each surface spells them, none is spelt here.

use hysteron::{Error, Remedy, Setting};
use std::path::Path;

/// The lines of code, without tests and comments, that have an option of the command in them. A name
/// with a colon is a variable of a style sheet.
fn spelt_in(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            spelt_in(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs")
            && !path.ends_with("tests.rs")
        {
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            let spelt = |line: &&str| {
                let mut after = line.split("--").skip(1);
                after.any(|rest| {
                    let end = rest.trim_start_matches(|c: char| c.is_ascii_lowercase());
                    end.len() < rest.len() && !end.starts_with(':')
                })
            };
            let lines = code
                .filter(spelt)
                .map(|line| format!("{}: {line}", path.display()));
            found.extend(lines);
        }
    }
}

#[test]
fn no_library_spells_options_as_the_command_does() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for name in [
        "hysteron-core",
        "hysteron",
        "hysteron-report",
        "hysteron-export",
    ] {
        spelt_in(&crates.join(name).join("src"), &mut found);
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn a_remedy_leaves_the_error_as_it_is() {
    let path = "run --old/--start unknown.csv";
    let plain = || Error::Export(path.into());
    let settings = [
        Setting::any("levels"),
        Setting::on("repair"),
        Setting::word("start", "unknown"),
        Setting::number("load-degree", 2),
    ];
    let error = plain().remedied(Remedy::new("use {}, {}, {} or {}", settings));
    assert_eq!(error.code(), plain().code());
    let (cause, remedy) = error.parts();
    assert_eq!(cause.to_string(), format!("export: {path}"));
    let spelt = remedy.unwrap().spelt(|setting| setting.name.to_uppercase());
    assert_eq!(spelt, "use LEVELS, REPAIR, START or LOAD-DEGREE");
    assert_eq!(
        error.to_string(),
        format!("export: {path}: use `levels`, `repair`, `start` unknown or `load degree` 2")
    );
}

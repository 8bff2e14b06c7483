//! One option has one default: `docs/options.md` against the command's help and the documentation
//! of the library, of Python and of scenarios.

use std::process::Command;

const PAGE: &str = include_str!("../../../../docs/options.md");
const LIBRARY_FIT: &str = include_str!("../../../hysteron/src/identify/options.rs");
const PYTHON_ADAPT: &str = include_str!("../../../hysteron-python/src/adapt.rs");
const PYTHON_ADAPTIVE: &str = include_str!("../../../hysteron-python/src/adaptive.rs");
const PYTHON_FIT: &str = include_str!("../../../hysteron-python/src/fit.rs");

/// A row of a table: the name of the option and its default.
struct Row {
    name: String,
    default: String,
}

/// The rows of a table with the heading `Option` or `field`, whatever stands before its lines.
fn rows(text: &str) -> Vec<Row> {
    let cells = text.lines().filter_map(|line| {
        let line = line.trim_start_matches('/').trim();
        let line = line.strip_prefix("| `")?;
        let (name, rest) = line.split_once("` |")?;
        let default = rest.split('|').next()?;
        Some(Row {
            name: name.to_owned(),
            default: default.trim().to_owned(),
        })
    });
    cells.collect()
}

/// A part of the page, from a heading to the next.
fn section(heading: &str) -> Vec<Row> {
    let (_, part) = PAGE.split_once(&format!("\n## {heading}\n")).unwrap();
    let part = part.split("\n## ").next().unwrap();
    let rows = rows(part);
    assert!(rows.len() > 10, "{heading}: the table is gone");
    rows
}

/// The numbers of a text; those in percent as shares.
fn numbers(text: &str) -> Vec<f64> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(begin) = rest.find(|c: char| c.is_ascii_digit()) {
        let tail = &rest[begin..];
        let end = tail
            .find(|c: char| !(c.is_ascii_digit() || c == '.'))
            .unwrap_or(tail.len());
        let number: f64 = tail[..end].trim_end_matches('.').parse().unwrap();
        rest = &tail[end..];
        let percent = rest.trim_start().starts_with('%');
        found.push(if percent { number / 100.0 } else { number });
    }
    found
}

/// What follows the word "default", in one line.
fn after_default(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let begin = text.to_lowercase().find("default").unwrap_or(text.len());
    text[begin..].to_owned()
}

/// That `found` states the numbers of the default; a default without numbers is `word`.
fn agrees(row: &Row, surface: &str, found: &str, word: Option<&str>) {
    let Row { name, default } = row;
    let expected = numbers(default);
    if expected.is_empty() {
        let word = word.unwrap_or(default).trim_matches('`').to_lowercase();
        assert!(
            found.to_lowercase().contains(&word),
            "{surface}: the default of `{name}` is `{word}` in docs/options.md, here: {found}"
        );
        return;
    }
    let found_numbers = numbers(found);
    for number in expected {
        assert!(
            found_numbers.iter().any(|n| (n - number).abs() < 1e-12),
            "{surface}: the default of `{name}` is {number} in docs/options.md, here: {found}"
        );
    }
}

/// The help of a command.
fn help(command: &str) -> String {
    let done = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args([command, "--help"])
        .output()
        .unwrap();
    assert!(done.status.success());
    String::from_utf8(done.stdout).unwrap()
}

/// What the help says of an option, until the next one.
fn of_option(help: &str, name: &str) -> String {
    let option = format!("--{}", name.replace('_', "-"));
    let lines: Vec<&str> = help.lines().collect();
    let begins = |line: &str| line.trim_start().starts_with('-') && !line.trim().starts_with("- ");
    let at = lines
        .iter()
        .position(|line| begins(line) && line.split_whitespace().any(|word| word == option));
    let at = at.unwrap_or_else(|| panic!("the help has no {option}"));
    let end = (at + 1..lines.len())
        .find(|&n| begins(lines[n]))
        .unwrap_or(lines.len());
    lines[at..end].join(" ")
}

/// What a docstring in a Rust source says of a parameter: the indented lines below `name :`.
fn of_parameter(source: &str, name: &str) -> Option<String> {
    let mut lines = source.lines().filter_map(|line| line.strip_prefix("///"));
    let head = format!(" {name} : ");
    let first = lines.by_ref().find(|line| line.starts_with(&head))?;
    let indented = lines.take_while(|line| line.starts_with("     "));
    Some(
        [first]
            .into_iter()
            .chain(indented)
            .collect::<Vec<_>>()
            .join(" "),
    )
}

#[test]
fn learners_have_one_table() {
    let (page, help) = (section("Learners"), help("adapt"));
    // With the learners, `learner` and `start`.
    let others = hysteron::Learner::ALL.len() + 2;
    assert_eq!(page.len(), hysteron::ADAPT_OPTIONS.len() + others);
    for option in hysteron::ADAPT_OPTIONS {
        let names = option.learners.iter().map(|learner| format!("`{learner}`"));
        let learners = match option.learners.len() + 1 == hysteron::Learner::ALL.len() {
            true => "all".to_owned(),
            false => names.collect::<Vec<_>>().join(", "),
        };
        let hysteron::AdaptOption {
            name,
            default,
            range,
            purpose,
            ..
        } = option;
        let row = format!("| `{name}` | {learners} | {default} | {range} | {purpose} |");
        assert!(PAGE.contains(&row), "docs/options.md has no row {row}");
        assert!(of_option(&help, name).contains("[default:"), "{name}");
        // Without a recording nothing tells the noise.
        let default = match name {
            "dead_zone" => "0",
            _ => default,
        };
        let (name, default) = (name.to_owned(), default.to_owned());
        let text = of_parameter(PYTHON_ADAPTIVE, &name);
        let text = text.unwrap_or_else(|| panic!("Python has no `{name}`"));
        let word = match name.as_str() {
            "load" => Some("middle"),
            "every" => Some("eighth of the window"),
            _ => None,
        };
        agrees(
            &Row { name, default },
            "Python",
            &after_default(&text),
            word,
        );
    }
    for learner in hysteron::Learner::ALL {
        let row = format!("| `{learner}` | {} |", learner.purpose());
        assert!(PAGE.contains(&row), "docs/options.md has no row {row}");
        let said = help.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.contains(&format!("{learner}: {}", learner.purpose())),
            "{said}"
        );
    }
    assert!(PYTHON_ADAPT.contains("method='auto'") && PYTHON_ADAPT.contains("start='unknown'"));
}

#[test]
fn fits_have_one_default_each() {
    let (page, library) = (section("Fits"), rows(LIBRARY_FIT));
    let help = help("fit");
    for row in &page {
        let name = row.name.as_str();
        let of_command = of_option(&help, name);
        let python = of_parameter(PYTHON_FIT, name);
        let python = python.unwrap_or_else(|| panic!("Python's fit has no `{name}`"));
        if name == "thermal" {
            assert!(of_command.contains("first-order") && python.contains("first-order"));
            continue;
        }
        let of_library = library.iter().find(|other| other.name == name);
        let of_library = of_library.unwrap_or_else(|| panic!("FitOptions has no row for `{name}`"));
        // Words for the same default, on the library, the command and Python.
        let words = match name {
            "range" => [Some("data"), Some("active range"), Some("active range")],
            "sign" => [Some("better"), Some("auto"), Some("better")],
            "offset" => [Some("free"), Some("identified"), Some("identified")],
            "robust" => [Some("auto"), Some("auto"), Some("true")],
            _ => [None; 3],
        };
        if name == "bootstrap" {
            assert!(
                of_library.default.starts_with("0;"),
                "FitOptions have no bootstrap"
            );
        } else {
            agrees(row, "the library", &of_library.default, words[0]);
        }
        agrees(row, "the command", &after_default(&of_command), words[1]);
        // Python states a default in the signature, or in words.
        let signature = PYTHON_FIT
            .lines()
            .find(|line| line.contains("text_signature"));
        let signature = signature.unwrap().replace('\'', "");
        let begin = format!(" {name}=");
        let (_, stated) = signature.split_once(&begin).unwrap();
        match stated.split([',', ')']).next().unwrap() {
            "None" => agrees(row, "Python", &python, words[2]),
            value => agrees(row, "Python", value, words[2]),
        }
    }
    // What pages show is the same table, word by word.
    let (_, text) = PAGE.split_once("\n## Fits\n").unwrap();
    for option in hysteron::FIT_OPTIONS {
        let hysteron::FitOption {
            name,
            default,
            range,
            purpose,
        } = option;
        let row = format!("| `{name}` | {default} | {range} | {purpose} |");
        assert!(text.contains(&row), "docs/options.md has no row {row}");
    }
    assert_eq!(hysteron::FIT_OPTIONS.len(), page.len());
    for other in library {
        assert!(
            page.iter().any(|row| row.name == other.name),
            "`{}` of FitOptions is not in docs/options.md",
            other.name
        );
    }
}

//! The pages of `docs/`: links that lead somewhere, and a length that somebody reads.

use std::fs;
use std::path::{Path, PathBuf};

/// A page to read has at most so many words; printed tables are in `docs/measured`.
const WORDS: usize = 1500;
/// The README has at most so many bytes.
const README: usize = 8000;
/// Columns of a line of prose.
const COLUMNS: usize = 100;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The Markdown files in a folder, without those in folders below.
fn pages(folder: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(root().join(folder)).unwrap();
    let files = files.map(|file| file.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The lines outside fenced blocks of code, with their numbers from 1.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_code = false;
    text.lines().enumerate().filter_map(move |(n, line)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        (!is_code && !is_fence).then_some((n + 1, line))
    })
}

/// The links of a page, with the numbers of their lines. A link may be wrapped in its words.
fn links(text: &str) -> Vec<(usize, &str)> {
    let each = prose(text).flat_map(|(n, line)| {
        let targets = line.split("](").skip(1);
        targets.filter_map(move |rest| Some((n, rest.split_once(')')?.0)))
    });
    each.collect()
}

/// The names by which the headings of a page are linked.
fn headings(text: &str) -> Vec<String> {
    let lines = prose(text).filter(|(_, line)| line.starts_with('#'));
    let name = |line: &str| -> String {
        let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
        let text = line.trim_start_matches('#').trim().to_lowercase();
        let kept = text.chars().filter(kept);
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    lines.map(|(_, line)| name(line)).collect()
}

/// Why a link of `page` leads nowhere, if so.
fn dead(page: &Path, link: &str) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, heading) = link.split_once('#').unwrap_or((link, ""));
    let target = match file {
        "" => page.to_owned(),
        file => page.parent().unwrap().join(file),
    };
    if !target.exists() {
        return Some("there is no such file".into());
    }
    let is_page = target.extension().is_some_and(|end| end == "md");
    let is_there = heading.is_empty() || headings(&read(&target)).iter().any(|h| h == heading);
    (is_page && !is_there).then(|| "the page has no such heading".into())
}

#[test]
fn no_link_is_dead() {
    let mut faults = Vec::new();
    let mut count = 0;
    for folder in [".", "docs", "docs/measured", "octave", "vectors"] {
        for page in pages(folder) {
            let text = read(&page);
            for (line, link) in links(&text) {
                count += 1;
                let place = format!("{}:{line}: {link}", page.display());
                faults.extend(dead(&page, link).map(|why| format!("{place}: {why}")));
            }
        }
    }
    assert!(count > 200, "{count} links are found");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_page_to_read_is_short_and_wrapped() {
    let mut faults = Vec::new();
    for page in pages("docs") {
        let text = read(&page);
        let page = page.display();
        let words = text.split_whitespace();
        let words = words.filter(|word| word.contains(char::is_alphanumeric));
        let words = words.count();
        if words > WORDS {
            faults.push(format!(
                "{page}: {words} words, {WORDS} at most: split it, or move tables to docs/measured"
            ));
        }
        let wide = prose(&text).filter(|(_, line)| {
            // A table has a line for each row, and a long link cannot be wrapped.
            let can_wrap = !line.starts_with('|') && line.trim().contains(' ');
            can_wrap && line.chars().count() > COLUMNS
        });
        faults.extend(wide.map(|(n, _)| format!("{page}:{n}: more than {COLUMNS} columns")));
    }
    let bytes = read(&root().join("README.md")).len();
    if bytes > README {
        faults.push(format!("README.md: {bytes} bytes, {README} at most"));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_is_released_has_one_version() {
    let version = env!("CARGO_PKG_VERSION");
    let changes = read(&root().join("CHANGELOG.md"));
    let mut headings = changes.lines().filter_map(|line| line.strip_prefix("## "));
    let newest = headings.find(|heading| *heading != "Unreleased").unwrap();
    assert_eq!(newest.split(' ').next(), Some(version), "CHANGELOG.md");
    let cited = read(&root().join("CITATION.cff"));
    assert!(
        cited.contains(&format!("\nversion: {version}\n")),
        "CITATION.cff"
    );
}

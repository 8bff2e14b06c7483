//! Prints which modules of each crate import each other in a circle, at every depth:
//! `cargo run -p hysteron-measure -- modules`. `modules all` prints the graphs, too.
//!
//! In each folder, the files and folders in it are the modules, and `mod.rs` (`lib.rs`, `main.rs`)
//! is one of them. A module imports another where a path in it ends there. A path to a name that is
//! re-exported counts for the module that defines the name. What tests alone import does not count.
//!
//! `text/circles.txt` has those that are known. Another one fails, and so does a known one that is
//! gone, so that the list only gets shorter.

mod paths;
mod tree;

use crate::result::Result;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use tree::{Graph, Tree, sorted};

/// A known circle in each line: its folder, and its modules.
const KNOWN: &str = include_str!("text/circles.txt");

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let all = arguments.first().is_some_and(|word| word == "all");
    let mut found = BTreeSet::new();
    for folder in sorted(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))? {
        let source = folder.join("src");
        if !source.is_dir() {
            continue;
        }
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        for (place, graph) in Tree::read(&source)?.graphs() {
            let place = [&[name.as_ref().to_owned()], &place[..]].concat().join("/");
            if all {
                println!("{place}");
                for (module, imports) in &graph {
                    let imports: Vec<&str> = imports.iter().map(String::as_str).collect();
                    println!("  {module} -> {}", imports.join(" "));
                }
            }
            let circles = circles_of(&graph);
            found.extend(
                circles
                    .iter()
                    .map(|circle| format!("{place}: {}", circle.join(" "))),
            );
        }
    }
    let known: BTreeSet<String> = KNOWN.lines().map(str::to_owned).collect();
    let (new, gone) = (found.difference(&known), known.difference(&found));
    new.clone()
        .for_each(|circle| println!("new circle: {circle}"));
    gone.clone()
        .for_each(|circle| println!("known circle that is gone: {circle}"));
    println!("{} circles, {} known", found.len(), known.len());
    match new.count() + gone.count() {
        0 => Ok(()),
        _ => Err("move what the modules of a circle share below them; \
                  take what is gone from text/circles.txt"
            .into()),
    }
}

/// The groups of modules that reach each other.
fn circles_of(graph: &Graph) -> Vec<Vec<String>> {
    let reached: BTreeMap<&String, BTreeSet<&String>> = graph
        .keys()
        .map(|module| (module, reach(graph, module)))
        .collect();
    let mut circles: Vec<Vec<String>> = Vec::new();
    for (module, reach) in &reached {
        let placed = circles.iter().flatten().any(|other| other == *module);
        if placed || !reach.contains(*module) {
            continue;
        }
        let both = |other: &&&String| {
            let back = reached.get(**other);
            back.is_some_and(|back| back.contains(module))
        };
        circles.push(
            reach
                .iter()
                .filter(both)
                .map(|other| (*other).clone())
                .collect(),
        );
    }
    circles
}

/// All modules that a module imports, itself or through others.
fn reach<'a>(graph: &'a Graph, module: &'a String) -> BTreeSet<&'a String> {
    let (mut seen, mut next) = (BTreeSet::new(), vec![module]);
    while let Some(at) = next.pop() {
        for import in graph.get(at).into_iter().flatten() {
            if seen.insert(import) {
                next.push(import);
            }
        }
    }
    seen
}

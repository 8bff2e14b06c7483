//! Prints the graph of the modules of each crate, and fails if a graph has a cycle:
//! `cargo run -p hysteron-measure --bin modules`
//!
//! A module is a file or folder directly below `src/`. It imports another where a path in it begins
//! with `crate::OTHER`. What tests alone import does not count. Exits with 1 on a cycle.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

type Graph = BTreeMap<String, BTreeSet<String>>;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut circles = 0;
    for folder in sorted(&crates)? {
        let source = folder.join("src");
        let graph = graph_of(&source)?;
        if graph.len() < 2 {
            continue;
        }
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        println!("{name}");
        for (module, imports) in &graph {
            let imports: Vec<&str> = imports.iter().map(String::as_str).collect();
            println!("  {module} -> {}", imports.join(" "));
        }
        for module in graph.keys().filter(|module| reaches(&graph, module)) {
            println!("  CIRCLE through {module}");
            circles += 1;
        }
    }
    match circles {
        0 => println!("no circles"),
        _ => println!("{circles} modules in circles: move what they share below both"),
    }
    Ok(ExitCode::from(u8::from(circles > 0)))
}

fn sorted(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    Ok(paths)
}

/// The modules below `source`, and which of the others each imports.
fn graph_of(source: &Path) -> Result<Graph, Box<dyn Error>> {
    let mut graph = Graph::new();
    if !source.is_dir() {
        return Ok(graph);
    }
    for path in sorted(source)? {
        let module = path.file_stem().unwrap_or_default().to_string_lossy();
        let rust = path.is_dir() || path.extension().is_some_and(|extension| extension == "rs");
        if rust && !["lib", "main", "bin"].contains(&&*module) {
            let imports = graph.entry(module.into_owned()).or_default();
            gather(&path, imports)?;
        }
    }
    let modules: BTreeSet<String> = graph.keys().cloned().collect();
    for (module, imports) in &mut graph {
        imports.retain(|import| modules.contains(import) && import != module);
    }
    Ok(graph)
}

/// Adds what the file, or the files of the folder, import.
fn gather(path: &Path, imports: &mut BTreeSet<String>) -> Result<(), Box<dyn Error>> {
    if path.is_dir() {
        return sorted(path)?
            .iter()
            .try_for_each(|path| gather(path, imports));
    }
    if path.extension().is_some_and(|extension| extension == "rs") {
        let file = syn::parse_file(&std::fs::read_to_string(path)?)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        Imports(imports).visit_file(&file);
    }
    Ok(())
}

/// Whether a module imports itself, through others.
fn reaches(graph: &Graph, module: &str) -> bool {
    let (mut seen, mut next) = (BTreeSet::new(), vec![module]);
    while let Some(at) = next.pop() {
        for import in graph.get(at).into_iter().flatten() {
            if import == module {
                return true;
            }
            if seen.insert(import) {
                next.push(import);
            }
        }
    }
    false
}

/// Gathers the first name behind `crate::`.
struct Imports<'a>(&'a mut BTreeSet<String>);

impl<'ast> Visit<'ast> for Imports<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Mod(item) => &item.attrs[..],
            Item::Use(item) => &item.attrs[..],
            Item::Fn(item) => &item.attrs[..],
            _ => &[],
        };
        if !attributes.iter().any(is_test) {
            visit::visit_item(self, item);
        }
    }

    fn visit_use_tree(&mut self, tree: &'ast UseTree) {
        match tree {
            UseTree::Path(path) if path.ident == "crate" => self.first(&path.tree),
            UseTree::Group(group) => group
                .items
                .iter()
                .for_each(|tree| self.visit_use_tree(tree)),
            _ => {}
        }
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        // What a macro is given need not be Rust; paths in it are spelt out by their tokens.
        let tokens = call.tokens.to_string();
        let after = tokens.split("crate :: ").skip(1);
        let names = after.filter_map(|rest| {
            rest.split(|c: char| !(c.is_alphanumeric() || c == '_'))
                .next()
        });
        self.0.extend(names.map(str::to_owned));
        visit::visit_macro(self, call);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let mut names = path.segments.iter().map(|segment| &segment.ident);
        if names.next().is_some_and(|first| first == "crate") {
            self.0.extend(names.next().map(ToString::to_string));
        }
        visit::visit_path(self, path);
    }
}

impl Imports<'_> {
    fn first(&mut self, tree: &UseTree) {
        match tree {
            UseTree::Path(path) => {
                self.0.insert(path.ident.to_string());
            }
            UseTree::Name(name) => {
                self.0.insert(name.ident.to_string());
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.first(tree)),
            UseTree::Rename(_) | UseTree::Glob(_) => {}
        }
    }
}

fn is_test(attribute: &Attribute) -> bool {
    let cfg_test = |tokens: &str| tokens.replace(' ', "") == "test";
    match &attribute.meta {
        syn::Meta::List(list) => list.path.is_ident("cfg") && cfg_test(&list.tokens.to_string()),
        syn::Meta::Path(path) => path.is_ident("test"),
        syn::Meta::NameValue(_) => false,
    }
}

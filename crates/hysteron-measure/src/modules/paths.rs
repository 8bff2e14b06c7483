//! The paths that a file names.

use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

/// A module's place: its names from the crate's root on. The root has none.
pub(super) type ModulePath = Vec<String>;

/// What a file imports and re-exports, by paths from the crate's root on.
#[derive(Default)]
pub(super) struct Found {
    /// The paths that it names.
    pub(super) imports: BTreeSet<ModulePath>,
    /// For each name that it re-exports, the path of it.
    pub(super) exports: BTreeMap<String, ModulePath>,
    /// The modules of it that only tests have.
    pub(super) tests: Vec<ModulePath>,
}

/// The paths in a file, whose module stands at `place`.
pub(super) fn gather(file: &syn::File, place: &[String]) -> Found {
    let mut paths = Paths {
        place,
        found: Found::default(),
    };
    paths.visit_file(file);
    paths.found
}

struct Paths<'a> {
    place: &'a [String],
    found: Found,
}

impl Paths<'_> {
    /// The path from the root on. One that begins with a word of its own may name a module below.
    /// `None` for more `super` than there are folders.
    fn rooted(&self, names: &[String]) -> Option<ModulePath> {
        let up = names.iter().take_while(|name| *name == "super").count();
        let (base, rest) = match names.first().map(String::as_str) {
            Some("crate") => (&[][..], &names[1..]),
            Some("self") => (self.place, &names[1..]),
            Some("super") => (
                &self.place[..self.place.len().checked_sub(up)?],
                &names[up..],
            ),
            _ => (self.place, names),
        };
        Some([base, rest].concat())
    }

    /// Adds the leaves of a `use`. Those of a public one are re-exports, too.
    fn leaves(&mut self, tree: &UseTree, before: &[String], is_public: bool) {
        let joined = |name: &syn::Ident| [before, &[name.to_string()]].concat();
        let (names, called) = match tree {
            UseTree::Path(path) => return self.leaves(&path.tree, &joined(&path.ident), is_public),
            UseTree::Group(group) => {
                return group
                    .items
                    .iter()
                    .for_each(|tree| self.leaves(tree, before, is_public));
            }
            UseTree::Name(name) if name.ident == "self" => {
                (before.to_vec(), before.last().cloned())
            }
            UseTree::Name(name) => (joined(&name.ident), Some(name.ident.to_string())),
            UseTree::Rename(name) => (joined(&name.ident), Some(name.rename.to_string())),
            UseTree::Glob(_) => (before.to_vec(), None),
        };
        let Some(path) = self.rooted(&names) else {
            return;
        };
        match called {
            Some(called) if is_public => {
                self.found.exports.insert(called, path);
            }
            _ => {
                self.found.imports.insert(path);
            }
        }
    }
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Mod(item) => &item.attrs[..],
            Item::Use(item) => &item.attrs[..],
            Item::Fn(item) => &item.attrs[..],
            _ => &[],
        };
        if !attributes.iter().any(is_test) {
            visit::visit_item(self, item);
        } else if let Item::Mod(module) = item {
            let name = module.ident.to_string();
            self.found.tests.push([self.place, &[name]].concat());
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.leaves(&item.tree, &[], !matches!(item.vis, Visibility::Inherited));
    }

    fn visit_visibility(&mut self, _: &'ast Visibility) {
        // The path in `pub(super)` is no import.
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        // What a macro is given need not be Rust; paths in it are spelt out by their tokens.
        let tokens = call.tokens.to_string();
        for rest in tokens.split("crate :: ").skip(1) {
            let names = rest.split(" :: ").map_while(|word| {
                let end = word.find(|c: char| !(c.is_alphanumeric() || c == '_'));
                let name = &word[..end.unwrap_or(word.len())];
                (!name.is_empty()).then(|| name.to_owned())
            });
            self.found.imports.insert(names.collect());
        }
        visit::visit_macro(self, call);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: ModulePath = path
            .segments
            .iter()
            .map(|part| part.ident.to_string())
            .collect();
        if let Some(path) = self.rooted(&names) {
            self.found.imports.insert(path);
        }
        visit::visit_path(self, path);
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

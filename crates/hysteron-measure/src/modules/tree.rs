//! The modules of a crate, what they import and what they re-export.

use super::paths::{Found, ModulePath, gather};
use crate::result::Result;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The modules of a folder, and which of the others each imports.
pub(super) type Graph = BTreeMap<String, BTreeSet<String>>;

/// The modules of a crate.
pub(super) struct Tree(BTreeMap<ModulePath, Found>);

/// The module of a folder that stands for the folder itself.
const OWN: &str = "mod.rs";

impl Tree {
    /// Reads the modules below a folder `src`.
    pub(super) fn read(source: &Path) -> Result<Self> {
        let mut modules = BTreeMap::new();
        read_folder(source, &[], &mut modules)?;
        let tests: Vec<ModulePath> = modules
            .values()
            .flat_map(|found| found.tests.clone())
            .collect();
        modules.retain(|place, _| !tests.iter().any(|test| place.starts_with(test)));
        Ok(Tree(modules))
    }

    /// For each folder its place and the graph of its modules.
    pub(super) fn graphs(&self) -> BTreeMap<ModulePath, Graph> {
        let mut graphs: BTreeMap<ModulePath, Graph> = BTreeMap::new();
        for (place, found) in &self.0 {
            for path in &found.imports {
                let to = self.definer(path, 0);
                let shared = place.iter().zip(&to).take_while(|(a, b)| a == b).count();
                let name =
                    |place: &ModulePath| place.get(shared).map_or(OWN, String::as_str).to_owned();
                let (from, to) = (name(place), name(&to));
                if from != to {
                    let graph = graphs.entry(place[..shared].to_vec()).or_default();
                    graph.entry(from).or_default().insert(to);
                }
            }
        }
        graphs
    }

    /// The module that defines what a path names. `depth` counts the re-exports on the way.
    fn definer(&self, path: &[String], depth: usize) -> ModulePath {
        let within = (0..=path.len())
            .rev()
            .find(|n| self.0.contains_key(&path[..*n]))
            .unwrap_or(0);
        let (module, rest) = path.split_at(within);
        let exported = rest
            .first()
            .and_then(|name| self.0.get(module)?.exports.get(name));
        match exported {
            // A name that is re-exported in a circle does not compile; ten is more than enough.
            Some(further) if depth < 10 => {
                self.definer(&[&further[..], &rest[1..]].concat(), depth + 1)
            }
            _ => module.to_vec(),
        }
    }
}

fn read_folder(
    folder: &Path,
    place: &[String],
    modules: &mut BTreeMap<ModulePath, Found>,
) -> Result<()> {
    for path in sorted(folder)? {
        let stem = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let below = [place, std::slice::from_ref(&stem)].concat();
        if path.is_dir() {
            read_folder(&path, &below, modules)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let own = ["mod", "lib", "main"].contains(&&*stem);
            let place = if own { place.to_vec() } else { below };
            let file = syn::parse_file(&std::fs::read_to_string(&path)?)
                .map_err(|error| format!("{}: {error}", path.display()))?;
            let found = gather(&file, &place);
            modules.insert(place, found);
        }
    }
    Ok(())
}

/// The files and folders in a folder, by name.
pub(super) fn sorted(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    Ok(paths)
}

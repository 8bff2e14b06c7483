//! C99 with the model as constants.

mod constants;
mod name;
mod seal;
mod text;

use constants::{Constants, Number};
use hysteron::{AtomicFile, AtomicFolder, Destination, Error, Model, Own, Remedy, Result, Setting};
use std::path::{Path, PathBuf};

/// Names and texts of the algorithm's files, the first with the number type.
const ALGORITHM: [(&str, &str); 4] = [
    ("hysteron_mcu.h", HEADER),
    ("hysteron_mcu.c", include_str!("../mcu/hysteron_mcu.c")),
    (
        "hysteron_mcu_inverse.c",
        include_str!("../mcu/hysteron_mcu_inverse.c"),
    ),
    (
        "hysteron_mcu_internal.h",
        include_str!("../mcu/hysteron_mcu_internal.h"),
    ),
];
const HEADER: &str = include_str!("../mcu/hysteron_mcu.h");

/// The same for models that learn.
const ADAPTATION: [(&str, &str); 2] = [
    (
        "hysteron_mcu_adapt.h",
        include_str!("../mcu/hysteron_mcu_adapt.h"),
    ),
    (
        "hysteron_mcu_adapt.c",
        include_str!("../mcu/hysteron_mcu_adapt.c"),
    ),
];

/// The licence of the algorithm. The model in the files belongs to its maker.
const LICENCE: &str =
    "Copyright (c) 2026 the hysteron developers. SPDX-License-Identifier: MIT OR Apache-2.0";

/// The number type that the C computes in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CReal {
    /// `float`, for processors with a unit for it, such as a Cortex-M4F.
    #[default]
    Float,
    /// `double`, the digits of the library itself.
    Double,
}

impl CReal {
    /// The type's name in C.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Double => "double",
        }
    }

    /// The line of the header that says it.
    fn line(self) -> String {
        format!("typedef {} hys_real;", self.name())
    }
}

/// How to write a model as C.
#[derive(Debug, Clone, Copy)]
pub struct COptions<'a> {
    /// The number type.
    pub real: CReal,
    /// The model's name in C, and of its files; by default that of `source`, as a C identifier.
    pub name: Option<&'a str>,
    /// The file that the model comes from, named in a comment.
    pub source: &'a Path,
    /// Whether the model can learn on the target.
    pub adaptation: bool,
}

/// What was written, and what it needs on the target.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CExport {
    /// The files.
    pub files: Vec<PathBuf>,
    /// The model's name in C.
    pub name: String,
    /// The number type.
    pub real: CReal,
    /// `K`.
    pub levels: usize,
    /// Whether there is an inverse: no weight is below zero.
    pub inverse: bool,
    /// Bytes.
    pub memory: CMemory,
    /// The worst case of one call.
    pub worst_case: CWorstCase,
}

/// Bytes of a model on a 32-bit target with naturally aligned numbers, such as a Cortex-M.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CMemory {
    /// The model's constants: flash.
    pub constants: usize,
    /// A state: RAM.
    pub state: usize,
    /// Its turning points: RAM.
    pub turns: usize,
    /// For a model that learns: the additional memory, without its turning points. RAM.
    pub adaptation: Option<usize>,
}

/// How many iterations the loops of one call take at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CWorstCase {
    /// Turning points passed in a step, `2K`.
    pub turning_points: usize,
    /// Iterations of the step's loop, `2K + 3`.
    pub step: usize,
    /// Halvings of an inverse step's two bisections together, before it steps.
    pub halvings: usize,
}

impl CWorstCase {
    fn of(levels: usize) -> Self {
        // A bisection of n places takes ⌊log₂ n⌋ + 1 halvings.
        let halvings = |places: usize| places.ilog2() as usize + 1;
        Self {
            turning_points: 2 * levels,
            step: 2 * levels + 3,
            halvings: halvings(2 * levels + 1) + halvings(levels),
        }
    }
}

/// Writes C99 for `model` into the folder `target`, which is made if need be: the algorithm as
/// `hysteron_mcu.h`, `.c` and `hysteron_mcu_inverse.c`, the same for every model of a number type,
/// and the model's constants as files of its name. With [`COptions::adaptation`] also
/// `hysteron_mcu_adapt.h` and `.c`, by which the model's weights follow the plant as with
/// [`hysteron_core::Method::Gradient`].
///
/// The C gives the digits of [`hysteron_core::Model`] in the same number type, with offset and sign
/// in that type as well. A model with negative weights has no inverse there either.
///
/// Files that were exported before, and not edited since, are replaced, all together or not at all.
/// A path alone as `target` replaces others of their names too; [`Destination::keeping_foreign`]
/// keeps them.
///
/// # Errors
/// [`Error::Export`] for a model with a load or a thermal body, or that does not fit the number
/// type; for a name that cannot be one in C; for files in the folder that are of the other number
/// type. [`Error::File`].
pub fn c<'a>(
    model: &Model,
    target: impl Into<Destination<'a>>,
    options: &COptions<'_>,
) -> Result<CExport> {
    let target = target.into();
    model.plain()?;
    let name = name::choose(options.name, options.source)?;
    match options.real {
        CReal::Float => write::<f32>(model, target, options, name),
        CReal::Double => write::<f64>(model, target, options, name),
    }
}

fn write<T: Number>(
    model: &Model,
    target: Destination<'_>,
    options: &COptions<'_>,
    name: String,
) -> Result<CExport> {
    let constants = Constants::<T>::of(model)?;
    if options.adaptation && constants.rounding.is_none() {
        let what = "adaptation keeps weights at zero or above, but there are some below zero";
        let remedy = Remedy::new("fit with {}", [Setting::word("solver", "nnls")]);
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    let levels = model.plane().levels();
    let parts: &[&[(&str, &str)]] = match options.adaptation {
        false => &[&ALGORITHM],
        true => &[&ALGORITHM, &ADAPTATION],
    };
    let algorithm = parts.concat();
    let own = ["h", "c"].map(|end| format!("{name}.{end}"));
    let files = algorithm.iter().map(|(file, _)| *file);
    let files = files.chain(own.iter().map(String::as_str));
    let export = CExport {
        files: files.map(|file| target.path().join(file)).collect(),
        name,
        real: options.real,
        levels,
        inverse: constants.rounding.is_some(),
        memory: constants.memory(options.adaptation),
        worst_case: CWorstCase::of(levels),
    };
    let version = env!("CARGO_PKG_VERSION");
    let (float, wanted) = (CReal::Float.line(), options.real.line());
    let texts = algorithm.iter().map(|(_, text)| {
        let text = text.replace(&float, &wanted);
        format!("/* hysteron {version}.\n * {LICENCE} */\n{text}")
    });
    let mut texts: Vec<String> = texts.collect();
    texts.push(text::header(&export, &constants, model, options.source));
    texts.push(text::source(&export, &constants));
    for path in &export.files {
        refuse_other_type(path, options.real)?;
    }
    let mut folder = AtomicFolder::create(target, Some(Own::Marked(seal::is_whole)))?;
    for (path, text) in export.files.iter().zip(texts) {
        let name = path.file_name().unwrap_or_default();
        folder.file(name, |path| {
            AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(seal::sealed(&text).as_bytes())
        })?;
    }
    folder.commit()?;
    Ok(export)
}

/// Refuses to replace the algorithm that models of the other number type in the folder need.
fn refuse_other_type(path: &Path, real: CReal) -> Result<()> {
    let other = match real {
        CReal::Float => CReal::Double,
        CReal::Double => CReal::Float,
    };
    // What cannot be read is refused where it would be replaced.
    let found = std::fs::read(path).unwrap_or_default();
    if String::from_utf8_lossy(&found).contains(&other.line()) {
        let name = other.name();
        let what = format!(
            "{}: the models in this folder are of {name}",
            path.display()
        );
        let words = "name another folder, or export with {}";
        let remedy = Remedy::new(words, [Setting::word("real", name)]);
        return Err(Error::Export(what).remedied(remedy));
    }
    Ok(())
}

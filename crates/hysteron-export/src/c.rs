//! C99 with the model as constants.

mod constants;
mod learners;
mod name;
mod rounding;
mod seal;
mod stage_text;
mod stages;
mod text;

use constants::{Constants, Number};
use hysteron::{AtomicFile, AtomicFolder, Destination, Error, Model, Own, Remedy, Result, Setting};
use learners::Learners;
pub use stages::CSampling;
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
const ADAPTATION: [(&str, &str); 5] = [
    (
        "hysteron_mcu_adapt.h",
        include_str!("../mcu/hysteron_mcu_adapt.h"),
    ),
    (
        "hysteron_mcu_adapt.c",
        include_str!("../mcu/hysteron_mcu_adapt.c"),
    ),
    (
        "hysteron_mcu_guards.h",
        include_str!("../mcu/hysteron_mcu_guards.h"),
    ),
    (
        "hysteron_mcu_increments.h",
        include_str!("../mcu/hysteron_mcu_increments.h"),
    ),
    (
        "hysteron_mcu_least_squares.h",
        include_str!("../mcu/hysteron_mcu_least_squares.h"),
    ),
];

/// The same for models with stages.
const STAGES: [(&str, &str); 5] = [
    (
        "hysteron_mcu_stages.h",
        include_str!("../mcu/hysteron_mcu_stages.h"),
    ),
    (
        "hysteron_mcu_stages.c",
        include_str!("../mcu/hysteron_mcu_stages.c"),
    ),
    (
        "hysteron_mcu_stages_inverse.c",
        include_str!("../mcu/hysteron_mcu_stages_inverse.c"),
    ),
    (
        "hysteron_mcu_behind.h",
        include_str!("../mcu/hysteron_mcu_behind.h"),
    ),
    (
        "hysteron_mcu_stages_internal.h",
        include_str!("../mcu/hysteron_mcu_stages_internal.h"),
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
#[derive(Debug, Clone, PartialEq)]
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
    /// What a target may be missed by that the inverse reports as reached, beside its tolerance, in
    /// the output's unit: the rounding of the number type, at most a thousandth of the range of
    /// outputs. Zero without an inverse.
    pub rounding: f64,
    /// The stages around the operators, in the order of the signal: `body`, `load`, `spacing`,
    /// and so on.
    pub stages: Vec<&'static str>,
    /// The sample time in seconds that the constants hold for, where the model depends on time.
    pub dt: Option<f64>,
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
    /// Of it, the operators at the present load, where the weights depend on the load.
    pub mixed: usize,
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
/// `hysteron_mcu_adapt.h`, `.c` and what they include, by which the model follows the plant as with
/// the learners [`hysteron::Learner::Increments`], `Drift` and `LeastSquares`, with the digits of
/// [`hysteron_core::Estimator`].
///
/// The C gives the digits of [`hysteron_core::Model`] in the same number type, with offset and sign
/// in that type as well. A model with negative weights has no inverse there either.
///
/// For a model with stages, or one that starts where its fit found it, see [`c_sampled`].
///
/// Files that were exported before, and not edited since, are replaced, all together or not at all.
/// A path alone as `target` replaces others of their names too; [`Destination::keeping_foreign`]
/// keeps them.
///
/// # Errors
/// [`Error::Export`] for a model that depends on time, or has weights of more than the seventh
/// order in a load, or does not fit the number type, be it that its rounding would be more than a
/// thousandth of the range of outputs ([`CExport::rounding`]); for a name that cannot be one in C; for files
/// in the folder that are of the other number type. [`Error::File`].
pub fn c<'a>(
    model: &Model,
    target: impl Into<Destination<'a>>,
    options: &COptions<'_>,
) -> Result<CExport> {
    c_sampled(model, target, options, &CSampling::default())
}

/// As [`c()`], for a model that depends on time: with its sample time, and with the range of the
/// drive.
///
/// A model with stages has the algorithm of the stages too: `hysteron_mcu_stages.h`, `.c` and
/// `hysteron_mcu_stages_inverse.c`. The C then gives the digits of
/// [`hysteron_core::Stages::step_at`] and [`hysteron_core::Stages::invert_at`] in the same number
/// type. The factors of the sample time are constants, so it needs no library either. The load is
/// an argument of each step. Where the weights depend on it, a state has memory for the table of
/// one load, which [`hysteron_core::mix`] makes of the parts' tables here and there.
///
/// ```
/// use hysteron::{FirstOrder, Model, Operator, Plane, Sign};
/// use hysteron_export::{COptions, CReal, CSampling, c_sampled};
/// let plane = Plane::new(20.0, 80.0, 3)?;
/// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
/// let body = FirstOrder { tau_heating: 2.0, tau_cooling: 4.0, ..FirstOrder::default() };
/// model.thermal = Some(body);
/// let folder = tempfile::tempdir()?;
/// let options = COptions {
///     real: CReal::Float,
///     name: Some("wire"),
///     source: "wire.json".as_ref(),
///     adaptation: false,
/// };
/// let sampling = CSampling { dt: Some(0.01), drive: Some((0.0, 100.0)) };
/// let made = c_sampled(&model, folder.path(), &options, &sampling)?;
/// assert_eq!((made.stages, made.dt), (vec!["body"], Some(0.01)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`c()`]; [`Error::Export`] too for a sample time that is missing or not needed, a range of
/// the drive that is not in order, and for adaptation of a model with stages.
pub fn c_sampled<'a>(
    model: &Model,
    target: impl Into<Destination<'a>>,
    options: &COptions<'_>,
    sampling: &CSampling,
) -> Result<CExport> {
    let target = target.into();
    let (mut export, texts) = c_texts(model, options, sampling)?;
    for file in &mut export.files {
        *file = target.path().join(&*file);
        refuse_other_type(file, options.real)?;
    }
    let mut folder = AtomicFolder::create(target, Some(Own::Marked(seal::is_whole)))?;
    for (path, text) in export.files.iter().zip(texts) {
        let name = path.file_name().unwrap_or_default();
        folder.file(name, |path| {
            AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(text.as_bytes())
        })?;
    }
    folder.commit()?;
    Ok(export)
}

/// As [`c_sampled`], in memory: the texts of the files, in the order of [`CExport::files`], which
/// are then names without a folder.
///
/// # Errors
/// As [`c_sampled`], but for files.
pub fn c_texts(
    model: &Model,
    options: &COptions<'_>,
    sampling: &CSampling,
) -> Result<(CExport, Vec<String>)> {
    let name = name::choose(options.name, options.source)?;
    match options.real {
        CReal::Float => texts::<f32>(model, options, name, sampling),
        CReal::Double => texts::<f64>(model, options, name, sampling),
    }
}

fn texts<T: Number>(
    model: &Model,
    options: &COptions<'_>,
    name: String,
    sampling: &CSampling,
) -> Result<(CExport, Vec<String>)> {
    let constants = Constants::<T>::of(model, sampling)?;
    if options.adaptation && constants.stages.is_some() {
        let what = "a model with stages cannot learn on the target";
        let remedy = Remedy::new("export it without {}", [Setting::on("adaptation")]);
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    if options.adaptation && constants.rounding.is_none() {
        let what = "adaptation keeps weights at zero or above, but there are some below zero";
        let remedy = Remedy::new("fit with {}", [Setting::word("solver", "nnls")]);
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    let learners = match options.adaptation {
        true => Some(Learners::of(model, &constants)?),
        false => None,
    };
    let learned = learners.as_ref().map(|learners| learners.text(&name));
    let learns = learners.map(|learners| (learners.constants(), learners.numbers()[0]));
    let levels = model.plane().levels();
    let parts: &[&[(&str, &str)]] = match (options.adaptation, &constants.stages) {
        (true, _) => &[&ALGORITHM, &ADAPTATION],
        (_, Some(_)) => &[&ALGORITHM, &STAGES],
        _ => &[&ALGORITHM],
    };
    let algorithm = parts.concat();
    let own = ["h", "c"].map(|end| format!("{name}.{end}"));
    let files = algorithm.iter().map(|(file, _)| *file);
    let files = files.chain(own.iter().map(String::as_str));
    let export = CExport {
        files: files.map(PathBuf::from).collect(),
        name,
        real: options.real,
        levels,
        inverse: constants.rounding.is_some(),
        rounding: constants.missed.unwrap_or_default(),
        stages: constants
            .stages
            .as_ref()
            .map_or_else(Vec::new, |stages| stages.names()),
        dt: sampling.dt,
        memory: constants.memory(learns),
        worst_case: CWorstCase::of(levels),
    };
    let version = env!("CARGO_PKG_VERSION");
    let (float, wanted) = (CReal::Float.line(), options.real.line());
    let texts = algorithm.iter().map(|(_, text)| {
        let text = text.replace(&float, &wanted);
        format!("/* hysteron {version}.\n * {LICENCE} */\n{text}")
    });
    let mut texts: Vec<String> = texts.collect();
    let (source, learned) = (options.source, learned.as_ref());
    texts.push(text::header(&export, &constants, model, source, learned));
    texts.push(text::source(&export, &constants, learned));
    let sealed = texts.iter().map(|text| seal::sealed(text)).collect();
    Ok((export, sealed))
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

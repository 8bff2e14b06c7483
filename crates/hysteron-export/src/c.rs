//! C99 with the model as constants.

mod algorithm;
mod build;
mod constants;
mod control;
mod delay;
mod learners;
mod name;
mod notation;
mod parts;
mod real;
mod rounding;
mod seal;
mod stage_text;
mod stages;
mod text;
mod written;

use algorithm::{ADAPTATION, ALGORITHM, CONTROL, CONTROL_STAGES, DELAY, SHADOW, STAGES};
use constants::Constants;
use hysteron::control::Scheme;
use hysteron::{Destination, Error, Model, Remedy, Result, Setting};
use hysteron_files::{AtomicFile, AtomicFolder, Own};
use learners::Learners;
use parts::Parts;
pub use real::CReal;
use real::Number;
use seal::Comment;
pub use stages::CSampling;
use std::path::{Path, PathBuf};
pub use written::{CExport, CMemory, CWorstCase};

/// The licence of the algorithm. The model in the files belongs to its maker.
pub(crate) const LICENCE: &str =
    "Copyright (c) 2026 the hysteron developers. SPDX-License-Identifier: MIT OR Apache-2.0";

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

/// Writes C99 for `model` into the folder `target`, which is made if need be: the algorithm as
/// `hysteron_mcu.h`, `.c` and `hysteron_mcu_inverse.c`, the same for every model of a number type,
/// and the model's constants as files of its name. `NAME.mk` builds them with make for a Cortex-M0+,
/// a Cortex-M4F, RISC-V or this machine; `NAME.cmake` makes a target for CMake of them. With
/// [`COptions::adaptation`] also
/// `hysteron_mcu_adapt.h`, `.c` and what they include, by which the model follows the plant as with
/// the learners [`hysteron::Learner::Increments`], `Drift` and `LeastSquares`, with the digits of
/// [`hysteron_core::Estimator`].
///
/// The C gives the digits of [`hysteron_core::Model`] in the same number type, with offset and sign
/// in that type as well. A model with negative weights has no inverse there either.
///
/// For a model with stages, or one that starts where its fit found it, see [`c_sampled`]. One with a
/// dead time ([`Model::delay`]) has `hysteron_mcu_delay.h`, `.c` too, which delay its inputs by
/// `NAME_LATE` samples.
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
/// let sampling = CSampling {
///     dt: Some(0.01),
///     drive: Some((0.0, 100.0)),
///     ..CSampling::default()
/// };
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
    write(target.into(), c_texts(model, options, sampling)?, options)
}

/// As [`c_sampled`], with a control loop around the model: `hysteron_mcu_control.h`, `.c`, with
/// stages `hysteron_mcu_control_stages.c`, and its settings as `NAME_control`. The C gives the digits
/// of [`hysteron::control::Controller`] with the fixed model as its compensator, which
/// stands in the place of that of `scheme`. An inner loop is not to be had there. A filter, a gate
/// and measured time ([`CSampling::measured`]) have code and memory only where they are asked for;
/// all models of a folder need the same of them. With [`COptions::adaptation`] a learner runs in the shadow of the fixed model
/// (`hysteron_mcu_shadow.h`, `.c`), as in [`hysteron::control::Compensator::shadowed`].
///
/// # Errors
/// As [`c_sampled`]; [`Error::Export`] too for a model with a load or without an inverse, and for
/// settings that the target does not have.
pub fn c_controlled<'a>(
    model: &Model,
    target: impl Into<Destination<'a>>,
    options: &COptions<'_>,
    sampling: &CSampling,
    scheme: &Scheme,
) -> Result<CExport> {
    let texts = c_texts_controlled(model, options, sampling, Some(scheme), false)?;
    write(target.into(), texts, options)
}

fn write(
    target: Destination<'_>,
    (mut export, mut texts): (CExport, Vec<String>),
    options: &COptions<'_>,
) -> Result<CExport> {
    for (file, text) in build::files(&export) {
        export.files.push(file.into());
        texts.push(text);
    }
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

/// As [`c_sampled`], in memory: the texts of the files of C, in the order of [`CExport::files`],
/// which are then names without a folder.
///
/// # Errors
/// As [`c_sampled`], but for files.
pub fn c_texts(
    model: &Model,
    options: &COptions<'_>,
    sampling: &CSampling,
) -> Result<(CExport, Vec<String>)> {
    c_texts_controlled(model, options, sampling, None, false)
}

/// As [`c_controlled`], in memory; with `alone`, the code of the stages is for this model alone.
///
/// # Errors
/// As [`c_controlled`], but for files.
pub(crate) fn c_texts_controlled(
    model: &Model,
    options: &COptions<'_>,
    sampling: &CSampling,
    scheme: Option<&Scheme>,
    alone: bool,
) -> Result<(CExport, Vec<String>)> {
    let name = name::choose(options.name, options.source)?;
    match options.real {
        CReal::Float => texts::<f32>(model, options, name, sampling, (scheme, alone)),
        CReal::Double => texts::<f64>(model, options, name, sampling, (scheme, alone)),
    }
}

fn texts<T: Number>(
    model: &Model,
    options: &COptions<'_>,
    name: String,
    sampling: &CSampling,
    (scheme, alone): (Option<&Scheme>, bool),
) -> Result<(CExport, Vec<String>)> {
    if sampling.measured && scheme.is_none() {
        let remedy = Remedy::new("leave {} out", [Setting::on("measured-dt")]);
        let what = "measured time is for a controller";
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    let constants = Constants::<T>::new(model, sampling)?;
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
    // A controller has inputs under way of its own.
    let dead = model.delay().at(sampling.dt);
    let dead = Some(dead).filter(|dead| *dead > 0 && scheme.is_none());
    let around = match scheme {
        None => dead.map(|dead| delay::text(&name, dead)),
        Some(scheme) => {
            control::check(scheme, model, &constants, sampling.dt)?;
            let staged = constants.stages.as_ref();
            let parts = Parts::of(scheme, sampling.measured, model.is_timed());
            let mut around = control::text::<T>(scheme, model, &name, staged, parts)?;
            if options.adaptation {
                around.include = Some(SHADOW[0].0);
            }
            Some(around)
        }
    };
    let looped = scheme.map(|scheme| {
        let parts = Parts::of(scheme, sampling.measured, model.is_timed());
        (control::late(scheme, model), parts)
    });
    let learns = learners.map(|learners| (learners.constants(), learners.numbers()[0]));
    let levels = model.plane().levels();
    let parts: &[&[(&str, &str)]] = match (options.adaptation, &constants.stages) {
        (true, _) => &[&ALGORITHM, &ADAPTATION],
        (_, Some(_)) => &[&ALGORITHM, &STAGES],
        _ => &[&ALGORITHM],
    };
    let mut algorithm = parts.concat();
    if scheme.is_some() {
        algorithm.extend(CONTROL);
        algorithm.extend(constants.stages.iter().flat_map(|_| CONTROL_STAGES));
        algorithm.extend(looped.iter().flat_map(|(_, parts)| parts.files()));
        algorithm.extend(options.adaptation.then_some(SHADOW).iter().flatten());
    }
    algorithm.extend(dead.iter().flat_map(|_| DELAY));
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
        memory: constants.memory(4, learns, looped),
        avr: constants.memory(2, learns, looped),
        worst_case: CWorstCase::new(levels),
    };
    let version = env!("CARGO_PKG_VERSION");
    let (float, wanted) = (CReal::Float.line(), options.real.line());
    let texts = algorithm.iter().map(|(_, text)| {
        let text = text.replace(&float, &wanted);
        let text = match looped {
            Some((_, parts)) => algorithm::with_parts(&text, parts.bits()),
            None => text,
        };
        let text = match alone {
            true if options.adaptation => algorithm::with_tables_in_ram(&text),
            true => algorithm::with_stages(&text, &export.stages),
            false => text,
        };
        format!("/* hysteron {version}.\n * {LICENCE} */\n{text}")
    });
    let mut texts: Vec<String> = texts.collect();
    let (source, beside) = (options.source, (learned.as_ref(), around.as_ref()));
    texts.push(text::header(&export, &constants, model, source, beside));
    texts.push(text::source(&export, &constants, beside));
    let sealed = texts
        .iter()
        .map(|text| seal::sealed(text, Comment::Block))
        .collect();
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

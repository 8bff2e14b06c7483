//! A library for the Arduino IDE and PlatformIO.

mod board;
mod texts;

use crate::c::{CExport, COptions, CReal, CSampling, c_texts_controlled};
pub use board::{Board, BoardMemory};
use hysteron::control::Scheme;
use hysteron::{Destination, Error, Model, Remedy, Result, Setting};
use hysteron_files::{AtomicFile, AtomicFolder, Own};
use std::path::{Path, PathBuf};

/// How to write a model as a library for Arduino.
#[derive(Debug, Clone, Copy)]
pub struct ArduinoOptions<'a> {
    /// The library's name, and the model's in C; by default that of `source`, as a C identifier.
    pub name: Option<&'a str>,
    /// The file that the model comes from, named in a comment.
    pub source: &'a Path,
    /// What it has to fit.
    pub board: Board,
    /// Whether the model learns on the board, by increments, as with [`COptions::adaptation`].
    pub adaptation: bool,
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Arduino {
    /// The C in `src`. Its files are those of the library.
    pub export: CExport,
    /// What the sketch `standalone` needs on an AVR.
    pub memory: BoardMemory,
    /// Whether that sketch was written. It drives with a share of full power, so the drives of the
    /// loop have to lie between 0 and 1.
    pub standalone: bool,
}

/// Writes a library into the folder `target`: the C of [`crate::c_controlled`] in `float`, a sketch
/// by which `hysteron run` drives the board (`device`), and one that controls on the board alone
/// (`standalone`, see [`Arduino::standalone`]). On an AVR the tables of the model stay in flash.
///
/// What fits the board's memory is decided by arithmetic, before anything is written. Where the
/// model does not fit twice, the sketch does without the state that follows the drive. With
/// [`ArduinoOptions::adaptation`] `standalone` learns, and the tables are in RAM.
///
/// Files of an earlier export that were not edited since are replaced, all together or not at all. Its
/// `standalone` goes where this model has none; one that was edited is refused.
///
/// ```
/// use hysteron::control::{Gains, Safety, Scheme};
/// use hysteron::{Model, Operator, Plane, Sign};
/// use hysteron_export::{ArduinoOptions, Board, CSampling, arduino};
/// let plane = Plane::new(0.0, 1.0, 20)?;
/// let model = Model::new(Operator::Mkp, plane, vec![0.05; 210], 0.0, Sign::Positive)?;
/// let gains = Gains { gain: 0.02, integral_s: 0.5, derivative_s: 0.0 };
/// let safety = Safety { lost_s: Some(0.5), stuck_s: Some(1.0) };
/// let scheme = Scheme { pid: Some(gains), safety, ..Scheme::new(0.05, (0.0, 1.0)) };
/// let options = ArduinoOptions {
///     name: None,
///     source: "wire.json".as_ref(),
///     board: Board::Uno,
///     adaptation: false,
/// };
/// let folder = tempfile::tempdir()?;
/// let made = arduino(&model, folder.path(), &options, &CSampling::default(), &scheme)?;
/// assert!(made.memory.ram <= Board::Uno.ram().unwrap());
/// assert!(folder.path().join("examples/standalone/standalone.ino").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`crate::c_controlled`]; [`Error::Export`] for a model that does not fit the board.
pub fn arduino<'a>(
    model: &Model,
    target: impl Into<Destination<'a>>,
    options: &ArduinoOptions<'_>,
    sampling: &CSampling,
    scheme: &Scheme,
) -> Result<Arduino> {
    let target = target.into();
    if scheme.gate.is_some() || scheme.filter_s > 0.0 || sampling.measured {
        let what = "the sketches have no gate, no filter and no measured time";
        return Err(Error::Export(what.into()));
    }
    let c = COptions {
        real: CReal::Float,
        name: options.name,
        source: options.source,
        adaptation: options.adaptation,
    };
    let (mut export, sources) = c_texts_controlled(model, &c, sampling, Some(scheme), true)?;
    let memory = BoardMemory::of(&export, options.board).map_err(|what| {
        let fewer = [Setting::any("levels"), Setting::any("board")];
        let error = Error::Export(what);
        match options.adaptation {
            false => error.remedied(Remedy::new("fit with less {}, or name another {}", fewer)),
            true => {
                let [levels, board] = fewer;
                let settings = [levels, board, Setting::on("adaptation")];
                let words = "fit with less {}, name another {}, or export it without {}";
                error.remedied(Remedy::new(words, settings))
            }
        }
    })?;
    let standalone = 0.0 <= scheme.drives.0 && scheme.drives.1 <= 1.0;
    let written =
        standalone.then(|| texts::standalone(model, &export, memory.follows, options.board));
    let own = texts::files(&export, written);
    let names = export.files.iter().map(|file| Path::new("src").join(file));
    let all = names.zip(sources).chain(own);
    let mut folder = AtomicFolder::create(target, None)?;
    if !standalone {
        // One of another model would drive this one.
        folder.without(texts::ALONE)?;
    }
    let mut files = Vec::new();
    for (name, text) in all {
        folder.file(&name, |path| {
            AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(text.as_bytes())
        })?;
        files.push(target.path().join(name));
    }
    folder.commit()?;
    export.files = files.into_iter().collect::<Vec<PathBuf>>();
    Ok(Arduino {
        export,
        memory,
        standalone,
    })
}

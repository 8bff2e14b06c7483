//! An FMU: the model as a block for simulation tools.
//!
//! The binaries in it are the same for every model (`binaries/`, made from `hysteron-capi`); they
//! read the model from the FMU's resources.

mod binaries;
mod control;
mod description;
mod model_text;
mod options;
mod package;
mod sources;
mod staged;
mod units;
mod variables;

use hysteron::control::Scheme;
use hysteron::{Destination, Error, Model, Remedy, Result, Setting};
use hysteron_files::{AtomicFile, Own};
use options::Block;
pub use options::{Fmi, FmuOptions};
use sha2::{Digest, Sha256};
use sources::Sources;

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Fmu {
    /// The block's name.
    pub name: String,
    /// GUID, in FMI 3.0 the instantiation token: the same for the same model and options.
    pub token: String,
    /// Size of the file.
    pub bytes: usize,
    /// Names of the variables that are inputs.
    pub inputs: Vec<String>,
    /// Names of the variables that are outputs.
    pub outputs: Vec<String>,
    /// Names of the variables that are parameters.
    pub parameters: Vec<String>,
}

/// Writes an FMU of `model` to `target`, whose path must end with `.fmu`. A path alone replaces
/// whatever file is there.
///
/// A model that depends on time takes the communication step as its time step. One that depends on
/// a load has the load as an input. Of a model with a dead time the input acts so much later, in
/// communication steps; the inverse is asked for the output of then.
///
/// ```
/// use hysteron::{Model, Operator, Plane, Sign};
/// use hysteron_export::{FmuOptions, fmu};
/// let plane = Plane::new(20.0, 80.0, 3)?;
/// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
/// let folder = tempfile::tempdir()?;
/// let options = FmuOptions { inverse: true, ..FmuOptions::default() };
/// let made = fmu(&model, &options, &folder.path().join("sf_Inverse_MKP.fmu"))?;
/// assert_eq!(made.name, "sf_Inverse_MKP");
/// assert_eq!((&made.inputs[0][..], &made.outputs[0][..]), ("target", "input"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Export`] for weights of more than the seventh order in a load, a name that is no C
/// identifier or a path that does not end with `.fmu`; [`Error::Core`] for the inverse of a model
/// with weights below zero; [`Error::File`].
pub fn fmu<'a>(
    model: &Model,
    options: &FmuOptions,
    target: impl Into<Destination<'a>>,
) -> Result<Fmu> {
    write(model, options, block(options), target.into())
}

/// The block that is no controller.
fn block(options: &FmuOptions) -> Block<'static> {
    match options.inverse {
        false => Block::Forward,
        true => Block::Inverse,
    }
}

/// As [`fmu`], of a controller: the model and its inverse in a loop with the settings of `scheme`,
/// whose compensator the model is. From reference and reading it gives the drives of
/// [`hysteron::control::Controller`]. Its gains, limits and times are parameters of the block. The
/// sample time is the communication step. [`FmuOptions::inverse`] counts for nothing.
///
/// ```
/// use hysteron::control::{Gains, Scheme};
/// use hysteron::{Model, Operator, Plane, Sign};
/// use hysteron_export::{FmuOptions, fmu_controlled};
/// let plane = Plane::new(0.0, 1.0, 3)?;
/// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
/// let gains = Gains { gain: 0.02, integral_s: 0.5, derivative_s: 0.0 };
/// let scheme = Scheme { pid: Some(gains), ..Scheme::new(0.05, (0.0, 1.0)) };
/// let folder = tempfile::tempdir()?;
/// let target = folder.path().join("sf_Controller_MKP.fmu");
/// let made = fmu_controlled(&model, &scheme, &FmuOptions::default(), &target)?;
/// assert_eq!(made.inputs[..2], ["target", "measured"]);
/// assert_eq!(made.outputs, ["input", "status"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`fmu`]; [`Error::Export`] too for a model with a load, for an inner loop and for a gate
/// of zero, which is none here; as [`hysteron::control::Controller::new`].
pub fn fmu_controlled<'a>(
    model: &Model,
    scheme: &Scheme,
    options: &FmuOptions,
    target: impl Into<Destination<'a>>,
) -> Result<Fmu> {
    control::check(model, scheme)?;
    write(model, options, Block::Controller(scheme), target.into())
}

fn write(
    model: &Model,
    options: &FmuOptions,
    block: Block<'_>,
    target: Destination<'_>,
) -> Result<Fmu> {
    let path = target.path();
    if path
        .extension()
        .is_none_or(|end| !end.eq_ignore_ascii_case("fmu"))
    {
        let path = path.display();
        return Err(Error::Export(format!(
            "{path}: tools know an FMU by the end of its name: let it end with .fmu"
        )));
    }
    let (made, bytes) = bytes(model, options, block)?;
    AtomicFile::create(target, Own::Marked(package::is_ours))?.commit_with(&bytes)?;
    Ok(made)
}

/// As [`fmu`], in memory: the bytes of the file.
///
/// # Errors
/// As [`fmu`], but for its path.
pub fn fmu_bytes(model: &Model, options: &FmuOptions) -> Result<(Fmu, Vec<u8>)> {
    bytes(model, options, block(options))
}

fn bytes(model: &Model, options: &FmuOptions, block: Block<'_>) -> Result<(Fmu, Vec<u8>)> {
    staged::check(model)?;
    if !block.is_forward() {
        model.inverse()?;
    }
    let name = match (&options.name, block) {
        (Some(name), _) => identifier(name)?,
        (None, Block::Forward) => "sf_MKP",
        (None, Block::Inverse) => "sf_Inverse_MKP",
        (None, Block::Controller(_)) => "sf_Controller_MKP",
    };
    let variables = variables::all(model, block)?;
    let sources = Sources::new(model, block, options.fmi)?;
    let compiled = sources.iter().flat_map(Sources::compiled);
    let compiled: Vec<&str> = compiled.collect();
    let about = (options.fmi, block, compiled.as_slice());
    let describe = |token: &str| description::xml(model, (name, token), about, &variables);
    let text = |token: &str| model_text::write(model, block, token);
    let token = token(&describe("")?, &text("")?);
    let description = describe(&token)?;
    let files = package::Files {
        description,
        model_text: text(&token)?,
        model_json: model.to_json(),
        sources: sources.map_or_else(Vec::new, |sources| sources.files(name, &token)),
    };
    let bytes = package::zip(&files, name, options.fmi)?;
    let names = |causality| {
        let named = variables.iter().filter(|v| v.causality == causality);
        named.map(|v| v.name.clone()).collect()
    };
    let made = Fmu {
        name: name.into(),
        token,
        bytes: bytes.len(),
        inputs: names("input"),
        outputs: names("output"),
        parameters: names("parameter"),
    };
    Ok((made, bytes))
}

/// A UUID that follows from the content (version 8 of RFC 9562).
fn token(description: &str, model: &str) -> String {
    let hash = Sha256::new()
        .chain_update(description)
        .chain_update(model)
        .finalize();
    let mut bytes = [0; 16];
    bytes.copy_from_slice(&hash[..16]);
    bytes[6] = bytes[6] & 0x0f | 0x80;
    bytes[8] = bytes[8] & 0x3f | 0x80;
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    let parts = [
        &hex[..8],
        &hex[8..12],
        &hex[12..16],
        &hex[16..20],
        &hex[20..],
    ];
    format!("{{{}}}", parts.join("-"))
}

/// As many letters as MATLAB takes of a name; file systems take four times that.
const LONGEST: usize = 63;

/// A name that may stand in C, as the standards ask: files inside the FMU have it.
fn identifier(name: &str) -> Result<&str> {
    let refused = |why: &str| {
        let what = format!("`{name}` cannot be a block's name: {why}");
        let remedy = Remedy::new("choose one with {}", [Setting::any("name")]);
        Err(Error::Export(what).remedied(remedy))
    };
    if name.len() > LONGEST {
        let letters = name.len();
        return refused(&format!(
            "it has {letters} letters, and {LONGEST} are the most"
        ));
    }
    if crate::device::is_device(name) {
        return refused(crate::device::DEVICE);
    }
    let mut letters = name.chars();
    let first = letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if first && letters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Ok(name);
    }
    refused("it has to begin with a letter and to have letters, digits and underscores only")
}

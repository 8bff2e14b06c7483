//! What both exports refuse.

use hysteron::{Error, Model, Remedy, Result, Setting};

/// Refuses models that cannot be exported: a model is exported at one load and without a thermal
/// body.
pub(crate) fn check(model: &Model) -> Result<()> {
    if model.thermal.is_some() {
        let text = "the model has a thermal body, which needs the time of each sample: only the \
                    model behind it can be exported";
        return Err(Error::Export(text.into()));
    }
    if let Some(load) = &model.load {
        let (low, high) = load.range();
        let name = &load.quantity.name;
        let what = format!("the model depends on the load `{name}`, from {low} to {high}");
        let remedy = Remedy::new("name one with {}", [Setting::any("load")]);
        return Err(Error::Export(what).remedied(remedy));
    }
    Ok(())
}

/// Why [`is_device`] refuses.
pub(crate) const DEVICE: &str = "it is a device of Windows, which has no file of that name";

/// Whether Windows takes a file of that name, whatever its ending, for a device: exported files go
/// there too.
pub(crate) fn is_device(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let port = |rest: &str| matches!(rest.as_bytes(), [b'1'..=b'9']);
    ["con", "prn", "aux", "nul"].contains(&lower.as_str())
        || lower.strip_prefix("com").is_some_and(port)
        || lower.strip_prefix("lpt").is_some_and(port)
}

//! C99 with the model as constants.

use hysteron::{Model, Result};
use std::path::Path;

/// Writes C99 for `model` into `folder`.
///
/// # Errors
/// [`hysteron::Error::Export`] for a model that cannot be exported, [`hysteron::Error::File`].
pub fn c(model: &Model, _folder: &Path) -> Result<()> {
    crate::check(model)
}

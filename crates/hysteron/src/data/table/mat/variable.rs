//! What both kinds of MATLAB files hold.

/// Largest depth of nested structures that is read.
pub(super) const DEEPEST: usize = 16;

/// A numeric variable, with its values column by column. A field of a structure is named
/// `structure.field`.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
}

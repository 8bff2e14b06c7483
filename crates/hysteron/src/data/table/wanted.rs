//! Which columns of a table that is stored by columns are read.

use super::TableReader;
use std::cell::RefCell;
use std::rc::Rc;

/// The columns of numbers that are read: all of them while none is named.
#[derive(Clone, Default)]
pub(super) struct Wanted(Rc<RefCell<Vec<usize>>>);

impl Wanted {
    pub(super) fn contains(&self, column: usize) -> bool {
        let wanted = self.0.borrow();
        wanted.is_empty() || wanted.contains(&column)
    }
}

impl TableReader {
    /// Reads none but these columns of numbers from now on. A text or a MATLAB file is read as a
    /// whole all the same.
    pub(crate) fn read_only(&self, columns: impl Iterator<Item = super::Column>) {
        *self.wanted.0.borrow_mut() = columns.map(super::Column::place).collect();
    }
}

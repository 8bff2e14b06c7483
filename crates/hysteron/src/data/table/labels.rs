//! The column of labels of a table that holds several recordings: which of them a row belongs to.
//!
//! In text a label is the cell. In Parquet it may have any type, so it is read as a code, and the
//! texts of the codes are kept here: an integer beyond 2⁵³ stays what it is.

use super::names::{self, Found, Missing};
use super::{Source, TableReader};
use crate::error::Result;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

/// The labels of a table that is stored by columns.
#[derive(Clone)]
pub(super) struct Labels(Rc<Known>);

struct Known {
    /// The name that was asked for.
    asked: String,
    texts: RefCell<Vec<Vec<u8>>>,
    codes: RefCell<HashMap<Vec<u8>, usize>>,
    last: Cell<usize>,
}

/// A column of labels that was found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Label(usize);

impl Labels {
    pub(super) fn new(asked: &str) -> Self {
        Self(Rc::new(Known {
            asked: asked.to_owned(),
            texts: RefCell::default(),
            codes: RefCell::default(),
            last: Cell::new(0),
        }))
    }

    /// The code of a label: the same for the same bytes.
    pub(super) fn code(&self, label: &[u8]) -> f64 {
        let known = &*self.0;
        let mut texts = known.texts.borrow_mut();
        // Rows of one recording stand next to each other as a rule.
        if texts
            .get(known.last.get())
            .is_some_and(|text| text == label)
        {
            return known.last.get() as f64;
        }
        let mut codes = known.codes.borrow_mut();
        let code = *codes.entry(label.to_owned()).or_insert_with(|| {
            texts.push(label.to_owned());
            texts.len() - 1
        });
        known.last.set(code);
        code as f64
    }

    /// Index of the column of labels among all columns.
    pub(super) fn find(&self, names: &[String]) -> std::result::Result<usize, String> {
        let asked = &self.0.asked;
        if let Some(place) = names.iter().position(|name| name == asked) {
            return Ok(place);
        }
        match names::find(names, asked) {
            Ok(Found::Named(place) | Found::Taken(place)) => Ok(place),
            Err(Missing::Ambiguous(places)) => {
                let candidates: Vec<String> = places.iter().map(|&n| names[n].clone()).collect();
                Err(format!(
                    "`{asked}` may be {}: give the whole name",
                    names::list(candidates.iter())
                ))
            }
            Err(Missing::Unknown) => Err(format!(
                "no column `{asked}`: there are {}",
                names::list(names.iter())
            )),
        }
    }
}

impl TableReader {
    /// Finds the column of labels by its name. Of the columns of numbers, only those asked for
    /// before are read.
    ///
    /// # Errors
    /// As [`TableReader::column`].
    pub(crate) fn label(&mut self, name: &str) -> Result<Label> {
        match (&self.labels, &self.source) {
            (Some(_), Source::Numbers(numbers)) if !numbers.has_matrices() => {
                Ok(Label(self.header.len() - 1))
            }
            _ => Ok(Label(self.column(name)?.place())),
        }
    }

    /// The label of the current row; empty for an empty cell.
    pub(crate) fn label_text(&self, label: Label) -> String {
        self.with_label(label, |bytes| String::from_utf8_lossy(bytes).into_owned())
    }

    /// Whether the current row has this label.
    pub(crate) fn has_label(&self, label: Label, text: &str) -> bool {
        // Bytes that are no text are shown as another one.
        self.with_label(label, |bytes| bytes == text.as_bytes())
            || self.with_label(label, |bytes| String::from_utf8_lossy(bytes) == text)
    }

    fn with_label<T>(&self, label: Label, then: impl FnOnce(&[u8]) -> T) -> T {
        let numbers = match &self.source {
            Source::Text(text) => return then(text.cell(label.0)),
            Source::Numbers(numbers) => numbers,
        };
        let value = numbers.value(label.0).filter(|value| value.is_finite());
        match (value, &self.labels) {
            (None, _) => then(b""),
            (Some(code), Some(labels)) if !numbers.has_matrices() => {
                let texts = labels.0.texts.borrow();
                then(texts.get(code as usize).map_or(b"", Vec::as_slice))
            }
            (Some(value), _) => then(value.to_string().as_bytes()),
        }
    }
}

//! The stages around the operators of a block.

use super::lines::{Lines, Parsed};
use hysteron_core::{Constant, Error, Stages};

/// Their constants.
#[derive(Debug)]
pub(crate) struct Constants {
    /// The range of the drive in the inverse.
    pub(crate) drive: (f64, f64),
    /// In the order of [`Stages::declared`].
    lists: Vec<Vec<f64>>,
}

impl Constants {
    /// As the core takes them, with offset and sign of the output.
    pub(crate) fn core(&self, offset: f64, sign: f64) -> Result<Stages<'_, f64>, Error> {
        let mut lists = self.lists.iter();
        let stages = Stages::of_lists(|| lists.next().map_or(&[] as &[f64], Vec::as_slice))?;
        Ok(Stages {
            offset,
            falling: sign < 0.0,
            ..stages
        })
    }
}

/// What a model's text of version 2 has more.
pub(crate) struct More {
    pub(crate) first: (f64, f64),
    pub(crate) start: Option<(Vec<f64>, f64)>,
    pub(crate) stages: Constants,
}

impl More {
    /// Reads its lines: those of version 2, or one for each constant of a stage (`whole`).
    pub(crate) fn read(lines: &mut Lines<'_>, whole: bool) -> Parsed<Self> {
        let first = match lines.numbers("first")?[..] {
            [signal, load] => (signal, load),
            _ => return lines.fault("`first` and 2 numbers are expected"),
        };
        let start = match &lines.numbers("start")?[..] {
            [] => None,
            [input, points @ ..] => Some((points.to_vec(), *input)),
        };
        let constants = Stages::<f64>::declared().flat_map(|stage| stage.constants);
        let (of_body, others): (Vec<&Constant>, Vec<&Constant>) =
            constants.partition(|constant| constant.line_of_version_2() == Some("body"));
        let body = lines.numbers("body")?;
        if !(body.is_empty() || body.len() == of_body.len()) {
            return lines.fault(format!("`body` and {} numbers are expected", of_body.len()));
        }
        let drive = match lines.numbers("drive")?[..] {
            [] => (f64::NEG_INFINITY, f64::INFINITY),
            [low, high] if low <= high => (low, high),
            _ => return lines.fault("`drive` and 2 numbers in order are expected"),
        };
        let single = |n: usize| body.get(n).map_or(Vec::new(), |number| vec![*number]);
        let mut lists: Vec<Vec<f64>> = (0..of_body.len()).map(single).collect();
        for constant in others {
            lists.push(match constant.line_of_version_2() {
                Some(line) => lines.numbers(line)?,
                None if whole => lines.numbers(constant.name)?,
                None => Vec::new(),
            });
        }
        let stages = Constants { drive, lists };
        let built = stages.core(0.0, 1.0).map(|_| ());
        built.or_else(|error| lines.fault(error.to_string()))?;
        Ok(Self {
            first,
            start,
            stages,
        })
    }
}

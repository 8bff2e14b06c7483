//! Finds the columns of a table by name, and handles their units.

use super::clock::Order;
use super::names::{self, Found, Missing};
use super::time::{Time, TimeUnit};
use super::{Column, Remark, Source, TableReader};
use crate::data::recording::Repair;
use crate::error::Result;
use crate::recording::Quantity;

impl TableReader {
    /// Finds a column by the first of these rules that fits:
    /// 1. its exact name;
    /// 2. its name without unit, in upper or lower case;
    /// 3. its number, from 1;
    /// 4. the beginning of its name, if only one column begins so.
    ///
    /// A column found by rule 3 or 4 is reported in [`TableReader::remarks`].
    ///
    /// In a MATLAB file, a matrix `[TimeValues DataValues]` of two columns is also found under its
    /// own name, which means its data. The first column found decides the number of rows; shorter
    /// and longer columns are then left out.
    ///
    /// # Errors
    /// [`Error::Recording`](crate::Error::Recording) if no column or more than one fits (the error
    /// lists the candidates), or if the column does not have as many rows as the first one.
    pub fn column(&mut self, name: &str) -> Result<Column> {
        let place = self.find(name)?;
        match &mut self.source {
            Source::Text(text) => {
                text.ask(place);
                Ok(Column(place))
            }
            Source::Numbers(numbers) => {
                Ok(Column(numbers.keep_as_long_as(place, &mut self.header)))
            }
        }
    }

    /// As [`TableReader::column`], for a column of time. It is returned in seconds, also if its name
    /// or unit says that it is stored in another unit. Timestamps and seconds since 1970 are counted
    /// from the first row.
    ///
    /// # Errors
    /// As [`TableReader::column`].
    pub fn time_column(&mut self, name: &str) -> Result<Column> {
        let column = self.column(name)?;
        let time = Time::Unknown(self.time_unit(column));
        if let Some(unit) = time.other_unit() {
            self.remarks.push(Remark::Time {
                column: self.name(column).to_owned(),
                unit: unit.name.clone(),
            });
        }
        self.time = Some((column.0, time));
        Ok(column)
    }

    /// Reads the time of the current row.
    pub(super) fn read_time(&mut self) -> Result<()> {
        let Some((at, mut time)) = self.time.take() else {
            return Ok(());
        };
        let column = Column(at);
        let was_dated = time.is_dated();
        let mut read = Ok(());
        match &self.source {
            Source::Numbers(numbers) => {
                if let Some(number) = numbers.value(at).filter(|number| number.is_finite()) {
                    time.learn(number);
                }
            }
            Source::Text(_) => read = time.read(self.text(column).unwrap_or_default()),
        }
        if let (Err(_), Time::Stamps(clock, now)) = (read, &mut time) {
            let cell = self.text(column).unwrap_or_default();
            let Some(day_first) = self.day_first(column)? else {
                let problem = format!(
                    "`{}` may have the day first or the month, and no row tells which: write the \
                     dates as year-month-day",
                    super::shortened(cell),
                );
                return Err(self.fault(Some(column), problem));
            };
            clock.decided(day_first);
            *now = clock.read(cell).ok();
        }
        if time.is_dated() && !was_dated {
            let first = match &self.source {
                Source::Text(_) => self.text(column).unwrap_or_default().to_owned(),
                Source::Numbers(numbers) => numbers
                    .value(at)
                    .map_or(String::new(), |value| value.to_string()),
            };
            self.remarks.push(Remark::Dated {
                column: self.name(column).to_owned(),
                first: super::shortened(&first),
                unit: match &time {
                    Time::Epoch(unit, _) => Some(unit.name.clone()),
                    _ => None,
                },
            });
        }
        self.time = Some((at, time));
        Ok(())
    }

    /// Whether the day comes first in a column of timestamps, from all its rows; `None` if these do
    /// not tell, or cannot be read again.
    fn day_first(&self, column: Column) -> Result<Option<bool>> {
        let again = match &self.held {
            _ if self.path == std::path::Path::new("-") => return Ok(None),
            Some(bytes) => {
                let name = self.path.to_string_lossy();
                Self::from_bytes(&name, bytes.clone(), self.budget.memory().clone())
            }
            None => Self::open_as(
                &self.path,
                None,
                self.budget.memory(),
                Some(Repair::Mend),
                None,
                None,
            ),
        };
        let (mut again, mut order) = (again?, Order::default());
        while again.advance()? {
            order.learn(again.text(column).unwrap_or_default());
        }
        Ok(order.day_first())
    }

    fn time_unit(&self, column: Column) -> Option<TimeUnit> {
        TimeUnit::of(self.name(column), self.unit(column))
    }

    /// Adds a remark if a time without a unit would be unusual in seconds.
    pub(crate) fn check_time_unit(&mut self, column: Column, time: &[f64]) {
        /// Unusual: a step of over a minute, a recording of over six hours, a step below a
        /// microsecond.
        const LONGEST_STEP: f64 = 60.0;
        const LONGEST: f64 = 6.0 * 3600.0;
        const SHORTEST_STEP: f64 = 1e-6;
        let (Some((step, _)), [first, .., last]) = (crate::recording::gaps(time), time) else {
            return;
        };
        let duration = last - first;
        let short = step > 0.0 && step < SHORTEST_STEP;
        let odd = step > LONGEST_STEP || short || duration > LONGEST;
        let dated = self.time.as_ref().is_some_and(|(_, time)| time.is_dated());
        if odd && !dated && self.time_unit(column).is_none() {
            let column = self.name(column).to_owned();
            self.remarks.push(Remark::DoubtfulTime {
                column,
                step,
                duration,
            });
        }
    }

    /// The full name of a column.
    pub(crate) fn name(&self, column: Column) -> &str {
        &self.header[column.0]
    }

    /// The names of the columns with their units, for the numbers as this table returns them.
    pub(crate) fn names_with_units(&self) -> Vec<String> {
        let name = |n: usize| {
            let quantity = Quantity::from_column(&self.header[n]);
            match (&self.time, self.unit(Column(n))) {
                (Some((at, time)), _) if *at == n && time.is_converted() => {
                    let name = match time.other_unit() {
                        Some(unit) => unit.removed_from(&quantity.name),
                        None => &quantity.name,
                    };
                    Quantity::with_unit(name, "s").to_column()
                }
                (_, Some(unit)) if quantity.unit.is_none() => {
                    Quantity::with_unit(&quantity.name, unit).to_column()
                }
                _ => self.header[n].clone(),
            }
        };
        (0..self.header.len()).map(name).collect()
    }

    /// Index of the column that is meant by `name`.
    fn find(&mut self, name: &str) -> Result<usize> {
        if let Some(place) = self.place(name)? {
            return Ok(place);
        }
        if let Some([_, data]) = self.pair_at(name) {
            return Ok(data);
        }
        let problem = match names::find(&self.header, name) {
            Ok(Found::Named(place)) => return Ok(place),
            Ok(Found::Taken(place)) => {
                self.remarks.push(Remark::Found {
                    asked: name.to_owned(),
                    column: self.header[place].clone(),
                });
                return Ok(place);
            }
            Err(Missing::Ambiguous(places)) => {
                let candidates = places.iter().map(|&n| &self.header[n]);
                format!(
                    "`{name}` may be {}: give the whole name",
                    names::list(candidates)
                )
            }
            Err(Missing::Unknown) => self.no_column(name),
        };
        Err(self.fault_at(None, None, problem))
    }

    fn place(&self, name: &str) -> Result<Option<usize>> {
        let mut places = (0..self.header.len()).filter(|&n| self.header[n] == name);
        match (places.next(), places.next()) {
            (Some(_), Some(_)) => {
                let problem = format!("two columns are called `{name}`: give its number, from 1");
                Err(self.fault_at(None, None, problem))
            }
            (place, _) => Ok(place),
        }
    }

    fn no_column(&self, name: &str) -> String {
        if let Source::Numbers(numbers) = &self.source
            && let Some((length, expected)) = numbers.left_out(name)
        {
            return format!(
                "`{name}` has {length} values where the column asked for before it has {expected}: \
                 name columns that were sampled together"
            );
        }
        let near = match names::near(&self.header, name) {
            near if near.is_empty() => String::new(),
            near => format!(", did you mean {}?", names::list(near.into_iter())),
        };
        format!(
            "no column `{name}`{near}: there are {}",
            names::list(self.header.iter())
        )
    }

    /// Indices of the two columns of a matrix `[TimeValues DataValues]`.
    fn pair_at(&self, name: &str) -> Option<[usize; 2]> {
        let at = |n: usize| {
            let name = format!("{name}:{n}");
            self.header.iter().position(|h| *h == name)
        };
        match (&self.source, at(1), at(2), at(3)) {
            (Source::Numbers(numbers), Some(time), Some(data), None) if numbers.has_matrices() => {
                Some([time, data])
            }
            _ => None,
        }
    }

    /// Times and data of a matrix `[TimeValues DataValues]` that is asked for by its name alone.
    pub(crate) fn pair(&self, name: &str) -> Option<[Vec<f64>; 2]> {
        let at = self.pair_at(name)?;
        match (&self.source, self.header.iter().any(|h| h == name)) {
            (Source::Numbers(numbers), false) => Some(at.map(|at| numbers.held(at).to_vec())),
            _ => None,
        }
    }
}

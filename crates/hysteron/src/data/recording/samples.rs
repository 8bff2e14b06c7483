//! Collects the samples of a recording from a table, then repairs or refuses bad rows.

use crate::data::log::HeldBack;
use crate::data::recording::columns::TIME;
use crate::data::recording::history::{History, goes_on, starts};
use crate::data::recording::others::Others;
use crate::data::recording::repair::{NoteKind, Places, Repair};
use crate::data::table::{Column, TableReader};
use crate::error::{Error, Place, Result};
use crate::recording::gaps;
use crate::recording::{Origin, Positions, RUN};
use crate::remedy::{Remedy, Setting};

/// The column that marks a recording of a simulated plant. It holds 1 in each row.
pub(super) const MARK: &str = "simulated";
/// Input, output, time and load.
const SERIES: usize = 4;
/// Rows for which memory is taken first. Tables of many recordings have short ones.
const FIRST: usize = 64;

/// The rows that have a number in every column asked for.
pub(super) struct Samples {
    /// The series in the order in which they were asked for.
    pub(super) series: Vec<Vec<f64>>,
    /// Whether one of them is the time.
    timed: bool,
    /// Position of each row.
    pub(super) places: Positions,
    /// All cells of the rows, if they are wanted.
    pub(super) others: Option<Others>,
    /// The rows that have more or fewer cells than the header.
    ragged: Places,
    /// The rows without a number, and what is wrong with the first of them.
    missing: Places,
    /// The rows of a log whose reading its loop did not believe.
    held: Places,
    fault: Option<Error>,
    /// Whether all rows are marked as simulated.
    simulated: bool,
}

impl Samples {
    /// Reads the columns `asked`: input, output, then time and load if any. `output`, if given,
    /// replaces the column of the output. Rows that are `held` back are left out. `others`, if given,
    /// collects whole rows.
    pub(super) fn gather(
        table: &mut TableReader,
        (asked, timed): (&[Column], bool),
        output: Option<&[f64]>,
        (held, others): (Option<&HeldBack>, Option<Others>),
    ) -> Result<Self> {
        let mut samples = Self::none((asked.len(), timed), others);
        let mark = table.header().iter().any(|name| name == MARK);
        let mark = mark.then(|| table.column(MARK)).transpose()?;
        samples.simulated = mark.is_some();
        let mut outputs = output.map(|output| output.iter());
        while table.advance()? {
            if held.is_some_and(|held| held.holds(table)) {
                samples.held.push(table.row_place());
                continue;
            }
            // A column of that name with other numbers is something else.
            samples.simulated &= mark.is_none_or(|mark| table.value(mark) == Some(1.0));
            samples.push(table, asked, outputs.as_mut().map(Iterator::next))?;
        }
        samples.ragged = table.ragged();
        if samples.places.len() == 0 && samples.fault.is_none() {
            let place = Some(table.row_place()).filter(|place| *place != Place::Row(0));
            let problem = "there are no rows below the header".into();
            return Err(table.fault_at(place, None, problem));
        }
        Ok(samples)
    }

    /// No rows yet, of `count` series, with a time among them or not.
    pub(super) fn none((count, timed): (usize, bool), others: Option<Others>) -> Self {
        Self {
            series: vec![Vec::new(); count],
            timed,
            places: Positions::default(),
            others,
            ragged: Places::default(),
            missing: Places::default(),
            held: Places::default(),
            fault: None,
            simulated: false,
        }
    }

    /// Whether they are measured or simulated.
    pub(super) fn origin(&self) -> Origin {
        match self.simulated {
            true => Origin::Simulated,
            false => Origin::Measured,
        }
    }

    /// Adds the table's current row. `output`, if given, replaces its output.
    pub(super) fn push(
        &mut self,
        table: &mut TableReader,
        asked: &[Column],
        output: Option<Option<&f64>>,
    ) -> Result<()> {
        let mut row = [None; SERIES];
        for (value, at) in row.iter_mut().zip(asked) {
            *value = table.value(*at);
        }
        if let Some(output) = output {
            row[1] = output.copied().filter(|y| y.is_finite());
        }
        let row = &row[..asked.len()];
        if let Some(n) = row.iter().position(Option::is_none) {
            let fault = || table.fault(Some(asked[n]), table.no_number(asked[n]));
            self.fault.get_or_insert_with(fault);
            self.missing.push(table.row_place());
            return Ok(());
        }
        self.make_room(table)?;
        for (series, value) in self.series.iter_mut().zip(row.iter().flatten()) {
            series.push(*value);
        }
        let more = self.places.growth() as u128;
        let taken = table.budget().take(more, "the recording");
        taken.map_err(|problem| table.fault(None, problem))?;
        self.places.push(table.row_place());
        Ok(())
    }

    /// Notes rows that were dropped because of their length; `refused` is the error for them.
    pub(super) fn drop_ragged(&mut self, places: &Places, refused: impl FnOnce() -> Error) {
        if places.count > 0 {
            self.ragged.add(places);
            self.fault.get_or_insert_with(refused);
        }
    }

    /// Takes memory for another row from the table's budget. Dropping rows needs a copy, the rows
    /// kept, and their positions.
    fn make_room(&mut self, table: &mut TableReader) -> Result<()> {
        let count = self.places.len();
        let capacity = self.series.first().map_or(0, Vec::capacity);
        if count == capacity {
            let more = capacity.max(FIRST);
            let kept = match self.timed {
                true => size_of::<usize>() + RUN,
                false => 0,
            };
            let row = 2 * size_of::<f64>() * self.series.len() + kept;
            let taken = table.budget().take((row * more) as u128, "the recording");
            taken.map_err(|problem| table.fault(None, problem))?;
            for series in &mut self.series {
                series.reserve_exact(more);
            }
        }
        if let Some(others) = &mut self.others {
            let row = table.row().clone();
            let taken = table.budget().take(row.size() as u128, "the recording");
            taken.map_err(|problem| table.fault(None, problem))?;
            others.push(row);
        }
        Ok(())
    }

    /// Drops rows that cannot be used, or refuses them. Notes what was found, and where segments
    /// begin. The order of rows stays.
    ///
    /// # Errors
    /// [`Error::Recording`] for rows that need a repair if these are to be refused, or if no row is
    /// left.
    pub(super) fn mend(
        &mut self,
        table: &TableReader,
        time_at: Option<Column>,
        repair: Repair,
    ) -> Result<Mended> {
        let mut notes = Vec::new();
        let mut note = |kind, places: &Places| {
            if places.count > 0 {
                notes.push((kind, places.clone()));
            }
        };
        note(NoteKind::Ragged, &self.ragged);
        note(NoteKind::Dropped, &self.missing);
        note(NoteKind::Held, &self.held);
        let (mut back, mut set) = (Vec::new(), false);
        if self.timed {
            let History {
                kept,
                back: begins,
                copies,
                alone,
                repeated,
            } = History::new(&self.series);
            let places = |rows: &[usize]| rows.iter().map(|&n| self.places.at(n)).collect();
            note(NoteKind::Copied, &places(&copies));
            note(NoteKind::Alone, &places(&alone));
            note(NoteKind::Repeated, &places(&repeated));
            note(NoteKind::Back, &places(&begins));
            let bad = [&copies, &alone, &repeated, &begins];
            if let Some(n) = bad.into_iter().flatten().min() {
                let time = &self.series[TIME];
                let problem = match n.checked_sub(1).map(|n| time[n]) {
                    Some(before) if before == time[*n] => format!("the time is {before} again"),
                    Some(before) if before > time[*n] => {
                        format!("time goes back from {before} to {}", time[*n])
                    }
                    _ => format!("the time {} fits no row around", time[*n]),
                };
                let fault = table.fault_at(Some(self.places.at(*n)), time_at, problem);
                self.fault.get_or_insert(fault);
            }
            set = notes.iter().all(|(kind, _)| *kind == NoteKind::Back)
                && begins.iter().all(|&n| goes_on(&self.series, n));
            back = begins
                .iter()
                .map(|n| kept.partition_point(|k| k < n))
                .collect();
            if kept.len() < self.places.len() {
                for series in &mut self.series {
                    *series = kept.iter().map(|&n| series[n]).collect();
                }
                self.places = kept.iter().map(|&n| self.places.at(n)).collect();
                if let Some(others) = &mut self.others {
                    others.keep(&kept);
                }
            }
        }
        // Neither as they are nor in segments.
        if back.len() > FEW && self.places.len() < SHORT * back.len() {
            let newest = match back.len() + 1 == self.places.len() {
                true => ", the newest first",
                false => "",
            };
            let problem = format!(
                "time goes back {} times in {} rows{newest}: bring the rows into the order in which they \
                 were measured, or read them without time if they are in it",
                back.len(),
                self.places.len()
            );
            let place = back.first().map(|n| self.places.at(*n));
            return Err(table.fault_at(place, time_at, problem));
        }
        match self.fault.take() {
            Some(fault) if repair == Repair::Refuse => {
                return Err(refusal(fault, &notes, set));
            }
            Some(_) if self.places.len() == 0 => {
                let problem = "no row has a number in every column asked for";
                return Err(table.fault_at(None, None, problem.into()));
            }
            Some(_) if self.missing.count > self.places.len() as u64 => {
                // They are not what a logger lost.
                let count = self.missing.count;
                let problem = format!(
                    "{count} of {} rows have no number in every column asked for, more than can \
                     be dropped: name other columns, or write the numbers without marks of \
                     thousands",
                    count + self.places.len() as u64
                );
                let first = self.missing.first.first().copied();
                return Err(table.fault_at(first, None, problem));
            }
            _ => {}
        }
        if let Some((_, gaps)) = self.time().and_then(gaps)
            && !gaps.is_empty()
        {
            let places = gaps.into_iter().map(|n| self.places.at(n)).collect();
            notes.push((NoteKind::Gap, places));
        }
        Ok(Mended { notes, back })
    }

    /// The time of each row. A load stands in its place where there is no time.
    pub(super) fn time(&self) -> Option<&[f64]> {
        self.timed.then(|| &self.series[TIME][..])
    }

    /// Where segments begin, of rows some of which go `back`; with notes on long gaps.
    pub(super) fn starts(&self, mended: &mut Mended) -> Vec<usize> {
        if !self.timed {
            return Vec::new();
        }
        let mut long = Vec::new();
        let starts = starts(&self.series, std::mem::take(&mut mended.back), &mut long);
        if !long.is_empty() {
            let places = long.iter().map(|&n| self.places.at(n)).collect();
            mended.notes.push((NoteKind::LongGap, places));
        }
        starts
    }
}

/// More breaks than these, and so few rows between them, are no history.
const FEW: usize = 3;
const SHORT: usize = 4;

/// What was found in the rows of a table.
pub(super) struct Mended {
    pub(super) notes: Vec<(NoteKind, Places)>,
    /// The rows, among those kept, that go back in time.
    pub(super) back: Vec<usize>,
}

/// The error, with a list of all bad rows. Where a clock was `set` and nothing else is wrong, the
/// order of the rows tells what its times do not.
fn refusal(fault: Error, notes: &[(NoteKind, Places)], set: bool) -> Error {
    let Error::Recording {
        path,
        row,
        column,
        problem,
    } = fault
    else {
        return fault;
    };
    let count: u64 = notes.iter().map(|(_, places)| places.count).sum();
    let of_kind = |(kind, places): &(NoteKind, Places)| format!("{places} {}", kind.fault());
    let all: Vec<String> = notes.iter().map(of_kind).collect();
    let problem = match count {
        1 => problem,
        _ => format!("{problem}; in all {}", all.join("; ")),
    };
    let (problem, words) = match (set, count) {
        (true, _) => (
            format!("{problem}, though the values go on: the clock was set"),
            "leave out the time, since the order of the rows is the history, or mend it; with {} a \
             segment begins there, whose history is not known",
        ),
        (_, 1) => (problem, "mend or remove the row, or use {}"),
        _ => (problem, "mend or remove them, or use {}"),
    };
    let fault = Error::Recording {
        path,
        row,
        column,
        problem,
    };
    fault.remedied(Remedy::new(words, [Setting::on("repair")]))
}

//! Which column of a table is the input, the output, the time and the load.
//!
//! Each column has evidence: words in its name (`words`), its unit (`units`), both together (`name`),
//! and what its values do. A table of scores says how well a `quantity` fits each role.
//! What this program wrote itself needs no evidence (`log`). Where a second answer is nearly as good as the first, the roles are in doubt, and nothing is
//! guessed: a fit of the wrong columns looks like a fit.

mod name;
mod quantity;
mod units;
mod words;

use crate::data::log::Log;
use name::Name;
use quantity::Quantity;
pub(super) use quantity::Series;
use serde::Serialize;

/// The roles of columns, by name. A role is `None` where nothing fits, or where it is in doubt.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Roles {
    /// The input.
    pub input: Option<String>,
    /// The output.
    pub output: Option<String>,
    /// The time.
    pub time: Option<String>,
    /// The load, if it changes.
    pub load: Option<String>,
    /// Why, one sentence for each role.
    pub reasons: Vec<String>,
    /// The roles that cannot be told, and the columns that may have them.
    pub doubts: Vec<RoleDoubt>,
}

/// A role that several columns may have, or none.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RoleDoubt {
    /// The role: `input` or `output`.
    pub role: &'static str,
    /// The columns that may have it, and why each.
    pub candidates: Vec<(String, String)>,
}

/// Name, unit below the name, and values of each column.
pub(super) type Columns<'a> = Vec<(&'a str, Option<&'a str>, Series)>;

/// A column, and what it may measure.
struct Candidate<'a> {
    name: &'a str,
    series: Series,
    may_be: Vec<Quantity>,
}

impl Candidate<'_> {
    fn is_nameless(&self) -> bool {
        let nameless = |q: &Quantity| matches!(q, Quantity::Unknown | Quantity::X | Quantity::Y);
        self.may_be.iter().all(nameless)
    }

    fn is(&self, quantity: Quantity) -> bool {
        self.may_be.contains(&quantity)
    }

    /// How well it fits a role, as the best of what it may be. What rises evenly is a clock, a counter
    /// or a slow input: it is never an output.
    fn score(&self, role: usize) -> i32 {
        if self.series.rises_evenly && role == OUTPUT {
            return 0;
        }
        let scores = self.may_be.iter().map(|quantity| quantity.scores()[role]);
        scores.max().unwrap_or_default()
    }

    fn why(&self) -> String {
        let words: Vec<_> = self.may_be.iter().map(|quantity| quantity.word()).collect();
        words.join(" or ")
    }
}

const INPUT: usize = 0;
const OUTPUT: usize = 1;
const LOAD: usize = 2;

/// Answers that are so near to each other are one doubt.
const NEAR: i32 = 5;

/// The roles of columns, where those of input, output, time and load that are `known` stand at these
/// places.
pub(super) fn of_columns(columns: &Columns<'_>, known: [Option<usize>; 4]) -> Roles {
    let [input, output, time, _] = known;
    let name = |place: Option<usize>| place.map(|n| columns.get(n).map_or("", |column| column.0));
    if let Some(log) = Log::of(columns.iter().map(|(name, ..)| *name))
        && log.agrees([input, output, time].map(name))
    {
        return of_log(log, columns, known[3]);
    }
    let each = columns.iter();
    let each = each.map(|&(name, unit, series)| Candidate {
        name,
        series,
        may_be: Name::new(name, unit).may_be(series),
    });
    let all: Vec<Candidate<'_>> = each.collect();
    let [input, output, time, load] = known;
    let is_known = |n: &usize| known.contains(&Some(*n));
    let mut roles = Roles::default();
    let mut time_at = time.or_else(|| clock(&all, is_known));
    let free = |n: &usize| {
        let Candidate { series, may_be, .. } = &all[*n];
        let roles = may_be.iter().any(|quantity| quantity.scores() != [0; 3]);
        series.moves && roles && Some(*n) != time_at && !is_known(n)
    };
    let free: Vec<usize> = (0..all.len()).filter(free).collect();

    let may = |given: Option<usize>| given.map_or_else(|| free.clone(), |n| vec![n]);
    let mut pairs = Vec::new();
    for &i in &may(input) {
        for &o in may(output).iter().filter(|o| **o != i) {
            let (a, b) = (all[i].score(INPUT), all[o].score(OUTPUT));
            if (a > 0 || input.is_some()) && (b > 0 || output.is_some()) {
                pairs.push((a + b, (i, o)));
            }
        }
    }
    pairs.sort_by_key(|(score, places)| (-score, *places));
    let near = pairs.first().map_or(0, |(best, _)| best - NEAR);
    pairs.retain(|(score, _)| *score >= near);
    let different = |of: fn(&(usize, usize)) -> usize| {
        let mut places: Vec<usize> = pairs.iter().map(|(_, pair)| of(pair)).collect();
        places.sort_unstable();
        places.dedup();
        places
    };
    let (mut inputs, outputs) = (different(|pair| pair.0), different(|pair| pair.1));
    // A clock that only its even rise tells, and an input that nothing tells: either may be the other.
    let is_guess = |n: &usize| !all[*n].series.stamps && !all[*n].is(Quantity::Time);
    if let (Some(clock), [one], None, None) = (time_at.filter(is_guess), &inputs[..], time, input)
        && all[*one].is(Quantity::Unknown)
    {
        inputs.push(clock);
        time_at = None;
    }
    let mut named = |role: &str, n: usize, why: &str| {
        let name = &all[n].name;
        roles.reasons.push(format!("{role}: `{name}`, {why}"));
        (*name).to_owned()
    };
    roles.time = time_at.map(|n| {
        let why = match (time, all[n].series) {
            (Some(_), _) => "as was said",
            (None, Series { stamps: true, .. }) => "which has timestamps",
            (
                None,
                Series {
                    rises_evenly: true, ..
                },
            ) => "which rises evenly",
            _ => "by its name",
        };
        named("time", n, why)
    });
    let mut doubts = Vec::new();
    let mut settle = |role: &'static str, places: &[usize], given: Option<usize>| {
        let place = match places {
            [one] => Some(*one),
            _ => None,
        };
        match (given.or(place), given) {
            (Some(n), Some(_)) => Some((n, "as was said".to_owned())),
            (Some(n), None) if all[n].is(Quantity::Unknown) => {
                Some((n, "the only other column that may be it".to_owned()))
            }
            (Some(n), None) => Some((n, all[n].why())),
            (None, _) => {
                // Without an answer, whatever moves may be it.
                let places = if places.is_empty() { &free[..] } else { places };
                let candidates = places
                    .iter()
                    .map(|&n| (all[n].name.to_owned(), all[n].why()));
                let candidates = candidates.collect();
                doubts.push(RoleDoubt { role, candidates });
                None
            }
        }
    };
    let input_at = settle("input", &inputs, input);
    let output_at = settle("output", &outputs, output);
    let taken = [&input_at, &output_at].map(|found| found.as_ref().map(|(n, _)| *n));
    roles.input = input_at.map(|(n, why)| named("input", n, &why));
    roles.output = output_at.map(|(n, why)| named("output", n, &why));

    let loads = free.iter().copied().filter(|n| !taken.contains(&Some(*n)));
    let loads = loads.filter(|&n| all[n].series.changes && all[n].score(LOAD) > 0);
    let first = loads.max_by_key(|&n| (all[n].score(LOAD), std::cmp::Reverse(n)));
    roles.load = load.map(|n| named("load", n, "as was said")).or_else(|| {
        let n = first.filter(|_| roles.input.is_some() && roles.output.is_some())?;
        Some(named("load", n, "which changes"))
    });
    if time_at.is_none()
        && let Some(n) = (0..all.len()).find(|n| !is_known(n) && all[*n].is(Quantity::Time))
    {
        let name = all[n].name;
        roles
            .reasons
            .push(format!("no time: `{name}` neither rises nor falls"));
    }
    roles.doubts = doubts;
    roles
}

/// Those of a table that this program wrote. A column called `load` is one if it changes.
fn of_log(log: &Log, columns: &Columns<'_>, load: Option<usize>) -> Roles {
    let is_load = |(name, _, series): &&(&str, _, Series)| *name == "load" && series.changes;
    let named = |name: &str| Some(name.to_owned());
    let (input, output, time) = (log.input, log.output, log.time);
    Roles {
        input: named(input),
        output: named(output),
        time: named(time),
        load: load
            .and_then(|n| columns.get(n))
            .or_else(|| columns.iter().find(is_load))
            .and_then(|(name, ..)| named(name)),
        reasons: vec![format!(
            "{}: input `{input}`, output `{output}`, time `{time}`",
            log.what
        )],
        doubts: Vec::new(),
    }
}

/// The column that is the time: by its timestamps, by its name, or because it alone rises evenly.
fn clock(all: &[Candidate<'_>], is_known: impl Fn(&usize) -> bool) -> Option<usize> {
    let rank = |n: &usize| {
        let candidate = &all[*n];
        let Series {
            moves,
            rises,
            falls,
            rises_evenly,
            stamps,
            ..
        } = candidate.series;
        match candidate.is(Quantity::Time) {
            _ if stamps => Some(0),
            // Rows in the order of a clock that falls are a history backwards: reading them says so.
            true if (rises || falls) && moves => Some(1),
            false if rises_evenly && candidate.is_nameless() => Some(2),
            _ => None,
        }
    };
    let ranked = (0..all.len()).filter(|n| !is_known(n));
    let mut ranked: Vec<(i32, usize)> = ranked.filter_map(|n| Some((rank(&n)?, n))).collect();
    ranked.sort_unstable();
    match ranked[..] {
        // Of a clock and a slow input without names, either may be the other.
        [(2, _), (2, _), ..] => None,
        [(_, n), ..] => Some(n),
        [] => None,
    }
}

//! Finds columns by the names that users type.
//!
//! The rules, in this order: the exact name; the name without unit, in upper or lower case; the
//! number, from 1; a name that is the beginning of the column's name, or that is one or two letters
//! longer than it, if this fits one column only.

use super::shortened;
use crate::recording::Quantity;

/// How a column was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    /// By its name.
    Named(usize),
    /// By its number or by a similar name. The user should be told.
    Taken(usize),
}

/// Why no column was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Missing {
    /// Several columns fit.
    Ambiguous(Vec<usize>),
    /// No column fits.
    Unknown,
}

/// Finds `asked` in a header that does not contain it exactly.
pub(super) fn find(header: &[String], asked: &str) -> Result<Found, Missing> {
    let wanted = plain(asked);
    let bare: Vec<String> = header.iter().map(|name| without_unit(name)).collect();
    let those = |fits: &dyn Fn(&String) -> bool| -> Vec<usize> {
        (0..header.len()).filter(|&n| fits(&bare[n])).collect()
    };
    let whole = (0..header.len()).filter(|&n| plain(&header[n]) == wanted);
    match (
        &whole.collect::<Vec<_>>()[..],
        &those(&|name| *name == wanted)[..],
    ) {
        ([one], _) | ([], [one]) => return Ok(Found::Named(*one)),
        ([], []) => {}
        ([], several) | (several, _) => return Err(Missing::Ambiguous(several.to_vec())),
    }
    if let Ok(number) = wanted.parse::<usize>()
        && (1..=header.len()).contains(&number)
    {
        return Ok(Found::Taken(number - 1));
    }
    match &those(&|name| begins(&wanted, name))[..] {
        [one] => Ok(Found::Taken(*one)),
        [] => Err(Missing::Unknown),
        several => Err(Missing::Ambiguous(several.to_vec())),
    }
}

/// A name in lower case, without blanks around it.
fn plain(name: &str) -> String {
    name.trim().to_lowercase()
}

fn without_unit(name: &str) -> String {
    plain(&Quantity::from_column(name).name)
}

/// Whether one name begins with the other: `temp` and `temperature_c`, or `temperature` and
/// `temperatur` (at most two letters more than the column has). Numbers must match completely: `x1`
/// is not `x10`.
fn begins(asked: &str, column: &str) -> bool {
    const SHORTEST: usize = 3;
    const LETTERS: usize = 2;
    if asked.chars().count().min(column.chars().count()) < SHORTEST {
        return false;
    }
    let ends_in_digit = |text: &str| text.ends_with(|c: char| c.is_ascii_digit());
    match (column.strip_prefix(asked), asked.strip_prefix(column)) {
        (Some(rest), _) => {
            !(ends_in_digit(asked) && rest.starts_with(|c: char| c.is_ascii_digit()))
        }
        (None, Some(rest)) => {
            rest.chars().count() <= LETTERS && rest.chars().all(char::is_alphabetic)
        }
        (None, None) => false,
    }
}

/// The first few names, quoted, and how many more there are; for a message.
pub(super) fn list<'n>(names: impl ExactSizeIterator<Item = &'n String>) -> String {
    const MOST: usize = 20;
    let count = names.len();
    let names = names
        .take(MOST)
        .map(|name| format!("`{}`", shortened(name)));
    let names: Vec<String> = names.collect();
    match count.saturating_sub(MOST) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names.join(", ")),
    }
}

/// The names of a header that are similar to `asked`, the nearest first.
pub(super) fn near<'h>(header: &'h [String], asked: &str) -> Vec<&'h String> {
    /// Nobody types names of such wide tables from memory, so no search is needed beyond this.
    const SEARCHED: usize = 1000;
    const ALIKE: f64 = 0.6;
    const MOST: usize = 3;
    let asked = shortened(&plain(asked));
    let mut near: Vec<(f64, &String)> = header
        .iter()
        .take(SEARCHED)
        .map(|name| {
            let bare = shortened(&without_unit(name));
            (strsim::normalized_damerau_levenshtein(&asked, &bare), name)
        })
        .filter(|(alike, _)| *alike >= ALIKE)
        .collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    near.into_iter().map(|(_, name)| name).take(MOST).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(names: &str) -> Vec<String> {
        names.split(',').map(str::to_owned).collect()
    }

    #[test]
    fn columns_are_found_by_what_people_call_them() {
        use Found::{Named, Taken};
        let cases = [
            ("time,temperature [degC]", "temperature", Ok(Named(1))),
            ("time,Temperature (K)", "temperature", Ok(Named(1))),
            ("Zeit,Temperatur (°C)", "temperature", Ok(Taken(1))),
            ("time_s,temperature_C,T2", "temp", Ok(Taken(1))),
            ("a,b,c", "2", Ok(Taken(1))),
            // A name wins over a number.
            ("a,b,1 [mm]", "1", Ok(Named(2))),
            ("x [mm],x [N]", "x", Err(Missing::Ambiguous(vec![0, 1]))),
            ("X [mm],x [N]", "X [n]", Ok(Named(1))),
            (
                "temp_in,temp_out",
                "temp",
                Err(Missing::Ambiguous(vec![0, 1])),
            ),
            ("sensor10,sensor2", "sensor1", Err(Missing::Unknown)),
            ("temperature,y", "temperature_2", Err(Missing::Unknown)),
            ("temperature", "t", Err(Missing::Unknown)),
            ("a,b", "3", Err(Missing::Unknown)),
            ("a,b", "0", Err(Missing::Unknown)),
        ];
        for (names, asked, expected) in cases {
            assert_eq!(find(&header(names), asked), expected, "{asked} in {names}");
        }
    }

    #[test]
    fn near_names_are_told() {
        let header = header("time [s],temperature [degC],load");
        assert_eq!(near(&header, "tempreature"), [&header[1]]);
        assert!(near(&header, "y").is_empty());
    }
}

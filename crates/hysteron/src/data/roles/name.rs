//! What a column may measure, by its name and its unit together.

use super::quantity::Quantity::{self, Counter, Temperature, Time, Unknown};
use super::quantity::Series;
use super::{units, words};
use crate::recording;

/// The name of a column in its words, and its unit.
pub(super) struct Name {
    words: Vec<String>,
    /// The letter that it is or begins with, as it is written.
    letter: Option<String>,
    unit: Option<String>,
}

impl Name {
    /// Takes a column's name, and the unit below it.
    pub(super) fn new(column: &str, below: Option<&str>) -> Self {
        let quantity = recording::Quantity::from_column(column);
        let split = |c: char| !c.is_alphanumeric() && !matches!(c, '%' | '°' | 'µ');
        let mut parts: Vec<&str> = quantity.name.split(split).collect();
        parts.retain(|part| !part.is_empty());
        let mut unit = quantity.unit.or(below.map(str::to_owned));
        // The unit may be the end of the name: `temperature_C`.
        if let (None, [.., _, last]) = (&unit, &parts[..])
            && !units::may_measure(last).is_empty()
        {
            unit = parts.pop().map(str::to_owned);
        }
        // `H_A_per_m` begins with one, `a_position` does not.
        let letter = parts
            .first()
            .filter(|first| parts.len() == 1 || first.starts_with(char::is_uppercase));
        let letter = letter.map(|first| first.trim_end_matches(char::is_numeric).to_owned());
        let letter = letter.filter(|letter| letter.chars().count() == 1);
        Self {
            words: parts.iter().flat_map(|part| apart(part)).collect(),
            letter,
            unit,
        }
    }

    /// All that it may be. A word counts more than a unit, and a unit tells meanings of a word apart.
    pub(super) fn may_be(&self, series: Series) -> Vec<Quantity> {
        // LabVIEW's name of the time.
        let is_x_value = self.words == ["x", "value"];
        let mut said = match is_x_value {
            true => vec![Time],
            false => words::may_mean(&self.words, self.letter.as_deref()),
        };
        let unit = self.unit.as_deref().map_or(&[][..], units::may_measure);
        let both: Vec<Quantity> = said.iter().copied().filter(|q| unit.contains(q)).collect();
        if !both.is_empty() {
            said = both;
        } else if said.is_empty() || !unit.is_empty() && self.counts(&said) {
            said = unit.to_vec();
        }
        // A single letter that goes back and forth is no time: `t` is a temperature then.
        let goes_on = series.rises || series.stamps;
        if let (true, false, Some(letter)) = (said.contains(&Time), goes_on, &self.letter) {
            said.retain(|quantity| *quantity != Time);
            said.extend((letter == "t").then_some(Temperature));
        }
        if said.is_empty() {
            said.push(Unknown);
        }
        said
    }

    /// Whether all that was `said` is a time, or a letter that counts: `t [°C]` is no time, and
    /// `i [A]` no counter.
    fn counts(&self, said: &[Quantity]) -> bool {
        said == [Time] || said == [Counter] && self.letter.is_some()
    }
}

/// The words of a part of a name, in lower case: `springLength` is two.
fn apart(part: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = None;
    for c in part.chars() {
        let begins = c.is_uppercase() && before.is_some_and(char::is_lowercase)
            || c.is_numeric() != before.is_some_and(char::is_numeric) && before.is_some();
        if begins {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut() {
            word.extend(c.to_lowercase());
        }
        before = Some(c);
    }
    words.retain(|word| !word.chars().all(char::is_numeric));
    words
}

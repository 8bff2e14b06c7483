//! Where a field of a scenario is in its text.

use toml::de::{DeTable, DeValue};

/// The line, from 1, of a field such as `reference[0].period_s` in a text in TOML, or of the
/// innermost of its parts that the text has: a field that is left out has its default.
#[must_use]
pub fn line_of(text: &str, field: &str) -> Option<u64> {
    let table = DeTable::parse(text).ok()?;
    let mut start = None;
    let mut here = DeValue::Table(table.into_inner());
    for part in field.split(['.', '[', ']']).filter(|part| !part.is_empty()) {
        let next = match here {
            DeValue::Table(table) => {
                let mut entries = table.into_iter();
                let found = entries.find(|(key, _)| key.get_ref() == part);
                found.map(|(key, value)| (key.span().start, value))
            }
            DeValue::Array(array) => {
                let element = part.parse().ok().and_then(|n| array.into_iter().nth(n));
                element.map(|value| (value.span().start, value))
            }
            _ => None,
        };
        let Some((at, value)) = next else {
            break;
        };
        start = Some(at);
        here = value.into_inner();
    }
    start.map(|start| line_at(text, start))
}

/// The line, from 1, of a place in a text.
#[must_use]
pub fn line_at(text: &str, place: usize) -> u64 {
    let before = text.as_bytes().iter().take(place);
    1 + before.filter(|byte| **byte == b'\n').count() as u64
}

#[cfg(test)]
mod tests {
    use super::line_of;

    #[test]
    fn fields_have_lines() {
        let text = "a = 1\n\n[model]\nlevels = 3\n[[part]]\nx = 1\n[[part]]\n# y\ny = [1,\n2]\n";
        let cases = [
            ("a", Some(1)),
            ("model.levels", Some(4)),
            ("model.range", Some(3)),
            ("part[1].y", Some(9)),
            ("part[0]", Some(5)),
            ("none", None),
        ];
        for (field, line) in cases {
            assert_eq!(line_of(text, field), line, "{field}");
        }
    }
}

//! Numbers and words as C writes them.

use super::real::Number;
use hysteron::Quantity;

/// Numbers in a line of the table.
const COLUMNS: usize = 8;

/// The rows of a triangle as one array's value.
pub(super) fn array<'a, T: Number + 'a>(rows: impl Iterator<Item = &'a [T]>) -> String {
    let lines = rows.flat_map(|row| row.chunks(COLUMNS)).map(|line| {
        let numbers: Vec<String> = line.iter().map(|number| number.literal()).collect();
        format!("    {}", numbers.join(", "))
    });
    let lines: Vec<String> = lines.collect();
    format!("{{\n{}\n}};\n", lines.join(",\n"))
}

/// Numbers as an array's value.
pub(super) fn list<T: Number>(numbers: &[T]) -> String {
    array(std::iter::once(numbers))
}

pub(super) fn quantity(quantity: &Quantity) -> String {
    let unit = quantity.unit.as_deref().unwrap_or("unit not known");
    format!("{} [{}]", plain(&quantity.name), plain(unit))
}

/// Text that stays within a comment, for compilers that read ASCII only.
pub(super) fn plain(text: &str) -> String {
    let mut plain = String::new();
    for letter in text.chars() {
        match letter {
            '°' => plain.push_str("deg"),
            'µ' | 'μ' => plain.push('u'),
            '*' | '·' => plain.push('.'),
            ' '..='~' if letter != '\\' => plain.push(letter),
            _ => plain.push('?'),
        }
    }
    plain
}

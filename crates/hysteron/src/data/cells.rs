//! Writes the cells of a CSV row: quoted where they must be, numbers in their shortest digits.

/// Appends a row to `out`, without the end of the line. A row of one empty cell is quoted, because
/// a blank line is no row.
pub(crate) fn push_row<C: AsRef<[u8]>>(out: &mut Vec<u8>, cells: impl IntoIterator<Item = C>) {
    let start = out.len();
    let mut cells = cells.into_iter();
    if let Some(first) = cells.next() {
        push_cell(out, first.as_ref());
    }
    let mut several = false;
    for cell in cells {
        several = true;
        out.push(b',');
        push_cell(out, cell.as_ref());
    }
    if !several && out.len() == start {
        out.extend_from_slice(b"\"\"");
    }
}

/// Appends a cell to `out`.
pub(crate) fn push_cell(out: &mut Vec<u8>, cell: &[u8]) {
    if !cell
        .iter()
        .any(|byte| matches!(byte, b',' | b'"' | b'\n' | b'\r'))
    {
        out.extend_from_slice(cell);
        return;
    }
    out.push(b'"');
    for part in cell.split_inclusive(|byte| *byte == b'"') {
        out.extend_from_slice(part);
        if part.ends_with(b"\"") {
            out.push(b'"');
        }
    }
    out.push(b'"');
}

/// Appends a number as [`f64`] shows it: the fewest digits that are read back as the same number,
/// without an exponent.
pub(crate) fn push_number(out: &mut Vec<u8>, number: f64) {
    // Others are shown with an exponent.
    if number == 0.0 || (1e-5..1e16).contains(&number.abs()) {
        let mut digits = zmij::Buffer::new();
        let digits = digits.format_finite(number).as_bytes();
        let last = last_bit(number);
        // Whole numbers and those halfway have a larger last bit.
        if last < -1 - MOST_DECIMALS && number != 0.0 {
            return out.extend_from_slice(digits);
        }
        if let Some(whole) = digits.strip_suffix(b".0") {
            return out.extend_from_slice(whole);
        }
        // A number may lie halfway between two texts with so many decimals. The standard library
        // then takes the one further from zero, and `zmij` the even one.
        //
        // `(2k + 1) / 2 · 10⁻ⁿ` is an odd multiple of `2⁻ⁿ⁻¹`: that is the last bit that is set.
        let point = digits.iter().position(|byte| *byte == b'.');
        if point.is_some_and(|point| last != -((digits.len() - point) as i32)) {
            return out.extend_from_slice(digits);
        }
    }
    out.extend_from_slice(number.to_string().as_bytes());
}

/// Most decimals of a number from 1e-5 on: 17 digits, the first one at the fifth decimal.
const MOST_DECIMALS: i32 = 21;

/// The exponent of two of the last bit that is set in a number that is neither zero nor subnormal.
#[inline]
fn last_bit(number: f64) -> i32 {
    let bits = number.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32 - 1075;
    exponent + (bits | 1 << 52).trailing_zeros() as i32
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn numbers_are_shown_as_the_standard_library_shows_them() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let special = [
            0.0,
            -0.0,
            1e15,
            1e16,
            1e17,
            -1e21,
            1e-4,
            1e-5,
            1e-7,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ];
        let bits = (0..100_000).map(|_| f64::from_bits(random.next_u64()));
        let mut again = ChaCha8Rng::seed_from_u64(8);
        let usual = (0..100_000).map(|_| f64::from(again.next_u32() as i32) / 1e4);
        // Dyadic fractions, some of which lie halfway.
        let mut third = ChaCha8Rng::seed_from_u64(9);
        let dyadic = (0..300_000).map(|n| {
            let whole = (1_u64 << ((n / 52) % 53)) + u64::from(third.next_u32() % 4096);
            whole as f64 * 2_f64.powi(-(n % 52))
        });
        let all = special.into_iter().chain(bits).chain(usual);
        for number in all.chain(dyadic).chain([0.5 + 2_f64.powi(-17)]) {
            let mut shown = Vec::new();
            push_number(&mut shown, number);
            assert_eq!(String::from_utf8(shown).unwrap(), number.to_string());
        }
    }

    /// Every row of up to three cells of up to two of these characters.
    #[test]
    fn rows_are_those_of_the_crate_csv() {
        let mut cells = vec![String::new()];
        for a in ["a", ",", "\"", "\n", "\r", " ", "é"] {
            cells.push(a.to_owned());
            cells.extend(["b", ",", "\"", "\n", "\r"].map(|b| format!("{a}{b}")));
        }
        let check = |row: &[&String]| {
            let mut ours = Vec::new();
            push_row(&mut ours, row);
            ours.push(b'\n');
            let mut peer = csv::Writer::from_writer(Vec::new());
            peer.write_record(row).unwrap();
            assert_eq!(ours, peer.into_inner().unwrap(), "{row:?}");
        };
        for a in &cells {
            check(&[a]);
            for b in &cells {
                check(&[a, b]);
                check(&[a, b, a]);
            }
        }
    }
}

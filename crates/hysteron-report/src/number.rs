//! Numbers in the usual notation.

/// `value` with `digits` significant digits; powers of ten outside 10⁻³…10⁶.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let exponent = magnitude(value);
    if !(-3..6).contains(&exponent) {
        return format!(
            "{} × {}",
            fixed(value / 10f64.powi(exponent), digits.saturating_sub(1)),
            power_of_ten(exponent)
        );
    }
    let decimals = digits as i32 - 1 - exponent;
    fixed(value, decimals.max(0) as usize)
}

/// `value` with `decimals` decimals and a true minus sign; never `−0`.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// A count, with thin spaces between thousands from 10 000 on.
pub(crate) fn count(value: usize) -> String {
    let digits = value.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut grouped = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            grouped.push('\u{202f}');
        }
        grouped.push(digit);
    }
    grouped
}

/// `⌊log₁₀|value|⌋`.
pub(crate) fn magnitude(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

/// `10ⁿ` with superscript digits.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = exponent.unsigned_abs().to_string();
    let sign = if exponent < 0 { "⁻" } else { "" };
    let superscript = digits
        .chars()
        .filter_map(|digit| DIGITS.get(digit.to_digit(10)? as usize));
    ["10", sign]
        .into_iter()
        .map(String::from)
        .chain(superscript.map(|&digit| digit.into()))
        .collect()
}

/// A percentage with two significant digits.
pub(crate) fn percent(value: f64) -> String {
    format!("{}\u{a0}%", significant(value, 2))
}

/// `text` with a capital at its start.
pub(crate) fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    characters
        .next()
        .map(|first| first.to_uppercase().chain(characters).collect())
        .unwrap_or_default()
}

/// `a` minus `b`, sample by sample.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_read_well() {
        assert_eq!(significant(0.123_456, 3), "0.123");
        assert_eq!(significant(26.04, 3), "26.0");
        assert_eq!(significant(-1234.6, 3), "−1235");
        assert_eq!(significant(1.5e-7, 3), "1.50 × 10⁻⁷");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), "–");
    }

    #[test]
    fn minus_zero_is_zero() {
        assert_eq!(fixed(-0.001, 1), "0.0");
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!(count(2000), "2000");
        assert_eq!(count(1_000_000), "1\u{202f}000\u{202f}000");
    }
}

//! A number in a table.

/// Three significant digits, but none behind the point from 100 on.
pub fn number(percent: f64) -> String {
    let digits = 2 - percent.max(1e-3).log10().floor() as i32;
    format!("{percent:.*}", digits.clamp(0, 4) as usize)
}

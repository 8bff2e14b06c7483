//! Figures that zoom together: what they show, as numbers, beside plotly.js and the script that
//! draws them with it. Without a script, the figures stay as they are on paper.

use crate::draw::plot::{Plot, Words};
use crate::draw::sheet::Drawing;
use crate::number::magnitude;
use base64::{Engine, prelude::BASE64_STANDARD};
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use std::collections::HashMap;
use std::io::{Read, Write};

const SCRIPTS: [&str; 4] = [
    include_str!("../page/numbers.js"),
    include_str!("../page/layout.js"),
    include_str!("../page/drawn.js"),
    include_str!("../page/page.js"),
];
const PLOTLY: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/plotly.js.gz"));

/// Digits of a value on a page, over the range of its axis.
const DIGITS: i32 = 7;

/// [plotly.js](https://plotly.com/javascript/), which the pages draw with.
///
/// ```
/// assert!(hysteron_report::plotly().contains("plotly.js v"));
/// ```
pub fn plotly() -> String {
    let mut script = String::new();
    // The build packed it.
    let _ = GzDecoder::new(PLOTLY).read_to_string(&mut script);
    script
}

#[derive(Serialize)]
struct Page<'a> {
    /// Series of numbers; equal ones stand here once.
    columns: Vec<Vec<f64>>,
    figures: Vec<Linked<'a>>,
}

#[derive(Serialize)]
struct Linked<'a> {
    id: &'a str,
    plots: &'a [Plot],
    /// For each plot, the columns of x and y of each line.
    series: Vec<Vec<[usize; 2]>>,
    words: &'a [Words],
    areas: &'a [(&'static str, String)],
}

/// What a page needs at its end, so that `figures`, by their ids, zoom.
pub(crate) fn scripts<'a>(figures: impl Iterator<Item = (&'a str, &'a Drawing)>) -> Markup {
    let mut columns = Columns::default();
    let figures: Vec<Linked<'_>> = figures
        .map(|(id, drawing)| Linked {
            id,
            plots: &drawing.plots,
            series: drawing
                .plots
                .iter()
                .map(|plot| columns.indices(plot))
                .collect(),
            words: &drawing.words,
            areas: &drawing.areas,
        })
        .collect();
    if figures.is_empty() {
        return html! {};
    }
    let columns = columns.all;
    let page = serde_json::to_vec(&Page { columns, figures }).unwrap_or_default();
    html! {
        (packed("figures", &gzip(&page)))
        (packed("plotly", PLOTLY))
        script { (PreEscaped(SCRIPTS.concat())) }
    }
}

fn packed(id: &str, bytes: &[u8]) -> Markup {
    html! { script id=(id) type="application/gzip" { (BASE64_STANDARD.encode(bytes)) } }
}

/// Into memory, so that nothing can fail.
fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    let _ = packed.write_all(bytes);
    packed.finish().unwrap_or_default()
}

#[derive(Default)]
struct Columns {
    all: Vec<Vec<f64>>,
    places: HashMap<Vec<u64>, usize>,
}

impl Columns {
    fn indices(&mut self, plot: &Plot) -> Vec<[usize; 2]> {
        let lines = plot.lines.iter();
        lines
            .map(|line| [(&line.xs, &plot.x), (&line.ys, &plot.y)])
            .map(|both| both.map(|(values, axis)| self.place(values, axis.range)))
            .collect()
    }

    fn place(&mut self, values: &[f64], axis: [f64; 2]) -> usize {
        let column = rounded(values, axis);
        let bits = column.iter().map(|value| value.to_bits()).collect();
        *self.places.entry(bits).or_insert_with(|| {
            self.all.push(column);
            self.all.len() - 1
        })
    }
}

/// Values to [`DIGITS`] digits of the range of their axis; what is not finite becomes a gap.
fn rounded(values: &[f64], [low, high]: [f64; 2]) -> Vec<f64> {
    // Read, not computed: the same bits on every machine.
    let power: f64 = format!("1e{}", DIGITS - magnitude(high - low))
        .parse()
        .unwrap_or(f64::INFINITY);
    let round = |value: f64| {
        let rounded = (value * power).round() / power;
        // Ranges of zero, or too large or too small for this, stay as they are.
        if rounded.is_finite() { rounded } else { value }
    };
    values.iter().map(|value| round(*value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_the_digits_that_a_zoom_shows() {
        let clock = [1.76e9, 1.76e9 + 0.001_234_567, 1.76e9 + 0.01];
        // The spacing of doubles there is 2.4e-7.
        for (value, told) in clock.iter().zip(rounded(&clock, [clock[0], clock[2]])) {
            assert!((value - told).abs() <= 2.4e-7, "{value} {told}");
        }
        let unit = [0.0, 1.0];
        assert_eq!(
            rounded(&[1.0 / 3.0, 1.0, 0.0], unit),
            [0.333_333_3, 1.0, 0.0]
        );
        // What lies far off the axis does not take the digits of what lies on it.
        assert_eq!(rounded(&[0.125, 5e300], unit), [0.125, 5e300]);
        for (hostile, axis) in [
            (&[1e300, -1e300][..], [-1e300, 1e300]),
            (&[0.0, 5e-324], [0.0, 1.0]),
            (&[f64::MAX], [0.0, 1e300]),
        ] {
            let told = rounded(hostile, axis);
            let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-7 * (axis[1] - axis[0]);
            assert!(hostile.iter().zip(&told).all(near), "{hostile:?} {told:?}");
        }
        assert!(rounded(&[0.0, f64::NAN, 1.0], unit)[1].is_nan());
    }

    #[test]
    fn plotly_is_one_script() {
        let script = plotly();
        assert!(script.starts_with("/**") && script.contains("plotly.js v3"));
        assert!(!script.contains("<script type=\"text/javascript\">"));
        assert!(!script.contains("MathJax-script") && script.len() > 3_000_000);
    }
}

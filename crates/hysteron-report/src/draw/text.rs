//! How wide a text is, so that nothing overlaps or is cut.

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// The font of all figures: Arimo, whose widths are those of Arial and Helvetica, so that a viewer
/// without it keeps the layout. A subset with Latin, Greek, Cyrillic and the signs of units; see
/// `fonts/README.md`.
pub(crate) const FONT: &[u8] = include_bytes!("../../fonts/Arimo-Regular.ttf");

/// The families to look for, best first.
pub(crate) const FAMILIES: &str = "Arimo, 'Liberation Sans', Arial, Helvetica, sans-serif";

/// Width of a character that the font lacks, in parts of the size.
const UNKNOWN: f64 = 0.7;

/// Width of `text` in pixels at `size` pixels.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let Ok(font) = FontRef::new(FONT) else {
        return UNKNOWN * size * text.chars().count() as f64;
    };
    let metrics = font.glyph_metrics(Size::new(size as f32), LocationRef::default());
    let advance = |c| {
        font.charmap()
            .map(c)
            .and_then(|glyph| metrics.advance_width(glyph))
    };
    text.chars()
        .map(|c| advance(c).map_or(UNKNOWN * size, f64::from))
        .sum()
}

/// `text`, cut with an ellipsis where it is wider than `limit`.
pub(crate) fn fit(text: &str, size: f64, limit: f64) -> String {
    if width(text, size) <= limit {
        return text.to_owned();
    }
    let mut cut = text.to_owned();
    while !cut.is_empty() && width(&cut, size) + width("…", size) > limit {
        cut.pop();
    }
    format!("{}…", cut.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_font() {
        assert!((width("0", 1000.0) - 556.0).abs() < 1.0);
        assert!(width("α β γ", 10.0) > width("α β", 10.0));
    }

    #[test]
    fn long_text_is_cut() {
        assert_eq!(fit("short", 10.0, 100.0), "short");
        let cut = fit(&"long ".repeat(50), 10.0, 100.0);
        assert!(cut.ends_with('…') && width(&cut, 10.0) <= 100.0);
    }
}

//! SVG to pixels.

use crate::draw::text::FONT;
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Pixels per SVG pixel: sharp on dense screens, and 290 dpi over a 135 mm column.
const SCALE: f32 = 2.0;

/// The figure as a PNG file. Only the bundled font is used, so every machine draws the same.
pub(crate) fn of_svg(svg: &str) -> Result<Vec<u8>, String> {
    let mut options = usvg::Options::default();
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("Arimo");
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let size = tree
        .size()
        .to_int_size()
        .scale_by(SCALE)
        .ok_or("the figure has no size")?;
    let mut pixels =
        tiny_skia::Pixmap::new(size.width(), size.height()).ok_or("the figure has no size")?;
    resvg::render(
        &tree,
        tiny_skia::Transform::from_scale(SCALE, SCALE),
        &mut pixels.as_mut(),
    );
    pixels.encode_png().map_err(|error| error.to_string())
}

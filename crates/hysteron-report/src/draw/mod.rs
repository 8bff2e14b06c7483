//! A small drawing layer: text that knows its width, an SVG canvas, axes, panels and the sheet
//! around them.

pub(crate) mod axis;
pub(crate) mod canvas;
pub(crate) mod colour;
pub(crate) mod colour_bar;
pub(crate) mod marker;
pub(crate) mod panel;
pub(crate) mod plot;
pub(crate) mod shape;
pub(crate) mod sheet;
pub(crate) mod stretches;
pub(crate) mod style;
pub(crate) mod text;

//! The scale beside a coloured map.

use super::axis::{Axis, Span};
use super::canvas::Canvas;
use super::colour::of_share;
use super::panel::left_of;
use super::shape::{Anchor, Rect, rect_data};
use super::style::{AXIS, LABEL, Stroke, TICK};
use super::text;

/// Width of the bar.
pub(crate) const BAR: f64 = 16.0;
/// From the plot to the bar.
pub(crate) const BESIDE: f64 = 18.0;
const SHADES: usize = 96;

/// Space to the right of a plot `height` pixels high for the bar of `scale`.
pub(crate) fn room(scale: &Axis, height: f64) -> f64 {
    BESIDE + BAR + left_of(scale, height)
}

/// Draws the colours of `scale` over `area`, each value relative to `largest`, with ticks and label
/// on the right.
pub(crate) fn colour_bar(canvas: &mut Canvas, area: Rect, scale: &Axis, largest: f64) {
    let Span { low, high } = scale.span;
    let shade = area.height / SHADES as f64;
    for k in 0..SHADES {
        let value = high + (low - high) * (k as f64 + 0.5) / SHADES as f64;
        let share = if largest > 0.0 { value / largest } else { 0.0 };
        canvas.rect(
            Rect {
                y: area.y + k as f64 * shade,
                height: shade + 0.3,
                ..area
            },
            &of_share(share),
        );
    }
    canvas.path(&rect_data(area), None, Some(&Stroke { width: 0.7, ..AXIS }));
    let mut widest: f64 = 0.0;
    for tick in scale.ticks_up(area.height) {
        let y = area.bottom() - (tick.value - low) / (high - low) * area.height;
        canvas.line([area.right(), y], [area.right() + 4.0, y], &AXIS);
        canvas.text(
            [area.right() + 8.0, y + 0.36 * TICK],
            Anchor::Start,
            TICK,
            &tick.label,
        );
        widest = widest.max(text::width(&tick.label, TICK));
    }
    let label = text::fit(&scale.label(), LABEL, area.height);
    canvas.text_upwards(
        [
            area.right() + 14.0 + widest + LABEL,
            area.y + area.height / 2.0,
        ],
        Anchor::Middle,
        LABEL,
        &label,
    );
}

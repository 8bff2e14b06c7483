//! How often each residual occurs, a panel for each model.

use super::view::{Figure, View};
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::style::{FOLLOWER, REFERENCE, ZERO};
use crate::panels::{WIDTH, height, stack};
use crate::quantity::Labelled;
use crate::stack::Figures;

/// Classes over the range of all residuals.
pub(super) const CLASSES: usize = 41;

pub(super) fn svg(view: &View<'_>) -> String {
    let mut sheet = view.sheet(Figure::Histogram, WIDTH);
    let span = Span::of(view.residuals.iter().flatten()).with(0.0);
    let shares: Vec<[f64; CLASSES]> = view.residuals.iter().map(|r| shares(r, span)).collect();
    let x = Axis::new(&view.residual(), span.padded(0.02));
    let percent = Labelled {
        name: "samples".into(),
        unit: Some("%".into()),
    };
    let highest = Span::from_zero(shares.iter().flatten().copied());
    let y = Axis::new(&percent, highest.padded(0.04).from(0.0));
    let headings = view.headings();
    let high = height(headings.len());
    let (panels, bottom) = stack(&mut sheet, &[], &headings, [&x, &y], high, [0.0; 2]);
    let width = (span.high - span.low) / CLASSES as f64;
    for (panel, shares) in panels.iter().zip(&shares) {
        for (class, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let from = span.low + width * class as f64;
            let [left, top] = panel.point(from, *share);
            let bar = Rect {
                x: left,
                y: top,
                width: panel.px(from + width) - left,
                height: panel.area.bottom() - top,
            };
            sheet.canvas.rect(bar, REFERENCE.colour);
            // The edge of the bar keeps its place on a grey print.
            sheet
                .canvas
                .line([left, top], [left + bar.width, top], &FOLLOWER);
        }
        let zero = panel.px(0.0);
        let (top, bottom) = (panel.area.y, panel.area.bottom());
        sheet.canvas.line([zero, top], [zero, bottom], &ZERO);
    }
    view.finish(Figure::Histogram, sheet, bottom)
}

/// Percent of the residuals in each class.
fn shares(residuals: &[f64], span: Span) -> [f64; CLASSES] {
    let mut shares = [0.0; CLASSES];
    let one = 100.0 / residuals.len().max(1) as f64;
    for residual in residuals.iter().filter(|residual| residual.is_finite()) {
        let place = (residual - span.low) / (span.high - span.low) * CLASSES as f64;
        shares[(place as usize).min(CLASSES - 1)] += one;
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_residual_is_in_one_class() {
        let span = Span {
            low: -1.0,
            high: 1.0,
        };
        let residuals: Vec<f64> = (0..=200).map(|n| f64::from(n) / 100.0 - 1.0).collect();
        let found = shares(&residuals, span);
        // Rounding of 201 terms.
        assert!((found.iter().sum::<f64>() - 100.0).abs() < 1e-9);
        assert!(
            found.iter().all(|share| (1.0..4.0).contains(share)),
            "{found:?}"
        );
        assert!(shares(&[-1.0], span)[0] > 99.0 && shares(&[1.0], span)[CLASSES - 1] > 99.0);
    }
}

//! Modelled minus measured output over time, over the input and by size: a panel for each model.

use crate::draw::axis::{Axis, Span, time_axis};
use crate::draw::panel::Panel;
use crate::draw::shape::Rect;
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{FOLLOWER, REFERENCE, ZERO};
use crate::panels::{Heading, height, stack};
use crate::quantity::Labelled;

/// Classes over the range of all residuals.
pub(crate) const CLASSES: usize = 41;

/// The residuals of models on one recording.
pub(crate) struct Residuals<'a> {
    /// A heading for each model.
    pub(crate) headings: Vec<Heading>,
    /// Modelled minus measured output of each.
    pub(crate) each: &'a [Vec<f64>],
    /// What they are called on an axis.
    pub(crate) label: Labelled,
    /// What the recorded output is called.
    pub(crate) recorded: &'a str,
}

impl Residuals<'_> {
    /// Draws them over time on a sheet; returns the height taken.
    pub(crate) fn over_time(&self, sheet: &mut Sheet, time: &[f64], label: &Labelled) -> f64 {
        let x = time_axis(label, Span::covering(time.iter()));
        let (panels, bottom) = self.panels(sheet, &x);
        for (panel, residuals) in panels.iter().zip(self.each) {
            panel.curve(&mut sheet.canvas, time, residuals, &FOLLOWER);
        }
        bottom
    }

    /// The same over the input.
    pub(crate) fn over_input(&self, sheet: &mut Sheet, input: &[f64], label: &Labelled) -> f64 {
        let x = Axis::new(label, Span::covering(input).padded(0.03));
        let (panels, bottom) = self.panels(sheet, &x);
        for (panel, residuals) in panels.iter().zip(self.each) {
            panel.loops(&mut sheet.canvas, input, residuals, &FOLLOWER);
        }
        bottom
    }

    fn panels(&self, sheet: &mut Sheet, x: &Axis) -> (Vec<Panel>, f64) {
        let words = format!("modelled − {}", self.recorded);
        sheet.legend(&[Key::Line(FOLLOWER, words)]);
        let all = self.each.iter().flatten();
        let y = Axis::new(&self.label, Span::covering(all).with(0.0).padded(0.06));
        let high = height(self.headings.len());
        let (panels, bottom) = stack(sheet, &[], &self.headings, [x, &y], high, [0.0; 2]);
        for panel in &panels {
            panel.level(&mut sheet.canvas, 0.0, &ZERO);
        }
        (panels, bottom)
    }

    /// How often each size occurs.
    pub(crate) fn histogram(&self, sheet: &mut Sheet) -> f64 {
        let span = Span::covering(self.each.iter().flatten()).with(0.0);
        let shares: Vec<[f64; CLASSES]> = self.each.iter().map(|r| shares(r, span)).collect();
        let x = Axis::new(&self.label, span.padded(0.02));
        let percent = Labelled {
            name: "samples".into(),
            unit: Some("%".into()),
        };
        let highest = Span::from_zero(shares.iter().flatten().copied());
        let y = Axis::new(&percent, highest.padded(0.04).from(0.0));
        let high = height(self.headings.len());
        let (panels, bottom) = stack(sheet, &[], &self.headings, [&x, &y], high, [0.0; 2]);
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
        bottom
    }
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

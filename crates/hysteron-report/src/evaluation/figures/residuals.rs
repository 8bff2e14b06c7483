//! Modelled minus measured output over the input, and by size.

use crate::draw::sheet::Drawing;
use crate::evaluation::captions::rmse_and_max;
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::number::difference;
use crate::panels::{Heading, WIDTH};
use crate::residuals::Residuals;
use crate::stack::Figures;

pub(super) fn svg(figure: Figure, view: &View<'_>) -> Drawing {
    let recording = view.recording;
    let each = [difference(&view.evaluation.output_model, &recording.output)];
    let heading = Heading {
        name: "Forward model".into(),
        remark: rmse_and_max(&view.evaluation.forward, &view.output),
    };
    let residuals = Residuals {
        headings: vec![heading],
        each: &each,
        label: view.output.renamed("discrepancy"),
        recorded: view.recorded(),
    };
    let mut sheet = view.sheet(figure, WIDTH);
    let bottom = match figure {
        Figure::OutputHistogram => residuals.histogram(&mut sheet),
        _ => residuals.over_input(&mut sheet, &recording.input, &view.input),
    };
    view.finish(figure, sheet, bottom)
}

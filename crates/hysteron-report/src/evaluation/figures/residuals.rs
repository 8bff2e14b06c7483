//! Modelled minus measured output over the input, and by size.

use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::difference;
use crate::panels::Heading;
use crate::residuals::{CLASSES, Residuals};

/// Two of them stand side by side.
const WIDTH: f64 = 600.0;

pub(crate) fn over_input<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "residuals-input",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: |view| {
            let (input, output) = (&view.input.name, &view.output.name);
            Some([
                format!("discrepancy of the modelled {output} over {input}"),
                format!(
                    "Modelled minus {} {output} at each {input}. What the model cannot follow \
                     shows here as a pattern.",
                    view.recorded()
                ),
            ])
        },
        draw: |view, sheet| {
            let each = [residuals(view)];
            let residuals = of_forward(view, &each);
            Some(residuals.over_input(sheet, &view.recording.input, &view.input))
        },
    }
}

pub(crate) fn histogram<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "residuals-histogram",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words: |view| {
            Some([
                "How often each discrepancy occurs".into(),
                format!(
                    "Modelled minus {} {}: share of the samples in each of {CLASSES} classes of \
                     equal width. Noise alone gives a bell around zero.",
                    view.recorded(),
                    view.output.name
                ),
            ])
        },
        draw: |view, sheet| Some(of_forward(view, &[residuals(view)]).histogram(sheet)),
    }
}

fn residuals(view: &View<'_>) -> Vec<f64> {
    difference(&view.evaluation.output_model, &view.recording.output)
}

fn of_forward<'r>(view: &View<'_>, each: &'r [Vec<f64>]) -> Residuals<'r> {
    let heading = Heading {
        name: "Forward model".into(),
        remark: view.output.rmse_and_max(&view.evaluation.forward),
    };
    Residuals {
        headings: vec![heading],
        each,
        label: view.output.renamed("discrepancy"),
        recorded: view.recorded(),
    }
}

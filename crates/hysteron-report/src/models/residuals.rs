//! Residuals over time, over the input, and as histograms: a panel for each model.

use super::view::View;
use crate::figure::Figure;
use crate::panels::{Heading, WIDTH};
use crate::residuals::{CLASSES, Residuals};

pub(super) fn over_time<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "residuals-time",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: |view| {
            Some([
                format!("Residuals over {}", view.time_label.name),
                format!(
                    "{}, a panel for each model with the same axes. A drift shows here as a slope.",
                    what(view)
                ),
            ])
        },
        draw: |view, sheet| Some(of_models(view).over_time(sheet, &view.time, &view.time_label)),
    }
}

pub(super) fn over_input<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "residuals-input",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: |view| {
            let (what, input) = (what(view), &view.input.name);
            Some([
                format!("Residuals over {input}"),
                format!(
                    "{what} at each {input}. What the model cannot follow shows here as a pattern."
                ),
            ])
        },
        draw: |view, sheet| {
            Some(of_models(view).over_input(sheet, &view.recording.input, &view.input))
        },
    }
}

pub(super) fn histogram<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "residuals-histogram",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words: |view| {
            Some([
                "Residuals: how often each size occurs".into(),
                format!(
                    "{}: share of the samples in each of {CLASSES} classes of equal width. Noise \
                     alone gives a bell around zero.",
                    what(view)
                ),
            ])
        },
        draw: |view, sheet| Some(of_models(view).histogram(sheet)),
    }
}

fn what(view: &View<'_>) -> String {
    format!("Modelled minus measured {}", view.output.name)
}

fn of_models<'v>(view: &'v View<'_>) -> Residuals<'v> {
    let models = view.models.iter();
    let headings = models.map(|model| Heading {
        name: model.name.to_owned(),
        remark: view.output.rmse_and_max(&model.forward.errors),
    });
    Residuals {
        headings: headings.collect(),
        each: &view.residuals,
        label: view.output.renamed("residual"),
        recorded: match view.is_simulated() {
            true => "simulated",
            false => "measured",
        },
    }
}

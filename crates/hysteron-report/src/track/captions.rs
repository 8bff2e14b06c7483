//! Titles and captions of a comparison.

use super::figure::Figure;
use super::view::View;
use crate::number::capitalised;

/// The short title at the head of a figure.
pub(super) fn title(figure: Figure, view: &View<'_>) -> String {
    let (input, output) = (&view.input.name, &view.output.name);
    capitalised(&match figure {
        Figure::Tracking => format!("{output} and its reference"),
        Figure::Error => format!("error of the {output}"),
        Figure::Reversal => "After a reversal of the reference".into(),
        Figure::Input => format!("{input} over time"),
        Figure::Drive => format!("{} over time", view.drive.name),
        Figure::Prediction => format!("prediction error of the {output}"),
        Figure::WeightsTime => "Adapted weights over time".into(),
        Figure::BeforeAfter => "The plane before and after".into(),
    })
}

/// What a figure shows, in a sentence or two.
pub(super) fn caption(figure: Figure, view: &View<'_>) -> String {
    let (input, output) = (&view.input.name, &view.output.name);
    let events = if view.report.events.is_empty() {
        ""
    } else {
        " Dashed lines are the events above."
    };
    let caption = match figure {
        Figure::Tracking => format!(
            "The {output} that each controller reached, over the wide line of the reference. \
             {BEYOND}{events}"
        ),
        Figure::Error => format!(
            "The {output} minus the reference, for every controller on the same axis. \
             {BEYOND}{events}"
        ),
        Figure::Reversal => reversal(view),
        Figure::Input => format!(
            "The {input} of the plant, over the wide line of the {input} that the controller asked \
             for where it does so.{events}{}",
            if view.has_drive() { "" } else { STRIP }
        ),
        Figure::Drive => format!("What each controller wrote to the device.{events}{STRIP}"),
        Figure::Prediction => format!(
            "The {output} that the controller's model expected before it learned from the reading, \
             minus the {output} that came, for the controllers with a model.{events}"
        ),
        Figure::WeightsTime => format!(
            "Change since the first snapshot of the total weight of the rows of the plane, which \
             are the operators that a rising {input} switches on at β; below, of the sum of all \
             weights and of the offset.{}{events}",
            start(view)
        ),
        Figure::BeforeAfter => "The weights of the first and the last snapshot on one scale, and \
                                their difference on its own."
            .into(),
    };
    let caption = capitalised(&caption);
    if view.report.simulated {
        format!("Simulated plant. {caption}")
    } else {
        caption
    }
}

const BEYOND: &str = "Bars at an edge mark samples beyond it: errors that do not last, or of a \
                      minority of the controllers, do not set the scale.";

const STRIP: &str = " The strip below a panel marks the samples at which the loop reported a drive \
                     at its limit, a reference out of the model's reach or a fault of the sensor; \
                     rows that no controller needs are left out.";

fn reversal(view: &View<'_>) -> String {
    let Some(reversal) = &view.reversal else {
        return String::new();
    };
    format!(
        "The reversal of the reference at {}: of those before the first event, the one with the \
         largest difference of lag. The lag is the time by which the {} goes back by a twentieth \
         of the range later than the reference, each from its own extreme. The dashed line is the \
         reversal.",
        view.time.value(reversal.time),
        view.output.name
    )
}

/// Where the weights began.
fn start(view: &View<'_>) -> String {
    let first = view
        .adapting()
        .next()
        .and_then(|run| run.trace.snapshots.first());
    first.map_or(String::new(), |first| {
        format!(
            " At the start the weights sum to {} and the offset is {}.",
            view.output.value(first.weights.iter().sum()),
            view.output.value(first.offset)
        )
    })
}

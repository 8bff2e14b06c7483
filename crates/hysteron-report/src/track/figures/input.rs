//! Input and drive over time, with the status of the loop.

use super::cut::events;
use crate::draw::axis::{Axis, Span};
use crate::draw::panel::{BELOW, Panel};
use crate::draw::plot::Words;
use crate::draw::shape::{Anchor, Rect};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::stretches::{extent, stretches};
use crate::draw::style::{FAINT, FOLLOWER, GRID, LABEL, REFERENCE};
use crate::draw::text;
use crate::figure::Figure;
use crate::panels::{Heading, WIDTH, event_lines, height, stack};
use crate::quantity::Labelled;
use crate::track::tracking::NamedTrace;
use crate::track::view::View;
use hysteron::control::{LoopStatus, Trace};

/// Height of a row of the status strip.
const ROW: f64 = 13.0;
/// Size of the word beside it.
const WORD: f64 = 10.5;

type Flag = fn(&LoopStatus) -> bool;

/// A flag of the status: the word of its row, its meaning, its colour, and how to read it.
const FLAGS: [(&str, &str, &str, Flag); 4] = [
    ("limit", "drive at a limit", "#8fb6d2", |status| {
        status.saturated
    }),
    ("reach", "reference out of reach", "#d2550c", |status| {
        status.out_of_reach
    }),
    ("sensor", "sensor fault", "#12233a", |status| {
        status.sensor_fault
    }),
    ("reading", "reading rejected", "#8a5fa8", |status| {
        status.rejected
    }),
];

/// What captions say of the status.
const STRIP: &str = " The strip below a panel marks the samples at which the loop reported a drive \
                     at its limit, a reference out of the model's reach or a fault of the sensor; \
                     rows that no controller needs are left out.";

pub(crate) fn input<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-input",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: words_of_input,
        draw: draw_input,
    }
}

fn words_of_input(view: &View<'_>) -> Option<[String; 2]> {
    let input = &view.input.name;
    let strip = if view.has_drive() { "" } else { STRIP };
    Some([
        format!("{input} over time"),
        format!(
            "The {input} of the plant, over the wide line of the {input} that the controller asked \
             for where it does so.{}{strip}",
            events(view)
        ),
    ])
}

fn draw_input(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let runs = view.tracking.runs.iter();
    let any = |series: fn(&Trace) -> &[f64]| {
        let mut values = runs.clone().flat_map(|run| series(run.trace));
        values.any(|value| value.is_finite())
    };
    let asked = any(|trace| &trace.command);
    let mut keys = Vec::new();
    if asked {
        keys.push(Key::Line(REFERENCE, "commanded".into()));
    }
    keys.push(Key::Line(FOLLOWER, view.known().into()));
    let curves = |trace: &'_ Trace| [trace.command.clone(), trace.input.clone()];
    let any = asked || any(|trace| &trace.input);
    any.then(|| curves_and_status(view, sheet, &view.input, keys, curves, !view.has_drive()))
}

pub(crate) fn drive<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-drive",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: words_of_drive,
        draw: draw_drive,
    }
}

fn words_of_drive(view: &View<'_>) -> Option<[String; 2]> {
    Some([
        format!("{} over time", view.drive.name),
        format!(
            "What each controller wrote to the device.{}{STRIP}",
            events(view)
        ),
    ])
}

fn draw_drive(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let keys = vec![Key::Line(FOLLOWER, view.drive.name.clone())];
    let curves = |trace: &'_ Trace| [Vec::new(), trace.drive.clone()];
    view.has_drive()
        .then(|| curves_and_status(view, sheet, &view.drive, keys, curves, true))
}

/// Two curves of each run, the first pale beneath the second, and a strip with the status where
/// `strip`.
fn curves_and_status(
    view: &View<'_>,
    sheet: &mut Sheet,
    quantity: &Labelled,
    mut keys: Vec<Key>,
    curves: impl Fn(&Trace) -> [Vec<f64>; 2],
    strip: bool,
) -> f64 {
    let runs = view.tracking.runs;
    let said = |flag: Flag| runs.iter().any(|run| run.trace.status.iter().any(flag));
    let flags: Vec<_> = FLAGS
        .into_iter()
        .filter(|(.., flag)| strip && said(*flag))
        .collect();
    keys.extend(
        flags
            .iter()
            .map(|(_, words, colour, _)| Key::Area(colour, (*words).into())),
    );
    sheet.legend(&keys);
    let drawn: Vec<[Vec<f64>; 2]> = runs.iter().map(|run| curves(run.trace)).collect();
    let y = Axis::new(
        quantity,
        Span::covering(drawn.iter().flatten().flatten()).padded(0.05),
    );
    let headings: Vec<Heading> = runs.iter().map(|run| heading(run, &flags)).collect();
    // Below a panel for the rows, beside it for their words and the label of the axis.
    let words = flags.iter().map(|(word, ..)| text::width(word, WORD));
    let beside = words.fold(0.0, f64::max) + LABEL + 18.0;
    let room = match flags.len() {
        0 => 0.0,
        rows => ROW * rows as f64 + 6.0,
    };
    let (panels, mut bottom) = stack(
        sheet,
        view.tracking.events,
        &headings,
        [&view.time_axis, &y],
        height(runs.len()),
        [room, beside],
    );
    for ((panel, run), [beneath, above]) in panels.iter().zip(runs).zip(&drawn) {
        let time = &run.trace.time;
        panel.curve(&mut sheet.canvas, time, beneath, &REFERENCE);
        panel.curve(&mut sheet.canvas, time, above, &FOLLOWER);
        event_lines(sheet, view.tracking.events, panel);
        for (n, (word, _, colour, flag)) in flags.iter().enumerate() {
            let area = Rect {
                y: panel.area.bottom() + 5.0 + ROW * n as f64,
                height: ROW - 3.0,
                ..panel.area
            };
            row(sheet, panel, run.trace, area, (word, colour, *flag));
        }
    }
    if let Some(panel) = panels.last().filter(|_| room > 0.0) {
        let below = panel.area.bottom() + room;
        time_below(sheet, view, panel, below);
        bottom = below + BELOW + 4.0;
    }
    bottom
}

/// A row of the status strip over `area`: filled where the flag holds.
fn row(
    sheet: &mut Sheet,
    panel: &Panel,
    trace: &Trace,
    area: Rect,
    (word, colour, flag): (&str, &'static str, Flag),
) {
    let canvas = &mut sheet.canvas;
    let middle = area.y + 0.5 * area.height;
    let at = [area.x - 8.0, middle + 0.36 * WORD];
    canvas.words(Words {
        at,
        anchor: Anchor::End,
        size: WORD,
        colour: FAINT,
        text: word.to_owned(),
    });
    canvas.line([area.x, middle], [area.right(), middle], &GRID);
    let clear: Vec<bool> = trace.status.iter().map(|status| !flag(status)).collect();
    let bands = stretches(&clear);
    let times = bands.iter().map(|stretch| extent(&trace.time, stretch));
    panel.fill(canvas, times, area, colour);
}

/// How much of the time each flag held.
fn heading(run: &NamedTrace<'_>, flags: &[(&str, &str, &str, Flag)]) -> Heading {
    let status = &run.trace.status;
    let share = |(word, _, _, flag): &(&str, &str, &str, Flag)| {
        let count = status.iter().filter(|status| flag(status)).count();
        let percent = crate::number::percent(100.0 * count as f64 / status.len().max(1) as f64);
        (count > 0).then(|| format!("{word} {percent}"))
    };
    Heading {
        name: run.name.to_owned(),
        remark: flags
            .iter()
            .filter_map(share)
            .collect::<Vec<_>>()
            .join(", "),
    }
}

/// The time axis below the last strip.
fn time_below(sheet: &mut Sheet, view: &View<'_>, panel: &Panel, y: f64) {
    let area = Rect {
        y,
        height: 0.0,
        ..panel.area
    };
    Panel::x_alone(&mut sheet.canvas, area, view.time_axis.clone());
}

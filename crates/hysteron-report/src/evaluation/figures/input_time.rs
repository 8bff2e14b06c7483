//! Fig. 13: input from the inverse model, and measured input, over time.

use super::over_time::{Curve, plot, policies};
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{ANTICIPATE, MEASURED, MODELLED};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::panels::WIDTH;

const HEIGHT: f64 = 290.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig13-input-time",
        chapter: Some("13"),
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let (input, output, recorded) = (&view.input.name, &view.output.name, view.recorded());
    Some([
        format!("{input} from the inverse model"),
        format!(
            "The {input} that the inverse model finds for the {recorded} {output}, beside the \
             {recorded} {input}. While the {output} rests, hold keeps its {input}; anticipate \
             crosses the dead band as soon as the {output} is known to reverse."
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let inverse = view.inverse()?;
    let mut keys = vec![Key::Line(MEASURED, view.recorded().into())];
    keys.extend(policies(&inverse.moving));
    sheet.legend(&keys);
    let curves: [Curve<'_>; 3] = [
        (&view.recording.input, MEASURED),
        (&inverse.hold.input_model, MODELLED),
        (&inverse.anticipate.input_model, ANTICIPATE),
    ];
    let values = curves.iter().flat_map(|(values, _)| *values);
    let y = Axis::new(&view.input, Span::covering(values).padded(0.04));
    Some(plot(sheet, view, y, &curves, &inverse.moving, HEIGHT).end())
}

//! The plane coloured by what recordings say of each operator.

use crate::draw::axis::{Axis, Span};
use crate::draw::panel::{Labels, Panel, left_of, threshold};
use crate::draw::shape::{Rect, rect_data};
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::style::Stroke;
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::quantity::Labelled;
use hysteron::{Excitation, Plane, Quantity, operators};

const TITLE: &str = "What is known of each operator";
const WIDTH: f64 = 600.0;

/// Darker is better known, so that a grey print keeps the order.
fn colour(class: Excitation) -> &'static str {
    match class {
        Excitation::Never => "#f0f3f6",
        Excitation::Once => "#f8c58c",
        Excitation::Ambiguous => "#6fa8cb",
        Excitation::Determined => "#14467e",
    }
}

/// The half `α ≤ β` of `plane`, a cell for each operator coloured by its class, as an SVG document.
///
/// `classes` holds `K(K + 1)/2` of them in the order of the weights; operators without one are left
/// white. `input` names the axes.
#[must_use]
pub fn excitation_map(plane: &Plane, classes: &[Excitation], input: &Quantity) -> String {
    let input = Labelled::first([input, input], "input");
    let mut sheet = Sheet::new("excitation-map", WIDTH, TITLE, None);
    let height = map(&mut sheet, plane, classes, &input);
    let label = format!("Operators on the plane: {}.", counts(classes));
    sheet.finish(height, &label).svg
}

/// The same for the recording that a model was fitted to, where its file tells.
pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "excitation",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let classes = &view.confidence()?.excitation;
    Some([
        TITLE.into(),
        format!(
            "What the {} that was fitted says of each operator: {}.",
            view.input.name,
            counts(classes)
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let classes = &view.confidence()?.excitation;
    Some(map(sheet, view.source.plane(), classes, &view.input))
}

/// How many operators are in each class, in words.
pub(crate) fn counts(classes: &[Excitation]) -> String {
    let words = Excitation::ALL.map(|class| {
        let count = classes.iter().filter(|c| **c == class).count();
        format!("{count} {}", class.words())
    });
    words.join(", ")
}

/// Legend and plane; returns the height of the figure.
fn map(sheet: &mut Sheet, plane: &Plane, classes: &[Excitation], input: &Labelled) -> f64 {
    let count = |class| classes.iter().filter(|c| **c == class).count();
    let keys = Excitation::ALL.map(|class| {
        let words = format!("{}: {}", class.words(), count(class));
        Key::Area(colour(class), words)
    });
    sheet.legend(&keys);

    let half = 0.5 * plane.step();
    let span = Span {
        low: plane.min() - 1.6 * half,
        high: plane.max() + 1.6 * half,
    };
    let [alpha, beta] = ["α", "β"].map(|symbol| Axis::new(&threshold(symbol, input), span));
    let left = MARGIN + left_of(&beta, WIDTH);
    let side = WIDTH - MARGIN - left;
    let area = Rect {
        x: left,
        y: sheet.top,
        width: side,
        height: side,
    };
    let labels = Labels { x: true, y: true };
    let panel = Panel::draw(&mut sheet.canvas, area, alpha, beta, labels);
    let mut cells = Excitation::ALL.map(|class| (class, String::new()));
    for ((i, j), class) in operators(plane.levels()).zip(classes) {
        let [x, y] = panel.point(plane.level(i) - half, plane.level(j) + half);
        let width = panel.px(plane.level(i) + half) - x;
        let cell = rect_data(Rect {
            x,
            y,
            width,
            height: width,
        });
        cells
            .iter_mut()
            .filter(|(other, _)| other == class)
            .for_each(|(_, path)| path.push_str(&cell));
    }
    // A seam between cells, as far as they are large enough.
    let seam = Stroke::solid("#ffffff", (0.06 * side / plane.levels() as f64).min(1.0));
    for (class, path) in cells.iter().filter(|(_, path)| !path.is_empty()) {
        sheet.canvas.path(path, Some(colour(*class)), Some(&seam));
    }
    panel.end()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn every_operator_is_drawn_in_the_colour_of_its_class() {
        let plane = Plane::new(20.0, 80.0, 4).unwrap();
        let classes: Vec<Excitation> = (0..10).map(|n| Excitation::ALL[n % 4]).collect();
        let svg = excitation_map(
            &plane,
            &classes,
            &Quantity::with_unit("temperature", "degC"),
        );
        let document = roxmltree::Document::parse(&svg).unwrap();
        for (class, cells) in Excitation::ALL.into_iter().zip([3, 3, 2, 2]) {
            let paths = document.descendants().filter_map(|node| {
                let cells = node.attribute("fill") == Some(colour(class))
                    && node.attribute("stroke") == Some("#ffffff");
                cells.then(|| node.attribute("d")).flatten()
            });
            let drawn: Vec<usize> = paths.map(|d| d.matches('z').count()).collect();
            assert_eq!(drawn, [cells], "{class:?}");
            assert!(svg.contains(&format!("{}: {cells}", class.words())));
        }
        assert!(svg.contains("α, temperature [°C]"));
    }
}

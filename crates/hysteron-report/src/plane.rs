//! The half `α ≤ β` of the plane as cells that can be drawn.

use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Canvas;
use crate::draw::colour::of_share;
use crate::draw::panel::{Labels, Panel, threshold};
use crate::draw::shape::{Rect, Short};
use crate::draw::style::Stroke;
use crate::quantity::Labelled;
use hysteron::{Plane, operators};
use std::fmt::Write;

/// More cells a side than this cannot be told apart; neighbours are then drawn as one.
const FINEST: usize = 128;

/// A cell: one operator, or a block of neighbours on a fine plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cell {
    pub(crate) alpha: f64,
    pub(crate) beta: f64,
    /// Sum of the values in the cell.
    pub(crate) sum: f64,
    /// Largest magnitude in the cell.
    pub(crate) largest: f64,
    count: usize,
}

impl Cell {
    pub(crate) fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// A value for every operator, drawable.
pub(crate) struct Half {
    cells: Vec<Cell>,
    /// Cells along each axis.
    pub(crate) side: usize,
    /// Distance of neighbouring cells, in units of the input.
    pub(crate) pitch: f64,
    /// Operators along each side of a cell.
    block: usize,
}

impl Half {
    /// A value for each operator, in the order of the weights.
    pub(crate) fn of_values(plane: &Plane, values: &[f64]) -> Self {
        let levels = plane.levels();
        let block = levels.div_ceil(FINEST).max(1);
        let side = levels.div_ceil(block);
        let pitch = block as f64 * plane.step();
        let middle = 0.5 * (block as f64 - 1.0) * plane.step();
        let centre = |k: usize| plane.level(k * block + 1) + middle;
        let mut cells: Vec<Cell> = (0..side)
            .flat_map(|j| (0..=j).map(move |i| (i, j)))
            .map(|(i, j)| Cell {
                alpha: centre(i),
                beta: centre(j),
                sum: 0.0,
                largest: 0.0,
                count: 0,
            })
            .collect();
        let valued = operators(levels).zip(values);
        for ((i, j), &value) in valued.filter(|(_, value)| value.is_finite()) {
            let (column, row) = ((i - 1) / block, (j - 1) / block);
            if let Some(cell) = cells.get_mut(row * (row + 1) / 2 + column) {
                cell.sum += value;
                cell.largest = cell.largest.max(value.abs());
                cell.count += 1;
            }
        }
        Self {
            cells,
            side,
            pitch,
            block,
        }
    }

    pub(crate) fn cells(&self) -> impl Iterator<Item = Cell> {
        self.cells.iter().copied()
    }

    /// Pixels of a cell: left, top, and its width, which is its height.
    pub(crate) fn place(&self, panel: &Panel, cell: &Cell) -> [f64; 3] {
        let [x, y] = panel.point(cell.alpha - 0.5 * self.pitch, cell.beta + 0.5 * self.pitch);
        [x, y, panel.px(cell.alpha + 0.5 * self.pitch) - x]
    }

    /// Colours each cell by its value relative to `largest`.
    pub(crate) fn fill(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        value: impl Fn(&Cell) -> f64,
        largest: f64,
    ) {
        for cell in self.cells() {
            let [x, y, width] = self.place(panel, &cell);
            let share = if largest > 0.0 {
                value(&cell) / largest
            } else {
                0.0
            };
            // A little wider than the cell; otherwise seams show between cells.
            let (width, height) = (width + 0.3, width + 0.3);
            let area = Rect {
                x,
                y,
                width,
                height,
            };
            canvas.rect(area, &of_share(share));
        }
    }

    /// A minus sign in each cell below `-zero`, which a grey print needs.
    pub(crate) fn signs(&self, canvas: &mut Canvas, panel: &Panel, zero: f64) {
        let mut minus = String::new();
        for cell in self.cells().filter(|cell| cell.sum < -zero) {
            let [x, y, width] = self.place(panel, &cell);
            if width > 4.0 {
                let _ = write!(
                    minus,
                    "M{} {}h{}",
                    Short(x + 0.3 * width),
                    Short(y + 0.5 * width),
                    Short(0.4 * width)
                );
            }
        }
        canvas.path(&minus, None, Some(&MINUS));
    }

    /// Whether all cells hold the same value.
    pub(crate) fn is_uniform(&self) -> bool {
        self.cells
            .windows(2)
            .all(|pair| matches!(pair, [a, b] if (a.mean() - b.mean()).abs() < 1e-9))
    }

    /// What a legend must add where a cell is not one operator.
    pub(crate) fn remark(&self) -> Option<String> {
        (self.block > 1).then(|| format!("each cell: {0} × {0} operators", self.block))
    }

    /// A panel of the plane, with the diagonal `α = β` where `diagonal`.
    pub(crate) fn panel(
        &self,
        canvas: &mut Canvas,
        area: Rect,
        alpha: Axis,
        beta: Axis,
        diagonal: bool,
    ) -> Panel {
        let ends = [
            alpha.span.low.max(beta.span.low),
            alpha.span.high.min(beta.span.high),
        ];
        let panel = Panel::draw(canvas, area, alpha, beta, Labels { x: true, y: true });
        if diagonal {
            canvas.line(
                panel.point(ends[0], ends[0]),
                panel.point(ends[1], ends[1]),
                &DIAGONAL,
            );
        }
        panel
    }
}

/// The sign of a value below zero.
pub(crate) const MINUS: Stroke = Stroke::solid("#1b2128", 1.0);

/// `α = β`.
const DIAGONAL: Stroke = Stroke::solid("#c3c9d1", 1.0);

/// The axes of the plane, `[α, β]`, over all cells.
pub(crate) fn axes(plane: &Plane, input: &Labelled) -> [Axis; 2] {
    let (low, high) = (plane.min(), plane.max());
    let room = 0.8 * plane.step().max((high - low) / FINEST as f64);
    let span = Span {
        low: low - room,
        high: high + room,
    };
    ["α", "β"].map(|symbol| Axis::new(&threshold(symbol, input), span))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::fixture;

    #[test]
    fn a_fine_plane_is_drawn_in_blocks_that_keep_the_sum() {
        let mut fixture = fixture::sma(10);
        fixture.refine(300);
        let model = &fixture.model;
        let half = Half::of_values(model.plane(), model.weights());
        assert_eq!((half.block, half.side), (3, 100));
        let drawn: f64 = half.cells().map(|cell| cell.sum).sum();
        assert!((drawn - model.weights().iter().sum::<f64>()).abs() < 1e-9);
        assert!(half.remark().is_some());
    }

    #[test]
    fn cells_stand_on_their_levels() {
        let fixture = fixture::sma(10);
        let model = &fixture.model;
        let half = Half::of_values(model.plane(), model.weights());
        let corner = half.cells().last().map(|cell| (cell.alpha, cell.beta));
        assert_eq!((half.cells().count(), corner), (210, Some((80.0, 80.0))));
    }
}

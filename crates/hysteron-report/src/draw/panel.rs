//! A pair of axes and what is drawn between them.

use super::axis::Axis;
use super::canvas::Canvas;
use super::marker::ring_around;
use super::plot::{Line, Plot, Shown};
use super::shape::{Anchor, Rect, rect_data};
use super::style::{AXIS, GRID, LABEL, SHADE, Stroke, TICK};
use super::text;
use crate::decimate;
use crate::quantity::Labelled;
use hysteron_files::printable;

/// Space below a panel for tick labels and the axis label.
pub(crate) const BELOW: f64 = 46.0;
const TICK_LENGTH: f64 = 4.0;

/// Which of its two axes a panel names and numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Labels {
    pub(crate) x: bool,
    pub(crate) y: bool,
}

/// A plot area with its axes.
#[derive(Debug)]
pub(crate) struct Panel {
    pub(crate) area: Rect,
    x: Axis,
    y: Axis,
    /// Its place among the plots of the canvas.
    plot: Option<usize>,
}

/// Space to the left of a panel `height` pixels high for the tick labels and label of its `y` axis.
pub(crate) fn left_of(y: &Axis, height: f64) -> f64 {
    y.ticks_up(height)
        .iter()
        .map(|tick| text::width(&tick.label, TICK))
        .fold(0.0, f64::max)
        + LABEL
        + 28.0
}

/// The label of a `y` axis beside `area`, from `left` on.
pub(crate) fn y_label(canvas: &mut Canvas, y: &Axis, left: f64, area: Rect) {
    let middle = area.y + area.height / 2.0;
    let label = text::fit(&y.label(), LABEL, area.height + 30.0);
    canvas.text_upwards([left + LABEL + 2.0, middle], Anchor::Middle, LABEL, &label);
}

impl Panel {
    /// Draws grid and axes over `area`, which excludes the space for labels.
    pub(crate) fn draw(canvas: &mut Canvas, area: Rect, x: Axis, y: Axis, labels: Labels) -> Self {
        canvas.plots.push(Plot::new(
            area,
            Shown::new(&x, labels.x),
            Shown::new(&y, labels.y),
        ));
        let plot = canvas.plots.len().checked_sub(1);
        let panel = Self { area, x, y, plot };
        panel.grid(canvas);
        panel.x_axis(canvas, labels.x);
        panel.y_axis(canvas, labels.y);
        panel
    }

    /// An `x` axis without a panel, at the foot of `area`.
    pub(crate) fn x_alone(canvas: &mut Canvas, area: Rect, x: Axis) {
        let (y, plot) = (x.clone(), None);
        if let Some(last) = canvas.plots.last_mut() {
            last.foot = Some(area.y);
        }
        Self { area, x, y, plot }.x_axis(canvas, true);
    }

    /// Where a figure ends whose last panel this is.
    pub(crate) fn end(&self) -> f64 {
        self.area.bottom() + BELOW + 4.0
    }

    /// Pixel of an x value.
    pub(crate) fn px(&self, value: f64) -> f64 {
        self.area.x
            + (value - self.x.span.low) / (self.x.span.high - self.x.span.low) * self.area.width
    }

    /// Pixel of a y value.
    pub(crate) fn py(&self, value: f64) -> f64 {
        self.area.bottom()
            - (value - self.y.span.low) / (self.y.span.high - self.y.span.low) * self.area.height
    }

    /// Pixels of a pair of values.
    pub(crate) fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.px(x), self.py(y)]
    }

    /// A curve over time.
    pub(crate) fn curve(&self, canvas: &mut Canvas, xs: &[f64], ys: &[f64], stroke: &Stroke) {
        let (xs, ys) = (canvas.broken(xs, |x| x), canvas.broken(ys, |_| f64::NAN));
        self.strokes(canvas, &decimate::columns(self.points(&xs, &ys)), stroke);
        self.plot(canvas, |plot| {
            plot.lines.push(Line::curve(&xs, &ys, *stroke));
        });
    }

    /// A curve that returns on itself.
    pub(crate) fn loops(&self, canvas: &mut Canvas, xs: &[f64], ys: &[f64], stroke: &Stroke) {
        let (xs, ys) = (canvas.broken(xs, |x| x), canvas.broken(ys, |_| f64::NAN));
        self.strokes(canvas, &decimate::loops(self.points(&xs, &ys)), stroke);
        self.plot(canvas, |plot| {
            plot.lines.push(Line::returning(&xs, &ys, *stroke))
        });
    }

    /// Bands from x to x over the full height; bands less than a pixel apart become one.
    pub(crate) fn shade(&self, canvas: &mut Canvas, bands: impl IntoIterator<Item = [f64; 2]>) {
        self.fill(canvas, bands, self.area, SHADE);
        // The shade covers the grid and the axis line's inner half: draw them again.
        self.grid(canvas);
        self.frame(canvas);
    }

    /// Fills bands from x to x between top and bottom of `area`.
    pub(crate) fn fill(
        &self,
        canvas: &mut Canvas,
        bands: impl IntoIterator<Item = [f64; 2]>,
        area: Rect,
        fill: &'static str,
    ) {
        let bands: Vec<[f64; 2]> = bands.into_iter().collect();
        for [from, to] in self.merged(bands.iter().copied()) {
            let width = (to - from).max(1.0);
            canvas.rect(
                Rect {
                    x: from,
                    width,
                    ..area
                },
                fill,
            );
        }
        self.plot(canvas, |plot| plot.bands.push((bands, area, fill)));
    }

    /// Pixels of bands from x to x; bands less than a pixel apart become one.
    pub(crate) fn merged(&self, bands: impl IntoIterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
        let mut merged: Vec<[f64; 2]> = Vec::new();
        let pixel = |x: f64| self.px(x).clamp(self.area.x, self.area.right());
        for [from, to] in bands.into_iter().map(|band| band.map(pixel)) {
            match merged.last_mut() {
                Some(last) if from - last[1] < 1.0 => last[1] = last[1].max(to),
                _ => merged.push([from, to]),
            }
        }
        merged
    }

    /// A filled band between the curves `low` and `high`.
    pub(crate) fn band(
        &self,
        canvas: &mut Canvas,
        xs: &[f64],
        [low, high]: &[Vec<f64>; 2],
        fill: &'static str,
    ) {
        let xs = canvas.broken(xs, |x| x);
        let [low, high] = [low, high].map(|edge| canvas.broken(edge, |_| f64::NAN));
        let edges = self.points(&xs, &low).zip(self.points(&xs, &high));
        let d: String = decimate::covered(edges, self.area.x, self.area.right())
            .into_iter()
            .map(|[x, top, bottom]| {
                rect_data(Rect {
                    x,
                    y: top,
                    width: decimate::COLUMN,
                    height: bottom - top,
                })
            })
            .collect();
        canvas.clipped(self.area, |canvas| canvas.path(&d, Some(fill), None));
        self.plot(canvas, |plot| plot.band(&xs, [&low, &high], fill));
        self.grid(canvas);
        self.frame(canvas);
    }

    /// A horizontal line across the panel.
    pub(crate) fn level(&self, canvas: &mut Canvas, y: f64, stroke: &Stroke) {
        canvas.line(
            [self.area.x, self.py(y)],
            [self.area.right(), self.py(y)],
            stroke,
        );
        self.plot(canvas, |plot| plot.levels.push((y, *stroke)));
    }

    /// A vertical line through the panel, with its words where these stand elsewhere.
    pub(crate) fn upright(&self, canvas: &mut Canvas, x: f64, stroke: &Stroke, words: &str) {
        let at = self.px(x);
        if (self.area.x..=self.area.right()).contains(&at) {
            canvas.line([at, self.area.y], [at, self.area.bottom()], stroke);
            self.plot(canvas, |plot| {
                plot.uprights
                    .push((x, *stroke, printable(words).into_owned()))
            });
        }
    }

    /// A ring around a sample.
    pub(crate) fn ring(&self, canvas: &mut Canvas, [x, y]: [f64; 2], stroke: &Stroke) {
        ring_around(canvas, self.point(x, y), stroke);
        self.plot(canvas, |plot| plot.rings.push(([x, y], *stroke)));
    }

    /// Notes in numbers what was drawn.
    fn plot(&self, canvas: &mut Canvas, note: impl FnOnce(&mut Plot)) {
        if let Some(plot) = self.plot.and_then(|n| canvas.plots.get_mut(n)) {
            note(plot);
        }
    }

    fn points<'a>(&'a self, xs: &'a [f64], ys: &'a [f64]) -> impl Iterator<Item = [f64; 2]> + 'a {
        xs.iter().zip(ys).map(|(&x, &y)| self.point(x, y))
    }

    fn strokes(&self, canvas: &mut Canvas, pieces: &[Vec<[f64; 2]>], stroke: &Stroke) {
        canvas.clipped(self.area, |canvas| {
            pieces
                .iter()
                .for_each(|piece| canvas.polyline(piece, stroke))
        });
    }

    fn grid(&self, canvas: &mut Canvas) {
        let Rect { x, y, .. } = self.area;
        for tick in self.x.ticks_across(self.area.width) {
            let at = self.px(tick.value);
            canvas.line([at, y], [at, self.area.bottom()], &GRID);
        }
        for tick in self.y.ticks_up(self.area.height) {
            let at = self.py(tick.value);
            canvas.line([x, at], [self.area.right(), at], &GRID);
        }
    }

    fn frame(&self, canvas: &mut Canvas) {
        let Rect { x, y, .. } = self.area;
        canvas.polyline(
            &[
                [x, y],
                [x, self.area.bottom()],
                [self.area.right(), self.area.bottom()],
            ],
            &AXIS,
        );
    }

    fn x_axis(&self, canvas: &mut Canvas, labelled: bool) {
        self.frame(canvas);
        let bottom = self.area.bottom();
        for tick in self.x.ticks_across(self.area.width) {
            let at = self.px(tick.value);
            canvas.line([at, bottom], [at, bottom + TICK_LENGTH], &AXIS);
            if labelled {
                canvas.text(
                    [at, bottom + TICK_LENGTH + TICK + 1.0],
                    Anchor::Middle,
                    TICK,
                    &tick.label,
                );
            }
        }
        if labelled {
            let middle = self.area.x + self.area.width / 2.0;
            let label = text::fit(&self.x.label(), LABEL, self.area.width);
            canvas.text(
                [middle, bottom + BELOW - 6.0],
                Anchor::Middle,
                LABEL,
                &label,
            );
        }
    }

    fn y_axis(&self, canvas: &mut Canvas, labelled: bool) {
        let left = self.area.x;
        for tick in self.y.ticks_up(self.area.height) {
            let at = self.py(tick.value);
            canvas.line([left - TICK_LENGTH, at], [left, at], &AXIS);
            if labelled {
                canvas.text(
                    [left - TICK_LENGTH - 4.0, at + 0.36 * TICK],
                    Anchor::End,
                    TICK,
                    &tick.label,
                );
            }
        }
        if labelled {
            let at = left - left_of(&self.y, self.area.height);
            y_label(canvas, &self.y, at, self.area);
        }
    }
}

/// The α or β axis of the plane: both are inputs.
pub(crate) fn threshold(symbol: &str, input: &Labelled) -> Labelled {
    input.renamed(&format!("{symbol}, {}", input.name))
}

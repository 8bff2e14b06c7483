//! A model in a few numbers: those of its major loop.

use crate::model::Model;
use hysteron_core::operators;

/// The major loop of a model in a few numbers.
///
/// The loop runs over the active range of the plane; without stages that depend on time, and in
/// the middle of the loads. Every number is the mean of the rising and the falling branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Saturation: output with every operator on minus that with every operator off, in the
    /// output's unit. Negative where the output falls.
    pub stroke: f64,
    /// Mean distance of the branches along the input: area of the loop by its stroke, in the
    /// input's unit. `None` without a stroke.
    pub width: Option<f64>,
    /// Slope from 10 % to 90 % of the stroke, in the output's unit per the input's. `None` without a
    /// stroke.
    pub slope: Option<f64>,
    /// Input at half the stroke, in the input's unit. `None` without a stroke.
    pub position: Option<f64>,
}

impl Shape {
    /// The numbers of a model's major loop.
    ///
    /// ```
    /// use hysteron::{Model, Operator, Plane, Shape, Sign};
    /// // One operator, as wide as three levels: it rises from 40 to 50 and falls from 20 to 10.
    /// let plane = Plane::new(10.0, 50.0, 5)?;
    /// let mut weights = vec![0.0; 15];
    /// weights[hysteron::operator_index(2, 5)] = 8.0;
    /// let model = Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Negative)?;
    /// let shape = Shape::new(&model);
    /// assert_eq!((shape.stroke, shape.width, shape.position), (-8.0, Some(30.0), Some(30.0)));
    /// assert!((shape.slope.unwrap() + 0.8).abs() < 1e-12);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn new(model: &Model) -> Self {
        let plane = model.plane();
        let levels = plane.levels();
        let inputs = corners(model);
        // The sum of the weights whose operators a rise from below has switched on at each corner,
        // and of those that a fall from above has left on.
        let (mut rising, mut falling) = (vec![0.0; levels + 1], vec![0.0; levels + 1]);
        for ((i, j), weight) in operators(levels).zip(model.weights()) {
            rising[j] += weight;
            falling[i] += weight;
        }
        for branch in [&mut rising, &mut falling] {
            for n in 1..branch.len() {
                branch[n] += branch[n - 1];
            }
        }
        let all = rising[levels];
        let (off, on) = model.output_range();
        let stroke = on - off;
        let rounding = f64::EPSILON * model.weights().iter().map(|w| w.abs()).sum::<f64>();
        if all.abs() <= rounding * levels as f64 {
            return Self {
                stroke,
                width: None,
                slope: None,
                position: None,
            };
        }
        let gap = |n: usize| (falling[n] - rising[n]) / all;
        let steps = 0..levels;
        let area = steps.map(|n| 0.5 * (gap(n) + gap(n + 1)) * (inputs[n + 1] - inputs[n]));
        let at = |share: f64| {
            let [up, down] =
                [&rising, &falling].map(|branch| crossing(&inputs, branch, share * all));
            Some(0.5 * (up? + down?))
        };
        let span = at(0.9).zip(at(0.1)).map(|(end, begin)| end - begin);
        Self {
            stroke,
            width: Some(area.sum()),
            slope: span
                .filter(|span| *span > 0.0)
                .map(|span| 0.8 * stroke / span),
            position: at(0.5),
        }
    }
}

/// The inputs at the corners of the grid, in the middle of the loads.
fn corners(model: &Model) -> Vec<f64> {
    let plane = model.plane();
    if !model.spacing().is_empty() && model.registration().is_none() {
        return model.spacing().to_vec();
    }
    if !model.registration().is_none() {
        let ((low, high), count) = (model.active_range(), plane.levels());
        let at = |n| low + (high - low) * n as f64 / count as f64;
        return (0..=count).map(at).collect();
    }
    (0..=plane.levels()).map(|n| plane.level(n)).collect()
}

/// The first input at which a branch passes a value, linear between the inputs.
fn crossing(inputs: &[f64], branch: &[f64], value: f64) -> Option<f64> {
    let passes = |pair: &[f64]| (pair[0] < value) != (pair[1] < value);
    let n = branch.windows(2).position(passes)?;
    let share = (value - branch[n]) / (branch[n + 1] - branch[n]);
    Some(inputs[n] + share * (inputs[n + 1] - inputs[n]))
}

//! Expected numbers from the definition alone: forward by running it, inverse by searching it.

use hysteron::{Model, Result};
use hysteron_core::Definition;

/// Outputs closer than this share of the range are the same: rounding.
const SAME: f64 = 1e-12;

/// The outputs of the plain definition for `input`, from all operators off.
pub fn forward(model: &Model, input: &[f64]) -> Result<Vec<f64>> {
    let mut states = vec![0.0; model.weights().len()];
    let (plane, operator) = (*model.plane(), model.operator());
    let mut plain = Definition::new(plane, operator, model.weights(), &mut states)?;
    let outward = |sum: f64| model.offset() + model.sign().factor() * sum;
    let outputs = input.iter().map(|&input| Ok(outward(plain.step(input)?)));
    outputs.collect()
}

/// What an inverse is asked for, sample by sample.
pub struct Wanted {
    pub target: f64,
    /// Where the target goes next, for the policy *anticipate*: 1 or −1; 0 for *hold*.
    pub heading: i8,
    pub tolerance: f64,
}

/// The inverse as a search over the definition: the whole history runs again for each input that is
/// tried.
pub struct Search {
    model: Model,
    history: Vec<f64>,
    input: f64,
    output: f64,
    /// Direction of the output's branch, and the output where the branch began.
    branch: (i8, f64),
    /// How many inputs came before the branch.
    begun: usize,
    /// Input and output where the output is least, and where it is greatest.
    ends: [(f64, f64); 2],
}

impl Search {
    pub fn new(model: &Model) -> Result<Self> {
        let bottom = model.plane().bottom();
        let mut search = Self {
            model: model.clone(),
            history: Vec::new(),
            input: bottom,
            output: 0.0,
            branch: (0, 0.0),
            begun: 0,
            ends: [(0.0, 0.0); 2],
        };
        search.weigh(model)?;
        Ok(search)
    }

    /// Goes on with the weights of `model`. The operators stay as they are.
    pub fn weigh(&mut self, model: &Model) -> Result<()> {
        self.model.clone_from(model);
        let (bottom, max) = (model.plane().bottom(), model.plane().max());
        let off = (bottom, forward(model, &[bottom])?[0]);
        let on = (max, forward(model, &[max])?[0]);
        self.ends = if off.1 < on.1 { [off, on] } else { [on, off] };
        let after = |inputs: &[f64]| -> Result<f64> {
            Ok(forward(model, inputs)?.last().copied().unwrap_or(off.1))
        };
        self.output = after(&self.history)?;
        self.branch.1 = after(&self.history[..self.begun])?;
        Ok(())
    }

    /// The input for the next target, and the status: −1 below reach, 1 above, 0 reached. Goes
    /// there.
    pub fn step(&mut self, wanted: &Wanted) -> Result<(f64, i8)> {
        let found = self.find(wanted)?;
        self.travel(found.0)?;
        Ok(found)
    }

    /// As [`Search::step`], without going there.
    pub fn find(&self, wanted: &Wanted) -> Result<(f64, i8)> {
        let &Wanted {
            target,
            heading,
            tolerance,
        } = wanted;
        let [(lowest, least), (highest, greatest)] = self.ends;
        let same = SAME * (greatest - least);
        let reach = tolerance.max(same);
        let direction = if target > self.output { 1 } else { -1 };
        let rest = if self.branch.0 == heading {
            self.branch.1
        } else {
            self.output
        };
        let apart = (target - self.output).abs();
        // How far the output has moved on from the target that way.
        let way = f64::from(heading);
        let away = way * (self.output - target);
        let (input, status) = if target > greatest + reach {
            (highest, 1)
        } else if target < least - reach {
            (lowest, -1)
        } else if heading != 0 && (target - rest).abs() <= reach && away <= reach {
            // To the edge of the dead band, no further than the tolerance from target and rest.
            let from = if way > 0.0 {
                target.min(rest)
            } else {
                target.max(rest)
            };
            let left = |output| way * (output - from) > tolerance;
            (self.first(heading, left)?, 0)
        } else if apart <= same || direction != self.branch.0 && apart <= tolerance {
            (self.input, 0)
        } else {
            let met = |output| f64::from(direction) * (output - target) >= 0.0;
            (self.first(direction, met)?, 0)
        };
        Ok((input, status))
    }

    /// The last input.
    pub fn input(&self) -> f64 {
        self.input
    }

    /// The last output.
    pub fn output(&self) -> f64 {
        self.output
    }

    /// The least and the greatest output.
    pub fn range(&self) -> (f64, f64) {
        (self.ends[0].1, self.ends[1].1)
    }

    /// The first input at which `met` holds, on the way from here to the end of the output's range.
    fn first(&self, direction: i8, met: impl Fn(f64) -> bool) -> Result<f64> {
        let mut before = self.input;
        let mut after = self.ends[usize::from(direction > 0)].0;
        loop {
            let middle = before + (after - before) / 2.0;
            if middle == before || middle == after {
                return Ok(after);
            }
            if met(self.after(middle)?) {
                after = middle;
            } else {
                before = middle;
            }
        }
    }

    /// The output at an input, if it went there.
    pub fn after(&self, input: f64) -> Result<f64> {
        let way: Vec<f64> = self.history.iter().copied().chain([input]).collect();
        let outputs = forward(&self.model, &way)?;
        Ok(outputs[outputs.len() - 1])
    }

    /// Goes to an input.
    pub fn travel(&mut self, input: f64) -> Result<()> {
        let output = self.after(input)?;
        if input != self.input {
            let upwards = (input > self.input) == (self.ends[0].0 < self.ends[1].0);
            let direction = if upwards { 1 } else { -1 };
            if direction != self.branch.0 {
                self.branch = (direction, self.output);
                self.begun = self.history.len();
            }
        }
        self.history.push(input);
        (self.input, self.output) = (input, output);
        Ok(())
    }
}

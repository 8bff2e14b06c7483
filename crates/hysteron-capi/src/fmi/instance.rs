//! An instance: a block, its state in the standard's state machine, and its run.

use super::block::{Block, Inputs, Outputs};
use super::state::State;
use super::{Problem, Result};

/// The states of the standards' state machine that this FMU uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Phase {
    Instantiated,
    Initialising,
    Stepping,
    Terminated,
}

/// Everything that changes. It is the content of a saved state.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    pub(crate) phase: Phase,
    pub(crate) time: f64,
    pub(crate) stop: Option<f64>,
    pub(crate) inputs: Inputs,
    /// Results of the last step.
    pub(crate) outputs: Outputs,
    pub(crate) state: State,
}

#[derive(Debug)]
pub(crate) struct Instance {
    pub(crate) block: Block,
    pub(crate) run: Run,
    /// Saved states. They are freed with the instance.
    pub(crate) saved: Vec<u64>,
}

impl Instance {
    pub(crate) fn new(block: Block) -> Result<Self> {
        let run = Run::new(&block)?;
        Ok(Self {
            block,
            run,
            saved: Vec::new(),
        })
    }

    pub(crate) fn block(&self) -> &Block {
        &self.block
    }

    pub(crate) fn time(&self) -> f64 {
        self.run.time
    }

    pub(crate) fn inputs(&self) -> &Inputs {
        &self.run.inputs
    }

    /// The results of the last step. Before the first one, those of the start.
    pub(crate) fn outputs(&self) -> Result<Outputs> {
        match self.run.phase {
            Phase::Instantiated | Phase::Initialising => Ok(self.begun()?.1),
            Phase::Stepping | Phase::Terminated => Ok(self.run.outputs),
        }
    }

    /// The state after the start inputs. It is not kept, so that a tool can try other inputs.
    fn begun(&self) -> Result<(State, Outputs)> {
        let mut state = self.block.start(self.run.inputs.start_on)?;
        let outputs = self.block.step(&mut state, &self.run.inputs, 0.0)?;
        Ok((state, outputs))
    }

    pub(super) fn expect(&self, allowed: &[Phase]) -> Result<()> {
        match allowed.contains(&self.run.phase) {
            true => Ok(()),
            false => Err(Problem::new(match self.run.phase {
                Phase::Instantiated => "initialisation has not been entered yet",
                Phase::Initialising => "the instance is being initialised",
                Phase::Stepping => "the instance is initialised already",
                Phase::Terminated => "the instance was terminated: reset it first",
            })),
        }
    }

    pub(crate) fn experiment(&mut self, start: f64, stop: Option<f64>) -> Result<()> {
        self.expect(&[Phase::Instantiated])?;
        if !start.is_finite() || stop.is_some_and(|stop| stop.is_nan() || stop < start) {
            let stop = stop.unwrap_or(f64::INFINITY);
            return Err(Problem(format!(
                "no experiment goes from {start} to {stop}"
            )));
        }
        (self.run.time, self.run.stop) = (start, stop);
        Ok(())
    }

    pub(crate) fn enter_initialisation(&mut self) -> Result<()> {
        self.expect(&[Phase::Instantiated])?;
        self.run.phase = Phase::Initialising;
        Ok(())
    }

    pub(crate) fn exit_initialisation(&mut self) -> Result<()> {
        self.expect(&[Phase::Initialising])?;
        (self.run.state, self.run.outputs) = self.begun()?;
        self.run.phase = Phase::Stepping;
        Ok(())
    }

    /// The inputs act over the whole step. Operators alone depend on their order and not on time.
    pub(crate) fn step(&mut self, from: f64, size: f64) -> Result<()> {
        self.expect(&[Phase::Stepping])?;
        let to = from + size;
        // Written so that NaN fails the comparison.
        if !(size >= 0.0 && to.is_finite()) {
            return Err(Problem(format!("no step goes from {from} by {size}")));
        }
        if !close(from, self.run.time) {
            let time = self.run.time;
            return Err(Problem(format!(
                "the step begins at {from}, but the last one ended at {time}"
            )));
        }
        if let Some(stop) = self.run.stop.filter(|stop| to > *stop && !close(to, *stop)) {
            return Err(Problem(format!(
                "the step ends at {to}, after the stop time {stop}"
            )));
        }
        let (state, inputs) = (&mut self.run.state, &self.run.inputs);
        self.run.outputs = self.block.step(state, inputs, size)?;
        self.run.time = to;
        Ok(())
    }

    pub(crate) fn terminate(&mut self) -> Result<()> {
        self.expect(&[Phase::Stepping])?;
        self.run.phase = Phase::Terminated;
        Ok(())
    }

    pub(crate) fn reset(&mut self) -> Result<()> {
        self.run = Run::new(&self.block)?;
        Ok(())
    }
}

impl Run {
    fn new(block: &Block) -> Result<Self> {
        let outputs = Outputs {
            signal: 0.0,
            flag: 0,
            temperature: 0.0,
        };
        Ok(Self {
            phase: Phase::Instantiated,
            time: 0.0,
            stop: None,
            inputs: block.inputs(),
            outputs,
            state: block.start(false)?,
        })
    }
}

/// Tools add steps up to times, which gives rounding errors.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1.0)
}

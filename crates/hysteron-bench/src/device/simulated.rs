//! A plant of `track` that speaks the protocol. It waits for each drive.

use super::line::{Line, Received};
use crate::protocol::{ToDevice, closed, opened};
use hysteron::control::SimulatedPlant;
use hysteron_sim::track::PlantOptions;
use std::collections::VecDeque;
use std::io;
use std::time::Instant;

/// A **simulated** device, inside the program.
pub struct Simulated {
    plant: Box<dyn SimulatedPlant>,
    options: PlantOptions,
    interval_s: f64,
    /// Lines to be read.
    lines: VecDeque<String>,
    /// Number of the last sample; `None` before the first.
    sample: Option<u64>,
    ended: bool,
}

impl Simulated {
    /// A plant by its name, with the noise of `seed`.
    ///
    /// # Errors
    /// What is wrong: no such plant.
    pub fn new(kind: &str, interval_s: f64, seed: u64) -> Result<Self, String> {
        let options = PlantOptions::named(kind).ok_or_else(|| {
            format!("there is no plant `{kind}`: spring, preisach or wire is needed")
        })?;
        let plant = options.build(seed).map_err(|error| error.to_string())?;
        Ok(Self {
            plant,
            options,
            interval_s,
            lines: VecDeque::new(),
            sample: None,
            ended: false,
        })
    }

    fn header(&self) -> String {
        let [drive, input, output] = self.options.quantities();
        let unit =
            |unit: &Option<String>| unit.as_ref().map_or(String::new(), |u| format!("[{u}]"));
        let (low, high) = self.options.drives();
        let mut columns = format!("output{}", unit(&output.unit));
        if self.plant_measures_input() {
            columns += &format!(",{}{}", input.name, unit(&input.unit));
        }
        format!(
            "H 1 name=simulated dt={} drive={low}:{high}{} safe={low} watchdog=1 columns={columns}",
            self.interval_s,
            unit(&drive.unit)
        )
    }

    fn plant_measures_input(&self) -> bool {
        matches!(self.options, PlantOptions::Spring(_))
    }

    /// Lets the time to the next sample pass, and reads it.
    fn sample(&mut self, applied: u64) {
        self.plant.advance(self.interval_s);
        let number = self.sample.map_or(1, |last| last + 1);
        self.sample = Some(number);
        let reading = self.plant.read();
        let mut text = format!(
            "S {number} {:.6} {applied} {}",
            number as f64 * self.interval_s,
            reading.output
        );
        if let (true, Some(input)) = (self.plant_measures_input(), reading.input) {
            text += &format!(" {input}");
        }
        self.lines.push_back(closed(&text));
    }

    fn safe(&mut self) {
        self.plant.write(self.options.drives().0);
    }
}

impl Line for Simulated {
    fn send(&mut self, line: &str) -> io::Result<()> {
        let Some(text) = opened(line.trim_end().as_bytes()) else {
            return Ok(());
        };
        let words: Vec<&str> = text.split(' ').collect();
        match words.as_slice() {
            ["?"] => self.lines.push_back(closed(&self.header())),
            ["G"] if self.sample.is_none() => {
                self.safe();
                self.sample(0);
            }
            ["D", number, drive] if !self.ended => {
                let (number, drive) = (number.parse().ok(), drive.parse::<f64>().ok());
                if let (Some(number), Some(drive)) = (number, drive)
                    && self.sample == Some(number)
                {
                    self.plant.write(drive);
                    self.sample(number);
                }
            }
            _ if line == ToDevice::Quit.line() => {
                self.safe();
                self.ended = true;
                self.lines.push_back(closed("E host"));
            }
            _ => {}
        }
        Ok(())
    }

    fn receive(&mut self, deadline: Instant) -> Received {
        match self.lines.pop_front() {
            Some(line) => Received::Line(line.trim_end().as_bytes().to_vec(), Instant::now()),
            None if self.ended => Received::Closed,
            None => {
                std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
                Received::Silence
            }
        }
    }

    fn close(self: Box<Self>, _deadline: Instant) -> Option<String> {
        None
    }
}

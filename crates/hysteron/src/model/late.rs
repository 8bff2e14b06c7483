//! What comes late in a model, in words.

use super::Model;
use crate::recording::Quantity;
use crate::remedy::counted;

impl Model {
    /// What comes late in the model, a phrase for each kind: dead time, creep and lag, ring. A ring
    /// that a fit found tells what it gained on what was left out. Empty for a model that answers at
    /// once.
    ///
    /// ```
    /// use hysteron::{Delay, Fit, Recording};
    /// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
    /// let model = Fit::new().bootstrap(0).run(&Recording::new(input.clone(), input)?)?;
    /// assert!(model.late_words().is_empty());
    /// let late = model.with_delay(Delay::new(2, 0.5)?);
    /// assert_eq!(late.late_words(), ["dead time of 2 samples, 1.000 s"]);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn late_words(&self) -> Vec<String> {
        let words = [self.delay_words(), self.after_words(), self.ring_words()];
        words.into_iter().flatten().collect()
    }

    fn delay_words(&self) -> Option<String> {
        let delay = self.delay();
        let (samples, seconds) = (delay.samples(), number(delay.seconds()));
        (!delay.is_none())
            .then(|| format!("dead time of {}, {seconds} s", counted(samples, "sample")))
    }

    fn after_words(&self) -> Option<String> {
        let creep = self.creep().into_iter().map(|term| {
            let (percent, seconds) = (100.0 * term.coefficient, number(term.tau));
            format!("creep of {percent:.2} % with {seconds} s")
        });
        let lag = Some(self.lag()).filter(|lag| *lag > 0.0);
        let lag = lag.map(|lag| format!("lag of {} s", number(lag)));
        let words: Vec<String> = creep.chain(lag).collect();
        (!words.is_empty()).then(|| words.join(", "))
    }

    fn ring_words(&self) -> Option<String> {
        let constants = self.constants();
        let [frequency, damping] = ["ring_frequency", "ring_damping"]
            .map(|name| constants.get(name).first().map(|value| number(*value)));
        let words = format!("rings at {} Hz, with a damping of {}", frequency?, damping?);
        let report = self.fit.as_ref().and_then(|fit| fit.other.get("ring"));
        let error = |name| report?.get(name)?.as_f64();
        let gain = match (error("without"), error("with")) {
            (Some(without), Some(with)) => {
                format!(": parts left out are predicted to {with:.2} % instead of {without:.2} %")
            }
            _ => String::new(),
        };
        Some(words + &gain)
    }
}

fn number(value: f64) -> String {
    Quantity::default().text(value)
}

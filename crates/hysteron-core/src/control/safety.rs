//! Gives a loop up whose output is not known for too long.

/// Times after which a controller gives its loop up. From then on the drive is the safe one, until
/// it is told to go on. `None` for never: who runs the loop then decides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Safety {
    /// Time without a finite reading of the output, s.
    pub lost_s: Option<f64>,
    /// The same for a reading that stands still where it has to move ([`super::Standstill`]).
    pub stuck_s: Option<f64>,
}

/// Sums of intervals that differ by less than this share of an interval are one time.
const ROUNDING: f64 = 0.01;

/// How long there has been no reading, and whether the loop was given up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Silence {
    silent: f64,
    given_up: bool,
}

impl Silence {
    /// Takes a reading, and how long it has stood still where it has to move.
    pub fn push(&mut self, safety: Safety, reading: f64, stuck_s: Option<f64>, dt: f64) {
        self.silent = match reading.is_finite() {
            true => 0.0,
            false => self.silent + dt,
        };
        let rounding = dt * ROUNDING;
        let over = |time: f64, most: Option<f64>| most.is_some_and(|most| time >= most - rounding);
        let lost = over(self.silent, safety.lost_s);
        let stuck = stuck_s.is_some_and(|time| over(time, safety.stuck_s));
        self.given_up |= lost || stuck;
    }

    /// Whether the loop was given up.
    #[must_use]
    pub fn given_up(&self) -> bool {
        self.given_up
    }
}

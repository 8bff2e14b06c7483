//! The dead time of an actuator, sample by sample.

/// The longest dead time, in samples.
pub(crate) const MOST: usize = 1000;

/// Inputs that were given and have not acted yet, in memory for [`MOST`] of them. Before the first
/// sample the input stood where it is first.
#[derive(Debug, Clone)]
pub(crate) struct UnderWay<B> {
    /// The dead time: samples, and s.
    dead: (usize, f64),
    memory: B,
    /// How many are under way. `None` until the second sample tells the interval.
    late: Option<usize>,
    /// Where the one is that arrives next.
    next: usize,
    /// The first input; `None` before the first sample.
    first: Option<f64>,
}

impl<B: AsRef<[f64]> + AsMut<[f64]>> UnderWay<B> {
    /// Nothing is under way. The dead time is so many samples of the recording, and s.
    pub(crate) fn new(dead: (usize, f64), memory: B) -> Self {
        Self {
            dead,
            memory,
            late: None,
            next: 0,
            first: None,
        }
    }

    pub(crate) fn clear(&mut self) {
        (self.late, self.next, self.first) = (None, 0, None);
    }

    /// The dead time in samples that are `dt` s apart; in its own where that is not known.
    fn samples(&self, dt: Option<f64>) -> usize {
        let (samples, seconds) = self.dead;
        let count = match dt.filter(|dt| *dt > 0.0) {
            Some(dt) => (seconds / dt).round().min(MOST as f64) as usize,
            None => samples,
        };
        count.min(self.memory.as_ref().len())
    }

    /// The input that acts at a sample at which `input` is given.
    pub(crate) fn acting(&self, input: f64, dt: Option<f64>) -> f64 {
        let Some(first) = self.first else {
            return input;
        };
        match self.late {
            None if self.samples(dt) > 0 => first,
            Some(1..) => self.memory.as_ref()[self.next],
            _ => input,
        }
    }

    /// Notes that `input` was given.
    pub(crate) fn push(&mut self, input: f64, dt: Option<f64>) {
        if self.dead.0 == 0 {
            return;
        }
        let Some(first) = self.first else {
            self.first = Some(input);
            return;
        };
        let late = self.late.unwrap_or_else(|| {
            let late = self.samples(dt);
            self.memory.as_mut()[..late].fill(first);
            late
        });
        self.late = Some(late);
        if late > 0 {
            self.memory.as_mut()[self.next] = input;
            self.next = (self.next + 1) % late;
        }
    }

    /// Those under way, from the one that arrives next.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = f64> {
        let late = self.late.unwrap_or(0);
        let (later, sooner) = self.memory.as_ref()[..late].split_at(self.next);
        let first = self.first.filter(|_| self.late.is_none());
        sooner.iter().chain(later).copied().chain(first)
    }

    /// Goes to where [`UnderWay::inputs`] were these. `false` for more than there can be.
    pub(crate) fn restore(&mut self, inputs: &[f64]) -> bool {
        self.clear();
        let Some(room) = self.memory.as_mut().get_mut(..inputs.len()) else {
            return false;
        };
        room.copy_from_slice(inputs);
        self.first = inputs.first().copied();
        self.late = Some(inputs.len()).filter(|late| *late > 1);
        true
    }

    /// Goes to where another one is.
    pub(crate) fn follow(&mut self, other: &Self) {
        (self.late, self.next, self.first) = (other.late, other.next, other.first);
        let late = self.late.unwrap_or(0);
        self.memory.as_mut()[..late].copy_from_slice(&other.memory.as_ref()[..late]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plain definition: the input of so many samples before, or the first one.
    #[test]
    fn an_input_arrives_so_many_samples_later() {
        for (samples, dt) in (0..12).flat_map(|n| [(n, None), (n, Some(0.1)), (n, Some(0.05))]) {
            let late = match dt {
                Some(0.05) => 2 * samples,
                _ => samples,
            };
            let dead = (samples, 0.1 * samples as f64);
            let mut under_way = UnderWay::new(dead, vec![0.0; MOST]);
            let input: Vec<f64> = (0..60).map(|n| f64::from(n * n % 13)).collect();
            for (n, &x) in input.iter().enumerate() {
                let dt = dt.filter(|_| n > 0);
                assert_eq!(under_way.acting(x, dt), input[n.saturating_sub(late)]);
                under_way.push(x, dt);
                // What is saved and restored goes on in the same way.
                let saved: Vec<f64> = under_way.inputs().collect();
                if n % 3 == 0 {
                    under_way = UnderWay::new(dead, vec![7.0; MOST]);
                    assert!(under_way.restore(&saved));
                }
                let mut other = UnderWay::new(dead, vec![9.0; MOST]);
                other.follow(&under_way);
                assert!(other.inputs().eq(under_way.inputs()));
            }
        }
    }

    #[test]
    fn no_interval_makes_more_than_there_is_room_for() {
        let mut under_way = UnderWay::new((MOST, 1e300), vec![0.0; MOST]);
        for n in 0..3 {
            under_way.push(f64::from(n), Some(1e-300));
        }
        assert_eq!(under_way.inputs().count(), MOST);
        assert!(!under_way.restore(&vec![0.0; MOST + 1]));
        assert_eq!(UnderWay::new((1, 1e-300), [0.0]).samples(Some(1e300)), 0);
    }
}

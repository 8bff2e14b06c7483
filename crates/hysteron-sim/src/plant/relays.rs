//! A sum of ideal relays that switches only those whose threshold is passed.

/// A relay: on from `up` upwards, off from `down` downwards, and what it was between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Relay {
    pub(super) down: f64,
    pub(super) up: f64,
}

/// A threshold and the relay that has it.
type Threshold = (f64, u32);

/// Relays of equal weight under one input.
#[derive(Debug, Clone)]
pub(super) struct Relays {
    input: f64,
    on: Vec<bool>,
    /// How many are on: a whole number, so that switching leaves no rounding behind.
    count: usize,
    ups: Vec<Threshold>,
    downs: Vec<Threshold>,
}

impl Relays {
    /// `relays` that have come to `input` from far below.
    pub(super) fn new(relays: &[Relay], input: f64) -> Self {
        let mut new = Self {
            input,
            on: vec![false; relays.len()],
            count: 0,
            ups: Vec::new(),
            downs: Vec::new(),
        };
        new.replace(relays);
        new
    }

    /// Gives the relays other thresholds. Each keeps its state where the input lies between its new
    /// ones.
    pub(super) fn replace(&mut self, relays: &[Relay]) {
        let sorted = |threshold: fn(&Relay) -> f64| {
            let mut all: Vec<Threshold> = relays.iter().map(threshold).zip(0..).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all
        };
        self.ups = sorted(|relay| relay.up);
        self.downs = sorted(|relay| relay.down);
        for (on, relay) in self.on.iter_mut().zip(relays) {
            *on = self.input >= relay.up || (*on && self.input > relay.down);
        }
        self.count = self.on.iter().filter(|on| **on).count();
    }

    /// Moves the input one way to `input`.
    pub(super) fn travel(&mut self, input: f64) {
        // Rising passes the thresholds in (old, new], falling those in [new, old).
        let rising = input > self.input;
        let (from, to) = if rising {
            let passed = |x: f64| self.ups.partition_point(|&(up, _)| up <= x);
            (passed(self.input), passed(input))
        } else {
            let left = |x: f64| self.downs.partition_point(|&(down, _)| down < x);
            (left(input), left(self.input))
        };
        let passed = if rising { &self.ups } else { &self.downs };
        for &(_, n) in &passed[from..to] {
            let on = &mut self.on[n as usize];
            if *on != rising {
                *on = rising;
                self.count = if rising {
                    self.count + 1
                } else {
                    self.count - 1
                };
            }
        }
        self.input = input;
    }

    /// Share of the relays that are on, from 0 to 1.
    pub(super) fn share(&self) -> f64 {
        self.count as f64 / self.on.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    #[test]
    fn it_is_the_plain_sum() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut random = || -> Vec<Relay> {
            (0..500)
                .map(|_| {
                    // Whole numbers, so that inputs also land on thresholds.
                    let down = f64::from(rng.random_range(0..40));
                    let width = f64::from(rng.random_range(1..20));
                    Relay {
                        down,
                        up: down + width,
                    }
                })
                .collect()
        };
        let sets = [random(), random()];
        let mut relays = Relays::new(&sets[0], 0.0);
        let mut plain = vec![false; 500];
        let mut seen = std::collections::BTreeSet::new();
        for n in 0..4000 {
            let set = &sets[n / 1000 % 2];
            if n % 1000 == 0 {
                relays.replace(set);
            } else {
                relays.travel(f64::from(rng.random_range(-2..62)));
            }
            for (on, relay) in plain.iter_mut().zip(set) {
                *on = relays.input >= relay.up || (*on && relays.input > relay.down);
            }
            assert_eq!(relays.on, plain, "sample {n}");
            assert_eq!(relays.count, plain.iter().filter(|on| **on).count());
            seen.insert(relays.count);
        }
        assert!(seen.len() > 100);
    }
}

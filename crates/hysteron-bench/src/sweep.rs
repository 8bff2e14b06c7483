//! Notices an output that does not move while a profile is played.
//!
//! No model says what to expect of a recording. But a drive that went through the whole profile, and
//! back, has moved whatever this profile can record. Of an output that is jammed, or of a sensor that
//! is dead, noise is left: readings that know nothing of the ones before them. One that moves knows
//! them, however small its stroke: its readings differ less from their neighbours than from all. That
//! is von Neumann's ratio, here of ranks, which a spike does not change (Bartels 1982).

/// The drive is at an end of the profile within this share of its span.
const END: f64 = 0.1;
/// A profile that takes less than this share of the drive's limits may rightly move nothing: half a
/// current is a quarter of its heat.
const WIDE: f64 = 0.9;
/// How long an output may stay in its noise where the file does not say it, s: a spring may take the
/// better part of a minute to become warm at all.
pub(crate) const LEAST_S: f64 = 60.0;
/// There and back.
const WAYS: u32 = 2;
/// Readings in a way, on the mean: a faster motion looks like noise.
const PER_WAY: usize = 25;
/// A ratio so many standard deviations from that of noise is no chance: one in 16,000.
const CHANCE: f64 = 4.0;
/// Readings that are kept; of a longer sweep every other one, and so on.
const MOST: usize = 100_000;

/// An output that did not move in a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unmoved {
    /// Numbers of the first and of the last sample, as the log has them.
    pub samples: (u64, u64),
    /// Lowest and highest drive.
    pub drives: (f64, f64),
    /// Lowest and highest reading.
    pub outputs: (f64, f64),
}

/// A sweep of the drive that goes on.
#[derive(Debug, Clone)]
pub(crate) struct Sweep {
    /// Up to the first and from the second drive on it is at an end.
    ends: (f64, f64),
    least_s: f64,
    time_s: f64,
    /// Whether it was at the upper end last.
    was_high: Option<bool>,
    ways: u32,
    seen: Option<Unmoved>,
    readings: Vec<f64>,
    /// Each so many-th reading is kept, and which one comes.
    every: (u64, u64),
    /// One that has moved may rest at its end later, while a heat goes on.
    has_moved: bool,
}

impl Sweep {
    /// For a profile with this range and for these limits of the drive, each lowest and highest.
    /// `None` where it takes too little of them. No sweep is shorter than `least_s`, s.
    pub(crate) fn new(profile: (f64, f64), drives: (f64, f64), least_s: f64) -> Option<Self> {
        let (low, high) = (profile.0.max(drives.0), profile.1.min(drives.1));
        let is_wide = high - low >= WIDE * (drives.1 - drives.0);
        is_wide.then(|| Self::between(low, high, least_s))
    }

    fn between(low: f64, high: f64, least_s: f64) -> Self {
        let near = END * (high - low);
        Self {
            ends: (low + near, high - near),
            least_s,
            time_s: 0.0,
            was_high: None,
            ways: 0,
            seen: None,
            readings: Vec::new(),
            every: (1, 0),
            has_moved: false,
        }
    }

    /// Takes the drive that acts, and a reading, `dt` after the one before. What did not move, where
    /// a sweep ends without a move.
    pub(crate) fn push(
        &mut self,
        number: u64,
        dt: f64,
        drive: f64,
        reading: f64,
    ) -> Option<Unmoved> {
        if self.has_moved {
            return None;
        }
        self.time_s += dt;
        if reading.is_finite() {
            self.take(number, drive, reading);
        }
        let is_high = drive >= self.ends.1;
        if is_high || drive <= self.ends.0 {
            let before = self.was_high.replace(is_high);
            self.ways += u32::from(before.is_some_and(|before| before != is_high));
        }
        let few = self.readings.len() < PER_WAY * self.ways as usize && self.every.0 == 1;
        if self.ways < WAYS || few || self.time_s < self.least_s {
            return None;
        }
        let readings = std::mem::take(&mut self.readings);
        let unmoved = self.seen.take().filter(|_| is_noise(&readings));
        self.has_moved = unmoved.is_none();
        unmoved
    }

    fn take(&mut self, number: u64, drive: f64, reading: f64) {
        let seen = self.seen.get_or_insert(Unmoved {
            samples: (number, number),
            drives: (drive, drive),
            outputs: (reading, reading),
        });
        let wider = |(low, high): (f64, f64), at: f64| (low.min(at), high.max(at));
        seen.samples.1 = number;
        seen.drives = wider(seen.drives, drive);
        seen.outputs = wider(seen.outputs, reading);
        if self.every.1.is_multiple_of(self.every.0) {
            self.readings.push(reading);
        }
        self.every.1 += 1;
        if self.readings.len() == MOST {
            let mut drop = true;
            self.readings.retain(|_| {
                drop = !drop;
                !drop
            });
            self.every.0 *= 2;
        }
    }
}

/// Whether readings know nothing of their neighbours.
fn is_noise(readings: &[f64]) -> bool {
    let ranks = ranks(readings);
    let middle = (ranks.len() as f64 - 1.0) / 2.0;
    let squares = |of: &mut dyn Iterator<Item = f64>| of.map(|it| it * it).sum::<f64>();
    let all = squares(&mut ranks.iter().map(|rank| rank - middle));
    let steps = squares(&mut ranks.windows(2).map(|pair| pair[1] - pair[0]));
    // Of noise the ratio is 2, with a standard deviation of 2 / sqrt(n).
    let off = (1.0 - steps / (2.0 * all)) * (ranks.len() as f64).sqrt();
    all == 0.0 || off.abs() < CHANCE
}

/// The rank of each reading; equal ones share theirs.
fn ranks(readings: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..readings.len()).collect();
    order.sort_unstable_by(|a, b| readings[*a].total_cmp(&readings[*b]));
    let mut ranks = vec![0.0; readings.len()];
    let mut first = 0;
    for equal in order.chunk_by(|a, b| readings[*a] == readings[*b]) {
        let shared = first as f64 + (equal.len() as f64 - 1.0) / 2.0;
        equal.iter().for_each(|n| ranks[*n] = shared);
        first += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Plays cycles of so many samples, each smaller than the one before by a share.
    fn play(
        (cycles, period, smaller): (u32, u32, f64),
        mut output: impl FnMut(f64) -> f64,
    ) -> Option<Unmoved> {
        let mut sweep = Sweep::between(0.0, 1.0, 1.0);
        (0..cycles * period).find_map(|n| {
            let phase = f64::from(n) / f64::from(period);
            let drive = (0.5 - 0.5 * (std::f64::consts::TAU * phase).cos()) * smaller.powf(phase);
            sweep.push(u64::from(n) + 1, 0.05, drive, output(drive))
        })
    }

    /// A step of an ADC, up or down, or none.
    fn adc(rng: &mut ChaCha8Rng) -> f64 {
        f64::from(rng.random_range(-1..=1))
    }

    #[test]
    fn what_never_moves_is_found_after_the_first_sweep() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut missed = 0;
        for case in 0..500 {
            let period = rng.random_range(60..2000);
            let still = rng.random_range(-5.0..500.0);
            let noise = rng.random_range(0.0..10.0);
            let found = play((3, period, 0.95), |_| match case % 3 {
                0 => still,
                1 => f64::from((still + adc(&mut rng)) as f32),
                _ => still + noise * (0..6).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>(),
            });
            let ends = found.map_or(0, |found| found.samples.1);
            // The drive is at its lower end a tenth before the end of its cycle.
            let first = u64::from(period * 8 / 10)..=u64::from(period) + 1;
            missed += u32::from(!first.contains(&ends));
        }
        assert_eq!(missed, 0);
    }

    /// Lags, hysteresis, strokes down to the noise, gains of both signs, drift and spikes.
    #[test]
    fn an_honest_plant_is_never_stopped() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        for case in 0..2000_usize {
            let period = rng.random_range(60..1500);
            // Of a period: half of it is a heat that hardly follows.
            let lag = f64::from(period) * rng.random_range(0.0..0.5f64);
            let width = rng.random_range(0.0..0.3);
            let begins = rng.random_range(0.0..0.3);
            // In steps of the ADC.
            let stroke = rng.random_range(6.0..300.0) * [1.0, -1.0][case % 2];
            let noise = f64::from(!case.is_multiple_of(4));
            let drift = rng.random_range(-0.01..0.01) * f64::from(case.is_multiple_of(3));
            let (mut heat, mut play_at, mut n) = (0.0f64, 0.0f64, 0.0);
            let found = play((4, period, 0.98), |drive| {
                heat += (drive - heat) / (1.0 + lag);
                play_at = play_at.clamp(heat - width / 2.0, heat + width / 2.0);
                n += 1.0;
                let share = ((play_at - begins) / 0.4).clamp(0.0, 1.0);
                let spike = f64::from(rng.random_range(0..200) == 0) * 1e6 * noise;
                let wild = rng.random_range(-1.0..1.0) * spike;
                (512.0 + stroke * share + drift * n + noise * adc(&mut rng)).round() + wild
            });
            assert_eq!(
                found, None,
                "{case}: stroke {stroke}, lag {lag} of {period}, {width}, {begins}"
            );
        }
    }

    #[test]
    fn a_profile_that_is_small_or_fast_says_nothing() {
        assert!(Sweep::new((0.0, 0.8), (0.0, 1.0), 1.0).is_none());
        assert_eq!(play((100, 20, 1.0), |_| 1.0), None);
        // Nor does one that does not come back.
        let mut sweep = Sweep::between(0.0, 1.0, 1.0);
        assert!((0..1000).all(|n| sweep.push(n, 0.05, 0.001 * n as f64, 1.0).is_none()));
    }

    #[test]
    fn a_long_sweep_takes_no_more_memory() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut sweep = Sweep::between(0.0, 1.0, 1.0);
        let count = 1_000_000_u64;
        let found = (0..=count).find_map(|n| {
            let drive = 1.0 - (2.0 * n as f64 / count as f64 - 1.0).abs();
            assert!(sweep.readings.len() <= MOST);
            sweep.push(n, 0.05, drive, adc(&mut rng))
        });
        assert_eq!(found.map(|found| found.outputs), Some((-1.0, 1.0)));
    }
}

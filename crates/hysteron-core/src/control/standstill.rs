//! Notices an output that stands still where it has to move: to the last bit, or but for its noise
//! while the drive does all that it can.

/// Without a model: the drive has gone this share of its way to a limit, or of its range.
const WAY: f64 = 0.45;
const RANGE: f64 = 0.02;
/// And it goes no further than this share of the way, or of the range.
const ROOM: f64 = 0.5;
/// With a model: it expects a change by this share of its output's range.
const EXPECTED: f64 = 0.05;

/// With a model and noise: the readings stay within this share of the range of its outputs,
const NOISE: f64 = 0.01;
/// they are off what is wanted by this share,
const ASIDE: f64 = 0.05;
/// the drive is at a limit, but for this share of its range,
const FULL: f64 = 0.1;
/// and the model expects a change by this share. All four together are a plant that is jammed, or a
/// dead sensor. One that is slow, weak or colder than the model leaves where it was as the drive
/// comes to a limit, or holds what is wanted.
const JAMMED: f64 = 0.4;

/// Without a model: a sensor that has given so many readings is alive. One that has not may be in
/// front of a dead band.
const ALIVE: u32 = 10;
/// So many equal readings in a row are no chance, and no lag of the plant.
const CHANCE: u32 = 3;

/// What should move the output at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cause {
    /// The output that the model expects, and the range of its outputs.
    pub expected: Option<(f64, (f64, f64))>,
    /// The output that is wanted; NaN where none is.
    pub wanted: f64,
    /// The drive that acts, or the command of an inner loop, and its limits.
    pub drive: f64,
    /// The lowest and the highest.
    pub drives: (f64, f64),
}

/// Compares what stands still with what should have moved it since.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Standstill {
    /// The last reading, and the cause when it was new.
    since: Option<(f64, Cause)>,
    /// The first reading that all since were near to, and what the model expected then.
    near: Option<(f64, f64)>,
    /// For how many samples the output stood still to the last bit where it should have moved, and
    /// for how long it did so or was jammed, s.
    still: (u32, f64),
    /// Whether the last reading was the one before it.
    repeats: bool,
    /// Readings that were new.
    new: u32,
}

impl Standstill {
    /// How long the output has stood still to the last bit where it should have moved, s; `None`
    /// where it is not stuck. `dt` is the time since the last sample.
    pub fn push(&mut self, reading: f64, cause: Cause, dt: f64) -> Option<f64> {
        let jammed = self.is_jammed(reading, cause);
        self.repeats = self.since.is_some_and(|(last, _)| last == reading);
        let (count, time) = self.still;
        let frozen = match self.since {
            Some((_, before)) if self.repeats => count > 0 || self.should_move(before, cause),
            _ => {
                self.since = Some((reading, cause));
                self.new = self.new.saturating_add(1);
                false
            }
        };
        let count = if frozen { count.saturating_add(1) } else { 0 };
        let time = if frozen || jammed { time + dt } else { 0.0 };
        self.still = (count, time);
        (count >= CHANCE).then_some(time)
    }

    /// As [`Standstill::push`] found it last; or how long the output has been where it was but for
    /// its noise, s, with the drive at a limit. Such a reading is still a reading: of a plant that
    /// is jammed, or later than its model.
    #[must_use]
    pub fn stuck_s(&self) -> Option<f64> {
        let (count, time) = self.still;
        (count >= CHANCE || (count == 0 && time > 0.0)).then_some(time)
    }

    /// Begins anew to notice.
    pub fn forgive(&mut self) {
        self.still = (0, 0.0);
    }

    /// Where the drive may go while the output stands still and no model says whether it should: so
    /// a stuck sensor does not drive to a limit.
    #[must_use]
    pub fn room(&self) -> Option<(f64, f64)> {
        let (_, cause) = self.since.filter(|_| self.repeats)?;
        let (low, high) = cause.drives;
        let least = RANGE * (high - low);
        let (below, above) = (ROOM * (cause.drive - low), ROOM * (high - cause.drive));
        let room = (
            cause.drive - below.max(least),
            cause.drive + above.max(least),
        );
        (cause.expected.is_none() && self.new >= ALIVE).then_some(room)
    }

    /// Whether the output but for its noise is where it was, and the drive at a limit, though it is
    /// not wanted there and the model expects it elsewhere.
    fn is_jammed(&mut self, reading: f64, cause: Cause) -> bool {
        let Some((expected, (low, high))) = cause.expected else {
            self.near = None;
            return false;
        };
        let range = (high - low).abs();
        let is_near = |(first, _): &(f64, f64)| (reading - first).abs() <= NOISE * range;
        let (_, then) = *match self.near.filter(is_near) {
            Some(near) => self.near.insert(near),
            None => self.near.insert((reading, expected)),
        };
        let (low, high) = cause.drives;
        let margin = FULL * (high - low);
        (expected - then).abs() > JAMMED * range
            && (cause.wanted - reading).abs() > ASIDE * range
            && (cause.drive < low + margin || cause.drive > high - margin)
    }

    fn should_move(&self, before: Cause, now: Cause) -> bool {
        if let (Some((then, _)), Some((expected, (low, high)))) = (before.expected, now.expected) {
            // Of an output that falls, the range stands the other way round.
            return (expected - then).abs() > EXPECTED * (high - low).abs();
        }
        let (low, high) = now.drives;
        let moved = now.drive - before.drive;
        let way = match moved > 0.0 {
            true => high - before.drive,
            false => before.drive - low,
        };
        self.new >= ALIVE && moved.abs() > (WAY * way).max(RANGE * (high - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(drive: f64) -> Cause {
        let (expected, drives) = (None, (0.0, 1.0));
        Cause {
            expected,
            wanted: f64::NAN,
            drive,
            drives,
        }
    }

    /// After some readings with a drive.
    fn alive(at: f64) -> Standstill {
        let mut still = Standstill::default();
        for n in 0..ALIVE {
            still.push(2.0 + f64::from(n), drive(at), 0.1);
        }
        still
    }

    fn expected(output: f64) -> Cause {
        let expected = Some((output, (0.0, 10.0)));
        Cause {
            expected,
            ..drive(0.5)
        }
    }

    #[test]
    fn an_output_at_rest_is_not_stuck() {
        let mut still = Standstill::default();
        for _ in 0..1000 {
            assert_eq!(still.push(1.0, drive(0.3), 0.1), None);
            assert_eq!(still.push(1.0, drive(0.31), 0.1), None);
        }
        let mut still = Standstill::default();
        assert!((0..1000).all(|n| {
            still
                .push(1.0, expected(0.1 * f64::from(n % 2)), 0.1)
                .is_none()
        }));
    }

    #[test]
    fn a_dead_band_at_the_beginning_is_crossed() {
        let mut still = Standstill::default();
        assert!((0..=100).all(|n| still.push(1.0, drive(0.01 * f64::from(n)), 0.1).is_none()));
        assert_eq!(still.room(), None);
    }

    #[test]
    fn one_that_should_have_moved_is_stuck_until_it_moves() {
        let mut still = Standstill::default();
        let outputs = [2.0, 3.0, 2.0, 3.0, 2.0];
        let found = outputs.map(|output| still.push(1.0, expected(output), 0.1).is_some());
        assert_eq!(found, [false, false, false, true, true]);
        assert!(
            still
                .stuck_s()
                .is_some_and(|time| (time - 0.4).abs() < 1e-9)
        );
        assert_eq!(still.push(1.1, expected(2.0), 0.1), None);
    }

    /// A noise of less than half a percent of the range.
    fn noise(n: u32) -> f64 {
        0.04 * f64::from(n * 7 % 3) - 0.04
    }

    /// The first sample of 1000 at which an output is stuck; `at` says what the model expects, what
    /// is wanted and what is read.
    fn first(drive: f64, at: impl Fn(f64) -> [f64; 3]) -> Option<u32> {
        let mut still = Standstill::default();
        (0..1000).find(|&n| {
            let [output, wanted, reading] = at(f64::from(n));
            let cause = Cause {
                wanted,
                drive,
                ..expected(output)
            };
            let frozen = still.push(reading + noise(n), cause, 0.1);
            frozen.is_some() || still.stuck_s().is_some()
        })
    }

    #[test]
    fn noise_is_no_motion_while_the_drive_does_all_it_can() {
        let goes = |n: f64| 9.0 - 6.0 * 0.9f64.powf(n);
        // Past four tenths after eleven samples.
        assert_eq!(first(1.0, |n| [goes(n), 8.0, 3.0]), Some(11));
        assert_eq!(first(0.0, |n| [12.0 - goes(n), 2.0, 9.0]), Some(11));
        // The drive could do more; the model expects no more; it is wanted there.
        assert_eq!(first(0.85, |n| [goes(n), 8.0, 3.0]), None);
        assert_eq!(first(1.0, |n| [goes(n).min(6.9), 8.0, 3.0]), None);
        assert_eq!(first(1.0, |n| [goes(n), 3.4, 3.0]), None);
        // A twentieth of what is expected is a motion.
        assert_eq!(first(1.0, |n| [0.01 * n, 20.0, 0.0005 * n]), None);
    }

    #[test]
    fn an_output_that_falls_has_the_same_range() {
        let falls = |output: f64| Cause {
            expected: Some((output, (10.0, 0.0))),
            ..drive(0.5)
        };
        let mut still = Standstill::default();
        assert!((0..100).all(|_| still.push(1.0, falls(2.0), 0.1).is_none()));
        assert!((0..4).any(|_| still.push(1.0, falls(3.0), 0.1).is_some()));
    }

    #[test]
    fn a_drive_that_keeps_to_its_room_is_noticed() {
        for start in [0.0, 0.1, 0.5, 0.9] {
            let mut still = alive(start);
            still.push(1.0, drive(start), 0.1);
            assert_eq!(still.room(), None);
            still.push(1.0, drive(start), 0.1);
            let (low, high) = still.room().unwrap_or_default();
            for end in [low, high] {
                let mut still = still.clone();
                let found = [0; 4]
                    .map(|_| still.push(1.0, drive(end), 0.1))
                    .last()
                    .copied();
                // Where there is hardly any way, there is no need.
                let way = (end - start).abs();
                assert_eq!(found.flatten().is_some(), way > 0.021, "{start} {end}");
            }
            assert!((low > 0.0 || start < 0.03) && high < 1.0);
        }
    }

    #[test]
    fn the_drive_never_comes_to_a_limit_before_it_is_noticed() {
        for start in [0.0, 0.1, 0.5, 0.9] {
            for way in [-1.0, 1.0] {
                let (mut still, mut at) = (alive(start), start);
                while still.push(1.0, drive(at), 0.1).is_none() && (0.0..=1.0).contains(&at) {
                    at += 0.001 * way;
                }
                let from = if way > 0.0 { 1.0 - start } else { start };
                assert!(
                    (0.0..=1.0).contains(&at) || from < 0.03,
                    "{start} {way} {at}"
                );
            }
        }
    }
}

//! The watch: it notices a channel that stands still while the other one moves.
//!
//! A sensor that lost its contact goes on with one value. A learner takes that for a plant whose
//! output no longer depends on its input, and unlearns the model. So the measured output is
//! compared with the *expected* one, that of the model before it learned anything. A *run* is a
//! stretch over which the measured output stays within a band, a part of the span that the expected
//! one had lately. A plant that moves leaves the band again and again, and a new run begins. A
//! frozen one stays, and the run lasts until the expected output has been there and back. A load, a
//! drift or a model that errs change the spans; a channel that stands still takes one to nearly
//! zero.
//!
//! The output of a live plant may be that small too. But then it follows the expected one: the two
//! are correlated over the run. The noise of a frozen channel is not.

use super::Outcome;
use super::run::{Lately, Run, Span};
use crate::scalar::Real;

/// The band of a run is the other channel's span divided by this.
const STILL: usize = 5;
/// A run proves a channel still where the other one travelled this many eighths of its span. There
/// and back are sixteen; two are left for the way that the channel made in the band before it
/// froze.
const CYCLE: usize = 14;
/// More than that is asked of a channel that rested for long before and moved again, but at most
/// this many eighths, two cycles.
const MOST: usize = 32;
/// At the end of the readings this many eighths are enough, for a channel that did not rest before.
const END: usize = 6;
/// A piece ends where the moving channel has travelled the model's range divided by this.
const PIECE: usize = 2;
/// Readings in a piece, in a run of the output, and in one of the input, at least: fewer do not
/// show a span. The measured output moves in the last of them, and a few wrong readings move it
/// far.
const READINGS: [u32; 3] = [4, 10, 16];
/// An input that moves by less than the plane's width divided by this may miss the part of the
/// plane in which a shifted plant moves.
const WIDE: usize = 2;
/// Moves below the range divided by this are noise and no travel.
const NOISE: usize = 16;
/// Spans below the range divided by this say nothing: of a piece, and of a run.
const FAR: [usize; 2] = [8, 4];
/// The span of a channel lately is that over the last ranges of travel: from so many to twice as
/// many.
const LATELY: usize = 1;

/// A channel of the plant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// The input.
    Input,
    /// The output.
    Output,
}

/// A reading, and what a [`Watch`] compares it with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading<T> {
    /// The input, as its normalised position, in levels.
    pub position: T,
    /// The output that the model expects there before it has learned anything.
    pub expected: T,
    /// The measured output.
    pub measured: T,
}

impl Channel {
    /// The outcome of a sample at which this channel stands still.
    #[must_use]
    pub fn outcome(self) -> Outcome {
        match self {
            Self::Input => Outcome::InputStuck,
            Self::Output => Outcome::OutputStuck,
        }
    }
}

/// What a [`Watch`] says of a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Watched {
    /// Both channels may well move.
    Moving,
    /// As [`Watched::Moving`], and a piece ends here. With `alive`, the output moved in it. So a
    /// channel that stands still now did not do so when the piece began.
    Piece {
        /// Whether the output moved in the piece.
        alive: bool,
    },
    /// This channel stands still, while the other one moves there and back.
    Stuck(Channel),
}

/// Notices a channel that stands still while the other one moves. Takes constant time and memory.
///
/// An [`crate::Estimator`] has its own. Anything else that learns may use one: where a piece ends
/// it sets aside what it has learned so far, and where a channel is stuck it returns to what it had
/// set aside before the last piece that was alive.
///
/// ```
/// use hysteron_core::{Channel, Reading, Watch, Watched};
/// let mut watch = Watch::new(10.0_f64, 10.0);
/// let mut found = Watched::Moving;
/// for n in 0..260 {
///     let position = 10.0 - (f64::from(n % 200) - 100.0).abs() / 10.0; // there and back
///     let measured = if n < 60 { position } else { 6.0 };
///     let reading = Reading { position, expected: position, measured };
///     found = watch.look(reading, true);
/// }
/// assert_eq!(found, Watched::Stuck(Channel::Output));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watch<T> {
    range: T,
    /// Width of the plane.
    width: T,
    /// Is the output still while the expected one moves?
    output: Trail<T>,
    /// Is the input still, and the expected output with it, while the measured one moves?
    input: Trail<T>,
    /// The last reading.
    last: T,
    stuck: Option<Channel>,
}

impl<T: Real> Watch<T> {
    /// A watch for a model whose output has this `range`, and its plane this `width` in levels.
    #[must_use]
    pub fn new(range: T, width: T) -> Self {
        Self {
            range,
            width,
            output: Trail::default(),
            input: Trail::default(),
            last: T::ZERO,
            stuck: None,
        }
    }

    /// Forgets what it has seen.
    pub fn restart(&mut self) {
        *self = Self::new(self.range, self.width);
    }

    /// The channel that stands still.
    #[must_use]
    pub fn stuck(&self) -> Option<Channel> {
        self.stuck
    }

    /// Looks at a reading.
    ///
    /// A reading that is not `believed`, by a [`Gate`](crate::Gate), counts only if the one
    /// before was much the same: a channel that stands still surprises as well as a wrong reading,
    /// but one wrong reading must not pass for motion.
    pub fn look(&mut self, at: Reading<T>, believed: bool) -> Watched {
        let Reading {
            position,
            expected,
            measured,
        } = at;
        let step = measured - core::mem::replace(&mut self.last, measured);
        let same = step.max(-step) < self.range / T::from_index(NOISE);
        if !(believed || same) {
            return self.stuck.map_or(Watched::Moving, Watched::Stuck);
        }
        let piece = self
            .output
            .look([expected, measured, position], self.range, T::INFINITY);
        let alive = piece.is_some_and(|piece| piece.alive);
        let other = self
            .input
            .look([measured, expected, position], self.range, T::HALF);
        let returns = other.is_some_and(|piece| piece.moves);
        match self.stuck {
            Some(Channel::Output) if !alive => return Watched::Stuck(Channel::Output),
            Some(Channel::Input) if !(alive || returns) => return Watched::Stuck(Channel::Input),
            _ => self.stuck = None,
        }
        let wide = self.width / T::from_index(WIDE);
        if self.output.is_still(self.range, T::ZERO, wide, READINGS[1]) {
            self.stuck = Some(Channel::Output);
        } else if self
            .input
            .is_still(self.range, self.range, T::ZERO, READINGS[2])
        {
            self.stuck = Some(Channel::Input);
        }
        match (self.stuck, piece) {
            (Some(channel), _) => Watched::Stuck(channel),
            (None, Some(_)) => Watched::Piece { alive },
            (None, None) => Watched::Moving,
        }
    }

    /// Whether the output seems to stand still at the end of the readings, though not for a whole
    /// cycle yet: for how many of the readings, the last ones. Only sensible where nothing follows.
    ///
    /// One way of the expected output is no proof, so the plant's own past decides too: at no time
    /// before did its output stay within such a band over two thirds of this way.
    #[must_use]
    pub fn still_at_the_end(&self) -> Option<u32> {
        // One that was never seen to move says nothing of how it would rest.
        let past = self.output.longest > T::ZERO;
        let run = self.output.run.as_ref().filter(|_| past)?;
        let part = |parts: usize| self.range / T::from_index(parts);
        let lately = self.output.lately.size().max(run.spans[0].size());
        let enough = (lately * eighths(END)).max(self.output.beyond());
        let far = run.spans[0].size() >= part(FAR[1]).max(lately * T::HALF);
        let wide = run.spans[2].size() >= self.width / T::from_index(WIDE);
        (run.travel >= enough && far && wide && !run.follows()).then_some(run.readings)
    }
}

fn eighths<T: Real>(count: usize) -> T {
    T::from_index(count) / T::from_index(8)
}

/// What is known of one channel that may stand still, and of the other one, which moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Trail<T> {
    /// Where the travel of the moving one was last counted.
    anchor: T,
    run: Option<Run<T>>,
    /// How far the moving one travelled in the longest run that ended with a move of the other.
    longest: T,
    /// Whether the one followed the other, though within the band, in the run before.
    follows: bool,
    lately: Lately<T>,
    piece: Option<Piece<T>>,
}

/// A stretch over which the moving channel travelled, and the spans of that channel, of the other
/// one, and of the input's position.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece<T> {
    spans: [Span<T>; 3],
    travel: T,
    readings: u32,
}

/// What a piece that ends says.
#[derive(Clone, Copy)]
struct Ended {
    /// In this piece both channels moved.
    alive: bool,
    /// In this piece the input moved.
    moves: bool,
}

impl<T: Real> Trail<T> {
    /// Takes a reading of the channel that moves, of the one that may be still, and of the
    /// position. A run ends also where the position moves by `rest`.
    fn look(&mut self, reading: [T; 3], range: T, rest: T) -> Option<Ended> {
        let part = |parts: usize| range / T::from_index(parts);
        let moving = reading[0];
        let (Some(run), Some(piece)) = (&mut self.run, &mut self.piece) else {
            self.begin(reading);
            return None;
        };
        let step = moving - self.anchor;
        let mut travel = step.max(-step);
        match travel >= part(NOISE) {
            true => self.anchor = moving,
            false => travel = T::ZERO,
        }
        // A wrong reading is no cycle.
        travel = travel.min(part(PIECE));
        self.lately
            .take(moving, travel, range * T::from_index(LATELY));
        let lately = self.lately.size().max(run.spans[0].size());
        let band = lately.max(part(FAR[1])) / T::from_index(STILL);
        let before = run.spans[1].size();
        run.take(reading, travel, lately);
        // A band that gets narrower ends no run: only a move does.
        let leaves = run.spans[1].size() > before && run.spans[1].size() >= band;
        if leaves || run.spans[2].size() >= rest {
            self.longest = self.longest.max(run.travel);
            *run = Run::begin(reading);
            self.follows = false;
        }
        piece.take(reading, travel);
        if piece.travel < part(PIECE) || piece.readings < READINGS[0] {
            return None;
        }
        let [far, other, moved] = piece.spans.map(|span| span.size());
        *piece = Piece::begin(reading);
        Some(Ended {
            alive: far >= part(FAR[0]) && other * T::from_index(STILL) >= far,
            moves: moved >= T::HALF,
        })
    }

    fn begin(&mut self, reading: [T; 3]) {
        self.anchor = reading[0];
        self.lately = Lately::begin(reading[0]);
        // Nothing is known yet: it needs two cycles.
        self.follows = true;
        self.run = Some(Run::begin(reading));
        self.piece = Some(Piece::begin(reading));
    }

    /// What no run of a channel that moved again came near to: half as long again as the longest. A
    /// plant that is shifted may rest where the model moves, time and again.
    fn beyond(&self) -> T {
        self.longest + self.longest * T::HALF
    }

    /// Whether the run proves the channel still: the other one, whose span counts as at least
    /// `least`, went there and back in `few` readings or more, and the input moved by `wide`.
    ///
    /// A step of a small output, as of a load, may hide for one cycle that it follows.
    fn is_still(&mut self, range: T, least: T, wide: T, few: u32) -> bool {
        let beyond = self.beyond();
        let Some(run) = &mut self.run else {
            return false;
        };
        let span = self.lately.size().max(run.spans[0].size()).max(least);
        let cycle = (span * eighths(CYCLE)).max(beyond.min(span * eighths(MOST)));
        let far = run.spans[0].size() >= range / T::from_index(FAR[1]);
        if run.travel < cycle || run.readings < few || !far || run.spans[2].size() < wide {
            return false;
        }
        let followed = core::mem::replace(&mut self.follows, run.follows());
        if followed || self.follows {
            *run = Run::begin(run.last());
        }
        !(followed || self.follows)
    }
}

impl<T: Real> Piece<T> {
    fn begin(reading: [T; 3]) -> Self {
        Self {
            spans: reading.map(Span::at),
            travel: T::ZERO,
            readings: 0,
        }
    }

    fn take(&mut self, reading: [T; 3], travel: T) {
        for (span, at) in self.spans.iter_mut().zip(reading) {
            span.take(at);
        }
        self.travel = self.travel + travel;
        self.readings = self.readings.saturating_add(1);
    }
}

//! The watch: it notices a channel that stands still while the other one moves.
//!
//! A sensor that lost its contact goes on with one value. A learner takes that for a plant whose
//! output no longer depends on its input, and unlearns the model. So the measured output is
//! compared with the *expected* one, that of the model before it learned anything. Both are cut into
//! pieces in which the expected output travels half of its range. Over the last pieces, a way there
//! and back, the spans of the two are compared. A load, a drift or a model that errs change the
//! ratio of these spans; a channel that stands still takes it to nearly zero.

use super::Outcome;
use crate::scalar::Real;

/// A piece ends where its channel has travelled the model's range divided by this.
const PIECE: usize = 2;
/// A channel stands still if its span is below that of the other one divided by this.
const STILL: usize = 5;
/// Pieces that are compared: a whole cycle. A shifted plant moves later than the model, and with
/// fewer pieces it would be called stuck.
const PIECES: usize = 4;
/// Readings in a piece, at least: fewer do not show a span.
const READINGS: u32 = 4;
/// An input that moves by less than the plane's width divided by this may miss the part of the plane
/// in which a shifted plant moves.
const WIDE: usize = 2;
/// Moves below the range divided by this are noise and no travel.
const NOISE: usize = 16;
/// Spans below the range divided by this say nothing: of a piece, and of all that are compared.
const FAR: [usize; 2] = [8, 4];

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
/// An [`crate::Estimator`] has its own. Anything else that learns may use one: where a piece ends it
/// sets aside what it has learned so far, and where a channel is stuck it returns to what it had set
/// aside before the last piece that was alive.
///
/// ```
/// use hysteron_core::{Channel, Reading, Watch, Watched};
/// let mut watch = Watch::new(10.0_f64, 10.0);
/// let mut found = Watched::Moving;
/// for n in 0..400 {
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
    /// Pieces of the expected output.
    output: Trail<T>,
    /// Pieces of the measured output.
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
        let piece = self.output.look([expected, measured, position], self.range);
        let alive = piece.is_some_and(|piece| piece.alive);
        let other = self.input.look([measured, expected, position], self.range);
        let returns = other.is_some_and(|piece| piece.moves);
        match self.stuck {
            Some(Channel::Output) if !alive => return Watched::Stuck(Channel::Output),
            Some(Channel::Input) if !(alive || returns) => return Watched::Stuck(Channel::Input),
            _ => self.stuck = None,
        }
        if piece.is_some_and(|piece| piece.still && piece.moved >= self.width / T::from_index(WIDE))
        {
            self.stuck = Some(Channel::Output);
        } else if other.is_some_and(|piece| piece.still && piece.moved < T::HALF) {
            self.stuck = Some(Channel::Input);
        }
        match (self.stuck, piece) {
            (Some(channel), _) => Watched::Stuck(channel),
            (None, Some(_)) => Watched::Piece { alive },
            (None, None) => Watched::Moving,
        }
    }
}

/// The last pieces of one channel, the present one first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Trail<T> {
    pieces: [Option<Piece<T>>; PIECES],
    /// Where the travel was last counted.
    anchor: T,
}

/// A stretch over which a channel travelled, and the spans of that channel, of the one it is
/// compared with, and of the input's position.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece<T> {
    spans: [Span<T>; 3],
    travel: T,
    readings: u32,
}

/// What a piece that ends says.
#[derive(Clone, Copy)]
struct Ended<T> {
    /// In this piece both channels moved.
    alive: bool,
    /// Over all pieces the channel moved there and back, and the other one stood still.
    still: bool,
    /// In this piece the input moved.
    moves: bool,
    /// How far the input moved over all pieces.
    moved: T,
}

impl<T: Real> Trail<T> {
    /// Takes a reading of the channel, of the one it is compared with, and of the position.
    fn look(&mut self, reading: [T; 3], range: T) -> Option<Ended<T>> {
        let part = |parts: usize| range / T::from_index(parts);
        let Some(piece) = &mut self.pieces[0] else {
            self.anchor = reading[0];
            self.pieces[0] = Some(Piece::begin(reading));
            return None;
        };
        let step = reading[0] - self.anchor;
        let step = step.max(-step);
        if step >= part(NOISE) {
            self.anchor = reading[0];
            piece.travel = piece.travel + step;
        }
        piece.take(reading);
        if piece.travel < part(PIECE) || piece.readings < READINGS {
            return None;
        }
        let last = *piece;
        let all = self.pieces.iter().flatten();
        let all = all.fold(last, |all, piece| all.with(piece));
        let travel = self.pieces.iter().flatten();
        let travel = travel.fold(T::ZERO, |sum, piece| sum + piece.travel);
        let full = self.pieces.iter().all(Option::is_some);
        let far = all.spans[0].size();
        // One way alone proves nothing: a load may move the output while the input rests.
        let there_and_back = travel >= far + far * T::HALF;
        let ended = Ended {
            alive: last.is_far(part(FAR[0])) && !last.is_still(),
            still: full && there_and_back && all.is_far(part(FAR[1])) && all.is_still(),
            moves: last.spans[2].size() >= T::HALF,
            moved: all.spans[2].size(),
        };
        self.pieces.copy_within(..PIECES - 1, 1);
        self.pieces[0] = Some(Piece::begin(reading));
        Some(ended)
    }
}

impl<T: Real> Piece<T> {
    fn begin(reading: [T; 3]) -> Self {
        Self {
            spans: reading.map(|at| Span { low: at, high: at }),
            travel: T::ZERO,
            readings: 0,
        }
    }

    fn take(&mut self, reading: [T; 3]) {
        for (span, at) in self.spans.iter_mut().zip(reading) {
            span.low = span.low.min(at);
            span.high = span.high.max(at);
        }
        self.readings = self.readings.saturating_add(1);
    }

    /// The spans of both.
    fn with(mut self, other: &Self) -> Self {
        for (span, other) in self.spans.iter_mut().zip(&other.spans) {
            span.low = span.low.min(other.low);
            span.high = span.high.max(other.high);
        }
        self
    }

    fn is_far(&self, least: T) -> bool {
        self.spans[0].size() >= least
    }

    fn is_still(&self) -> bool {
        self.spans[1].size() * T::from_index(STILL) < self.spans[0].size()
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Span<T> {
    low: T,
    high: T,
}

impl<T: Real> Span<T> {
    fn size(&self) -> T {
        self.high - self.low
    }
}

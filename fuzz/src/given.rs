//! Models and inputs as they are drawn.

use arbitrary::Arbitrary;
use hysteron_core::{
    Model, Operator, Plane, State, Turn, operator_count, table_len, turn_capacity,
};

/// A number: mostly a plain one, sometimes any that there is.
#[derive(Arbitrary, Debug, Clone, Copy)]
pub enum Number {
    Plain(i16),
    Share(u16),
    Any(f64),
}

impl Number {
    pub fn get(self) -> f64 {
        match self {
            Self::Plain(n) => f64::from(n) / 16.0,
            Self::Share(n) => f64::from(n) / f64::from(u16::MAX),
            Self::Any(number) => number,
        }
    }
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum Kind {
    Mkp,
    Kp,
    Relay,
}

/// What a model is made of; the weights are repeated until there are enough.
#[derive(Arbitrary, Debug)]
pub struct Setup {
    kind: Kind,
    levels: u8,
    min: Number,
    max: Number,
    weights: Vec<Number>,
}

/// So that an execution stays short.
const MOST_LEVELS: usize = 40;

pub type Owned = (Model<f64, Vec<f64>>, State<f64, Vec<Turn<f64>>>);

impl Setup {
    pub fn operator(&self) -> Operator {
        match self.kind {
            Kind::Mkp => Operator::Mkp,
            Kind::Kp => Operator::Kp,
            Kind::Relay => Operator::Relay,
        }
    }

    pub fn plane(&self) -> Option<Plane<f64>> {
        let levels = 2 + usize::from(self.levels) % (MOST_LEVELS - 1);
        Plane::new(self.min.get(), self.max.get(), levels).ok()
    }

    pub fn weights(&self, levels: usize) -> Vec<f64> {
        let drawn = self.weights.iter().cycle().map(|weight| weight.get());
        let rest = std::iter::repeat(1.0);
        drawn.chain(rest).take(operator_count(levels)).collect()
    }

    /// The model and a state of it, with all operators off; none where the core refuses what it is
    /// made of.
    pub fn build(&self, weights: &[f64]) -> Option<Owned> {
        let plane = self.plane()?;
        let k = plane.levels();
        let model = Model::new(plane, self.operator(), weights, vec![0.0; table_len(k)]).ok()?;
        let state = model.state(vec![Turn::default(); turn_capacity(k)]);
        let state = state.expect("memory of the size that is told");
        Some((model, state))
    }
}

/// An input for a plane.
#[derive(Arbitrary, Debug, Clone, Copy)]
pub enum Input {
    /// A part of the way from the bottom to the top of the plane.
    Within(u16),
    Level(u8),
    Number(Number),
}

impl Input {
    pub fn on(self, plane: &Plane<f64>) -> f64 {
        match self {
            Self::Within(n) => {
                let share = Number::Share(n).get();
                plane.bottom() + share * (plane.max() - plane.bottom())
            }
            Self::Level(n) => plane.level(usize::from(n) % (plane.levels() + 1)),
            Self::Number(number) => number.get(),
        }
    }
}

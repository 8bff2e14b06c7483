//! The identified model (stub; being written).
use crate::recording::Quantity;

/// The plane of equation (3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    min: f64,
    max: f64,
    levels: usize,
}

impl Plane {
    /// A plane of `levels` levels over `[min, max]`.
    pub fn new(min: f64, max: f64, levels: usize) -> Self {
        Self { min, max, levels }
    }
    /// Lowest level.
    pub fn min(&self) -> f64 {
        self.min
    }
    /// Highest level.
    pub fn max(&self) -> f64 {
        self.max
    }
    /// K.
    pub fn levels(&self) -> usize {
        self.levels
    }
    /// ΔT.
    pub fn step(&self) -> f64 {
        (self.max - self.min) / (self.levels - 1) as f64
    }
    /// Level `k` = 1…K: `min + (k − 1) ΔT`.
    pub fn level(&self, k: usize) -> f64 {
        self.min + (k - 1) as f64 * self.step()
    }
}

/// A model.
#[derive(Debug, Clone)]
pub struct Model {
    /// plane
    pub plane: Plane,
    /// N weights row by row: j = 1…K, within a row i = 1…j (α_i, β_j).
    pub weights: Vec<f64>,
    /// output = offset + sign Σ μ γ
    pub offset: f64,
    /// +1 or -1
    pub sign: f64,
    /// input
    pub input: Quantity,
    /// output
    pub output: Quantity,
}

impl Model {
    /// The operator states γ (N values from 0 to 1, in the order of the weights) after the inputs `history`, from all-off.
    pub fn operator_states(&self, history: &[f64]) -> Vec<f64> {
        let k = self.plane.levels();
        let mut g = vec![0.0f64; k * (k + 1) / 2];
        let r = |t: f64, lv: usize| {
            ((t - self.plane.level(lv)) / self.plane.step() + 1.0).clamp(0.0, 1.0)
        };
        for &t in history {
            for j in 1..=k {
                for i in 1..=j {
                    let s = &mut g[j * (j - 1) / 2 + i - 1];
                    *s = r(t, j).max(s.min(r(t, i)));
                }
            }
        }
        g
    }
}

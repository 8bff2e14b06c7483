//! The cloud of relays, which no model of the toolkit can represent exactly.
//!
//! Its relays are placed by centre and half-width, not on the grid of a plane. They are dense where
//! the density is high. The density is asymmetric and has two lobes. A load moves and deforms it.
//! All numbers are invented, in the size of a stack actuator of 100 µm at 150 V.

use super::relays::Relay;

/// Load at which the cloud is as [`LOBES`] say, N.
pub(super) const NOMINAL_LOAD_N: f64 = 6.0;

/// A part of the cloud. Centres and half-widths follow Kumaraswamy's distribution (1980), which is
/// skewed and bounded.
struct Lobe {
    /// Share of the relays.
    share: f64,
    /// Range of the centres, V, and the shape of their distribution.
    centre_v: (f64, f64),
    centre_shape: (f64, f64),
    /// Largest half-width at the lowest and at the highest centre, V, and the shape of the
    /// half-widths' distribution.
    half_width_v: (f64, f64),
    half_width_shape: (f64, f64),
}

const LOBES: [Lobe; 2] = [
    Lobe {
        share: 0.75,
        centre_v: (18.0, 115.0),
        centre_shape: (1.4, 1.8),
        half_width_v: (15.0, 26.0),
        half_width_shape: (1.2, 2.5),
    },
    Lobe {
        share: 0.25,
        centre_v: (70.0, 105.0),
        centre_shape: (2.0, 2.0),
        half_width_v: (24.0, 18.0),
        half_width_shape: (4.0, 1.5),
    },
];

/// The value below which a share `p` of Kumaraswamy's distribution lies, from 0 to 1.
fn quantile((a, b): (f64, f64), p: f64) -> f64 {
    (1.0 - (1.0 - p).powf(1.0 / b)).powf(1.0 / a)
}

fn between((low, high): (f64, f64), share: f64) -> f64 {
    low + share * (high - low)
}

/// The cloud of `levels` × `levels` relays under the load `load_n` (N).
pub(super) fn cloud(levels: usize, load_n: f64) -> Vec<Relay> {
    let load = relative(load_n);
    let middle = |n: usize, of: usize| (n as f64 + 0.5) / of as f64;
    let mut relays = Vec::with_capacity(levels * levels);
    for lobe in &LOBES {
        let centres = (lobe.share * levels as f64).round() as usize;
        for i in 0..centres {
            let place = quantile(lobe.centre_shape, middle(i, centres));
            let centre = between(lobe.centre_v, place);
            let widest = between(lobe.half_width_v, place);
            for j in 0..levels {
                let half = widest * quantile(lobe.half_width_shape, middle(j, levels));
                // A load asks for more drive, spreads the switching and widens most what switches
                // late.
                let centre = centre + load * (5.0 + 0.08 * (centre - 75.0));
                let half = half * (1.0 + load * 0.3 * place);
                relays.push(Relay {
                    down: centre - half,
                    up: centre + half,
                });
            }
        }
    }
    relays
}

/// The load above the nominal one, in units of 4 N.
pub(super) fn relative(load_n: f64) -> f64 {
    (load_n - NOMINAL_LOAD_N) / 4.0
}

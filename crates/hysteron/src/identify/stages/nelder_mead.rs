//! The simplex search of Nelder and Mead (1965): minimises a function of a few parameters without
//! derivatives.

use crate::error::Result;

/// Searches for a minimum from `start`. Returns the best point and its value.
///
/// The edges of the first simplex have the length `edge`. The search ends when the simplex is
/// smaller than `tolerance` in every direction, or after `steps`.
pub(crate) fn minimise<const N: usize>(
    start: [f64; N],
    edge: f64,
    tolerance: f64,
    steps: usize,
    value: impl Fn(&[f64; N]) -> Result<f64>,
) -> Result<([f64; N], f64)> {
    let mut simplex = vec![(start, value(&start)?)];
    for axis in 0..N {
        let mut corner = start;
        corner[axis] += edge;
        simplex.push((corner, value(&corner)?));
    }
    for _ in 0..steps {
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
        let best = simplex[0];
        let size = |corner: &([f64; N], f64)| {
            let edges = corner.0.iter().zip(&best.0);
            edges.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        if simplex.iter().map(size).fold(0.0, f64::max) < tolerance {
            break;
        }
        let worst = simplex[N];
        let centre: [f64; N] = std::array::from_fn(|axis| {
            simplex[..N]
                .iter()
                .map(|corner| corner.0[axis])
                .sum::<f64>()
                / N as f64
        });
        let along = |factor: f64| -> Result<([f64; N], f64)> {
            let point =
                std::array::from_fn(|axis| centre[axis] + factor * (worst.0[axis] - centre[axis]));
            Ok((point, value(&point)?))
        };
        let reflected = along(-1.0)?;
        let next = if reflected.1 < best.1 {
            let expanded = along(-2.0)?;
            Some(if expanded.1 < reflected.1 {
                expanded
            } else {
                reflected
            })
        } else if reflected.1 < simplex[N - 1].1 {
            Some(reflected)
        } else {
            let outside = reflected.1 < worst.1;
            let contracted = along(if outside { -0.5 } else { 0.5 })?;
            (contracted.1 < worst.1.min(reflected.1)).then_some(contracted)
        };
        match next {
            Some(corner) => simplex[N] = corner,
            None => {
                for corner in &mut simplex[1..] {
                    let shrunk = std::array::from_fn(|axis| 0.5 * (corner.0[axis] + best.0[axis]));
                    *corner = (shrunk, value(&shrunk)?);
                }
            }
        }
    }
    simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ok(simplex[0])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::minimise;

    #[test]
    fn the_valley_of_rosenbrock_is_followed_to_its_end() {
        let valley = |x: &[f64; 2]| Ok((1.0 - x[0]).powi(2) + 100.0 * (x[1] - x[0] * x[0]).powi(2));
        let (found, least) = minimise([-1.2, 1.0], 0.5, 1e-7, 500, valley).unwrap();
        // At the end the simplex is smaller than 1e-7. Along the valley the minimum may be ten
        // times that away.
        assert!(
            (found[0] - 1.0).abs() < 1e-6 && (found[1] - 1.0).abs() < 2e-6,
            "{found:?}"
        );
        assert!(least < 1e-12);
    }

    #[test]
    fn one_parameter_is_no_special_case() {
        let (found, _) = minimise([0.0], 1.0, 1e-8, 200, |x| Ok((x[0] - 3.0).powi(2))).unwrap();
        assert!((found[0] - 3.0).abs() < 1e-7);
    }
}

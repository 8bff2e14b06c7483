//! Which instants of a recording show how the boundary on the plane develops.

use hysteron::Turning;

/// Sample indices at which the picture of the plane is worth drawing, in the order of time: the
/// reversals of the input by more than `threshold` and the samples midway of the branches between
/// them.
pub(crate) fn candidates(input: &[f64], threshold: f64) -> Vec<usize> {
    let mut turning = Turning::new(threshold);
    let turns = input.iter().filter_map(|&x| turning.push(x));
    let mut ends: Vec<usize> = turns.map(|(sample, _)| sample).collect();
    ends.extend(input.len().checked_sub(1));
    let branches = ends.windows(2);
    let mut found: Vec<usize> = branches
        .flat_map(|branch| {
            midway(input, branch[0], branch[1])
                .into_iter()
                .chain([branch[1]])
        })
        .collect();
    found.dedup();
    if found.is_empty() {
        found = ends;
    }
    found
}

/// The first sample of a branch at which the input has gone half its way.
fn midway(input: &[f64], from: usize, to: usize) -> Option<usize> {
    let (start, end) = (input[from], input[to]);
    let half = 0.5 * (start + end);
    let passed = |x: f64| if end > start { x >= half } else { x <= half };
    (from + 1..to).find(|&sample| passed(input[sample]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reversals_and_midways_of_a_zigzag() {
        let input: Vec<f64> = (0..=10).chain((0..10).rev()).map(f64::from).collect();
        assert_eq!(candidates(&input, 0.5), [5, 10, 15, 20]);
        assert_eq!(candidates(&[3.0], 1.0), [0]);
        assert!(candidates(&[], 1.0).is_empty());
    }
}

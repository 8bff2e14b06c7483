//! Which moments of a recording show how the plane's boundary comes about.

/// Sample indices at which the picture of the plane is worth drawing, in the order of time: the significant reversals of
/// the input and the samples midway of the branches between them.
///
/// A reversal is significant when the input comes back by more than `threshold`.
pub(crate) fn candidates(input: &[f64], threshold: f64) -> Vec<usize> {
    let ends = reversals(input, threshold);
    let mut found = Vec::new();
    for branch in ends.windows(2) {
        let &[from, to] = branch else { continue };
        found.extend(midway(input, from, to));
        found.push(to);
    }
    found.dedup();
    if found.is_empty() {
        found.extend(input.iter().rposition(|x| x.is_finite()));
    }
    found
}

/// Start, significant reversals and end of the input.
fn reversals(input: &[f64], threshold: f64) -> Vec<usize> {
    let mut finite = input.iter().enumerate().filter(|(_, x)| x.is_finite());
    let Some((start, _)) = finite.next() else {
        return Vec::new();
    };
    let (mut lowest, mut highest) = (start, start);
    let mut rising: Option<bool> = None;
    let mut last = start;
    let mut ends = vec![start];
    for (k, &x) in finite {
        last = k;
        if x > input[highest] {
            highest = k;
        }
        if x < input[lowest] {
            lowest = k;
        }
        if rising != Some(false) && input[highest] - x > threshold {
            ends.push(highest);
            (rising, lowest) = (Some(false), k);
        } else if rising != Some(true) && x - input[lowest] > threshold {
            ends.push(lowest);
            (rising, highest) = (Some(true), k);
        }
    }
    ends.push(last);
    ends.dedup();
    ends
}

/// The first sample of a branch at which the input has gone half its way.
fn midway(input: &[f64], from: usize, to: usize) -> Option<usize> {
    let (start, end) = (input[from], input[to]);
    let half = 0.5 * (start + end);
    (from..to)
        .find(|&k| {
            if end > start {
                input[k] >= half
            } else {
                input[k] <= half
            }
        })
        .filter(|&k| k > from)
}

/// The turning points of `input` that a hysteresis operator still remembers, and its last value.
///
/// Operators forget an excursion that a larger one has wiped out, and do not feel time, so the states after these few
/// values are the states after all of `input`, however long it is.
pub(crate) fn remembered(input: &[f64]) -> Vec<f64> {
    // All operators start off, which is where an input from below everything would have left them.
    let mut memory = vec![f64::NEG_INFINITY];
    for &x in input.iter().filter(|x| x.is_finite()) {
        while let &[.., before, last] = memory.as_slice() {
            let continues = (last > before) == (x > last) || x == last;
            // Going back past the turn before the last wipes out both.
            let wipes = memory.len() > 2
                && if last > before {
                    x <= before
                } else {
                    x >= before
                };
            if continues {
                memory.pop();
            } else if wipes {
                memory.truncate(memory.len() - 2);
            } else {
                break;
            }
        }
        memory.push(x);
    }
    memory.remove(0);
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reversals_and_midways_of_a_zigzag() {
        let input: Vec<f64> = [0..=10, 0..=10].concat_zigzag();
        assert_eq!(reversals(&input, 0.5), [0, 10, 20]);
        assert_eq!(candidates(&input, 0.5), [5, 10, 15, 20]);
    }

    #[test]
    fn ripples_are_not_significant() {
        let input: Vec<f64> = (0..100)
            .map(|k| k as f64 + if k % 2 == 0 { 0.9 } else { -0.9 })
            .collect();
        assert_eq!(
            reversals(&input, 5.0),
            [0, 1, 99]
                .into_iter()
                .filter(|k| reversals(&input, 5.0).contains(k))
                .collect::<Vec<_>>()
        );
        assert!(candidates(&[3.0], 1.0) == [0] && candidates(&[], 1.0).is_empty());
    }

    trait Zigzag {
        fn concat_zigzag(self) -> Vec<f64>;
    }
    impl Zigzag for [std::ops::RangeInclusive<i32>; 2] {
        fn concat_zigzag(self) -> Vec<f64> {
            let [up, down] = self;
            up.map(f64::from)
                .chain(down.rev().skip(1).map(f64::from))
                .collect()
        }
    }

    #[test]
    fn memory_gives_the_same_states_as_the_whole_history() {
        let fixture = crate::fixture::sma(600);
        let source = crate::source::Source::new(&fixture.model);
        for end in [1, 37, 200, 411, 600] {
            let history = &fixture.recording.input[..end];
            let short = remembered(history);
            assert!(short.len() <= history.len());
            assert_eq!(
                source.states(&short),
                source.states(history),
                "after {end} samples"
            );
        }
    }
}

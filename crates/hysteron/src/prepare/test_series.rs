//! Series with known truth, for tests.

use crate::recording::Recording;

/// The readings of a first-order sensor that starts settled; exact for a truth that is linear
/// between samples.
pub(crate) fn behind_sensor(truth: &[f64], step: f64, tau: f64) -> Vec<f64> {
    let keep = (-step / tau).exp();
    let mut last = truth[0];
    let mut lagging = truth[0];
    let readings = truth.iter().map(|&x| {
        let slope = (x - last) / step;
        lagging = x - slope * tau + (lagging - last + slope * tau) * keep;
        last = x;
        lagging
    });
    readings.collect()
}

/// A rate-independent actuator (ten play operators in parallel) through the same loops, first fast
/// and then at a quarter of the speed.
pub(crate) fn two_rates(step: f64) -> Recording {
    let targets = [80.0, 25.0, 60.0, 35.0, 75.0, 20.0];
    let mut input = vec![20.0_f64];
    for rate in [2.0, 0.5] {
        for target in targets {
            let start = input[input.len() - 1];
            let count = ((target - start).abs() / (rate * step)).round() as usize;
            input.extend((1..=count).map(|n| start + (target - start) * n as f64 / count as f64));
        }
    }
    let mut plays = [20.0_f64; 10];
    let respond = |&x: &f64| {
        for (half_width, play) in (1_u8..).zip(&mut plays) {
            *play = play.clamp(x - f64::from(half_width), x + f64::from(half_width));
        }
        plays.iter().sum::<f64>() / 10.0
    };
    let output = input.iter().map(respond).collect();
    let time = (0..input.len()).map(|n| n as f64 * step).collect();
    Recording {
        time: Some(time),
        ..Recording::new(input, output).unwrap()
    }
}

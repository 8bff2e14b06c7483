//! Colour maps whose lightness falls steadily, so that a grey print keeps the order.

/// From nothing to the largest weight.
const SEQUENTIAL: [[f64; 3]; 6] = [
    [240.0, 243.0, 246.0],
    [193.0, 217.0, 229.0],
    [124.0, 181.0, 207.0],
    [58.0, 134.0, 180.0],
    [27.0, 84.0, 147.0],
    [9.0, 36.0, 84.0],
];

/// The same for weights below zero; their cells also carry a minus sign, which survives a grey
/// print.
const NEGATIVE: [[f64; 3]; 6] = [
    [240.0, 243.0, 246.0],
    [250.0, 214.0, 181.0],
    [242.0, 163.0, 101.0],
    [217.0, 104.0, 45.0],
    [165.0, 62.0, 15.0],
    [97.0, 31.0, 5.0],
];

/// The colour of `share` of the largest magnitude, −1…1.
pub(crate) fn of_share(share: f64) -> String {
    let map = if share < 0.0 { &NEGATIVE } else { &SEQUENTIAL };
    let place = share.abs().clamp(0.0, 1.0) * (map.len() - 1) as f64;
    let below = (place as usize).min(map.len() - 2);
    let part = place - below as f64;
    let channel =
        |c: usize| (map[below][c] + part * (map[below + 1][c] - map[below][c])).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(colour: &str) -> f64 {
        let channel =
            |at: usize| f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap_or(0));
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    }

    #[test]
    fn both_ways_from_zero_get_darker() {
        for sign in [1.0, -1.0] {
            let steps: Vec<f64> = (0..=50)
                .map(|k| luminance(&of_share(sign * f64::from(k) / 50.0)))
                .collect();
            assert!(steps.is_sorted_by(|lighter, darker| lighter > darker));
            assert!(steps[0] - steps[50] > 180.0);
        }
    }

    #[test]
    fn beyond_the_range_is_the_end_of_it() {
        assert_eq!(of_share(7.0), of_share(1.0));
        assert_eq!(of_share(-7.0), of_share(-1.0));
    }
}

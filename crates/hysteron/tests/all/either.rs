//! Of two parts of a recording that disagree, nothing tells which one is wrong.

use hysteron::{Doubt, Recording, doubts};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random branches through plays, with noise on both series. So many samples a branch.
fn loops(rng: &mut ChaCha8Rng, samples: u32) -> Recording {
    let mut input = vec![0.0];
    for k in 0..20 {
        let from = *input.last().unwrap();
        let to = rng.random_range(if k % 2 == 0 { 0.3..1.0 } else { -1.0..-0.3 });
        let share = |n: u32| f64::from(n) / f64::from(samples);
        input.extend((1..=samples).map(|n| from + (to - from) * share(n)));
    }
    let mut rests = [0.0_f64; 3];
    let output = input.iter().map(|x| {
        for (rest, width) in rests.iter_mut().zip([0.05, 0.15, 0.3]) {
            *rest = rest.clamp(x - width, x + width);
        }
        rests.iter().sum::<f64>() + 0.002 * rng.random_range(-1.0..1.0)
    });
    let output = output.collect();
    for x in &mut input {
        *x += 0.001 * rng.random_range(-1.0..1.0);
    }
    Recording::new(input, output).unwrap()
}

#[test]
fn two_parts_are_both_named_and_a_part_within_alone() {
    let mut named = 0;
    for seed in 0..8 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        // The last one is long: not all of its rows are looked at.
        let clean = loops(&mut rng, if seed < 7 { 100 } else { 700 });
        let len = clean.len();
        let cut = rng.random_range(len / 4..3 * len / 4);
        let wrong = [0..cut, cut..len, len / 2..len / 2 + len / 5];
        for wrong in wrong {
            let mut recording = clean.clone();
            recording.output[wrong.clone()]
                .iter_mut()
                .for_each(|y| *y *= 25.4);
            let found = doubts(&recording).unwrap();
            let Some(Doubt::Disagree { rows, others, .. }) = found.first() else {
                panic!("seed {seed}, {wrong:?}: {found:?}");
            };
            let touches = |rows: &hysteron::Rows| rows.first == 1 || rows.last == len;
            let is_either = rows.len() == 1 && touches(&rows[0]);
            assert_eq!(others.is_some(), is_either, "seed {seed}: {found:?}");
            // Where it ends is told to a tenth of the rows.
            let near = |a: usize, b: usize| a.abs_diff(b) <= len / 10;
            let is_wrong = |rows: &hysteron::Rows| {
                near(rows.first, wrong.start + 1) && near(rows.last, wrong.end)
            };
            named += i32::from(rows.iter().chain(others).any(is_wrong));
            let said = found[0].to_string();
            assert_eq!(said.contains("either may be wrong"), is_either, "{said}");
        }
    }
    // Of the others, rows within the right part were named.
    assert!(named >= 22, "{named} of 24");
}

//! The exponential of exported C is that of the core, bit for bit.

use crate::common::programs::has;
use crate::common::reference::Number;
use crate::common::{Exported, answers, same, walks};
use hysteron::control::Scheme;
use hysteron::{Model, Operator, Plane, Sign};
use hysteron_core::Real;
use hysteron_export::{COptions, CReal, CSampling, c_controlled};
use rand::RngExt;
use std::process::Command;

/// Numbers of all sizes, and the bounds of the algorithm with their neighbours.
fn numbers() -> Vec<f64> {
    let bounds = [
        0.0,
        f64::INFINITY,
        f64::MIN_POSITIVE,
        3.725_290_298_461_914e-9, // 2^-28
        1.220_703_125e-4,         // 2^-13
        0.5 * core::f64::consts::LN_2,
        1.5 * core::f64::consts::LN_2,
        87.336_55,
        103.972_084,
        708.396_418_532_264_1,
        745.133_219_101_941_1,
    ];
    let near = bounds.iter().flat_map(|&bound: &f64| {
        let bits = bound.to_bits();
        let wide = (0..40).map(move |n| f64::from_bits(bits.saturating_add(n).saturating_sub(20)));
        let single = (bound as f32).to_bits();
        let narrow =
            (0..40).map(move |n| f32::from_bits(single.saturating_add(n).saturating_sub(20)));
        wide.chain(narrow.map(f64::from))
    });
    let mut rng = walks::rng(3);
    let mut numbers: Vec<f64> = near.filter(|x| *x >= 0.0).collect();
    for _ in 0..20_000 {
        numbers.push(rng.random_range(0.0..3.0));
        numbers.push(rng.random_range(80.0..800.0));
        numbers.push(10f64.powf(rng.random_range(-20.0..4.0)));
    }
    numbers
}

fn compare<T: Number + Real>(exported: &Exported, of: impl Fn(f64) -> T) {
    let (mut commands, mut expected) = (String::new(), String::new());
    for number in numbers() {
        let number = of(number);
        commands += &format!("{}\n", number.hex());
        expected += &format!("{}\n", Real::exp(-number).hex());
    }
    for flags in [["-O0"], ["-O2"]] {
        let program = exported.compile("cc", &flags, "decay.c");
        let found = answers(&mut Command::new(program), &commands);
        same(&commands, &expected, &found, flags[0]);
    }
}

fn export(real: CReal) -> Exported {
    let folder = tempfile::tempdir().unwrap();
    let plane = Plane::new(0.0, 1.0, 2).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive).unwrap();
    let options = COptions {
        real,
        name: Some("m"),
        source: "m.json".as_ref(),
        adaptation: false,
    };
    let scheme = Scheme {
        filter_s: 1.0,
        ..Scheme::new(0.1, (0.0, 1.0))
    };
    let sampling = CSampling::default();
    let made = c_controlled(&model, folder.path(), &options, &sampling, &scheme).unwrap();
    let sources = made.files.into_iter();
    let sources = sources.filter(|file| file.extension().is_some_and(|end| end == "c"));
    Exported::of(folder, real, sources.collect())
}

#[test]
fn a_decay_has_the_digits_of_the_core() {
    if has("cc") {
        compare(&export(CReal::Double), |number| number);
        compare(&export(CReal::Float), |number| number as f32);
    }
}

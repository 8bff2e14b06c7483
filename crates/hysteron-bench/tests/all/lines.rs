//! The lines of the protocol, attacked.

use hysteron_bench::protocol::{FromDevice, closed, drive_text, opened};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

#[test]
fn a_line_with_a_changed_byte_is_not_there() {
    let line = closed("S 12 0.600 11 0.0132 22.4");
    let line = line.trim_end().as_bytes();
    for at in 0..line.len() {
        for bit in 0..8 {
            let mut changed = line.to_vec();
            changed[at] ^= 1 << bit;
            let found = opened(&changed);
            // The check may be written in small letters.
            let small = changed.eq_ignore_ascii_case(line) && at > line.len() - 5;
            assert!(found.is_none() || small, "{at} {bit}");
        }
    }
}

#[test]
fn a_carriage_return_is_dropped_and_a_long_line_too() {
    assert_eq!(
        opened(format!("{}\r", closed("?").trim_end()).as_bytes()),
        Some("?")
    );
    let long = |count| closed(&"x".repeat(count)).trim_end().to_owned();
    assert!(opened(long(195).as_bytes()).is_some());
    assert!(opened(long(196).as_bytes()).is_none());
}

#[test]
fn noise_is_never_a_line_and_never_a_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let words = [
        "S",
        "H",
        "E",
        "1",
        "-1",
        "nan",
        "inf",
        "1e999",
        "dt=",
        "drive=1:0[",
        "columns=",
        "*",
        "=",
        "\u{e9}",
    ];
    for _ in 0..20_000 {
        let count = rng.random_range(0..12);
        let text: Vec<&str> = (0..count)
            .map(|_| words[rng.random_range(0..words.len())])
            .collect();
        let text = text.join(" ");
        let _ = FromDevice::parse(&text);
        let bytes: Vec<u8> = (0..count)
            .map(|_| rng.random_range(0..=255u32) as u8)
            .collect();
        let _ = opened(&bytes);
    }
}

#[test]
fn a_header_says_what_is_wrong_with_it() {
    let good = "H 1 name=wire dt=0.05 drive=0:0.12[A2] safe=0 watchdog=1 \
                columns=output[mm],temperature[degC]";
    let Some(FromDevice::Header(Ok(header))) = FromDevice::parse(good) else {
        panic!("{good}");
    };
    assert_eq!(
        (header.dt, header.drive, header.watchdog),
        (0.05, (0.0, 0.12), Some(1.0))
    );
    assert_eq!(
        (header.unit.as_deref(), header.column("temperature")),
        (Some("A2"), Some(1))
    );
    for (from, to, says) in [
        ("H 1", "H 2", "version"),
        ("dt=0.05", "dt=0", "dt"),
        ("dt=0.05 ", "", "dt"),
        ("0:0.12", "0.12:0", "lower"),
        ("0:0.12", "nan:1", "number"),
        ("safe=0", "safe=1", "outside"),
        ("output", "displacement", "output"),
        ("temperature[degC]", "output[mm]", "two columns"),
    ] {
        let Some(FromDevice::Header(Err(error))) = FromDevice::parse(&good.replace(from, to))
        else {
            panic!("{from} {to}");
        };
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn a_drive_as_text_is_short_within_its_limits_and_near() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..20_000 {
        let scale = 10f64.powi(rng.random_range(-12..12));
        let (low, high) = (
            -scale * rng.random::<f64>(),
            scale * (0.01 + rng.random::<f64>()),
        );
        let drive = low + (high - low) * rng.random::<f64>();
        for drive in [drive, low, high] {
            let (text, value) = drive_text(drive, (low, high));
            assert!(
                (low..=high).contains(&value) && text.parse::<f64>() == Ok(value),
                "{text}"
            );
            assert!(
                (value - drive).abs() <= 1e-8 * (high - low),
                "{drive} {text}"
            );
            assert!(text.len() < 60, "{text}");
        }
    }
}

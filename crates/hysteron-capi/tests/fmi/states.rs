//! States: saved, put back, carried as bytes.

use crate::api::*;
use crate::{expected, feed};
use hysteron_export::Fmi;
use std::ptr::null_mut;

/// In the middle of a run, save, run astray, and come back: nothing has changed, in this instance
/// or in another.
#[test]
fn saving_changes_nothing() {
    let names = [
        "forward-relay-5",
        "forward-mkp-20",
        "inverse-mkp-5-negative",
        "inverse-kp-5",
    ];
    // Miri takes a thousand times as long.
    let (names, samples) = match cfg!(miri) {
        true => (&names[..1], 8),
        false => (&names[..], usize::MAX),
    };
    for name in names {
        let vector = vector(name);
        let (model, kind) = (model(&vector), vector["kind"].as_str().unwrap());
        for fmi in [Fmi::V2, Fmi::V3] {
            let fmu = Unpacked::new(&model, kind == "inverse", fmi);
            for run in vector["runs"].as_array().unwrap() {
                let expected = expected(&model, kind, run);
                let mut instance = fmu.instance();
                if kind == "inverse" {
                    instance.set(TOLERANCE, run["tolerance"].as_f64().unwrap());
                }
                assert_eq!(instance.initialise(0.0), 0);
                let mut state = null_mut();
                for (n, expected) in expected.iter().enumerate().take(samples) {
                    feed(instance, kind, run, n);
                    if n % 7 == 3 {
                        // A state of before is written over.
                        assert_eq!(instance.save(&mut state), 0);
                        for astray in [1e3, -1e3, 0.7, 0.1] {
                            assert_eq!(instance.next(astray), 0);
                        }
                        assert_eq!(instance.restore(state), 0);
                    }
                    if n % 7 == 5 {
                        assert_eq!(instance.save(&mut state), 0);
                        let bytes = instance.serialise(state);
                        let other = fmu.instance();
                        let mut there = null_mut();
                        assert_eq!(other.deserialise(&bytes, &mut there), 0);
                        assert_eq!(other.restore(there), 0);
                        assert_eq!(other.forget(&mut there), 0);
                        assert!(there.is_null());
                        instance.free();
                        (instance, state) = (other, null_mut());
                    }
                    assert_eq!(
                        instance.step(n as f64, 1.0),
                        0,
                        "the time is part of the state"
                    );
                    assert_eq!(
                        instance.outputs(),
                        *expected,
                        "{name}, {}, sample {n}",
                        run["name"]
                    );
                }
                instance.free();
            }
        }
    }
}

/// States before initialisation and after the end are states too.
#[test]
fn every_phase_can_be_saved() {
    let model = model(&vector("forward-mkp-5"));
    for fmi in [Fmi::V2, Fmi::V3] {
        let fmu = Unpacked::new(&model, false, fmi);
        let instance = fmu.instance();
        let mut states = [null_mut(); 3];
        assert_eq!(instance.save(&mut states[0]), 0);
        assert_eq!(instance.enter(1.0), 0);
        assert_eq!(instance.save(&mut states[1]), 0);
        assert_eq!(instance.exit(), 0);
        assert_eq!(instance.terminate(), 0);
        assert_eq!(instance.save(&mut states[2]), 0);
        for state in &mut states {
            let bytes = instance.serialise(*state);
            assert_eq!(instance.deserialise(&bytes, state), 0);
        }
        assert_eq!(
            (instance.restore(states[2]), instance.step(1.0, 1.0)),
            (0, 3)
        );
        assert_eq!((instance.restore(states[1]), instance.exit()), (0, 0));
        assert_eq!(
            (instance.restore(states[0]), instance.initialise(0.0)),
            (0, 0)
        );
        assert_eq!(instance.step(0.0, 1.0), 0);
        instance.free();
    }
}

#[test]
fn bytes_that_are_no_state_are_refused() {
    let model = model(&vector("forward-mkp-2"));
    let other_model = with_other_weights(&model);
    for fmi in [Fmi::V2, Fmi::V3] {
        let fmu = Unpacked::new(&model, false, fmi);
        let instance = fmu.started();
        assert_eq!(instance.next(0.6), 0);
        let before = instance.outputs();
        let mut state = null_mut();
        assert_eq!(instance.save(&mut state), 0);
        let bytes = instance.serialise(state);
        let mut read = null_mut();
        for length in (0..bytes.len()).step_by(stride(7)) {
            assert_eq!(
                instance.deserialise(&bytes[..length], &mut read),
                3,
                "{length} bytes"
            );
        }
        assert_eq!(
            instance.deserialise(&[&bytes[..], &[0]].concat(), &mut read),
            3
        );
        for place in (0..bytes.len()).step_by(stride(7)) {
            for bit in 0..8 {
                let mut changed = bytes.clone();
                changed[place] ^= 1 << bit;
                assert_eq!(instance.deserialise(&changed, &mut read), 3, "byte {place}");
            }
        }
        assert!(read.is_null());
        // Another model, and another block of the same model.
        for other in [
            Unpacked::new(&other_model, false, fmi),
            Unpacked::new(&model, true, fmi),
        ] {
            let other = other.instance();
            assert_eq!(other.deserialise(&bytes, &mut read), 3);
            assert_eq!(other.restore(state), 3);
            assert_eq!(other.save(&mut state), 3);
            other.free();
        }
        assert_eq!(instance.outputs(), before);
        instance.free();
    }
}

/// The same plane with other weights.
fn with_other_weights(model: &hysteron::Model) -> hysteron::Model {
    let weights = model.weights().iter().map(|mu| mu + 1.0).collect();
    hysteron::Model::new(model.operator(), *model.plane(), weights, 0.0, model.sign()).unwrap()
}

#[test]
fn states_end_with_free_and_with_their_instance() {
    let model = model(&vector("forward-mkp-2"));
    for fmi in [Fmi::V2, Fmi::V3] {
        let fmu = Unpacked::new(&model, false, fmi);
        let (a, b) = (fmu.started(), fmu.started());
        let mut state = null_mut();
        assert_eq!(a.save(&mut state), 0);
        assert_eq!(b.restore(state), 0, "of the same model");
        let mut copy = state;
        assert_eq!(a.forget(&mut state), 0);
        assert!(state.is_null());
        assert_eq!(a.forget(&mut state), 0, "null is nothing to free");
        assert_eq!(
            (a.restore(copy), a.save(&mut copy), a.forget(&mut copy)),
            (3, 3, 3)
        );
        assert_eq!(a.restore(null_mut()), 3);

        assert_eq!(a.save(&mut state), 0);
        a.free();
        assert_eq!(b.restore(state), 3, "it ended with its instance");
        b.free();
    }
}

/// Bytes with the right checksum that this library never wrote: refused, or a state that runs.
#[test]
fn forged_bytes_do_no_harm() {
    let model = model(&vector("forward-mkp-2"));
    let forged = |words: &[u64]| {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let sum = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        [bytes, sum.to_le_bytes().to_vec()].concat()
    };
    for inverse in [false, true] {
        let instance = Unpacked::new(&model, inverse, Fmi::V2).started();
        let mut state = null_mut();
        assert_eq!((instance.next(0.6), instance.save(&mut state)), (0, 0));
        let bytes = instance.serialise(state);
        let (words, _) = bytes.as_chunks::<8>();
        let words: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        let (_, words) = words.split_last().unwrap();
        assert_eq!(forged(words), bytes, "the forger knows how");
        let odd = [
            0.0,
            -0.0,
            1.5,
            -1.0,
            1e300,
            f64::NAN,
            f64::INFINITY,
            f64::MIN_POSITIVE,
        ]
        .map(f64::to_bits);
        let odd = odd.into_iter().chain([1, 2, 4, u64::MAX, 1 << 63]);
        let every = (0..words.len()).flat_map(|place| odd.clone().map(move |value| (place, value)));
        // Miri takes seconds for each: some of every place and of every value will do there.
        let every = every.step_by(if cfg!(miri) { 11 } else { 1 });
        let mut accepted = 0;
        for (place, value) in every {
            let mut words = words.to_vec();
            words[place] = value;
            if instance.deserialise(&forged(&words), &mut state) == 0 {
                accepted += 1;
                assert_eq!(instance.restore(state), 0);
                for input in [0.2, 0.9, 0.4] {
                    let time = instance.get(TIME).unwrap();
                    instance.set(SIGNAL, input);
                    instance.step(time, 1.0);
                }
            }
        }
        assert!(accepted > 10, "{accepted}");
        // More turning points than any run leaves, nested in one cell.
        let count: u32 = if cfg!(miri) { 100 } else { 10_000 };
        let mut many = words[..24].to_vec();
        many.push(u64::from(count));
        many.extend((0..count).map(|n| {
            let away = 0.4 * f64::from(count - n) / f64::from(count);
            (1.5 + if n % 2 == 0 { away } else { -away }).to_bits()
        }));
        assert_eq!(instance.deserialise(&forged(&many), &mut state), 0);
        assert_eq!((instance.restore(state), instance.next(0.9)), (0, 0));
        instance.free();
    }
}

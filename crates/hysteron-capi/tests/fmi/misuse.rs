//! Calls that are not allowed give an error and a message, and change nothing.

use crate::api::*;
use hysteron_capi::fmi::{fmi2, fmi3};
use hysteron_export::Fmi;
use std::ptr::{null, null_mut};

fn fmus() -> [Unpacked; 4] {
    let model = model(&vector("forward-mkp-2"));
    let all = [
        (false, Fmi::V2),
        (true, Fmi::V2),
        (false, Fmi::V3),
        (true, Fmi::V3),
    ];
    all.map(|(inverse, fmi)| Unpacked::new(&model, inverse, fmi))
}

#[test]
fn the_order_of_calls() {
    for fmu in fmus() {
        let c = fmu.instance();
        assert_eq!((c.step(0.0, 1.0), c.exit(), c.terminate()), (3, 3, 3));
        assert_eq!(c.enter(0.0), 0);
        assert_eq!((c.step(0.0, 1.0), c.enter(0.0), c.terminate()), (3, 3, 3));
        assert_eq!(c.exit(), 0);
        assert_eq!((c.enter(0.0), c.exit()), (3, 3));
        assert_eq!(c.step(0.0, 1.0), 0);
        assert_eq!(c.terminate(), 0);
        assert_eq!(
            (
                c.step(1.0, 1.0),
                c.enter(0.0),
                c.set(SIGNAL, 0.0),
                c.terminate()
            ),
            (3, 3, 3, 3)
        );
        assert!(c.get(RESULT).is_ok(), "results can be read after the end");
        assert_eq!((c.reset(), c.initialise(0.0), c.step(0.0, 1.0)), (0, 0, 0));
        c.free();
    }
}

#[test]
fn steps_that_cannot_be() {
    for fmu in fmus() {
        let c = fmu.started();
        assert_eq!(c.next(0.5), 0);
        let before = c.outputs();
        for size in [-1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(c.step(1.0, size), 3);
        }
        for from in [0.0, 2.0, f64::NAN, f64::INFINITY] {
            assert_eq!(c.step(from, 1.0), 3);
        }
        for input in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(c.next(input), 3);
        }
        assert_eq!(
            (c.outputs(), c.get(TIME)),
            (before, Ok(1.0)),
            "all as before"
        );
        assert_eq!(c.next(0.5), 0, "and it goes on");
        assert_eq!(c.outputs(), before);
        c.free();
        let c = fmu.instance();
        assert_eq!(
            (c.enter(f64::NAN), c.enter(0.0), c.set(SIGNAL, f64::NAN)),
            (3, 0, 0)
        );
        assert_eq!((c.get(RESULT), c.exit()), (Err(3), 3));
        assert_eq!((c.set(SIGNAL, 0.5), c.exit()), (0, 0));
        c.free();
    }
}

#[test]
fn the_stop_time_is_kept() {
    let [fmu, ..] = fmus();
    let c = fmu.instance();
    let setup = |start, stop| fmi2::fmi2SetupExperiment(c.handle, 1, 1e-6, start, 1, stop);
    assert_eq!(
        (setup(2.0, 1.0), setup(0.0, 1.0)),
        (3, 0),
        "the first ends before it begins"
    );
    assert_eq!(
        (fmi2::fmi2EnterInitializationMode(c.handle), c.exit()),
        (0, 0)
    );
    // Ten steps of 0.1 add up to a little less, eleven to more.
    for n in 0..10 {
        assert_eq!(c.step(f64::from(n) * 0.1, 0.1), 0);
    }
    assert_eq!((c.step(1.0, 0.0), c.step(1.0, 0.1)), (0, 3));
    c.free();
}

#[test]
fn variables_that_are_not_there() {
    for (n, fmu) in fmus().into_iter().enumerate() {
        let (c, inverse) = (fmu.started(), n % 2 == 1);
        for reference in [FLAG, HEADING, START_ON, 7, u32::MAX] {
            assert_eq!(
                (c.get(reference), c.set(reference, 0.0)),
                (Err(3), 3),
                "{reference}"
            );
        }
        for reference in [TIME, SIGNAL, RESULT, TOLERANCE, START_ON, 7] {
            assert_eq!(
                (c.get_integer(reference), c.set_integer(reference, 0)),
                (Err(3), 3)
            );
        }
        for reference in [TIME, SIGNAL, FLAG, HEADING, 7] {
            assert_eq!(c.set_boolean(reference, true), 3);
        }
        for output in [TIME, RESULT] {
            assert_eq!(c.set(output, 0.0), 3);
        }
        assert_eq!(c.set_integer(FLAG, 0), 3);
        let allowed = if inverse { 0 } else { 3 };
        assert_eq!(
            (c.set(TOLERANCE, 0.5), c.set_integer(HEADING, -1)),
            (allowed, allowed)
        );
        assert_eq!(
            (
                c.set(TOLERANCE, -0.5),
                c.set(TOLERANCE, f64::NAN),
                c.set_integer(HEADING, 2)
            ),
            (3, 3, 3)
        );
        c.free();
    }
}

/// All of the values are set or none.
#[test]
fn a_set_that_fails_sets_nothing() {
    let [fmu, ..] = fmus();
    let c = fmu.started();
    assert_eq!(c.set(SIGNAL, 0.25), 0);
    let status =
        unsafe { fmi2::fmi2SetReal(c.handle, [SIGNAL, RESULT].as_ptr(), 2, [0.5, 0.5].as_ptr()) };
    assert_eq!((status, c.get(SIGNAL)), (3, Ok(0.25)));
    c.free();
}

#[test]
fn dead_and_made_up_instances() {
    for fmu in fmus() {
        let c = fmu.started();
        let (mut state, live) = (null_mut(), fmu.started());
        assert_eq!(c.save(&mut state), 0);
        c.free();
        c.free();
        let made_up = [
            0_usize,
            1,
            8,
            usize::MAX,
            c.handle.addr() ^ 1 << 50,
            c.handle.addr() + 1_000_000,
        ];
        for handle in made_up
            .map(std::ptr::without_provenance_mut)
            .into_iter()
            .chain([c.handle, state])
        {
            let c = Instance { handle, ..c };
            assert_eq!(
                (
                    c.enter(0.0),
                    c.exit(),
                    c.step(0.0, 1.0),
                    c.terminate(),
                    c.reset()
                ),
                (3, 3, 3, 3, 3)
            );
            assert_eq!(
                (c.get(RESULT), c.set(SIGNAL, 0.0), c.save(&mut state)),
                (Err(3), 3, 3)
            );
            c.free();
        }
        assert_eq!(live.next(0.5), 0, "others live on");
        live.free();
    }
}

#[test]
fn null_pointers() {
    let [fmu, _, fmu3, _] = fmus();
    let (c, c3) = (fmu.started().handle, fmu3.started().handle);
    let one = 1_u32;
    unsafe {
        assert_eq!(fmi2::fmi2GetReal(c, null(), 1, &mut 0.0), 3);
        assert_eq!(fmi2::fmi2GetReal(c, &one, 1, null_mut()), 3);
        assert_eq!(fmi2::fmi2SetReal(c, &one, 1, null()), 3);
        assert_eq!(fmi2::fmi2SetBoolean(c, null(), 1, &1), 3);
        assert_eq!(
            fmi2::fmi2GetReal(c, null(), 0, null_mut()),
            0,
            "nothing is nothing"
        );
        assert_eq!(fmi2::fmi2GetReal(c, null(), usize::MAX, null_mut()), 3);
        assert_eq!(fmi2::fmi2GetString(c, null(), 0, null_mut()), 0);
        assert_eq!(fmi2::fmi2SetString(c, &one, 1, null()), 3);
        assert_eq!(fmi2::fmi2GetFMUstate(c, null_mut()), 3);
        assert_eq!(fmi2::fmi2FreeFMUstate(c, null_mut()), 3);
        assert_eq!(
            fmi2::fmi2DeSerializeFMUstate(c, null(), 100, &mut null_mut()),
            3
        );
        assert_eq!(fmi2::fmi2GetRealStatus(c, 2, null_mut()), 3);
        assert_eq!(fmi2::fmi2GetRealStatus(c, 2, &mut 0.0), 0);
        assert_eq!(fmi2::fmi2GetStatus(c, 0, null_mut()), 2);
        assert_eq!(fmi2::fmi2SetDebugLogging(c, 1, 1, null()), 3);
        assert_eq!(fmi2::fmi2SetDebugLogging(c, 1, 1, [null()].as_ptr()), 3);
        assert_eq!(
            fmi2::fmi2SetDebugLogging(c, 1, 1, [c"logNothing".as_ptr()].as_ptr()),
            3
        );
        assert_eq!(
            fmi2::fmi2SetDebugLogging(c, 1, 1, [c"logStatusError".as_ptr()].as_ptr()),
            0
        );
        assert_eq!(fmi2::fmi2SetDebugLogging(c, 0, 0, null()), 0);
        let name = c"x".as_ptr();
        assert!(fmi2::fmi2Instantiate(null(), 1, null(), null(), null(), 0, 0).is_null());
        assert!(fmi2::fmi2Instantiate(name, 1, name, name, null(), 0, 0).is_null());
        assert_eq!(
            fmi2::fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut()),
            3
        );
        assert_eq!(fmi2::fmi2CancelStep(c), 3);

        assert_eq!(fmi3::fmi3GetFloat64(c3, null(), 1, &mut 0.0, 1), 3);
        assert_eq!(
            fmi3::fmi3GetFloat64(c3, &one, 1, &mut 0.0, 2),
            3,
            "as many values as references"
        );
        assert_eq!(fmi3::fmi3SetBoolean(c3, &one, 1, null(), 1), 3);
        assert_eq!(fmi3::fmi3GetUInt16(c3, &one, 1, &mut 0, 1), 3);
        assert_eq!(fmi3::fmi3GetUInt16(c3, null(), 0, null_mut(), 0), 0);
        let (null_flag, null_time) = (null_mut(), null_mut());
        assert_eq!(
            fmi3::fmi3DoStep(c3, 0.0, 1.0, 1, null_flag, null_flag, null_flag, null_time),
            0
        );
        assert_eq!(fmi3::fmi3EnterEventMode(c3), 3);
        let none = fmi3::fmi3InstantiateCoSimulation(
            null(),
            null(),
            null(),
            0,
            0,
            0,
            0,
            null(),
            0,
            null_mut(),
            None,
            null(),
        );
        assert!(none.is_null());
        let exchange = fmi3::fmi3InstantiateModelExchange(name, name, name, 0, 0, null_mut(), None);
        assert!(exchange.is_null());
    }
    fmi2::fmi2FreeInstance(c);
    fmi3::fmi3FreeInstance(c3);
    fmi2::fmi2FreeInstance(null_mut());
}

#[test]
fn messages_say_what_is_wrong() {
    let [_, _, fmu, _] = fmus();
    let mut log = Vec::new();
    let c = fmu.try_instance(Some(&mut log)).unwrap();
    assert_eq!(c.step(0.0, 1.0), 3);
    assert_eq!((c.initialise(0.0), c.next(f64::NAN)), (0, 3));
    unsafe {
        assert_eq!(fmi3::fmi3SetDebugLogging(c.handle, 0, 0, null()), 0);
        assert_eq!(c.next(f64::NAN), 3);
        assert_eq!(
            fmi3::fmi3SetDebugLogging(c.handle, 1, 1, [c"logStatusError".as_ptr()].as_ptr()),
            0
        );
    }
    assert_eq!(c.set(RESULT, 0.0), 3);
    c.free();
    assert!(fmu.with_token("{other}", Some(&mut log)).is_none());
    let expected = [
        "fmi3DoStep: initialisation has not been entered yet",
        "fmi3DoStep: the input is NaN, not a finite number",
        "fmi3SetFloat64: the variable with the value reference 2 is an output and cannot be set",
        "instantiate: the tool's GUID (instantiation token) is `{other}`, that of the model `{",
    ];
    assert_eq!(log.len(), expected.len(), "{log:#?}");
    for (found, expected) in log.iter().zip(expected) {
        assert!(found.starts_with(expected), "{found}");
    }
}

/// Every byte changed and every length cut: no instance, and a message that names the file.
#[test]
fn a_broken_model_gives_no_instance() {
    for fmu in fmus() {
        let file = fmu.resources().join("model.txt");
        let text = std::fs::read(&file).unwrap();
        let mut log = Vec::new();
        let mut refused = |bytes: &[u8]| {
            std::fs::write(&file, bytes).unwrap();
            fmu.try_instance(Some(&mut log)).is_none()
        };
        let apart = stride(17);
        for length in (0..text.len()).step_by(apart) {
            assert!(refused(&text[..length]), "{length} bytes");
        }
        for place in (0..text.len()).step_by(apart) {
            let mut bytes = text.clone();
            bytes[place] ^= 1 << (place % 8);
            assert!(refused(&bytes), "byte {place}");
        }
        std::fs::remove_file(&file).unwrap();
        assert!(fmu.try_instance(Some(&mut log)).is_none());
        if fmu.fmi == Fmi::V3 {
            assert_eq!(log.len(), 2 * text.len().div_ceil(apart) + 1);
            let (missing, broken) = log.split_last().unwrap();
            assert!(broken.iter().all(|text| text.contains("model.txt, line ")));
            assert!(missing.contains("model.txt: "), "{missing}");
        }
        std::fs::write(&file, &text).unwrap();
        fmu.started().free();
    }
}

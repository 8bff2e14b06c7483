//! Handles in many threads at once: a call succeeds, or it reports that the handle was freed.

use hysteron_capi::*;
use std::ptr::null_mut;

#[test]
fn a_state_freed_while_others_step_it() {
    let weights = [1.0; 3];
    let mut model = 0;
    // SAFETY: live memory of the sizes given.
    let made = unsafe {
        hysteron_model_new(
            HYSTERON_MKP,
            0.0,
            1.0,
            2,
            weights.as_ptr(),
            3,
            0.0,
            1,
            &mut model,
        )
    };
    assert_eq!(made, HYSTERON_OK);
    // Miri takes a thousand times as long.
    let (states, calls) = if cfg!(miri) { (4, 50) } else { (50, 2000) };
    for _ in 0..states {
        let mut state = 0;
        // SAFETY: a live number.
        assert_eq!(
            unsafe { hysteron_state_new(model, &mut state) },
            HYSTERON_OK
        );
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    for n in 0..calls {
                        let mut output = 0.0;
                        // SAFETY: a live number.
                        match unsafe {
                            hysteron_step(state, f64::from(n % 7) / 6.0, &mut output, null_mut())
                        } {
                            HYSTERON_OK => assert!((0.0..=3.0).contains(&output)),
                            code => assert_eq!(code, HYSTERON_HANDLE),
                        }
                    }
                });
            }
            let freed = [(); 2].map(|()| scope.spawn(|| hysteron_state_free(state)).join());
            assert!(matches!(freed, [Ok(HYSTERON_OK), Ok(HYSTERON_HANDLE)]));
        });
    }
    assert_eq!(hysteron_model_free(model), HYSTERON_OK);
}

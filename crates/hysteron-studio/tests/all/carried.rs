//! Fits that are carried to another process as bytes, as a page without threads does.

use hysteron_studio::{Fault, Finished, Job, Request, Session};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::sync::Mutex;

/// Loops of a play that shrink, without and with time and load.
fn table(kind: usize, turn: f64) -> String {
    let heads = [
        "T [degC],lift [mm]",
        "t [s],T [degC],lift [mm]",
        "t [s],T [degC],lift [mm],load [N]",
    ];
    let mut text = heads[kind].to_owned() + "\n";
    let mut y = 20.0_f64;
    for n in 0..400 {
        let x = f64::from(n);
        let input = 50.0 - 30.0 * (x * turn).cos() * (1.0 - x / 700.0);
        y = y.clamp(input - 4.0, input + 4.0);
        let time = if kind > 0 {
            format!("{},", 0.1 * x)
        } else {
            String::new()
        };
        let load = if kind > 1 {
            format!(",{}", 5.0 * (n / 200 + 1) as f64)
        } else {
            String::new()
        };
        text += &format!("{time}{input},{}{load}\n", 0.2 * y);
    }
    text
}

fn session(texts: &[String]) -> Session {
    let mut session = Session::new(1 << 28);
    for (n, text) in texts.iter().enumerate() {
        session
            .open(&format!("run{n}.csv"), text.clone().into())
            .unwrap();
    }
    session
}

fn job(session: &mut Session, request: &Value) -> Result<Job, Fault> {
    let request = serde_json::from_value(request.clone()).unwrap();
    Ok(session.handle(request)?.job.unwrap())
}

/// All that a page sees, and the session as a file.
fn all(session: &mut Session) -> Vec<Value> {
    let take = serde_json::from_value(json!({"request": "take", "what": "session"})).unwrap();
    let mut answer = |request| serde_json::to_value(session.handle(request).unwrap().response);
    vec![answer(Request::Overview).unwrap(), answer(take).unwrap()]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..Default::default() })]

    /// A fit that was carried is the fit that was not, to the last bit.
    #[test]
    fn a_carried_fit_is_the_same(
        kind in 0..3_usize, turn in 0.03..0.12_f64, levels in 4..10_u8, held in 0..5_usize,
    ) {
        let texts = [table(kind, turn), table(kind, turn * 1.1)];
        let held_out = [
            json!("usual"),
            json!("nothing"),
            json!({"words": "branches:25%"}),
            json!("usual"),
            json!({"words": "rows:100-130,300-400"}),
        ];
        let options = json!({"levels": levels.to_string(), "bootstrap": "3"});
        let request = json!({"request": "fit", "options": options, "hold_out": held_out[held]});
        let [mut near, mut far] = [session(&texts), session(&texts)];
        for session in [&mut near, &mut far] {
            // The second file tests, is looked at, or is fitted as well.
            let purpose = match held {
                3 => Some("validate"),
                4 => Some("look"),
                _ => None,
            };
            if let Some(purpose) = purpose {
                let used = json!({"request": "use", "file": 2, "purpose": purpose});
                session.handle(serde_json::from_value(used).unwrap()).unwrap();
            }
        }
        let found = near_and_far(&mut near, &mut far, &request);
        prop_assert_eq!(found.0, found.1);
        prop_assert_eq!(all(&mut near), all(&mut far));
    }

    /// Bytes that are no job, or a job that is cut or changed, are refused or run: nothing panics.
    #[test]
    fn other_bytes_are_refused(
        at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in any::<bool>(),
    ) {
        let mut near = session(&[table(1, 0.1)]);
        let options = json!({"levels": "3", "bootstrap": "0"});
        let request = json!({"request": "fit", "options": options, "hold_out": "nothing"});
        let whole = job(&mut near, &request).unwrap();
        let mut bytes = whole.to_bytes();
        let at = at.index(bytes.len());
        if cut {
            bytes.truncate(at);
        } else {
            bytes[at] = byte;
        }
        match Job::from_bytes(&bytes) {
            Err(fault) => prop_assert!(fault.code > 0 && !fault.problem.is_empty()),
            Ok(job) => drop(near.finish(job.run())),
        }
        let mut bytes = whole.run().to_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        if let Err(fault) = Finished::from_bytes(&bytes) {
            prop_assert!(fault.code == 104, "{fault:?}");
        }
    }
}

/// A fit made here, and one made elsewhere; the faults, if there is no fit.
fn near_and_far(
    near: &mut Session,
    far: &mut Session,
    request: &Value,
) -> (Option<Fault>, Option<Fault>) {
    let here = job(near, request).unwrap();
    let there = job(far, request).unwrap().to_bytes();
    let told = Mutex::new(Vec::new());
    let tell = |stage: &'static str, share: f64| told.lock().unwrap().push((stage, share));
    let found = Job::from_bytes(&there)
        .unwrap()
        .run_telling(&tell)
        .to_bytes();
    let told = told.into_inner().unwrap();
    assert!(!told.is_empty());
    // What is told elsewhere is seen here.
    let (stage, share) = told[told.len() - 1];
    let id = far.jobs()[0].id;
    far.told(id, stage.to_owned(), share);
    assert_eq!(far.jobs()[0].stage, stage);
    (
        near.finish(here.run()).err(),
        far.finish(Finished::from_bytes(&found).unwrap()).err(),
    )
}

#[test]
fn a_fit_that_was_cancelled_elsewhere_is_not_taken() {
    let mut session = session(&[table(0, 0.1)]);
    let request = json!({"request": "fit", "options": {"levels": "5", "bootstrap": "0"}});
    let carried = job(&mut session, &request).unwrap();
    let id = carried.id;
    let cancel = json!({"request": "cancel", "job": id});
    session
        .handle(serde_json::from_value(cancel).unwrap())
        .unwrap();
    let found = Job::from_bytes(&carried.to_bytes()).unwrap().run();
    assert_eq!(session.finish(found).unwrap_err().code, 103);
    assert!(session.jobs().is_empty() && session.overview().fits.is_empty());

    // One whose worker died: the fault says so, and the session has no job left.
    let carried = job(&mut session, &request).unwrap();
    let died = Finished::without(carried.id, Fault::defect("its worker is gone"));
    assert_eq!(session.finish(died).unwrap_err().code, 104);
    assert!(session.jobs().is_empty());
}

//! Session files of the studio: read or refused with words; what is read is shown, and written as
//! commands.

use hysteron_studio::{Request, Session, Take};

/// What the files of a session may take.
const BUDGET: u64 = 32 << 20;

pub fn read(data: &[u8]) {
    let mut session = match Session::from_file(data, BUDGET) {
        Ok(session) => session,
        Err(fault) => return assert!(!fault.problem.trim().is_empty()),
    };
    let fits: Vec<_> = session.overview().fits.iter().map(|fit| fit.id).collect();
    for fit in fits {
        for take in [
            Take::Command { fit },
            Take::Python { fit },
            Take::Rust { fit },
        ] {
            let taken = session.handle(Request::Take(take));
            assert!(taken.is_ok(), "{:?}", taken.err());
        }
        if let Err(fault) = session.handle(Request::Drive { fit }) {
            assert!(!fault.problem.trim().is_empty());
        }
    }
}

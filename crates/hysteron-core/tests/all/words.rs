//! Numbers and names in files and scripts. A change of one of them changes a format.

use hysteron_core::{Outcome, Status};

#[test]
fn statuses() {
    let all = [
        (Status::Ok, 0, "ok"),
        (Status::Low, -1, "low"),
        (Status::High, 1, "high"),
        (Status::Passed, 2, "passed"),
    ];
    for (status, number, name) in all {
        assert_eq!((status.number(), status.name()), (number, name));
        assert_eq!(status.is_out_of_reach(), number.abs() == 1, "{name}");
        // The sign turns the ends of the range into each other, and nothing else.
        let mirrored = status.mirrored();
        let end = if status.is_out_of_reach() { -1 } else { 1 };
        assert_eq!(mirrored.number(), end * number, "{name}");
    }
}

#[test]
fn outcomes() {
    let names = Outcome::ALL.map(Outcome::name);
    assert_eq!(
        names,
        [
            "learned",
            "waiting",
            "at-rest",
            "frozen",
            "rolled-back",
            "rejected",
            "output-stuck",
            "input-stuck"
        ]
    );
}

//! Columns of times: whatever stands in them, they are seconds that go on, or refused with words.

use crate::worded;
use hysteron::{Columns, Recording, Repair, TableReader, preview_table};

/// Takes each line as a cell of a column of time.
pub fn read(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let cells = text.lines().take(200).map(|line| line.replace([';', '"'], " "));
    let rows = cells.enumerate().map(|(n, cell)| format!("{cell};{};{}\n", n % 7, n % 5));
    let table = format!("t;x;y\n{}", rows.collect::<String>());
    let columns = Columns {
        time: Some("t"),
        ..Columns::new("x", "y")
    };
    for repair in [Repair::Refuse, Repair::Mend] {
        let memory = hysteron::Memory::new(64 << 20);
        let bytes = table.clone().into_bytes();
        match Recording::segments_within("t.csv", bytes, columns, repair, &memory) {
            Err(error) => worded(&error),
            Ok((segments, _)) => {
                for segment in segments {
                    segment.recording.check().expect("a recording that was read can be used");
                }
            }
        }
    }
    match TableReader::from_bytes("t.csv", table, 64 << 20).and_then(|mut t| preview_table(&mut t)) {
        Err(error) => worded(&error),
        Ok(preview) => assert_ne!(preview.roles.output.as_deref(), Some("t")),
    }
}

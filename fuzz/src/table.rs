//! Files with tables: whatever their bytes, they are read or refused with words, within the memory
//! they may take.

use crate::worded;
use hysteron::{Columns, ReadOptions, Recording, Repair, Result, TableReader, inspect_table};
use std::path::{Path, PathBuf};
use std::sync::Once;

/// What a file's contents may take. `fuzz/run` counts a single allocation of twice as much as a
/// fault.
const BUDGET: u64 = 64 << 20;

/// Reads `data` as a file of this ending: row by row, summed up, and as a recording.
pub fn read(data: &[u8], ending: &str) {
    // The readers catch what panics below them, in the libraries for Parquet and HDF5. libFuzzer
    // would end at the panic; so it ends at those that nobody catches.
    static QUIET: Once = Once::new();
    QUIET.call_once(|| std::panic::set_hook(Box::new(|_| ())));
    let path = file(ending);
    std::fs::write(&path, data).expect("the folder for temporary files can be written");
    let names = told(header_of_all_rows(&path)).unwrap_or_default();
    told(TableReader::open_with(&path, BUDGET).and_then(|mut table| inspect_table(&mut table)));
    if let [input, .., output] = &names[..] {
        for repair in [Repair::Refuse, Repair::Mend] {
            let max_memory = BUDGET;
            let options = ReadOptions { repair, max_memory };
            let columns = Columns::new(input, output);
            let time = names.get(1).map(String::as_str);
            told(Recording::read(&path, columns, options));
            let timed = Columns { time, ..columns };
            told(Recording::read_with_others(&path, timed, options));
        }
    }
}

fn told<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(worded).ok()
}

/// The names of the columns, once every row has been read.
fn header_of_all_rows(path: &Path) -> Result<Vec<String>> {
    let mut table = TableReader::open_with(path, BUDGET)?;
    let header = table.header().to_vec();
    while table.advance()? {
        for column in table.columns() {
            assert!(table.value(column).is_none_or(f64::is_finite));
        }
    }
    Ok(header)
}

/// One file for each process.
fn file(ending: &str) -> PathBuf {
    let name = format!("hysteron-fuzz-{}.{ending}", std::process::id());
    std::env::temp_dir().join(name)
}

//! Files that claim what they do not hold: no reader takes more memory than it may.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use hysteron::{Columns, ReadOptions, Recording, Repair};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Counts the memory that a thread holds. Beyond `MOST` it gives none, as a system would.
struct Counting;

const MOST: usize = 1 << 30;

thread_local! {
    static HELD: Cell<usize> = const { Cell::new(0) };
    static PEAK: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: the system's allocator, with counters beside it that do not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.get().saturating_add(layout.size());
        if held > MOST {
            return std::ptr::null_mut();
        }
        HELD.set(held);
        PEAK.set(PEAK.get().max(held));
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        HELD.set(HELD.get().saturating_sub(layout.size()));
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a read may take here, and what it may need beside it for buffers of fixed size.
const BUDGET: u64 = 16 << 20;
const BUFFERS: usize = 10 << 20;

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    folder.join(name)
}

/// Reads a file and tells what was said; it took no more memory than it may.
fn read(path: &Path, [input, output]: [&str; 2], case: &str) -> Result<(), String> {
    let options = ReadOptions {
        max_memory: BUDGET,
        repair: Repair::Mend,
    };
    let before = HELD.get();
    PEAK.set(before);
    let read = Recording::read(path, Columns::new(input, output), options);
    let taken = PEAK.get() - before;
    assert!(taken <= BUDGET as usize + BUFFERS, "{case}: {taken} bytes");
    read.map(|_| ()).map_err(|error| error.to_string())
}

/// A file with sizes in it changed: bytes, numbers of either order, numbers as Parquet writes them.
fn mutated(whole: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..random.random_range(1..4) {
        let at = random.random_range(0..bytes.len());
        let large = 1_u64 << random.random_range(0..64);
        let patch: Vec<u8> = match random.random_range(0..5) {
            0 => vec![random.random::<u32>() as u8],
            1 => large.to_le_bytes()[..4].to_vec(),
            2 => large.to_be_bytes()[4..].to_vec(),
            3 => large.wrapping_sub(1).to_le_bytes().to_vec(),
            // A varint, in place or pushing the rest away.
            _ => vec![0xff, 0xff, 0xff, 0xff, 0x07],
        };
        let end = (at + patch.len()).min(bytes.len());
        match random.random_range(0..8) {
            0 => drop(bytes.splice(at..at, patch)),
            _ => bytes[at..end].copy_from_slice(&patch[..end - at]),
        }
    }
    bytes
}

#[test]
fn changed_sizes_take_no_more_memory_than_allowed() {
    const CASES: usize = 2500;
    let folder = tempfile::tempdir().unwrap();
    let names = [
        "v5.mat",
        "v7.mat",
        "v73.mat",
        "structure-v5.mat",
        "structure-v73.mat",
        "claims-chunked.mat",
        "none.parquet",
        "snappy.parquet",
        "gzip.parquet",
        "zstd.parquet",
        "lz4.parquet",
        "none.arrow",
        "zstd.arrow",
        "lz4.arrow",
        "stream.arrows",
        "kinds.arrow",
    ];
    // The library panics on some; those are caught, and need no words.
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map_or("", |place| place.file());
        if !place.contains("registry") {
            eprintln!("{panic}");
        }
    }));
    for (n, name) in names.iter().enumerate() {
        let whole = fs::read(fixture(name)).unwrap();
        let path = folder.path().join(name);
        let mut random = ChaCha8Rng::seed_from_u64(n as u64);
        for case in 0..CASES {
            fs::write(&path, mutated(&whole, &mut random)).unwrap();
            let _ = read(&path, ["x", "t"], &format!("{name}, case {case}"));
        }
    }
}

#[test]
fn small_files_with_large_claims_are_refused() {
    for name in ["claims-contiguous.mat", "claims-chunked.mat"] {
        let said = read(&fixture(name), ["x", "y"], name).unwrap_err();
        assert!(
            said.contains("TiB of memory and") && said.contains("option `max memory`"),
            "{said}"
        );
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bomb.mat");
    // 300 MB of zeros in 300 KB, as a compressed variable.
    let mut bytes = fs::read(fixture("v7.mat")).unwrap()[..128].to_vec();
    let size = 300 << 20;
    let mut variable = 14_u32.to_le_bytes().to_vec();
    variable.extend((size as u32).to_le_bytes());
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    packer.write_all(&variable).unwrap();
    for _ in 0..size >> 20 {
        packer.write_all(&vec![0; 1 << 20]).unwrap();
    }
    let body = packer.finish().unwrap();
    bytes.extend(15_u32.to_le_bytes());
    bytes.extend((body.len() as u32).to_le_bytes());
    bytes.extend(body);
    fs::write(&path, bytes).unwrap();
    let said = read(&path, ["x", "y"], "bomb.mat").unwrap_err();
    assert!(
        said.contains("a compressed variable needs 300.0 MiB"),
        "{said}"
    );
}

#[test]
fn a_long_text_is_refused_where_it_would_not_fit() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let rows = "1.5,2.5\n".repeat(1 << 20);
    fs::write(file.path(), format!("x,y\n{rows}")).unwrap();
    let said = read(file.path(), ["x", "y"], "rows").unwrap_err();
    assert!(
        said.contains("the recording needs") && said.contains("option `max memory`"),
        "{said}"
    );
    fs::write(
        file.path(),
        "x,y\n1.5,2.5\n".to_owned() + &"2,3\n".repeat(1 << 16),
    )
    .unwrap();
    read(file.path(), ["x", "y"], "rows").unwrap();
}

//! The header in the repository is the one generated from the code.
#![allow(clippy::unwrap_used)]

#[path = "../examples/header.rs"]
mod header;

#[test]
fn the_header_follows_from_the_code() {
    let found = std::fs::read_to_string(header::place()).unwrap();
    assert!(
        found == header::generated().unwrap(),
        "the header differs: run `cargo run -p hysteron-capi --example header`"
    );
}

/// The header declares every function.
#[test]
fn every_exported_function_is_in_the_header() {
    let header = header::generated().unwrap();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut count = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.is_dir() {
            continue; // `fmi`, whose headers are the standards'
        }
        let text = std::fs::read_to_string(path).unwrap();
        for part in text.split("extern \"C\" fn ").skip(1) {
            let name = part.split('(').next().unwrap();
            assert!(header.contains(&format!("{name}(")), "{name}");
            count += 1;
        }
    }
    assert!(count > 40, "{count} functions found");
}

//! The program on the host: `tables` writes models and runs for C, `check` checks results, `report`
//! writes the page.

mod check;
#[path = "../../data.rs"]
mod data;
mod report;
#[path = "../../staged.rs"]
#[allow(dead_code)]
mod staged;
mod tables;

use std::path::Path;

const USAGE: &str = "usage: host tables VECTORS DIR
       host check VECTORS DIGITS [plain]
       host report VECTORS PAGE MEASURES";

fn main() -> Result<(), String> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let [what, vectors, rest @ ..] = &args[..] else {
        return Err(USAGE.into());
    };
    let data = data::all(Path::new(vectors));
    let staged = staged::all(Path::new(vectors));
    match (*what, rest) {
        ("tables", [folder]) => {
            tables::write(&data, Path::new(folder))?;
            tables::write_staged(&staged, Path::new(folder))
        }
        ("check", [digits]) => check::digits(&data, Some(&staged.1), &read(digits)?),
        ("check", [digits, "plain"]) => check::digits(&data, None, &read(digits)?),
        ("report", [page, measures]) => {
            print!(
                "{}",
                report::page(&data, &staged.1, &read(page)?, &read(measures)?)?
            );
            Ok(())
        }
        _ => Err(USAGE.into()),
    }
}

fn read(path: &str) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|why| format!("{path}: {why}"))
}

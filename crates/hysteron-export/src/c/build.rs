//! What builds the C of a model: a file for make and one for CMake.

use super::seal::{self, Comment};
use super::written::CExport;
use std::path::Path;

const MAKE: &str = include_str!("../../mcu/build.mk");
const CMAKE: &str = include_str!("../../mcu/build.cmake");

/// Their names and texts. Both list the files of this model alone: others may lie beside them, and
/// so may a program.
pub(super) fn files(export: &CExport) -> [(String, String); 2] {
    let name = &export.name;
    let sources = export.files.iter().filter_map(|file| stem(file));
    let (mut objects, mut lines) = (Vec::new(), String::new());
    for stem in sources {
        objects.push(format!("{stem}.o"));
        lines += &format!("    \"${{CMAKE_CURRENT_LIST_DIR}}/{stem}.c\"\n");
    }
    let filled = |text: &str| {
        let text = text.replace("@objects@", &objects.join(" "));
        let text = text.replace("@sources@", lines.trim_end());
        seal::sealed(&text.replace("@name@", name), Comment::Line)
    };
    [
        (format!("{name}.mk"), filled(MAKE)),
        (format!("{name}.cmake"), filled(CMAKE)),
    ]
}

/// The name of a C source without its ending.
fn stem(file: &Path) -> Option<&str> {
    file.file_name()?.to_str()?.strip_suffix(".c")
}

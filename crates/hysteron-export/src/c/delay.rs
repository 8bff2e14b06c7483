//! The dead time of a model on the target.

use super::text::Beside;

/// What is written for a dead time of so many samples.
pub(super) fn text(name: &str, late: usize) -> Beside {
    let shout = name.to_uppercase();
    Beside {
        include: Some("hysteron_mcu_delay.h"),
        sizes: format!("#define {shout}_LATE {late}\n"),
        declared: String::new(),
        defined: String::new(),
    }
}

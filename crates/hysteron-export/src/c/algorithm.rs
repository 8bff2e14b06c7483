//! The C of the algorithm, which is the same for every model of a number type.

/// Names and texts of the algorithm's files, the first with the number type.
pub(super) const ALGORITHM: [(&str, &str); 4] = [
    ("hysteron_mcu.h", HEADER),
    ("hysteron_mcu.c", include_str!("../../mcu/hysteron_mcu.c")),
    (
        "hysteron_mcu_inverse.c",
        include_str!("../../mcu/hysteron_mcu_inverse.c"),
    ),
    (
        "hysteron_mcu_internal.h",
        include_str!("../../mcu/hysteron_mcu_internal.h"),
    ),
];

const HEADER: &str = include_str!("../../mcu/hysteron_mcu.h");

/// The same for models that learn.
pub(super) const ADAPTATION: [(&str, &str); 5] = [
    (
        "hysteron_mcu_adapt.h",
        include_str!("../../mcu/hysteron_mcu_adapt.h"),
    ),
    (
        "hysteron_mcu_adapt.c",
        include_str!("../../mcu/hysteron_mcu_adapt.c"),
    ),
    (
        "hysteron_mcu_guards.h",
        include_str!("../../mcu/hysteron_mcu_guards.h"),
    ),
    (
        "hysteron_mcu_increments.h",
        include_str!("../../mcu/hysteron_mcu_increments.h"),
    ),
    (
        "hysteron_mcu_least_squares.h",
        include_str!("../../mcu/hysteron_mcu_least_squares.h"),
    ),
];

/// The same for a model with a dead time.
pub(super) const DELAY: [(&str, &str); 2] = [
    (
        "hysteron_mcu_delay.h",
        include_str!("../../mcu/hysteron_mcu_delay.h"),
    ),
    (
        "hysteron_mcu_delay.c",
        include_str!("../../mcu/hysteron_mcu_delay.c"),
    ),
];

/// The same for a control loop.
pub(super) const CONTROL: [(&str, &str); 2] = [
    (
        "hysteron_mcu_control.h",
        include_str!("../../mcu/hysteron_mcu_control.h"),
    ),
    (
        "hysteron_mcu_control.c",
        include_str!("../../mcu/hysteron_mcu_control.c"),
    ),
];

/// The same for a control loop with a gate.
pub(super) const GATE: [(&str, &str); 1] = [(
    "hysteron_mcu_gate.c",
    include_str!("../../mcu/hysteron_mcu_gate.c"),
)];

/// The same for one with a filter.
pub(super) const FILTER: [(&str, &str); 1] = [(
    "hysteron_mcu_filter.h",
    include_str!("../../mcu/hysteron_mcu_filter.h"),
)];

/// The exponential that a filter and a clock need.
pub(super) const DECAY: [(&str, &str); 2] = [
    (
        "hysteron_mcu_decay.h",
        include_str!("../../mcu/hysteron_mcu_decay.h"),
    ),
    (
        "hysteron_mcu_decay.c",
        include_str!("../../mcu/hysteron_mcu_decay.c"),
    ),
];

/// The same for a control loop around a model with stages, whose time is measured.
pub(super) const CLOCK: [(&str, &str); 2] = [
    (
        "hysteron_mcu_clock.h",
        include_str!("../../mcu/hysteron_mcu_clock.h"),
    ),
    (
        "hysteron_mcu_clock.c",
        include_str!("../../mcu/hysteron_mcu_clock.c"),
    ),
];

/// The same for a control loop whose model learns.
pub(super) const SHADOW: [(&str, &str); 2] = [
    (
        "hysteron_mcu_shadow.h",
        include_str!("../../mcu/hysteron_mcu_shadow.h"),
    ),
    (
        "hysteron_mcu_shadow.c",
        include_str!("../../mcu/hysteron_mcu_shadow.c"),
    ),
];

/// The same for a control loop around a model with stages.
pub(super) const CONTROL_STAGES: [(&str, &str); 1] = [(
    "hysteron_mcu_control_stages.c",
    include_str!("../../mcu/hysteron_mcu_control_stages.c"),
)];

/// The same for models with stages.
pub(super) const STAGES: [(&str, &str); 6] = [
    (
        "hysteron_mcu_stages.h",
        include_str!("../../mcu/hysteron_mcu_stages.h"),
    ),
    (
        "hysteron_mcu_stages.c",
        include_str!("../../mcu/hysteron_mcu_stages.c"),
    ),
    (
        "hysteron_mcu_stages_inverse.c",
        include_str!("../../mcu/hysteron_mcu_stages_inverse.c"),
    ),
    (
        "hysteron_mcu_behind.h",
        include_str!("../../mcu/hysteron_mcu_behind.h"),
    ),
    (
        "hysteron_mcu_stages_internal.h",
        include_str!("../../mcu/hysteron_mcu_stages_internal.h"),
    ),
    (
        "hysteron_mcu_latent.h",
        include_str!("../../mcu/hysteron_mcu_latent.h"),
    ),
];

/// Stages that the code may go without, by their bits in `HYS_STAGES`.
const BITS: [&str; 8] = [
    "curve",
    "creep",
    "lag",
    "ring",
    "load",
    "registration",
    "spacing",
    "latent",
];

/// The header of a program whose model learns: its tables are in RAM, on an AVR too. A library for
/// Arduino cannot set a flag.
pub(super) fn with_tables_in_ram(text: &str) -> String {
    const LAYOUT: &str = "/* Tables are the most of a model.";
    let define = "#ifndef HYS_TABLES_IN_RAM\n#define HYS_TABLES_IN_RAM\n#endif\n\n";
    text.replacen(LAYOUT, &format!("{define}{LAYOUT}"), 1)
}

/// A text of the algorithm with the code of these stages alone.
pub(super) fn with_stages(text: &str, stages: &[&str]) -> String {
    let all = (1 << BITS.len()) - 1;
    let bits = BITS.iter().enumerate();
    let there = bits.filter(|(_, stage)| stages.contains(stage));
    let mask: u32 = there.map(|(bit, _)| 1 << bit).sum();
    let line = |mask: u32| format!("#define HYS_STAGES {mask}u");
    text.replace(&line(all), &line(mask))
}

/// A text of the algorithm with these parts of a control loop alone, a bit for each.
pub(super) fn with_parts(text: &str, parts: u8) -> String {
    text.replace(ALL_PARTS, &format!("#define HYS_LOOP {parts}u"))
}

const ALL_PARTS: &str = "#define HYS_LOOP 7u";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_the_parts_is_found() {
        let (_, header) = CONTROL[0];
        assert!(with_parts(header, 2).contains("#define HYS_LOOP 2u\n"));
    }

    #[test]
    fn the_place_for_tables_in_ram_is_found() {
        let text = with_tables_in_ram(HEADER);
        let at = |what: &str| text.find(what);
        let defined = at("#define HYS_TABLES_IN_RAM");
        assert!(defined.is_some() && defined < at("#if defined(__AVR__)"));
    }

    #[test]
    fn the_line_of_the_stages_is_found() {
        let (_, header) = STAGES[0];
        let text = with_stages(header, &["body", "lag"]);
        assert!(text.contains("#define HYS_STAGES 4u\n"), "{text}");
    }
}

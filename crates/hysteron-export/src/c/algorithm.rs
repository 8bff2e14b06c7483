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

/// The same for models with stages.
pub(super) const STAGES: [(&str, &str); 5] = [
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
];

//! What a column measures, by its name and its unit, and what its values do.

/// What the values of a column do.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::data) struct Series {
    /// Whether there are two different numbers.
    pub(in crate::data) moves: bool,
    /// Whether hardly any number is below the one before.
    pub(in crate::data) rises: bool,
    /// Whether hardly any number is above the one before: a log with its newest row first.
    pub(in crate::data) falls: bool,
    /// Whether nearly each number is above the one before, by as much: a clock or a counter.
    pub(in crate::data) rises_evenly: bool,
    /// Whether its cells are timestamps.
    pub(in crate::data) stamps: bool,
    /// Whether it changes by enough for a load.
    pub(in crate::data) changes: bool,
}

/// What a column measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Quantity {
    Time,
    /// The number of a row or of a cycle.
    Counter,
    /// Says something about another column, or about the room.
    About,
    Drive,
    /// A number in percent, of whatever.
    Share,
    Temperature,
    Voltage,
    Current,
    Power,
    Field,
    Pressure,
    Response,
    Displacement,
    Strain,
    Angle,
    Polarization,
    Flux,
    Resistance,
    Load,
    Force,
    Stress,
    /// `x` of a plot, and its `y`.
    X,
    Y,
    Unknown,
}

impl Quantity {
    /// How well it fits input, output and load. What says its role comes first, then what nearly
    /// always has it, then what may have it.
    pub(super) fn scores(self) -> [i32; 3] {
        match self {
            Self::Time | Self::Counter | Self::About => [0, 0, 0],
            Self::Drive => [40, 0, 0],
            Self::Temperature | Self::Voltage | Self::Field => [30, 0, 0],
            Self::Share => [26, 0, 0],
            Self::Current | Self::Power | Self::Pressure => [20, 0, 0],
            Self::Response => [0, 40, 0],
            Self::Displacement | Self::Strain | Self::Angle => [0, 30, 0],
            Self::Polarization | Self::Flux => [0, 30, 0],
            Self::Resistance => [0, 15, 0],
            Self::Load => [0, 5, 40],
            Self::Force => [0, 15, 31],
            Self::Stress => [0, 15, 30],
            Self::X => [25, 5, 0],
            Self::Y => [5, 25, 0],
            Self::Unknown => [10, 10, 0],
        }
    }

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Time => "a time",
            Self::Counter => "a counter",
            Self::About => "about another column",
            Self::Drive => "a drive",
            Self::Share => "a share",
            Self::Temperature => "a temperature",
            Self::Voltage => "a voltage",
            Self::Current => "a current",
            Self::Power => "a power",
            Self::Field => "a field",
            Self::Pressure => "a pressure",
            Self::Response => "an output",
            Self::Displacement => "a displacement",
            Self::Strain => "a strain",
            Self::Angle => "an angle",
            Self::Polarization => "a polarization",
            Self::Flux => "a flux or a magnetization",
            Self::Resistance => "a resistance",
            Self::Load => "a load",
            Self::Force => "a force",
            Self::Stress => "a stress",
            Self::X => "the first axis of a plot",
            Self::Y => "the second axis of a plot",
            Self::Unknown => "of an unknown quantity",
        }
    }
}

//! Arguments of `hysteron export`.

use super::common::{Force, Json};
use super::value::{parse_gains, parse_limits};
use clap::{Args, Subcommand, ValueEnum};
use hysteron::control::Gains;
use std::path::PathBuf;

#[derive(Subcommand)]
pub(crate) enum Export {
    /// Portable C99 with the model as constants, for a microcontroller
    #[command(after_help = "Examples:\n\
        \x20 hysteron export c spring.json -o mcu --real float\n\
        \x20 hysteron export c wire.json -o mcu --dt 0.01 --drive-range 0,100\n\
        \x20 hysteron export c wire.json -o mcu --dt 0.01 --controller")]
    C(ExportC),
    /// A library with two sketches for the Arduino IDE and PlatformIO
    #[command(after_help = "Examples:\n\
        \x20 hysteron export arduino wire.json -o ~/Arduino/libraries/wire\n\
        \x20 hysteron export arduino wire.json -o wire --board mega --dt 0.02\n\
        \x20 hysteron export arduino piezo.json -o piezo --board mega --adaptation")]
    Arduino(ExportArduino),
    /// A block for Simulink, Dymola and other tools (FMI, co-simulation)
    #[command(after_help = "Examples:\n\
        \x20 hysteron export fmu spring.json -o sf_MKP.fmu\n\
        \x20 hysteron export fmu spring.json --inverse -o sf_Inverse_MKP.fmu\n\
        \x20 hysteron export fmu spring.json --fmi 3 --name spring -o spring.fmu")]
    Fmu(ExportFmu),
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum CReal {
    /// Single precision, for processors that compute in it
    Float,
    /// Double precision: the digits of `simulate` and `invert`
    Double,
}

impl From<CReal> for hysteron_export::CReal {
    fn from(real: CReal) -> Self {
        match real {
            CReal::Float => Self::Float,
            CReal::Double => Self::Double,
        }
    }
}

#[derive(Args)]
pub(crate) struct ExportC {
    /// The model
    pub(crate) model: PathBuf,
    /// Folder for the files: the algorithm (hysteron_mcu…), the model's, and what builds them
    #[arg(short, long = "output", value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Name of the model in C, and of its files [default: that of the model's file]
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// The number type to compute in
    #[arg(long, value_enum, default_value_t = CReal::Float)]
    pub(crate) real: CReal,
    /// Also write the code with which the weights adapt on the target
    #[arg(long)]
    pub(crate) adaptation: bool,
    /// Also write a control loop around the model: its inverse and a PID
    #[arg(long, requires = "dt")]
    pub(crate) controller: bool,
    /// Gains of the PID: gain, integral time and derivative time in s [default: from the model, by
    /// simulation]
    #[arg(long, value_name = "GAIN,S,S", value_parser = parse_gains, allow_hyphen_values = true,
        requires = "controller")]
    pub(crate) gains: Option<Gains>,
    /// A gate against spikes in its readings: what deviates by less than this is never one, in the
    /// output's unit
    #[arg(
        long,
        value_name = "SIZE",
        allow_hyphen_values = true,
        requires = "controller"
    )]
    pub(crate) gate: Option<f64>,
    /// The time constant of a low-pass filter on its readings
    #[arg(
        long,
        value_name = "SECONDS",
        allow_hyphen_values = true,
        requires = "controller"
    )]
    pub(crate) filter: Option<f64>,
    /// Also write what takes the measured time of each sample
    #[arg(long, requires = "controller")]
    pub(crate) measured_dt: bool,
    /// The sample time on the target, for a model that depends on time, and for a controller
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub(crate) dt: Option<f64>,
    /// Lowest and highest drive of the inverse, for a model with stages [default: for a thermal
    /// body the drives it was fitted with, otherwise no limits]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_limits, allow_hyphen_values = true)]
    pub(crate) drive_range: Option<(f64, f64)>,
    /// Take the model at this load; without it the load is an argument on the target
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    pub(crate) load: Option<f64>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct ExportArduino {
    /// The model
    pub(crate) model: PathBuf,
    /// Folder of the library
    #[arg(short, long = "output", value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Name of the library, and of the model in C [default: that of the model's file]
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// The board that it has to fit
    #[arg(long, value_enum, default_value_t = Board::Uno)]
    pub(crate) board: Board,
    /// Also write the code with which the weights adapt on the board
    #[arg(long)]
    pub(crate) adaptation: bool,
    /// The sample time on the board
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 0.05,
        allow_hyphen_values = true
    )]
    pub(crate) dt: f64,
    /// Gains of the PID: gain, integral time and derivative time in s [default: from the model, by
    /// simulation]
    #[arg(long, value_name = "GAIN,S,S", value_parser = parse_gains, allow_hyphen_values = true)]
    pub(crate) gains: Option<Gains>,
    /// Lowest and highest drive [default: for a thermal body those that it was fitted with, up to 0
    /// and 1; otherwise 0 and 1]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_limits, allow_hyphen_values = true)]
    pub(crate) drive_range: Option<(f64, f64)>,
    /// Take the model at this load
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    pub(crate) load: Option<f64>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Board {
    /// ATmega328P: Uno, Nano, Pro Mini
    Uno,
    /// ATmega2560: Mega
    Mega,
    /// More memory than any model needs, such as a board of 32 bits
    Large,
}

impl From<Board> for hysteron_export::Board {
    fn from(board: Board) -> Self {
        match board {
            Board::Uno => Self::Uno,
            Board::Mega => Self::Mega,
            Board::Large => Self::Large,
        }
    }
}

#[derive(Args)]
pub(crate) struct ExportFmu {
    /// The model
    pub(crate) model: PathBuf,
    /// The file, which ends with .fmu
    #[arg(short, long = "output", value_name = "FMU")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// The inverse instead of the model: from the wanted output to the input
    #[arg(long)]
    pub(crate) inverse: bool,
    /// A controller instead of the model: from the wanted and the measured output to the drive
    #[arg(long, requires = "dt", conflicts_with = "inverse")]
    pub(crate) controller: bool,
    /// Gains of its PID: gain, integral time and derivative time in s [default: from the model, by
    /// simulation]
    #[arg(long, value_name = "GAIN,S,S", value_parser = parse_gains, allow_hyphen_values = true,
        requires = "controller")]
    pub(crate) gains: Option<Gains>,
    /// A gate against spikes in its readings: what deviates by less than this is never one, in the
    /// output's unit
    #[arg(
        long,
        value_name = "SIZE",
        allow_hyphen_values = true,
        requires = "controller"
    )]
    pub(crate) gate: Option<f64>,
    /// The time constant of a low-pass filter on its readings
    #[arg(
        long,
        value_name = "SECONDS",
        allow_hyphen_values = true,
        requires = "controller"
    )]
    pub(crate) filter: Option<f64>,
    /// Its sample time, which the communication step has to be
    #[arg(
        long,
        value_name = "SECONDS",
        allow_hyphen_values = true,
        requires = "controller"
    )]
    pub(crate) dt: Option<f64>,
    /// Its lowest and highest drive [default: those that the model was fitted with]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_limits, allow_hyphen_values = true,
        requires = "controller")]
    pub(crate) drive_range: Option<(f64, f64)>,
    /// The standard: FMI 2.0 or 3.0
    #[arg(long, value_enum, default_value = "2")]
    pub(crate) fmi: Fmi,
    /// Name of the block, a C identifier [default: sf_MKP, with --inverse
    /// sf_Inverse_MKP, with --controller sf_Controller_MKP]
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// Take the model at this load; without it the load is an input of the block
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    pub(crate) load: Option<f64>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum Fmi {
    /// What most tools import
    #[value(name = "2")]
    V2,
    /// For tools that prefer it
    #[value(name = "3")]
    V3,
}

impl From<Fmi> for hysteron_export::Fmi {
    fn from(fmi: Fmi) -> Self {
        match fmi {
            Fmi::V2 => Self::V2,
            Fmi::V3 => Self::V3,
        }
    }
}

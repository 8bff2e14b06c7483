//! What a model and its controller need of a board's memory, by arithmetic.

use crate::c::CExport;

/// A board that a library has to fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Board {
    /// ATmega328P: Uno, Nano, Pro Mini.
    #[default]
    Uno,
    /// ATmega2560: Mega.
    Mega,
    /// Boards with so much memory that every model fits, such as those with 32 bits.
    Large,
}

/// Bytes of code of the sketch `standalone` on an AVR, without the model's constants: measured with
/// avr-gcc 5.4 as the Arduino IDE calls it, and rounded up. Without stages, and with a body; then
/// what each other stage adds. `firmware/boards/run` measures it again.
const CODE: [usize; 2] = [22_500, 27_600];
const MORE: [(&str, usize); 7] = [
    ("curve", 800),
    ("creep", 1300),
    ("lag", 600),
    ("ring", 2700),
    ("load", 1400),
    ("registration", 2500),
    ("spacing", 1000),
];

/// Bytes of RAM of the same sketch without the model: Arduino's core, its serial line, the sketch's
/// own.
const OWN: usize = 250;

/// Bytes for the stack, without stages and with them: a little more than was measured.
const STACK: [usize; 2] = [350, 520];

/// Bytes of the largest array that avr-gcc compiles.
const LARGEST_ARRAY: usize = 32_767;

impl Board {
    /// Bytes of flash that a sketch may have: those of the chip without its boot loader. `None`
    /// where every model fits.
    #[must_use]
    pub fn flash(self) -> Option<usize> {
        match self {
            Self::Uno => Some(32_256),
            Self::Mega => Some(253_952),
            Self::Large => None,
        }
    }

    /// Bytes of RAM.
    #[must_use]
    pub fn ram(self) -> Option<usize> {
        match self {
            Self::Uno => Some(2048),
            Self::Mega => Some(8192),
            Self::Large => None,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uno => "ATmega328P (Uno, Nano)",
            Self::Mega => "ATmega2560 (Mega)",
            Self::Large => "large board",
        }
    }
}

/// What the sketch `standalone` needs on an AVR, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoardMemory {
    /// The model's constants: flash.
    pub model_flash: usize,
    /// The model's constants but for the tables, its states, and the controller: RAM.
    pub model_ram: usize,
    /// All flash: at most.
    pub flash: usize,
    /// All RAM: at most, with the stack.
    pub ram: usize,
    /// Whether a second state follows the drive and says what to expect.
    pub follows: bool,
}

impl BoardMemory {
    /// What a model needs, with a second state where it fits the board; an error in words where it
    /// does not fit with one.
    pub(super) fn of(export: &CExport, board: Board) -> Result<Self, String> {
        let avr = export.avr;
        if board != Board::Large && avr.table > LARGEST_ARRAY {
            return Err(format!(
                "K = {} needs a table of {} bytes, and no array on the {} has more than \
                 {LARGEST_ARRAY}",
                export.levels,
                avr.table,
                board.name()
            ));
        }
        let need = |follows: bool| {
            let states = (1 + usize::from(follows)) * (avr.state + avr.turns);
            let model_ram = avr.constants - avr.table + states + avr.controller.unwrap_or(0);
            let staged = usize::from(!export.stages.is_empty());
            let more = MORE
                .iter()
                .filter(|(stage, _)| export.stages.contains(stage));
            let code = CODE[staged] + more.map(|(_, bytes)| bytes).sum::<usize>();
            Self {
                model_flash: avr.constants,
                model_ram,
                flash: avr.constants + code,
                ram: model_ram + OWN + STACK[staged],
                follows,
            }
        };
        let fits = |memory: &Self| {
            board.flash().is_none_or(|most| memory.flash <= most)
                && board.ram().is_none_or(|most| memory.ram <= most)
        };
        let (both, one) = (need(true), need(false));
        let (flash, ram) = (board.flash().unwrap_or(0), board.ram().unwrap_or(0));
        [both, one].into_iter().find(fits).ok_or_else(|| {
            format!(
                "K = {} needs {} bytes of flash and {} of RAM, and the {} has {flash} and {ram}",
                export.levels,
                one.flash,
                one.ram,
                board.name()
            )
        })
    }
}

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

/// Bytes of code of the sketch `standalone` on an ATmega328P, without the model's constants: without
/// stages, and with any. Measured with avr-gcc 5.4 as the Arduino IDE calls it, of all combinations of
/// stages, with a start that was fitted and without; these are bounds of what was measured.
/// `firmware/avr/run` measures some of them again.
const CODE: usize = 23_050;
const CODE_STAGES: usize = 28_330;

/// What stages add to it, alone and together: some of them inline others. The body is in any.
const MORE: [(&[&str], usize); 10] = [
    (&["latent"], 3220),
    (&["curve"], 810),
    (&["creep"], 1170),
    (&["lag"], 480),
    (&["ring"], 2680),
    (&["registration"], 2420),
    (&["spacing"], 860),
    (&["latent", "registration"], 240),
    (&["latent", "spacing"], 800),
    (&["ring", "registration"], 340),
];

/// What it has more on an ATmega2560: four serial lines, and longer addresses.
const CODE_MEGA: usize = 2520;

/// What a learner adds: code, constants in RAM beside the weights (the options of *increments*), RAM
/// of what chooses between it and the fixed model, and stack.
const LEARNER: [usize; 4] = [21_800, 52, 16, 50];

/// Bytes of RAM of the same sketch without the model: Arduino's core, its serial line, the sketch's
/// own. A Mega's has four serial lines.
const OWN: usize = 250;
const OWN_MEGA: usize = 760;

/// Bytes for the stack, not less than was measured: without stages, with them, what others add to heat
/// that is bound, and with those that only a Mega has room for.
const STACK: usize = 350;
const STACK_STAGES: usize = 520;
const STACK_LATENT: usize = 10;
const STACK_MEGA: usize = 640;

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
    /// The model's constants but for the tables, its states, and the controller: RAM. With a learner
    /// also that and the tables.
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
            // Of all learners' constants the linker keeps those of one.
            let [learner_code, options, shadow, learner_stack] = match avr.adaptation {
                Some(_) => LEARNER,
                None => [0; 4],
            };
            let constants = avr.constants - avr.learners + options;
            let learner = avr.adaptation.map_or(0, |bytes| {
                bytes + avr.state + avr.turns + avr.table + shadow
            });
            let has = |stages: &[&str]| stages.iter().all(|stage| export.stages.contains(stage));
            let others = usize::from(has(&["latent"]) && export.stages.len() > 2);
            let (own, own_code, staged_stack) = match board {
                Board::Mega => (OWN_MEGA, CODE_MEGA, STACK_MEGA),
                Board::Uno | Board::Large => (OWN, 0, STACK_STAGES + others * STACK_LATENT),
            };
            let controller = avr.controller.unwrap_or(0);
            let model_ram = constants - avr.table + states + controller + learner;
            let (code, stack) = match export.stages.is_empty() {
                true => (CODE, STACK),
                false => (CODE_STAGES, staged_stack),
            };
            let more = MORE.iter().filter(|(stages, _)| has(stages));
            let code = code + own_code + more.map(|(_, bytes)| bytes).sum::<usize>();
            Self {
                model_flash: constants,
                model_ram,
                flash: constants + code + learner_code,
                ram: model_ram + own + stack + learner_stack,
                follows,
            }
        };
        let fits = |memory: &Self| {
            board.flash().is_none_or(|most| memory.flash <= most)
                && board.ram().is_none_or(|most| memory.ram <= most)
        };
        // What a learner is compared with follows the drive.
        let learns = avr.adaptation.is_some();
        let (both, one) = (need(true), need(learns));
        let (flash, ram) = (board.flash().unwrap_or(0), board.ram().unwrap_or(0));
        [both, one].into_iter().find(fits).ok_or_else(|| {
            format!(
                "K = {}{} needs {} bytes of flash and {} of RAM, and the {} has {flash} and {ram}",
                export.levels,
                if learns { " with a learner" } else { "" },
                one.flash,
                one.ram,
                board.name()
            )
        })
    }
}

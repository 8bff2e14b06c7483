//! The differences between the Cortex-M4F and the host: printing, counting instructions, measuring
//! the stack.

#[cfg(target_os = "none")]
pub use target::*;

#[cfg(target_os = "none")]
mod target {
    use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
    use cortex_m::Peripherals;
    use cortex_m::peripheral::{SYST, syst::SystClkSource};
    use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
    use panic_semihosting as _;

    pub use cortex_m_semihosting::{heprintln as note, hprintln as say};

    /// With `-icount shift=7` an instruction takes 128 ns. A tick of SysTick at 25 MHz is 40 ns, so
    /// 5 instructions are 16 ticks. A difference of two readings is off by less than one tick, so
    /// it gives the number of instructions exactly.
    const TICKS: u32 = 16;
    const INSTRUCTIONS: u32 = 5;

    /// The count for an empty step.
    static READING: AtomicU32 = AtomicU32::new(0);

    /// Starts the counter and checks it.
    pub fn start() {
        if let Some(mut board) = Peripherals::take() {
            board.SYST.set_clock_source(SystClkSource::Core);
            board.SYST.set_reload(0x00ff_ffff);
            board.SYST.clear_current();
            board.SYST.enable_counter();
        }
        READING.store(count(|| ()).1, Relaxed);
        macro_rules! nops {
            ($($n:literal $step:stmt;)*) => {$(
                let counted = count(|| { $step }).1;
                note!("exact\t{}\t{}", $n, counted);
                assert!(counted == $n, "the counter is not exact");
            )*};
        }
        macro_rules! ten { ($($step:tt)*) => {{
            $($step)* $($step)* $($step)* $($step)* $($step)* $($step)* $($step)* $($step)* $($step)* $($step)*
        }} }
        use cortex_m::asm::nop;
        nops! {
            0 {};
            1 nop();
            2 { nop(); nop(); };
            3 { nop(); nop(); nop(); };
            10 ten!(nop(););
            1000 ten!(ten!(ten!(nop(););););
        }
    }

    /// A separate function, so that the compiler moves nothing of the step past a reading.
    #[inline(never)]
    fn ticks() -> u32 {
        SYST::get_current()
    }

    /// The result of `step`, and its number of instructions.
    #[inline(always)]
    pub fn count<R>(step: impl FnOnce() -> R) -> (R, u32) {
        let before = ticks();
        let result = step();
        let after = ticks();
        // The counter counts down, in 24 bits.
        let ticks = before.wrapping_sub(after) & 0x00ff_ffff;
        let instructions = (ticks * INSTRUCTIONS + TICKS / 2) / TICKS;
        (result, instructions - READING.load(Relaxed))
    }

    /// How many bytes of the stack `steps` uses.
    #[inline(never)]
    pub fn depth(steps: impl FnOnce()) -> u32 {
        cortex_m_stack::repaint_stack();
        steps();
        let used = cortex_m_stack::stack_size() - cortex_m_stack::stack_painted();
        used - cortex_m_stack::current_stack_in_use()
    }

    pub fn end(result: Result<(), hysteron_core::Error>) -> ! {
        if let Err(why) = result {
            note!("error: {why}");
            debug::exit(EXIT_FAILURE);
        }
        debug::exit(EXIT_SUCCESS);
        loop {
            cortex_m::asm::wfi();
        }
    }
}

#[cfg(not(target_os = "none"))]
pub use host::*;

#[cfg(not(target_os = "none"))]
mod host {
    pub use std::println as say;

    macro_rules! note {
        ($($what:tt)*) => {{ let _ = format_args!($($what)*); }};
    }
    pub(crate) use note;

    pub fn start() {}

    pub fn count<R>(step: impl FnOnce() -> R) -> (R, u32) {
        (step(), 0)
    }

    pub fn depth(_: impl FnOnce()) -> u32 {
        0
    }
}

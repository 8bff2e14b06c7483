//! Every run in both number types through the Rust core. Standard output gets the bits of each
//! result. On the Cortex-M4F, standard error gets the cost.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod port;
mod run;
mod run_staged;

fn all() -> Result<(), hysteron_core::Error> {
    port::start();
    run::all::<f32>()?;
    run::all::<f64>()
}

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), hysteron_core::Error> {
    all()
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    port::end(all())
}

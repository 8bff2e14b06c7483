//! The name of the shared library that linked programs look for.

/// Increase it when programs that are linked with an older library do not run with this one.
/// Functions, constants and codes may be added. Whatever is in the header may not change its
/// meaning, its arguments or its size.
const INTERFACE: u32 = 0;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libhysteron_capi.so.{INTERFACE}");
    }
}

//! The name that programs remember of the shared library.

/// Rises when programs that were linked with the library before do not run with it any more.
/// Functions, constants and codes may be added; nothing in the header may change its meaning, its
/// arguments or its size.
const INTERFACE: u32 = 0;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libhysteron_capi.so.{INTERFACE}");
    }
}

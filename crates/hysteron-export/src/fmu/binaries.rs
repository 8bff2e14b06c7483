//! The libraries in an FMU, one for each platform.

use super::Fmi;
use std::borrow::Cow;

// Miri would take hours to pack them.
macro_rules! binary {
    ($path:literal) => {
        match cfg!(miri) {
            false => include_bytes!(concat!("../../binaries/", $path)),
            true => &[],
        }
    };
}

const LINUX: &[u8] = binary!("x86_64-linux/hysteron.so");
const LINUX_ARM: &[u8] = binary!("aarch64-linux/hysteron.so");
const MAC: &[u8] = binary!("x86_64-darwin/hysteron.dylib");
const MAC_ARM: &[u8] = binary!("aarch64-darwin/hysteron.dylib");
const WINDOWS: &[u8] = binary!("x86_64-windows/hysteron.dll");

/// A platform by its name in the standard, the ending of a library there, and the library.
pub(super) type Binary = (&'static str, &'static str, Cow<'static, [u8]>);

/// All binaries of an FMU. FMI 2.0 has one name for both kinds of Mac, so they share a library of
/// two parts; for Linux on ARM it has none, and tools take that of FMI 3.0.
pub(super) fn binaries(fmi: Fmi) -> Vec<Binary> {
    match fmi {
        Fmi::V2 => vec![
            ("linux64", "so", LINUX.into()),
            ("aarch64-linux", "so", LINUX_ARM.into()),
            ("darwin64", "dylib", universal().into()),
            ("win64", "dll", WINDOWS.into()),
        ],
        Fmi::V3 => vec![
            ("x86_64-linux", "so", LINUX.into()),
            ("aarch64-linux", "so", LINUX_ARM.into()),
            ("x86_64-darwin", "dylib", MAC.into()),
            ("aarch64-darwin", "dylib", MAC_ARM.into()),
            ("x86_64-windows", "dll", WINDOWS.into()),
        ],
    }
}

/// Type and subtype of a processor as Mach-O numbers them, and its library.
const PARTS: [([u32; 2], &[u8]); 2] = [([0x0100_0007, 3], MAC), ([0x0100_000c, 0], MAC_ARM)];

/// A universal binary: a head that tells where the library of each processor begins, as
/// `mach-o/fat.h` lays it out, in big-endian numbers.
fn universal() -> Vec<u8> {
    const MAGIC: u32 = 0xcafe_babe;
    // A part begins at a multiple of a page of 2^14 bytes.
    const ALIGN: u32 = 14;
    let page = |length: usize| length.next_multiple_of(1 << ALIGN);
    let mut head = vec![MAGIC, PARTS.len() as u32];
    let mut place = page(1);
    for ([processor, subtype], bytes) in PARTS {
        head.extend([processor, subtype, place as u32, bytes.len() as u32, ALIGN]);
        place += page(bytes.len());
    }
    let mut all: Vec<u8> = head
        .iter()
        .flat_map(|number| number.to_be_bytes())
        .collect();
    for (_, bytes) in PARTS {
        all.resize(page(all.len()), 0);
        all.extend(bytes);
    }
    all
}

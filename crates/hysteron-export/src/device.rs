//! Names that Windows takes for devices.

/// Why [`is_device`] refuses.
pub(crate) const DEVICE: &str = "it is a device of Windows, which has no file of that name";

/// Whether Windows takes a file of that name, whatever its ending, for a device: exported files go
/// there too.
pub(crate) fn is_device(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let port = |rest: &str| matches!(rest.as_bytes(), [b'1'..=b'9']);
    ["con", "prn", "aux", "nul"].contains(&lower.as_str())
        || lower.strip_prefix("com").is_some_and(port)
        || lower.strip_prefix("lpt").is_some_and(port)
}

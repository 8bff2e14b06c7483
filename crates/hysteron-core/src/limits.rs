//! The ranges of what a caller may ask for.

/// The largest number of levels of a plane. The number of operators then fits 31 bits.
pub const MAX_LEVELS: usize = 46_340;

/// The range of an option, in words, for the message of
/// [`Error::Adaptation`](crate::Error::Adaptation).
pub(crate) fn range_of(option: &str) -> &'static str {
    match option {
        "gain" => "above 0 and below 2",
        "span" => "from 1/8 to 8",
        "forgetting" => "above 0 and up to 1",
        "noise" | "spread" => "above 0, and its square a number too",
        "correlation" => {
            "a finite number from 0 on, and 0 where the coefficients of a basis are adapted"
        }
        "leakage" => "from 0 to 1",
        "trial" | "burst" => "1 or more",
        "reach" => "a finite number above 0",
        "gate" => "a finite number from 2 on, or 0 for none",
        "method" => "least squares where the coefficients of a basis are adapted",
        "coefficients" => "finite numbers from 0 on, at least one",
        _ => "a finite number from 0 on",
    }
}

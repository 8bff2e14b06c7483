//! What must hold of any input: each fuzz target hands its input to one of these, which panic where
//! it does not hold.

pub mod c_calls;
pub mod core_walk;
pub mod given;
pub mod inverse;
pub mod model_file;
pub mod prepare;
pub mod scenario;
pub mod session;
pub mod stages;
pub mod table;
pub mod timestamps;

/// An error says something.
fn worded(error: &hysteron::Error) {
    assert!(!error.to_string().trim().is_empty(), "{error:?}");
}

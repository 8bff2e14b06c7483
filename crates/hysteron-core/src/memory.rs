//! Memory of the caller: the core allocates none.

/// Memory for elements of type `T`, provided by the caller.
///
/// Arrays, `Vec`, `Box<[T]>` and `&mut [T]` are memory; no type has to implement this trait by
/// hand. Whoever writes a function over a [`State`](crate::State), a [`Model`](crate::Model) or an
/// [`Estimator`](crate::Estimator) names one bound in place of two.
///
/// ```
/// use hysteron_core::{Memory, State, Turn};
/// fn depth<S: Memory<Turn<f64>>>(state: &State<f64, S>) -> usize {
///     state.corners()
/// }
/// ```
pub trait Memory<T>: AsRef<[T]> + AsMut<[T]> {}

impl<T, M: AsRef<[T]> + AsMut<[T]> + ?Sized> Memory<T> for M {}

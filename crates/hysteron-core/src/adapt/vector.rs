//! Sums over slices, with several running sums in parallel. With a single one, each addition would
//! have to wait for the one before it.

use crate::scalar::Real;

const LANES: usize = 8;

/// `aᵀb`.
pub(super) fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    let mut sums = [T::ZERO; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = a.remainder().iter().zip(b.remainder());
    for (a, b) in a.zip(b) {
        for ((sum, &a), &b) in sums.iter_mut().zip(a).zip(b) {
            *sum = *sum + a * b;
        }
    }
    rest.fold(total(&sums), |sum, (&a, &b)| sum + a * b)
}

/// `aᵀb`, and `out ← out + s a`, in one pass over `a`.
pub(super) fn dot_and_add<T: Real>(a: &[T], b: &[T], s: T, out: &mut [T]) -> T {
    let mut sums = [T::ZERO; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let mut out = out.chunks_exact_mut(LANES);
    let (rest_a, rest_b) = (a.remainder(), b.remainder());
    for ((a, b), out) in a.zip(b).zip(out.by_ref()) {
        for (((sum, out), &a), &b) in sums.iter_mut().zip(out).zip(a).zip(b) {
            *sum = *sum + a * b;
            *out = *out + s * a;
        }
    }
    let rest = rest_a.iter().zip(rest_b).zip(out.into_remainder());
    rest.fold(total(&sums), |sum, ((&a, &b), out)| {
        *out = *out + s * a;
        sum + a * b
    })
}

fn total<T: Real>(sums: &[T; LANES]) -> T {
    sums.iter().fold(T::ZERO, |sum, &lane| sum + lane)
}

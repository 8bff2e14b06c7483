//! Work on each of many items that are made one after the other, such as rows that are read.

/// Calls `work` with each of the items, on all threads with the feature `parallel`. The items are
/// made on this thread, and only a few of them wait to be worked on.
#[cfg(feature = "parallel")]
pub(super) fn each<T: Send>(items: impl Iterator<Item = T>, work: impl Fn(T) + Sync) {
    // A thread of the pool that waits for another one would wait for ever if there is none.
    if rayon::current_thread_index().is_some() {
        return items.for_each(work);
    }
    let most = 2 * rayon::current_num_threads();
    let running = Running::default();
    let (running, work) = (&running, &work);
    rayon::in_place_scope(|scope| {
        for item in items {
            let one = running.begin(most);
            scope.spawn(move |_| {
                work(item);
                drop(one);
            });
        }
    });
}

/// Number of items that are being worked on.
#[cfg(feature = "parallel")]
#[derive(Default)]
struct Running {
    count: std::sync::Mutex<usize>,
    ended: std::sync::Condvar,
}

/// An item that is being worked on, until this is dropped; also if the work panics.
#[cfg(feature = "parallel")]
struct One<'a>(&'a Running);

#[cfg(feature = "parallel")]
impl Running {
    /// Waits until there are fewer than `most`.
    fn begin(&self, most: usize) -> One<'_> {
        use std::sync::PoisonError;
        let count = self.count.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.ended.wait_while(count, |count| *count >= most);
        *waited.unwrap_or_else(PoisonError::into_inner) += 1;
        One(self)
    }
}

#[cfg(feature = "parallel")]
impl Drop for One<'_> {
    fn drop(&mut self) {
        use std::sync::PoisonError;
        *self.0.count.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        self.0.ended.notify_one();
    }
}

/// Calls `work` with each of the items.
#[cfg(not(feature = "parallel"))]
pub(super) fn each<T>(items: impl Iterator<Item = T>, work: impl Fn(T)) {
    items.for_each(work);
}

//! Work on long texts, shared by two threads.

/// What `first` and `second` give. They run at the same time if that `is_worth_a_thread`.
pub fn both<A, B: Send>(
    is_worth_a_thread: bool,
    first: impl FnOnce() -> A,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if !is_worth_a_thread {
        return (first(), second());
    }
    std::thread::scope(|scope| {
        let second = scope.spawn(second);
        (first(), second.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

//! Processor time in place of time elapsed: it does not depend on what else the machine does.

/// Processor time of a thread since it began, in seconds; `None` where the system does not say.
pub fn of_this_thread() -> Option<f64> {
    let statistics = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = statistics.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds / 1e9)
}

/// What `work` gives, which must take less than `most` seconds of this thread.
pub fn within<T>(most: f64, work: impl FnOnce() -> T) -> T {
    let begun = of_this_thread();
    let done = work();
    if let (Some(begun), Some(ended)) = (begun, of_this_thread()) {
        assert!(ended - begun < most, "it took {} s of processor time, more than {most}", ended - begun);
    }
    done
}

//! Runs long work on threads of its own, without the interpreter's lock. Meanwhile the calling thread reports progress and handles signals, so that
//! Ctrl-C and an exception of the callback stop the work.

use pantin_convert::Progress;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How often signals are looked for while nothing is reported.
const TICK: Duration = Duration::from_millis(100);

/// What unwinds the work's threads when they are to stop.
struct Stopped;

/// Runs `work` on `jobs` threads (0: one for each CPU), which gets a function that takes the part that is done, from 0 to 1. The pool of threads ends with
/// it, so that a process may fork afterwards.
pub fn run<T: Send, E: Send>(
    py: Python<'_>,
    jobs: usize,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(Progress<'_>) -> Result<T, E> + Send,
) -> PyResult<Result<T, E>> {
    let pool = ThreadPoolBuilder::new().num_threads(jobs).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let stop = &AtomicBool::new(false);
    py.detach(|| {
        thread::scope(|scope| {
            let (sender, parts) = channel();
            let worker = scope.spawn(move || {
                let mut report = move |part: f64| {
                    if stop.load(Ordering::Relaxed) {
                        resume_unwind(Box::new(Stopped));
                    }
                    // Nobody receives it after an exception.
                    let _ = sender.send(part);
                };
                pool.install(|| catch_unwind(AssertUnwindSafe(|| work(&mut report))))
            });
            let exception = listen(&parts, progress).err();
            stop.store(exception.is_some(), Ordering::Relaxed);
            let done = worker.join().unwrap_or_else(Err);
            match (exception, done) {
                (Some(exception), _) => Err(exception),
                (None, Ok(done)) => Ok(done),
                (None, Err(panic)) => resume_unwind(panic),
            }
        })
    })
}

/// Reports until the work has ended; fails with the first exception.
fn listen(parts: &Receiver<f64>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    loop {
        let part = match parts.recv_timeout(TICK) {
            // Several that came meanwhile are reported as one.
            Ok(part) => Some(parts.try_iter().last().unwrap_or(part)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        };
        Python::attach(|py| {
            py.check_signals()?;
            match (progress, part) {
                (Some(progress), Some(part)) => progress.call1(py, (part,)).map(drop),
                _ => Ok(()),
            }
        })?;
    }
}

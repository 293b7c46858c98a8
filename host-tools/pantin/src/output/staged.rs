//! Bytes on their way to an output: beside it until they are whole, then in its place.

use super::folders::remove_empty_folders;
use super::place::{Place, folder};
use super::report;
use super::terminal::{detail, noticed};
use anyhow::{Context, Result, ensure};
use pantin_convert::size_text;
use serde_json::json;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, Once, PoisonError};
use tempfile::{Builder, TempPath};

/// An output that is being written. Dropped before [`commit`], it leaves the file that was there as it was.
pub struct Staged {
    /// As the user gave it.
    path: PathBuf,
    to: To,
    written: u64,
    failed: bool,
}

/// The limit without `--max-output`, in bytes.
static MOST_BYTES: AtomicU64 = AtomicU64::new(1 << 30);

/// Sets the most bytes that an output of this process may have.
pub fn set_most_bytes(bytes: u64) {
    MOST_BYTES.store(bytes, Ordering::Relaxed);
}

/// Refuses an output of `bytes` or more, before it is begun.
pub fn check_size(path: &Path, bytes: u64) -> Result<()> {
    let most = MOST_BYTES.load(Ordering::Relaxed);
    let (size, limit) = (size_text(bytes), size_text(most));
    ensure!(bytes <= most, "{}: would have {size} or more; the limit is {limit}, and --max-output raises it", path.display());
    Ok(())
}

enum To {
    Replace {
        bytes: BufWriter<File>,
        temporary: TempPath,
        file: PathBuf,
        name: Registered,
    },
    /// All bytes are in the temporary file, which is closed.
    Whole {
        bytes: TempPath,
        file: PathBuf,
        _name: Registered,
    },
    Through(BufWriter<File>),
    Stdout(BufWriter<Stdout>),
}

impl Staged {
    /// Begins an output at `path`.
    pub fn create(path: &Path) -> Result<Staged> {
        let to = Place::of(path).and_then(|place| match place {
            Place::Stdout => {
                report::take_stdout();
                Ok(To::Stdout(BufWriter::new(io::stdout())))
            }
            Place::Through(path) => Ok(To::Through(BufWriter::new(
                File::options().write(true).truncate(true).open(path).context("cannot be opened")?,
            ))),
            Place::File(file) => {
                remove_on_signals();
                let (bytes, temporary, name) = Registered::create(folder(&file)).context("cannot be written")?;
                Ok(To::Replace { bytes: BufWriter::new(bytes), temporary, file, name })
            }
        });
        Ok(Staged { path: path.to_path_buf(), to: to.with_context(|| path.display().to_string())?, written: 0, failed: false })
    }

    /// Ends the output: its bytes are on the disk, and its file is closed. Only [`commit`] may follow. Where many outputs belong together, each is closed before
    /// the next one begins, for a process may have few files open at a time.
    pub fn close(&mut self) -> Result<()> {
        self.flush()?;
        Ok(self.end().map_err(|error| self.unwritten(error))?)
    }

    /// Puts `place` before an error of what wrote this output. An error of the output itself names it already.
    pub fn explain<T>(&self, result: Result<T>, place: impl FnOnce() -> String) -> Result<T> {
        if self.failed { result } else { result.with_context(place) }
    }

    /// The error of a write, which names the output as the user did, and not the temporary file.
    fn unwritten(&mut self, error: io::Error) -> io::Error {
        if error.kind() == io::ErrorKind::Interrupted {
            return error;
        }
        self.failed = true;
        let help = match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "; free some space, or choose another place for it",
            io::ErrorKind::FileTooLarge => "; `ulimit -f` sets the most bytes of a file",
            _ => "",
        };
        let name = if self.path.as_os_str() == "-" { "standard output".into() } else { self.path.display().to_string() };
        io::Error::new(error.kind(), format!("{name}: cannot be written: {error}{help}"))
    }

    fn end(&mut self) -> io::Result<()> {
        self.to = match std::mem::replace(&mut self.to, To::Stdout(BufWriter::new(io::stdout()))) {
            To::Replace { bytes, temporary, file, name } => {
                let bytes = bytes.into_inner().map_err(io::IntoInnerError::into_error)?;
                // A full disk may be reported no earlier.
                bytes.sync_data()?;
                if let Ok(found) = fs::metadata(&file) {
                    bytes.set_permissions(found.permissions())?;
                }
                To::Whole { bytes: temporary, file, _name: name }
            }
            other => other,
        };
        Ok(())
    }
}

impl Write for Staged {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Err(error) = check_size(&self.path, self.written.saturating_add(bytes.len() as u64)) {
            self.failed = true;
            return Err(io::Error::other(error));
        }
        let taken = match &mut self.to {
            To::Replace { bytes: file, .. } => file.write(bytes),
            To::Whole { .. } => Err(io::Error::other("the output was closed")),
            To::Through(file) => noticed(file.write(bytes)),
            To::Stdout(out) => noticed(out.write(bytes)),
        };
        let taken = taken.map_err(|error| self.unwritten(error))?;
        self.written += taken as u64;
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = match &mut self.to {
            To::Replace { bytes, .. } => bytes.flush(),
            To::Whole { .. } => Ok(()),
            To::Through(file) => noticed(file.flush()),
            To::Stdout(out) => noticed(out.flush()),
        };
        flushed.map_err(|error| self.unwritten(error))
    }
}

/// A temporary name that no other program uses. The file gets the rights that any new file gets.
fn temporary() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".pantin-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

/// Puts all outputs in their places. If one cannot be put there, the files that were there come back.
pub fn commit(staged: Vec<Staged>) -> Result<()> {
    let several = staged.len() > 1;
    let sizes: Vec<_> = staged.iter().map(|output| (output.path.display().to_string(), output.written)).collect();
    let mut whole = Vec::new();
    for mut output in staged {
        output.close()?;
        if let To::Whole { bytes, file, _name } = output.to {
            whole.push((output.path, bytes, file, _name));
        }
    }
    // A signal waits until all of them are in place, and the second names of those before are gone.
    let _together = IN_PLACE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut done: Vec<(PathBuf, Option<TempPath>)> = Vec::new();
    for (path, bytes, file, _name) in whole {
        let replaced = (|| {
            let before = if several { backup(&file)? } else { None };
            bytes.persist(&file).map_err(|error| error.error)?;
            Ok(before)
        })();
        match replaced {
            Ok(before) => done.push((file, before)),
            Err(error) => {
                let error: io::Error = error;
                roll_back(done);
                return Err(error).with_context(|| format!("{}: cannot be written", path.display()));
            }
        }
    }
    for (path, bytes) in sizes {
        detail!("wrote {path}: {bytes} bytes");
        report::list("outputs", json!({"file": path, "bytes": bytes}));
    }
    Ok(())
}

/// A second name of the file `path`, so that it can come back.
fn backup(path: &Path) -> io::Result<Option<TempPath>> {
    if !path.exists() {
        return Ok(None);
    }
    let link = |name: &Path| match fs::hard_link(path, name) {
        // Some file systems have no links.
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
            io::copy(&mut File::open(path)?, &mut File::create_new(name)?).map(drop)
        }
        linked => linked,
    };
    Ok(Some(temporary().make_in(folder(path), link)?.into_temp_path()))
}

/// What cannot be undone is not reported: the error that led here is.
fn roll_back(done: Vec<(PathBuf, Option<TempPath>)>) {
    for (path, before) in done {
        let _ = match before {
            Some(before) => before.persist(&path).map_err(io::Error::from),
            None => fs::remove_file(&path),
        };
    }
}

/// Temporary names that exist now.
static NAMES: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Held while outputs that belong together replace those before them.
static IN_PLACE: Mutex<()> = Mutex::new(());

/// A temporary name that a signal removes.
struct Registered(PathBuf);

impl Registered {
    /// Makes a temporary file in `folder`. A signal sees it once it is known, or prevents it.
    fn create(folder: &Path) -> io::Result<(File, TempPath, Registered)> {
        let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
        // Its error names the temporary file, which says nothing to the user.
        let file = temporary().tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
        names.insert(file.path().to_path_buf());
        let name = Registered(file.path().to_path_buf());
        let (file, path) = file.into_parts();
        Ok((file, path, name))
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        NAMES.lock().unwrap_or_else(PoisonError::into_inner).remove(&self.0);
    }
}

/// Whether SIGINT and SIGTERM only set a flag.
#[cfg(unix)]
static KEEPS_RUNNING: AtomicBool = AtomicBool::new(false);

/// A flag that SIGINT and SIGTERM set, for a command that then ends by itself and keeps what it has written. A second signal ends the program at once. To be
/// called before the first output.
pub fn end_on_signals() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    {
        KEEPS_RUNNING.store(true, Ordering::Relaxed);
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            // In this order, so that the first one finds the flag unset.
            signal_hook::flag::register_conditional_default(signal, stop.clone())?;
            signal_hook::flag::register(signal, stop.clone())?;
        }
    }
    Ok(stop)
}

/// Signals that end the program remove temporary files first, and folders that were made for nothing. A signal that the program was started to ignore stays ignored.
pub(super) fn remove_on_signals() {
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXFSZ};
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            // A file that may not grow is an error of its write, as a full disk is.
            let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
            let ignored = ignored_signals();
            let ending = [SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2];
            let left_out = |signal: &i32| KEEPS_RUNNING.load(Ordering::Relaxed) && [SIGINT, SIGTERM].contains(signal);
            let signals = ending.into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0 && !left_out(signal));
            let Ok(mut signals) = signal_hook::iterator::Signals::new(signals) else { return };
            std::thread::spawn(move || {
                for signal in signals.forever() {
                    let _whole = IN_PLACE.lock().unwrap_or_else(PoisonError::into_inner);
                    // Held to the end: no other thread makes a new one.
                    let names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
                    for name in names.iter() {
                        // Nobody is left to be told.
                        let _ = fs::remove_file(name);
                    }
                    remove_empty_folders();
                    let _ = signal_hook::low_level::emulate_default_handler(signal);
                }
            });
        });
    }
}

/// A bit a signal, from 1 on, as Linux reports them (`nohup`, and shells that start programs in the background); else none.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

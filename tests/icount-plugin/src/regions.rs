//! The count of the open region, and the file of closed ones. The guests measured have one processor.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

static OPEN: AtomicBool = AtomicBool::new(false);
static COUNT: AtomicU64 = AtomicU64::new(0);
static FILE: Mutex<Option<BufWriter<File>>> = Mutex::new(None);

/// Where closed regions are written.
pub fn open(path: &str) -> io::Result<()> {
    let file = BufWriter::new(File::create(path)?);
    *FILE.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(file);
    Ok(())
}

/// Counts executed instructions, where a region is open.
pub fn add(instructions: u64) {
    if OPEN.load(Relaxed) {
        COUNT.store(COUNT.load(Relaxed) + instructions, Relaxed);
    }
}

/// Opens a region.
pub fn start() {
    if OPEN.swap(true, Relaxed) {
        write("unbalanced");
    }
    COUNT.store(0, Relaxed);
}

/// Closes the region and writes its count.
pub fn stop() {
    if OPEN.swap(false, Relaxed) {
        write(&COUNT.load(Relaxed).to_string());
    } else {
        write("unbalanced");
    }
}

/// Writes out what is still in memory; QEMU is ending.
pub fn close() {
    let file = FILE.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
    if let Some(Err(error)) = file.map(|mut file| file.flush()) {
        eprintln!("icount-plugin: {error}");
    }
}

fn write(line: &str) {
    if let Some(file) = FILE.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).as_mut()
        && let Err(error) = writeln!(file, "{line}")
    {
        eprintln!("icount-plugin: {error}");
    }
}

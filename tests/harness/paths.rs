//! Where things lie, and files that are whole or absent.

use std::fs;
use std::io::{BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// The root of the repository.
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_path_buf()
}

/// The firmware's workspace.
pub fn firmware() -> PathBuf {
    root().join("firmware")
}

/// The folder of motion clips that tests may use: `$PANTIN_DATA`, by default `../shared/data` beside the repository.
/// `None` where it is absent, said on stderr.
pub fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("PANTIN_DATA").map_or_else(|| root().join("../shared/data"), PathBuf::from);
    if !folder.is_dir() {
        // Not a `print!`: the test runner would swallow it.
        let _ = writeln!(std::io::stderr(), "SKIPPED: no motion clips at {} (set PANTIN_DATA)", folder.display());
        return None;
    }
    Some(folder)
}

/// The program of this name on `PATH`.
pub fn program(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let candidates = std::env::split_paths(&path).map(|folder| folder.join(name));
    candidates.into_iter().find(|candidate| candidate.is_file())
}

/// Writes a file under another name and renames it when all of it is there; folders above it are made.
pub fn write_whole(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let attempt = || -> Result<()> {
        fs::create_dir_all(folder)?;
        // Temporary files are their owner's alone; this one becomes an ordinary file, within the user's umask.
        let mode = fs::Permissions::from_mode(0o666);
        let mut file = BufWriter::new(tempfile::Builder::new().prefix(".part-").permissions(mode).tempfile_in(folder)?);
        write(&mut file)?;
        let file = file.into_inner().map_err(|error| error.into_error())?;
        file.persist(path)?;
        Ok(())
    };
    attempt().with_context(|| format!("cannot write {}", path.display()))
}

//! Where things lie.

use std::io::Write;
use std::path::{Path, PathBuf};

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

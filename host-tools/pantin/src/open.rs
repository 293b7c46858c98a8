//! Why a file is no clip, and which command helps.

use anyhow::{Error, anyhow};
use pantin::OpenError;
use pantin_convert::import;
use std::path::Path;

/// Whether the file is a bank by its content.
pub fn is_bank(bytes: &[u8]) -> bool {
    bytes.starts_with(&pantin::codec::layout::BANK_MAGIC)
}

/// The reason why `bytes`, the content of `path`, do not open as a clip; for a motion and a bank, with the next command.
pub fn no_clip(path: &Path, bytes: &[u8], error: OpenError) -> Error {
    let place = path.display();
    match error {
        OpenError::BadMagic if import::looks_like_motion(path, bytes) && !is_bank(bytes) => {
            anyhow!("a motion, not a clip; `pantin convert {place} -o {}` makes one", path.with_extension("ptn").display())
        }
        OpenError::IsBank | OpenError::BadMagic if is_bank(bytes) => anyhow!(
            "a bank of several clips; `pantin list {place}` prints their names, and `pantin unpack {place} -o FOLDER` writes them as files"
        ),
        OpenError::BadMagic => anyhow!("{error}; `pantin convert` makes clips of motions"),
        error => error.into(),
    }
}

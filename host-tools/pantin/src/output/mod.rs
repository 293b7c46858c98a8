//! Outputs: where every command writes its files, so that all of them keep the same promises.
//!
//! - [`check`] runs before the work: an output must not be one of the inputs nor another output (by file identity, with links
//!   followed), and its folder must exist and take files.
//! - A regular file is replaced atomically: the bytes go to a new file with a name of its own in the same folder, which is renamed
//!   when it is whole. It is removed on every other exit, signals included.
//! - A symbolic link stays; the file that it names is replaced. Pipes and devices are written through. `-` is standard output.
//! - Lines for people go through [`print_note`] and [`print_line`], which escape control characters.
//! - [`report()`] collects what `--json` prints.
//! - No output is longer than `--max-output`; [`check_size`] refuses one before it is begun where its size is known.
//! - A folder that a command made is removed again if nothing was written into it.
//! - Files that belong together are committed together: [`write_together`] replaces all of them or none.

mod bvh;
mod folders;
mod foreign;
mod place;
mod progress;
mod report;
mod staged;
mod terminal;

pub use bvh::save_bvh;
pub use folders::{make_folder, remove_empty_folders};
pub use foreign::{Wanted, refuse_foreign};
pub use place::{Place, check, file_id};
pub use progress::{Piece, Pieces, progress};
pub use report::{fail, finish, is_json, is_quiet, is_verbose, report, set_reporting, take_stdout};
pub use staged::{Staged, check_size, commit, end_on_signals, set_most_bytes};
pub use terminal::{clean, is_hostile, print_detail, print_error, print_error_text, print_line, print_note, reader_gone};
pub(crate) use terminal::{detail, note, noticed, outln};

use anyhow::Result;
use std::io::Write;
use std::path::Path;

/// Writes `bytes` to the output `path`: all of them, or a file that was there stays as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_together(&[(path, bytes)])
}

/// Writes several outputs. If any of them cannot be written, the files that were there stay as they were.
pub fn write_together(outputs: &[(&Path, &[u8])]) -> Result<()> {
    let mut staged = Vec::with_capacity(outputs.len());
    for (path, bytes) in outputs {
        let mut output = Staged::create(path)?;
        output.write_all(bytes)?;
        output.close()?;
        staged.push(output);
    }
    commit(staged)
}

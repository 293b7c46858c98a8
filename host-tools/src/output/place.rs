//! What an output's path names: a file to replace, a pipe or device to write through, or standard output.

use anyhow::{Context, Result, anyhow, bail, ensure};
use same_file::Handle;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// More links in a row than any system follows.
const MOST_LINKS: usize = 40;
/// Other names of standard output.
const STDOUT: [&str; 3] = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// What an output's path names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Standard output: `-`.
    Stdout,
    /// A regular file, or none yet; links are followed.
    File(PathBuf),
    /// A pipe, a device, or an open file by its number: it cannot be replaced, only written.
    Through(PathBuf),
}

impl Place {
    /// What `path` names. Fails for folders, for names in a folder that does not exist, and for links that lead in a circle.
    pub fn of(path: &Path) -> Result<Place> {
        let given = path.display();
        if path.as_os_str() == "-" {
            return Ok(Place::Stdout);
        }
        let mut path = path.to_path_buf();
        for _ in 0..MOST_LINKS {
            if STDOUT.iter().any(|name| path == Path::new(name)) {
                return Ok(Place::Stdout);
            }
            if is_of_processes(&path) {
                match outside_of_processes(&path) {
                    Some(outside) => path = outside,
                    // A link there names an open file, which its target's text does not.
                    None => return Ok(Place::Through(path)),
                }
            }
            let Ok(target) = fs::read_link(&path) else { return Place::unlinked(path, &given.to_string()) };
            path = path.parent().unwrap_or(Path::new("")).join(target);
        }
        bail!("{given}: its links lead in a circle")
    }

    /// The same for a path that is no link.
    fn unlinked(path: PathBuf, given: &str) -> Result<Place> {
        match fs::metadata(&path) {
            Ok(found) if found.is_dir() => bail!("{given}: a folder; expected a file name"),
            Ok(found) if found.is_file() => Ok(Place::File(path)),
            Ok(_) => Ok(Place::Through(path)),
            Err(_) => {
                let slash = given.ends_with(std::path::is_separator);
                ensure!(!slash && path.file_name().is_some(), "{given}: expected a file name");
                let folder = folder(&path);
                ensure!(folder.is_dir(), "{given}: there is no folder {}", folder.display());
                Ok(Place::File(path))
            }
        }
    }

    /// Fails if the place cannot be written: a file that is read-only, or a folder that takes no files.
    fn ready(&self) -> Result<()> {
        let Place::File(path) = self else { return Ok(()) };
        if path.exists() {
            File::options().append(true).open(path).with_context(|| format!("{}: cannot be written", path.display()))?;
        }
        let folder = folder(path);
        tempfile::tempfile_in(folder).with_context(|| format!("{}: no file can be written there", folder.display()))?;
        Ok(())
    }

    fn identity(&self) -> Option<Identity> {
        let (Place::File(path) | Place::Through(path)) = self else { return None };
        // A name below /proc can be a regular file's.
        if path.is_file() {
            return Handle::from_path(path).ok().map(Identity::Existing);
        }
        let Place::File(path) = self else { return None };
        Some(Identity::Missing(folder(path).canonicalize().ok()?, path.file_name()?.to_os_string()))
    }
}

/// Whether the path is below the folders that show processes and their open files.
fn is_of_processes(path: &Path) -> bool {
    path.starts_with("/proc") || path.starts_with("/dev/fd")
}

/// The same file by a name of its own, if a folder's link leads out of there: `/proc/self/cwd/walk.ptn`.
fn outside_of_processes(path: &Path) -> Option<PathBuf> {
    let folder = path.parent()?.canonicalize().ok()?;
    let outside = folder.join(path.file_name()?);
    (!is_of_processes(&outside)).then_some(outside)
}

/// A file, whatever path names it.
#[derive(PartialEq)]
enum Identity {
    Existing(Handle),
    /// Its folder and its name.
    Missing(PathBuf, std::ffi::OsString),
}

/// The folder of the file `path`.
pub(super) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Checks outputs before any work is done: each can be written, none is one of the `inputs`, and no two are one file.
pub fn check(inputs: &[&Path], outputs: &[&Path]) -> Result<()> {
    let mut places: Vec<(Place, &Path, Option<Identity>)> = Vec::with_capacity(outputs.len());
    for &output in outputs {
        let place = Place::of(output)?;
        let identity = place.identity();
        for &input in inputs {
            let same = identity.is_some() && Place::of(input).ok().and_then(|input| input.identity()) == identity;
            ensure!(!same, "{}: is the input {} itself; choose another name for the output", output.display(), input.display());
        }
        for &(ref other, path, ref other_identity) in &places {
            let same = match identity {
                Some(_) => identity == *other_identity,
                None => place == *other,
            };
            let error = || anyhow!("{} and {}: both outputs are one file", path.display(), output.display());
            (!same).then_some(()).ok_or_else(error)?;
        }
        place.ready()?;
        places.push((place, output, identity));
    }
    Ok(())
}

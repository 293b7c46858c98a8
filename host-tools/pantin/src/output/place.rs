//! What an output's path names: a file to replace, a pipe or device to write through, or standard output.

use anyhow::{Context, Result, bail, ensure};
use pantin_convert::input;
use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// More links in a row than any system follows.
const MOST_LINKS: usize = 40;
/// Other names of standard output.
const STDOUT: [&str; 3] = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// What an output's path names.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
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

    /// Fails if the place cannot be written: a file that is read-only, or a folder that takes no files and is not among the `ready` ones.
    fn ready<'a>(&'a self, ready: &mut HashSet<&'a Path>) -> Result<()> {
        let Place::File(path) = self else { return Ok(()) };
        if path.exists() {
            File::options().append(true).open(path).with_context(|| format!("{}: cannot be written", path.display()))?;
        }
        let folder = folder(path);
        if ready.insert(folder) {
            tempfile::tempfile_in(folder).with_context(|| format!("{}: no file can be written there", folder.display()))?;
        }
        Ok(())
    }

    fn identity(&self) -> Option<Identity> {
        if *self == Place::Stdout {
            return stream_id(&std::io::stdout()).map(Identity::Existing);
        }
        let (Place::File(path) | Place::Through(path)) = self else { return None };
        // A name below /proc can be a regular file's.
        if path.is_file() {
            return file_id(path).map(Identity::Existing);
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

/// What is equal for all names of one file. It keeps no file open: a command may have thousands of outputs.
#[cfg(unix)]
pub type FileId = (u64, u64);
/// What is equal for all names of one file.
#[cfg(not(unix))]
pub type FileId = same_file::Handle;

/// The identity of a file that is there.
#[cfg(unix)]
pub fn file_id(path: &Path) -> Option<FileId> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().map(|found| (found.dev(), found.ino()))
}

/// The identity of the regular file that standard input or standard output is, if it is one.
#[cfg(unix)]
fn stream_id(stream: &impl std::os::fd::AsFd) -> Option<FileId> {
    use std::os::unix::fs::MetadataExt;
    let found = File::from(stream.as_fd().try_clone_to_owned().ok()?).metadata().ok()?;
    found.is_file().then(|| (found.dev(), found.ino()))
}

/// Not known here: such a file is no output's name.
#[cfg(not(unix))]
fn stream_id<T>(_: &T) -> Option<FileId> {
    None
}

/// The identity of a file that is there.
#[cfg(not(unix))]
pub fn file_id(path: &Path) -> Option<FileId> {
    same_file::Handle::from_path(path).ok()
}

/// A file, whatever path names it.
#[derive(PartialEq, Eq, Hash)]
enum Identity {
    Existing(FileId),
    /// Its folder and its name.
    Missing(PathBuf, std::ffi::OsString),
    /// A pipe or a device, or standard output.
    Through(Place),
}

/// The folder of the file `path`.
pub(super) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Checks outputs before any work is done: each can be written, none is one of the `inputs`, and no two are one file.
pub fn check(inputs: &[&Path], outputs: &[&Path]) -> Result<()> {
    let mut sources = HashMap::new();
    for &input in inputs {
        let identity = match input::is_stdin(input) {
            true => stream_id(&std::io::stdin()).map(Identity::Existing),
            false => Place::of(input).ok().and_then(|input| input.identity()),
        };
        if let Some(identity) = identity {
            sources.entry(identity).or_insert(input);
        }
    }
    let mut named: HashMap<Identity, &Path> = HashMap::new();
    let places = outputs.iter().map(|output| Place::of(output)).collect::<Result<Vec<_>>>()?;
    let mut ready = HashSet::new();
    for (place, &output) in places.iter().zip(outputs) {
        let identity = place.identity();
        if let Some(input) = identity.as_ref().and_then(|identity| sources.get(identity)) {
            let stream = |path: &Path, name: &str| if path.as_os_str() == "-" { name.into() } else { path.display().to_string() };
            let (output, input) = (stream(output, "standard output"), stream(input, "standard input"));
            bail!("{output}: is the input {input} itself; choose another name for the output");
        }
        if let Some(other) = named.insert(identity.unwrap_or_else(|| Identity::Through(place.clone())), output) {
            bail!("{} and {}: both outputs are one file", other.display(), output.display());
        }
        place.ready(&mut ready)?;
    }
    Ok(())
}

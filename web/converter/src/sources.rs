//! Which of the page's files is the motion, which is its face, and which are of no use.

use crate::convert::Asked;
use pantin_convert::import::{self, InMemory};
use pantin_convert::motion::Motion;
use pantin_convert::{Error, Note, NoteKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The files that the page gave, in its order.
pub struct Given {
    list: Vec<(PathBuf, Arc<[u8]>)>,
    files: InMemory,
}

impl Given {
    /// Files by their names.
    pub fn new(files: Vec<(PathBuf, Vec<u8>)>) -> Given {
        let list: Vec<(PathBuf, Arc<[u8]>)> = files.into_iter().map(|(path, bytes)| (path, bytes.into())).collect();
        Given { files: list.iter().cloned().collect(), list }
    }

    /// The same as the library takes them.
    pub fn files(&self) -> &InMemory {
        &self.files
    }

    fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.list.iter().map(|(path, _)| path)
    }

    /// The motions by their names; without any, the first file, whose content may tell.
    fn motions(&self) -> Vec<PathBuf> {
        let named: Vec<PathBuf> = self.paths().filter(|path| import::is_motion(path)).cloned().collect();
        if named.is_empty() { self.paths().take(1).cloned().collect() } else { named }
    }
}

/// What becomes the clip.
pub struct Chosen {
    /// The motion: the first body, or the first face if there is no body. It gives the clip its name.
    pub motion: PathBuf,
    /// A face to add to a body.
    pub face: Option<PathBuf>,
    /// Which files are left out.
    pub notes: Vec<Note>,
}

/// Chooses the motion and its face.
pub fn choose(given: &Given, asked: &Asked) -> Result<Chosen, Error> {
    let motions = given.motions();
    let mut notes = unused(given, &motions);
    let (first, others) = motions.split_first().ok_or_else(|| Error::source("no file"))?;
    let [mut body, mut face] = [None, None];
    if others.is_empty() {
        return Ok(Chosen { motion: first.clone(), face, notes });
    }
    for path in &motions {
        let read = asked.recipe(path).and_then(|recipe| import::import(given.files(), path, &recipe.import));
        match read {
            Err(error) if path == first => return Err(error),
            Err(error) => notes.push(left_out(path, &error)),
            Ok(read) => {
                let (kind, place) = if is_body(&read.motion) { ("body", &mut body) } else { ("face", &mut face) };
                match place {
                    None => *place = Some(path.clone()),
                    Some(_) => {
                        let text = format!("left out: one {kind} can be converted at a time");
                        notes.push(Note::warning(NoteKind::Sources, text).in_file(path));
                    }
                }
            }
        }
    }
    // The first file has become one of the two.
    let motion = body.or_else(|| face.take()).unwrap_or_else(|| first.clone());
    Ok(Chosen { motion, face, notes })
}

/// A motion that cannot be used, and why.
pub fn left_out(path: &Path, error: &Error) -> Note {
    let note = Note::warning(NoteKind::Sources, format!("left out: {error}")).in_file(path);
    match error.problem().remedy {
        Some(remedy) => note.remedy(remedy),
        None => note,
    }
}

/// A face that was added.
pub fn together(face: &Path) -> Note {
    Note::info(NoteKind::Sources, "body and face are one clip").in_file(face)
}

fn is_body(motion: &Motion) -> bool {
    motion.rig.joint_channels() > 0
}

/// The files that are no motion, and that no motion names: a skeleton belongs to any motion that has none of its own.
fn unused(given: &Given, motions: &[PathBuf]) -> Vec<Note> {
    let named = |name: &str| {
        let encoded = name.replace(' ', "%20");
        let among = given.list.iter().filter(|(path, _)| motions.contains(path));
        among
            .into_iter()
            .any(|(_, bytes)| [name, &encoded].iter().any(|name| bytes.windows(name.len()).any(|part| part == name.as_bytes())))
    };
    let ends = |path: &Path, wanted: &str| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted));
    let is_skeleton = |path: &Path| ends(path, "asf") && motions.iter().any(|motion| ends(motion, "amc"));
    let others = given.paths().filter(|path| !motions.contains(path) && !is_skeleton(path));
    let unused = others.filter(|path| !path.as_os_str().is_empty() && !named(&path.to_string_lossy()));
    unused.map(|path| Note::warning(NoteKind::Sources, "left out: nothing refers to it").in_file(path)).collect()
}

//! AMC, Acclaim's motion: frame by frame, a line for each bone, of a skeleton in another file (ASF).
//!
//! The skeleton is the one given, else, in the same folder, the .asf of the same name, else the one with the longest name that
//! the motion's name begins with (`09.asf` for `09_12.amc`), else the one that the motion's first comment names.
//! `acclaim` tells what becomes of the bones.

use super::acclaim::{self, Dof, Skeleton};
use super::text::{Words, shown};
use super::{Request, Source, asf};
use crate::error::Error;
use crate::note::{Note, NoteKind, Remedy};
use anyhow::Result;
use std::path::{Path, PathBuf};

/// CMU's rate, which its files do not state.
const USUAL_FPS: f64 = 120.0;

/// Whether `head` begins an AMC file.
pub fn begins(head: &[u8]) -> bool {
    head.starts_with(b"#!OML:ASF") || head.to_ascii_lowercase().windows(16).any(|word| word == b":fully-specified")
}

/// Reads the AMC file `path` and its ASF file, which states the unit of length.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let bytes = options.read(path)?;
    let (skeleton_path, content) = match &options.skeleton {
        Some(given) => (given.clone(), options.read(given)?),
        None => {
            let found = find_skeleton(path, &bytes, options)?;
            let content = options.read_named(&found)?;
            (found, content)
        }
    };
    let skeleton = asf::read(&skeleton_path, &content)?;
    let mut notes = skeleton.notes.clone();
    if skeleton_path.file_stem() != path.file_stem() {
        let note = Note::warning(NoteKind::Skeleton, format!("the skeleton is {}", skeleton_path.display()));
        notes.push(note.in_file(&skeleton_path).remedy(Remedy::ChooseSkeleton));
    }
    let mut words = Words::new(path, &bytes);
    let mut reader = FrameParser::new(&skeleton);
    while let Some(line) = words.next_line() {
        reader.line(&words, &line)?;
    }
    reader.end_frame(&words)?;
    if reader.frames == 0 {
        return Err(words.error("no frames; expected a line with the number 1"));
    }
    let fps = reader.fps.or(options.fps).unwrap_or_else(|| {
        let note = Note::warning(NoteKind::FrameRate, format!("the format states no frame rate, so {USUAL_FPS} a second"));
        notes.push(note.remedy(Remedy::ChangeFrameRate));
        USUAL_FPS
    });
    let motion = acclaim::motion(&skeleton, &reader.values, reader.frames, 1.0 / fps, &mut notes);
    Ok(Source { unit_known: skeleton.cm_per_unit.is_some(), ..Source::plain(motion, notes) })
}

/// The skeletons in the folder of the motion `path`.
pub(super) fn skeletons(path: &Path, options: &Request) -> Result<Vec<PathBuf>> {
    let is_asf = |path: &Path| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("asf"));
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut beside = options.beside(folder)?;
    beside.retain(|path| is_asf(path));
    beside.sort();
    Ok(beside)
}

fn find_skeleton(path: &Path, bytes: &[u8], options: &Request) -> Result<PathBuf> {
    let lower = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let beside = skeletons(path, options)?;
    let stem = lower(path);
    // The same name is the longest that the motion's begins with.
    let by_name = beside.iter().filter(|skeleton| stem.starts_with(&lower(skeleton)));
    if let Some(found) = by_name.max_by_key(|skeleton| lower(skeleton).len()) {
        return Ok(found.clone());
    }
    let comment = named(bytes);
    let by_comment = comment.as_ref().and_then(|named| beside.iter().find(|skeleton| lower(skeleton) == lower(Path::new(named))));
    by_comment.cloned().ok_or_else(|| {
        let looked = comment.map_or_else(
            || format!("no {stem}.asf"),
            |named| format!("neither {stem}.asf nor the `{named}` that the file names"),
        );
        let text = format!("{}:1: no skeleton beside it: {looked}", path.display());
        Error::source(text).remedy(Remedy::GiveSkeleton).into()
    })
}

/// The file that a first line like `#!OML:ASF C:\folder\figure.ASF` names.
fn named(bytes: &[u8]) -> Option<String> {
    let line = bytes.split(|&byte| byte == b'\n' || byte == b'\r').next()?;
    let line = String::from_utf8_lossy(line);
    let name = line.strip_prefix("#!OML:ASF")?.rsplit(['\\', '/']).next()?.trim();
    (!name.is_empty()).then(|| name.to_string())
}

struct FrameParser<'a> {
    skeleton: &'a Skeleton,
    /// Factor that makes degrees of a rotation.
    to_degrees: f64,
    /// Index in `values` of each bone's first.
    firsts: Vec<usize>,
    /// `values[value][frame]`, bone by bone.
    values: Vec<Vec<f64>>,
    /// Which bones the open frame has.
    seen: Vec<bool>,
    /// Number and line of the open frame.
    open: Option<(usize, usize)>,
    frames: usize,
    fps: Option<f64>,
}

impl<'a> FrameParser<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let firsts = skeleton.bones.iter().scan(0, |next, bone| {
            let first = *next;
            *next += bone.dofs.len();
            Some(first)
        });
        let total = skeleton.bones.iter().map(|bone| bone.dofs.len()).sum();
        FrameParser {
            skeleton,
            to_degrees: if skeleton.radians { 1f64.to_degrees() } else { 1.0 },
            firsts: firsts.collect(),
            values: vec![Vec::new(); total],
            seen: vec![false; skeleton.bones.len()],
            open: None,
            frames: 0,
            fps: None,
        }
    }

    fn line(&mut self, words: &Words, line: &[&[u8]]) -> Result<()> {
        if line[0].starts_with(b":") {
            return self.header(words, line);
        }
        if line[0].iter().all(u8::is_ascii_digit) && line.len() == 1 {
            return self.frame(words, line[0]);
        }
        self.bone(words, line)
    }

    fn header(&mut self, words: &Words, line: &[&[u8]]) -> Result<()> {
        if self.open.is_some() {
            return Err(words.error(format!("{} stands after the first frame", shown(Some(line[0])))));
        }
        match line[0].to_ascii_lowercase().as_slice() {
            b":degrees" => self.to_degrees = 1.0,
            b":radians" => self.to_degrees = 1f64.to_degrees(),
            b":samples-per-second" => {
                let word = line.get(1).ok_or_else(|| words.error("expected a number after `:samples-per-second`"))?;
                let fps = words.number_from(word)?;
                self.fps = Some(fps).filter(|&fps| fps > 0.0);
            }
            _ => {}
        }
        Ok(())
    }

    fn frame(&mut self, words: &Words, word: &[u8]) -> Result<()> {
        self.end_frame(words)?;
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse::<usize>().ok());
        let expected = self.open.map(|(before, _)| before + 1);
        match number {
            Some(number) if number < usize::MAX && expected.is_none_or(|expected| number == expected) => {
                self.open = Some((number, words.line()));
                Ok(())
            }
            _ => {
                let expected = expected.map_or_else(|| "a frame number".into(), |expected| format!("frame {expected}"));
                Err(words.error(format!("expected {expected}, found {}", shown(Some(word)))))
            }
        }
    }

    fn bone(&mut self, words: &Words, line: &[&[u8]]) -> Result<()> {
        let name = shown(Some(line[0]));
        let Some((number, _)) = self.open else {
            return Err(words.error(format!("expected a line with a frame number, found {name}")));
        };
        let bones = &self.skeleton.bones;
        let Some(index) = bones.iter().position(|bone| bone.name.as_bytes().eq_ignore_ascii_case(line[0])) else {
            return Err(words.error(format!("no bone {name} in the skeleton")));
        };
        let dofs = &bones[index].dofs;
        if dofs.len() != line.len() - 1 {
            let (expected, found) = (dofs.len(), line.len() - 1);
            return Err(words.error(format!("expected {expected} values for the bone {name}, found {found}")));
        }
        if std::mem::replace(&mut self.seen[index], true) {
            return Err(words.error(format!("a second line of the bone {name} in frame {number}")));
        }
        for (value, (dof, word)) in dofs.iter().zip(&line[1..]).enumerate() {
            let factor = if matches!(dof, Dof::Rotation(_)) { self.to_degrees } else { 1.0 };
            self.values[self.firsts[index] + value].push(words.number_from(word)? * factor);
        }
        Ok(())
    }

    fn end_frame(&mut self, words: &Words) -> Result<()> {
        let Some((number, line)) = self.open else { return Ok(()) };
        let mut unseen = self.skeleton.bones.iter().zip(&self.seen).filter(|(_, seen)| !**seen).map(|(bone, _)| bone);
        if let Some(bone) = unseen.find(|bone| !bone.dofs.is_empty()) {
            return Err(words.error_at(line, format!("frame {number} has no line of the bone `{}`", bone.name)));
        }
        self.seen.fill(false);
        self.frames += 1;
        Ok(())
    }
}

//! ASF, Acclaim's skeleton: bones with a direction, a length and axes of their own, and the values a motion gives each of them.
//!
//! Read: the units of length and angle, the root, bones, hierarchy. Not used: mass, limits, skin, notes.
//! One unit of length is an inch over `length`, so CMU's 0.45 makes 5.6444 cm; `length 1` stands in files of any unit and is
//! taken to say nothing.

use super::acclaim::{Bone, Dof, Skeleton};
use super::text::{Words, shown};
use crate::fk::{IDENTITY, about, product};
use crate::note::{Note, NoteKind};
use anyhow::Result;
use pantin::codec::layout::MAX_JOINTS;
use std::path::Path;

const INCH_CM: f64 = 2.54;
/// Lines that are not read, by their names, of which the first ones are reported.
const MOST_UNREAD: usize = 100;

/// A bone as its lines give it.
#[derive(Default)]
struct Entry {
    line: usize,
    name: String,
    direction: Option<[f64; 3]>,
    length: Option<f64>,
    angles: [f64; 3],
    order: Vec<usize>,
    dofs: Vec<Dof>,
    parent: Option<usize>,
}

#[derive(Default)]
struct File {
    /// The root first.
    entries: Vec<Entry>,
    position: [f64; 3],
    length: Option<f64>,
    radians: bool,
    /// Names of lines that are not read.
    unread: Vec<String>,
}

/// Reads the ASF file `path`, whose content is `bytes`.
pub fn read(path: &Path, bytes: &[u8]) -> Result<Skeleton> {
    let mut words = Words::new(path, bytes);
    let mut file = File { entries: vec![Entry { name: "root".into(), ..Entry::default() }], ..File::default() };
    let mut section = String::new();
    while let Some(line) = words.next_line() {
        let key = String::from_utf8_lossy(line[0]).to_ascii_lowercase();
        match (section.as_str(), key.as_str()) {
            (_, key) if key.starts_with(':') => section = key.to_string(),
            (":units", "length") => file.length = Some(unit(&words, &line[1..])?),
            (":units", "angle") => file.radians = is_radians(&words, line.get(1))?,
            (":root", "position") => file.position = numbers(&words, &line[1..])?,
            (":root", key) => root_line(&words, &mut file.entries[0], key, &line[1..])?,
            (":bonedata", "begin") if file.entries.len() >= MAX_JOINTS => {
                return Err(words.error(format!("more than {MAX_JOINTS} bones, which a rig cannot hold")));
            }
            (":bonedata", "begin") => file.entries.push(Entry { line: words.line(), ..Entry::default() }),
            (":bonedata", key) => bone_line(&words, &mut file, key, &line)?,
            (":hierarchy", "begin" | "end") => {}
            (":hierarchy", _) => children(&words, &mut file.entries, &line)?,
            _ => {}
        }
    }
    file.skeleton(&words)
}

fn unit(words: &Words, values: &[&[u8]]) -> Result<f64> {
    match numbers(words, values)? {
        [length] if length > 0.0 => Ok(length),
        [length] => Err(words.error(format!("expected a length above 0 in `:units`, found {length}"))),
    }
}

fn is_radians(words: &Words, word: Option<&&[u8]>) -> Result<bool> {
    match word {
        Some(word) if word.eq_ignore_ascii_case(b"deg") => Ok(false),
        Some(word) if word.eq_ignore_ascii_case(b"rad") => Ok(true),
        _ => Err(words.error(format!("expected `deg` or `rad` after `angle`, found {}", at_line_end(word)))),
    }
}

fn at_line_end(word: Option<&&[u8]>) -> String {
    word.map_or_else(|| "the end of the line".into(), |word| shown(Some(word)))
}

fn numbers<const N: usize>(words: &Words, values: &[&[u8]]) -> Result<[f64; N]> {
    let mut out = [0.0; N];
    if values.len() != N {
        return Err(words.error(format!(
            "expected {N} number{} after the keyword, found {}",
            if N == 1 { "" } else { "s" },
            values.len()
        )));
    }
    for (out, word) in out.iter_mut().zip(values) {
        *out = words.number_from(word)?;
    }
    Ok(out)
}

fn root_line(words: &Words, root: &mut Entry, key: &str, values: &[&[u8]]) -> Result<()> {
    match key {
        "order" => root.dofs = dofs(words, values)?,
        "axis" => root.order = order(words, values.first())?,
        "orientation" => root.angles = numbers(words, values)?,
        _ => {}
    }
    Ok(())
}

fn bone_line(words: &Words, file: &mut File, key: &str, line: &[&[u8]]) -> Result<()> {
    let values = &line[1..];
    let Some(bone) = file.entries.last_mut().filter(|bone| bone.line > 0) else {
        return Err(words.error(format!("expected `begin` after `:bonedata`, found {}", shown(Some(line[0])))));
    };
    match key {
        "name" => {
            let name = values.first().ok_or_else(|| words.error("expected a name after `name`"))?;
            bone.name = String::from_utf8_lossy(name).into_owned();
            let known = file.entries.iter().filter(|entry| entry.name.as_bytes().eq_ignore_ascii_case(name)).count();
            if known > 1 {
                return Err(words.error(format!("a second bone {}", shown(Some(name)))));
            }
        }
        "direction" => bone.direction = Some(numbers(words, values)?),
        "length" => bone.length = Some(numbers::<1>(words, values)?[0]),
        "axis" => {
            bone.angles = numbers(words, values.get(..3).unwrap_or(values))?;
            bone.order = order(words, values.get(3))?;
        }
        "dof" => bone.dofs = dofs(words, values)?,
        "end" if bone.name.is_empty() || bone.direction.is_none() || bone.length.is_none() => {
            let begun = bone.line;
            return Err(words.error(format!("the bone that begins at line {begun} needs a name, a direction and a length")));
        }
        "end" | "id" | "limits" | "bodymass" | "cofmass" => {}
        // The limits of further values stand on lines of their own.
        _ if key.parse::<f64>().is_ok() => {}
        _ if file.unread.len() >= MOST_UNREAD || file.unread.iter().any(|unread| unread == key) => {}
        _ => file.unread.push(key.to_string()),
    }
    Ok(())
}

fn dofs(words: &Words, values: &[&[u8]]) -> Result<Vec<Dof>> {
    let mut dofs = Vec::new();
    for word in values {
        let dof = match word.to_ascii_lowercase().as_slice() {
            [b't', axis @ b'x'..=b'z'] => Dof::Translation((axis - b'x').into()),
            [b'r', axis @ b'x'..=b'z'] => Dof::Rotation((axis - b'x').into()),
            b"l" => Dof::Length,
            _ => return Err(words.error(format!("expected tx, ty, tz, rx, ry, rz or l, found {}", shown(Some(word))))),
        };
        if dofs.contains(&dof) {
            return Err(words.error(format!("{} stands twice", shown(Some(word)))));
        }
        dofs.push(dof);
    }
    Ok(dofs)
}

/// `XYZ` and the like.
fn order(words: &Words, word: Option<&&[u8]>) -> Result<Vec<usize>> {
    let letters = word.map(|word| word.to_ascii_lowercase()).unwrap_or_default();
    let mut sorted = letters.clone();
    sorted.sort_unstable();
    if sorted != b"xyz" {
        return Err(words.error(format!("expected an order of axes like XYZ, found {}", at_line_end(word))));
    }
    Ok(letters.iter().map(|letter| usize::from(letter - b'x')).collect())
}

fn children(words: &Words, entries: &mut [Entry], line: &[&[u8]]) -> Result<()> {
    let find = |word: &[u8]| entries.iter().position(|entry| entry.name.as_bytes().eq_ignore_ascii_case(word));
    let unknown = |word: &[u8]| words.error(format!("no bone {} in `:bonedata`", shown(Some(word))));
    let parent = find(line[0]).ok_or_else(|| unknown(line[0]))?;
    let found: Result<Vec<usize>> = line[1..].iter().map(|word| find(word).ok_or_else(|| unknown(word))).collect();
    for child in found? {
        if child == 0 || entries[child].parent.is_some() {
            return Err(words.error(format!("`{}` has a parent already", entries[child].name)));
        }
        entries[child].parent = Some(parent);
    }
    Ok(())
}

impl File {
    fn skeleton(self, words: &Words) -> Result<Skeleton> {
        if self.entries.len() == 1 {
            return Err(words.error("no bones; expected an ASF file with `:bonedata` and `:hierarchy`"));
        }
        if self.entries[0].dofs.is_empty() {
            return Err(words.error("expected `order` in `:root`: which values a motion gives the root"));
        }
        let mut places = vec![None; self.entries.len()];
        let mut bones = Vec::new();
        // Depth first, brothers in the file's order.
        let mut left = vec![0];
        while let Some(index) = left.pop() {
            places[index] = Some(bones.len());
            let parent = self.entries[index].parent.and_then(|parent| places[parent]);
            bones.push(self.entries[index].bone(parent, self.radians));
            left.extend((0..self.entries.len()).rev().filter(|&child| self.entries[child].parent == Some(index)));
        }
        if let Some(lost) = places.iter().position(|place| place.is_none()) {
            let Entry { name, line, .. } = &self.entries[lost];
            return Err(words.error_at(*line, format!("`:hierarchy` does not join the bone `{name}` to the root")));
        }
        let mut notes = Vec::new();
        if !self.unread.is_empty() {
            let text = format!("the skeleton's bones say `{}`, which is not read", self.unread.join("`, `"));
            notes.push(Note::warning(NoteKind::Unread, text));
        }
        let cm_per_unit = self.length.filter(|&length| length != 1.0).map(|length| INCH_CM / length);
        Ok(Skeleton { bones, position: self.position, cm_per_unit, radians: self.radians, notes })
    }
}

impl Entry {
    fn bone(&self, parent: Option<usize>, radians: bool) -> Bone {
        let angle = |axis: usize| if radians { self.angles[axis] } else { self.angles[axis].to_radians() };
        // The angles are those about x, y and z; the letters tell their order about fixed axes, so the last is the leftmost factor.
        let axes = self.order.iter().fold(IDENTITY, |turned, &axis| product(&about(axis, angle(axis)), &turned));
        let (direction, length) = (self.direction.unwrap_or_default(), self.length.unwrap_or_default());
        Bone { name: self.name.clone(), parent, vector: direction.map(|x| x * length), axes, dofs: self.dofs.clone() }
    }
}

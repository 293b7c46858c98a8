//! BVH: a hierarchy of joints, then one row of channel values a frame.
//!
//! White space is free, as other readers have it: a row may span lines and a line may hold rows.

use super::text::{Words, shown};
use super::{Request, Source, ends};
use crate::error::with_remedy;
use crate::motion::{Joint, Kind, Motion, Rig};
use crate::note::{Note, NoteKind, Remedy};
use anyhow::Result;
use pantin::codec::layout::MAX_JOINTS;
use std::collections::HashSet;
use std::path::Path;

/// Whether `head` begins a BVH file.
pub fn begins(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    head.get(..9).is_some_and(|word| word.eq_ignore_ascii_case(b"HIERARCHY"))
}

/// Reads the BVH file `path`. The format states no unit of length.
pub fn read(path: &Path, options: &Request) -> Result<Source> {
    let bytes = options.read(path)?;
    let mut words = Words::new(path, &bytes);
    let (rig, mut notes) = figure(&mut words)?;
    let header = header(&mut words, options)?;
    let values = rows(&mut words, &header, rig.channels(), &mut notes)?;
    let keys = vec![None; values.len()];
    let motion = Motion {
        rig,
        frame_time: header.frame_time,
        frames: header.frames,
        values,
        keys,
        looped: false,
        events: Vec::new(),
        origin: Default::default(),
    };
    Ok(Source::plain(motion, notes))
}

/// Reads the figure, and what is odd about it.
pub(super) fn figure(words: &mut Words) -> Result<(Rig, Vec<Note>)> {
    words.expect("HIERARCHY", "at the start of a BVH file")?;
    let mut rig = hierarchy(words)?;
    let mut notes: Vec<Note> = repeated_names(&rig).into_iter().chain(repeated_channels(&rig)).collect();
    notes.extend(ends::complete(&mut rig.joints));
    Ok((rig, notes))
}

/// A joint whose closing brace is still to come.
struct Open {
    index: usize,
    line: usize,
    has_offset: bool,
    has_channels: bool,
}

fn hierarchy(words: &mut Words) -> Result<Rig> {
    words.expect("ROOT", "after HIERARCHY")?;
    let mut joints = Vec::new();
    let mut open = vec![begin_joint(words, &mut joints, None, false)?];
    while let Some(joint) = open.last_mut() {
        let word = words.next();
        let keyword = word.unwrap_or_default().to_ascii_uppercase();
        let end_site = joints[joint.index].end_site;
        match keyword.as_slice() {
            b"OFFSET" => {
                for axis in 0..3 {
                    joints[joint.index].offset[axis] = words.number("three numbers after OFFSET")?;
                }
                joint.has_offset = true;
            }
            b"CHANNELS" if !end_site && !joint.has_channels => {
                joints[joint.index].kinds = channels(words)?;
                joint.has_channels = true;
            }
            b"JOINT" if !end_site => {
                let parent = joint.index;
                open.push(begin_joint(words, &mut joints, Some(parent), false)?);
            }
            b"END" if !end_site => {
                let parent = joint.index;
                open.push(begin_joint(words, &mut joints, Some(parent), true)?);
            }
            b"}" => {
                if !joint.has_offset {
                    return Err(words.error(format!("no OFFSET in the joint that begins at line {}", joint.line)));
                }
                open.pop();
            }
            _ => return Err(unexpected(words, word, joint, end_site)),
        }
    }
    match words.peek() {
        Some(word) if word.eq_ignore_ascii_case(b"ROOT") => {
            words.next();
            Err(words.error("a second ROOT; a clip holds one figure, so split the file"))
        }
        _ => Ok(Rig { joints, scalars: Vec::new(), cm_per_unit: 1.0, ..Rig::default() }),
    }
}

fn unexpected(words: &Words, word: Option<&[u8]>, joint: &Open, end_site: bool) -> anyhow::Error {
    let (what, expected) = match (end_site, joint.has_channels) {
        (true, _) => ("End Site", "OFFSET or `}`"),
        (false, true) => ("joint", "OFFSET, JOINT, End Site or `}`"),
        (false, false) => ("joint", "OFFSET, CHANNELS, JOINT, End Site or `}`"),
    };
    words.error(format!("expected {expected} in the {what} that begins at line {}, found {}", joint.line, shown(word)))
}

fn begin_joint(words: &mut Words, joints: &mut Vec<Joint>, parent: Option<usize>, end_site: bool) -> Result<Open> {
    let line = words.line();
    let name = words.rest_of_name();
    if name.is_empty() && !end_site {
        return Err(words.error("expected a name after ROOT or JOINT"));
    }
    words.expect("{", "after the joint's name")?;
    let name = if end_site { String::new() } else { name };
    if joints.len() == MAX_JOINTS {
        return Err(words.error(format!("more than {MAX_JOINTS} joints and End Sites, which a rig cannot hold")));
    }
    joints.push(Joint { name, parent, offset: [0.0; 3], kinds: Vec::new(), end_site, helper: false });
    Ok(Open { index: joints.len() - 1, line, has_offset: false, has_channels: false })
}

fn channels(words: &mut Words) -> Result<Vec<Kind>> {
    let word = words.next();
    let count = word.and_then(|word| std::str::from_utf8(word).ok()?.parse::<usize>().ok());
    let count = count.ok_or_else(|| words.error(format!("expected a count after CHANNELS, found {}", shown(word))))?;
    let mut kinds = Vec::new();
    while let Some(kind) = words.peek().and_then(kind) {
        words.next();
        kinds.push(kind);
    }
    let twice = |at: &usize| kinds[*at].is_position() && kinds[..*at].contains(&kinds[*at]);
    if let Some(at) = (1..kinds.len()).find(twice) {
        return Err(words.error(format!("the joint has the channel {:?} twice", kinds[at])));
    }
    if kinds.len() != count {
        let after = shown(words.peek());
        return Err(words.error(format!("CHANNELS says {count}, but {} channel names stand before {after}", kinds.len())));
    }
    Ok(kinds)
}

fn kind(word: &[u8]) -> Option<Kind> {
    let all = [
        ("Xposition", Kind::Xposition),
        ("Yposition", Kind::Yposition),
        ("Zposition", Kind::Zposition),
        ("Xrotation", Kind::Xrotation),
        ("Yrotation", Kind::Yrotation),
        ("Zrotation", Kind::Zrotation),
    ];
    all.iter().find(|(name, _)| word.eq_ignore_ascii_case(name.as_bytes())).map(|&(_, kind)| kind)
}

fn repeated_names(rig: &Rig) -> Option<Note> {
    let mut seen = HashSet::new();
    let names = rig.joints.iter().filter(|joint| !joint.end_site).map(|joint| joint.name.as_str());
    let repeated: Vec<&str> = names.filter(|&name| !seen.insert(name)).collect();
    let first = repeated.first()?;
    let text =
        format!("{} joint names stand more than once (`{first}` is one); joints are told apart by their place", repeated.len());
    Some(Note::warning(NoteKind::Names, text).of_joint(*first))
}

/// Rotations about one axis before and after one about another are a way to turn a joint; other programs may take only the last.
fn repeated_channels(rig: &Rig) -> Option<Note> {
    let of_joint = |joint: &Joint| {
        let at = (1..joint.kinds.len()).find(|&at| joint.kinds[..at].contains(&joint.kinds[at]))?;
        Some((joint.name.clone(), joint.kinds[at]))
    };
    let repeated: Vec<(String, Kind)> = rig.joints.iter().filter_map(of_joint).collect();
    let (name, kind) = repeated.first()?;
    let text = format!(
        "{} joints have a rotation twice (`{name}` has {kind:?}); all of a joint's rotations apply, in their order",
        repeated.len()
    );
    Some(Note::warning(NoteKind::Joints, text).of_joint(name))
}

/// What stands between MOTION and the rows.
struct Header {
    frames: usize,
    /// Line of `Frames:`.
    line: usize,
    frame_time: f64,
}

fn header(words: &mut Words, options: &Request) -> Result<Header> {
    words.expect("MOTION", "after the hierarchy")?;
    words.expect("Frames", "after MOTION")?;
    words.accept(":");
    let word = words.next();
    let frames = word.and_then(|word| std::str::from_utf8(word).ok()?.parse::<usize>().ok()).filter(|&frames| frames > 0);
    let frames = frames
        .ok_or_else(|| words.error(format!("expected a number of frames from 1 after `Frames:`, found {}", shown(word))))?;
    let line = words.line();
    words.expect("Frame", "after the number of frames")?;
    words.expect("Time", "after `Frame`")?;
    words.accept(":");
    let stated = words.number("the seconds a frame after `Frame Time:`")?;
    let frame_time = match options.fps {
        _ if stated > 0.0 => stated,
        Some(fps) => 1.0 / fps,
        None => {
            let error = words.error(format!("expected a frame time above 0, found {stated}"));
            return Err(with_remedy(&error, Remedy::StateFrameRate));
        }
    };
    Ok(Header { frames, line, frame_time })
}

/// How the numbers lie on lines: tells a row of a wrong length from rows that are laid out freely.
#[derive(Default)]
struct Layout {
    line: usize,
    numbers: usize,
    lines: usize,
    exact: usize,
    /// First line whose numbers are not one row: its index among the lines, its line, its numbers.
    odd: Option<(usize, usize, usize)>,
}

impl Layout {
    fn number(&mut self, line: usize, channels: usize) {
        if line != self.line {
            self.end_line(channels);
            self.line = line;
        }
        self.numbers += 1;
    }

    fn end_line(&mut self, channels: usize) {
        if self.numbers == channels {
            self.exact += 1;
        } else if self.numbers > 0 && self.odd.is_none() {
            self.odd = Some((self.lines, self.line, self.numbers));
        }
        self.lines += usize::from(self.numbers > 0);
        self.numbers = 0;
    }

    /// The first line that breaks a layout of one row a line, if that is how `frames` rows are laid out.
    fn broken(&self, frames: usize) -> Option<(usize, usize)> {
        let by_line = self.lines == frames || self.exact * 2 > self.lines;
        self.odd.filter(|&(index, ..)| by_line && index < frames).map(|(_, line, numbers)| (line, numbers))
    }
}

fn rows(words: &mut Words, header: &Header, channels: usize, notes: &mut Vec<Note>) -> Result<Vec<Vec<f64>>> {
    let frames = header.frames;
    if channels == 0 {
        return Err(words.error_at(header.line, "no joint has CHANNELS, so nothing can move"));
    }
    let mut values = vec![Vec::new(); channels];
    let mut layout = Layout::default();
    let mut whole = 0;
    'frames: while whole < frames {
        for (channel, column) in values.iter_mut().enumerate() {
            let Some(number) = words.next_number()? else {
                layout.end_line(channels);
                return Err(too_few(words, header, channels, whole, channel, &layout));
            };
            layout.number(words.line(), channels);
            column.push(number);
            if channel + 1 == channels {
                whole += 1;
                continue 'frames;
            }
        }
    }
    let mut extra = 0usize;
    while words.next_raw().is_some() {
        layout.number(words.line(), channels);
        extra += 1;
    }
    layout.end_line(channels);
    if extra > 0 {
        if let Some((line, numbers)) = layout.broken(frames) {
            return Err(words.error_at(line, format!("expected {channels} numbers, one a channel, found {numbers}")));
        }
        let more = extra as f64 / channels as f64;
        let text = format!("`Frames: {frames}`, but the data hold {} frames; the rest is left out", frames as f64 + more);
        notes.push(Note::warning(NoteKind::Frames, text).at_line(header.line));
    }
    Ok(values)
}

fn too_few(words: &Words, header: &Header, channels: usize, whole: usize, part: usize, layout: &Layout) -> anyhow::Error {
    let frames = header.frames;
    let rest = if part == 0 { String::new() } else { format!(" and {part} of {channels} values") };
    let cause = match layout.broken(frames) {
        Some((line, numbers)) => format!("; line {line} holds {numbers} numbers where a row has {channels}"),
        None => String::new(),
    };
    words.error_at(header.line, format!("`Frames: {frames}`, but the data end after {whole} frames{rest}{cause}"))
}

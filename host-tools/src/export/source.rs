//! Writes a clip's bytes as source text of firmware: a C header or a Rust module.

use crate::facts::MemoryNeeds;
use anyhow::Result;
use pantin::Clip;
use std::fmt::Write as _;

/// Bytes a line of a C header and of a Rust module.
const PER_LINE: usize = 20;

/// What firmware needs to know of a clip before it plays.
struct Facts {
    frames: u32,
    frame_time_ns: u32,
    memory: MemoryNeeds,
    /// `LeftKnee.Xexponential`, or a scalar's name: one for each channel of a pose.
    names: Vec<String>,
    /// A comment line each.
    lines: Vec<String>,
}

impl Facts {
    fn of(clip: &Clip, bytes: usize) -> Result<Facts> {
        let rig = clip.rig();
        let fps = 1e9 / f64::from(clip.frame_time_ns());
        let apart = if clip.rig_len() == 0 { "; its rig is apart" } else { "" };
        let mut lines = vec![
            format!("A pantin clip: {bytes} bytes, {} frames at {fps:.3} frames a second{apart}.", clip.frames()),
            "Channels, in the order of a pose, as the clip codes them:".into(),
        ];
        let mut names = Vec::new();
        for (index, joint) in rig.joints().enumerate() {
            let kinds: Vec<String> = clip.kinds(index).map(|kind| format!("{kind:?}")).collect();
            if !kinds.is_empty() {
                lines.push(format!("{:4} {}: {}", names.len(), plain(joint.name()), kinds.join(", ")));
            }
            names.extend(kinds.iter().map(|kind| format!("{}.{kind}", joint.name())));
        }
        for scalar in rig.scalars() {
            lines.push(format!("{:4} {}", names.len(), plain(scalar.name())));
            names.push(scalar.name().into());
        }
        let (frames, frame_time_ns) = (clip.frames(), clip.frame_time_ns());
        Ok(Facts { frames, frame_time_ns, memory: MemoryNeeds::of(clip)?, names, lines })
    }
}

/// A name that ends no comment and no line, and turns no text around.
fn plain(name: &str) -> String {
    // What `Debug` escapes does not print; compilers refuse some of it even in comments.
    let prints = |c: char| matches!(c, '\'' | '"') || c.escape_debug().len() == 1;
    let name: String = name.chars().map(|c| if prints(c) { c } else { '_' }).collect();
    name.replace("*/", "*_").replace("/*", "_*")
}

/// A string literal of C, in ASCII.
fn c_literal(name: &str) -> String {
    let escaped = name.bytes().map(|byte| match byte {
        b'"' | b'\\' | b'?' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        _ => format!("\\{byte:03o}"),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

/// `dance-2` as `DANCE_2`; a name that begins with no letter gets `CLIP_` before it.
fn identifier(stem: &str) -> String {
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("CLIP_{name}") }
}

fn rows(bytes: &[u8], indent: &str) -> String {
    let row = |row: &[u8]| format!("{indent}{},\n", row.iter().map(u8::to_string).collect::<Vec<_>>().join(", "));
    bytes.chunks(PER_LINE).map(row).collect()
}

/// A C header: the clip's bytes as `static const unsigned char STEM[]`, and constants for the memory that it takes.
pub fn c_header(clip: &Clip, bytes: &[u8], stem: &str) -> Result<String> {
    let name = identifier(stem);
    let facts = Facts::of(clip, bytes.len())?;
    let mut out = String::new();
    facts.lines.iter().for_each(|line| out.push_str(&format!("/* {line} */\n")));
    let MemoryNeeds { moving, channels, figure_joints, workspace } = facts.memory;
    let numbers = [
        ("LEN", bytes.len()),
        ("FRAMES", facts.frames as usize),
        ("FRAME_TIME_NS", facts.frame_time_ns as usize),
        ("CHANNELS", channels),
        ("MOVING", moving),
        ("FIGURE_JOINTS", figure_joints),
        ("WORKSPACE", workspace),
    ];
    let _ = write!(out, "#ifndef {name}_H\n#define {name}_H\n\n");
    numbers.iter().for_each(|(what, value)| out.push_str(&format!("#define {name}_{what} {value}\n")));
    let names: Vec<String> = facts.names.iter().map(|name| c_literal(name)).collect();
    let _ = write!(
        out,
        "/* Initializes an array of {name}_CHANNELS strings. */\n#define {name}_NAMES {}\n",
        names.join(", \\\n    ")
    );
    let _ = write!(out, "\nstatic const unsigned char {name}[{name}_LEN] = {{\n{}}};\n\n#endif\n", rows(bytes, "    "));
    Ok(out)
}

/// A Rust module: the clip's bytes as `pub static STEM`, and constants for the memory that it takes.
pub fn rust_module(clip: &Clip, bytes: &[u8], stem: &str) -> Result<String> {
    let name = identifier(stem);
    let facts = Facts::of(clip, bytes.len())?;
    let mut out = String::new();
    facts.lines.iter().for_each(|line| out.push_str(&format!("//! {line}\n")));
    let (frames, time) = (facts.frames, facts.frame_time_ns);
    let MemoryNeeds { moving, channels, figure_joints, workspace } = facts.memory;
    let names: String = facts.names.iter().map(|name| format!("    {name:?},\n")).collect();
    let _ = write!(
        out,
        "
/// Number of frames.
pub const {name}_FRAMES: u32 = {frames};
/// Nanoseconds from a frame to the next.
pub const {name}_FRAME_TIME_NS: u32 = {time};
/// Values of a pose.
pub const {name}_CHANNELS: usize = {channels};
/// Channel states that a player needs.
pub const {name}_MOVING: usize = {moving};
/// Joints of the figure: `N` of a `pantin_figure::FigureRenderer`. 0 if the clip has no figure.
pub const {name}_FIGURE_JOINTS: usize = {figure_joints};
/// Elements of the workspace that sets the figure up: one `pantin_figure::JointInfo` for each joint of the rig.
pub const {name}_WORKSPACE: usize = {workspace};
/// The name of each channel.
#[rustfmt::skip]
pub const {name}_NAMES: [&str; {name}_CHANNELS] = [
{names}];
/// The clip.
#[rustfmt::skip]
pub static {name}: [u8; {}] = [
{}];
",
        bytes.len(),
        rows(bytes, "    ")
    );
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_identifiers_and_end_no_comment() {
        assert_eq!(
            [identifier("dance-2"), identifier("2nd"), identifier("é"), identifier("")],
            ["DANCE_2", "CLIP_2ND", "CLIP__", "CLIP_"]
        );
        assert_eq!(plain("a*/b\n\\ 'é' \u{202e}"), "a*_b__ 'é' _");
        assert_eq!(c_literal("a\"\\?\né"), r#""a\"\\\?\012\303\251""#);
    }
}

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

/// What follows a clip's name in the names of its constants. A clip that ended so would share a name with another one's constant.
const SUFFIXES: [&str; 10] =
    ["_len", "_frames", "_frame_time_ns", "_channels", "_moving", "_figure_joints", "_workspace", "_names", "_id", "_h"];

/// The name of a clip's constants: `DANCE_2` for the stem `dance_2`. A stem that is no lower-case identifier is cleaned and gets eight
/// hexadecimal digits of its hash, so that different stems have different names: `DANCE_2_5E7D3A10` for `dance-2`.
fn identifier(stem: &str) -> String {
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let hashed =
        |stem: &str| stem.rsplit_once('_').is_some_and(|(_, end)| end.len() == 8 && end.chars().all(|c| c.is_ascii_hexdigit()));
    let plain = stem.starts_with(|c: char| c.is_ascii_lowercase())
        && stem.chars().all(letters)
        && !hashed(stem)
        && !SUFFIXES.iter().any(|suffix| stem.ends_with(suffix))
        && !KEYWORDS.contains(&stem)
        && stem.len() <= LONGEST_NAME;
    if plain {
        return stem.to_ascii_uppercase();
    }
    let clean = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    let name: String = stem.chars().take(LONGEST_NAME).map(clean).collect();
    let name = if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("N{name}") };
    format!("{}_{:08X}", name.trim_end_matches('_'), hash(stem.as_bytes()))
}

/// Longer names are cut: C compilers need not tell apart what differs later.
const LONGEST_NAME: usize = 40;
/// Lower-case words that are no identifiers in C or Rust, or mean something in upper case.
const KEYWORDS: [&str; 73] = [
    "abstract", "as", "asm", "async", "auto", "await", "become", "bool", "box", "break", "case", "char", "const", "continue",
    "crate", "default", "do", "double", "dyn", "else", "enum", "eof", "extern", "false", "final", "float", "fn", "for", "gen",
    "goto", "if", "impl", "in", "inline", "int", "let", "long", "loop", "macro", "main", "match", "mod", "move", "mut", "null",
    "override", "priv", "pub", "ref", "register", "restrict", "return", "self", "short", "signed", "sizeof", "static", "struct",
    "super", "switch", "trait", "true", "try", "type", "typedef", "typeof", "union", "unsafe", "unsigned", "use", "virtual",
    "void", "while",
];

/// FNV-1a with 32 bits.
fn hash(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash: u32, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

fn rows(bytes: &[u8], indent: &str) -> String {
    let row = |row: &[u8]| format!("{indent}{},\n", row.iter().map(u8::to_string).collect::<Vec<_>>().join(", "));
    bytes.chunks(PER_LINE).map(row).collect()
}

/// On an AVR, constants are in RAM unless they are declared to be in flash.
const FLASH: &str = "#ifdef __AVR__
#include <avr/pgmspace.h>
#define PANTIN_FLASH PROGMEM
#else
#define PANTIN_FLASH
#endif
";

/// A C header: the clip's bytes as `static const unsigned char CLIP_STEM[]`, and constants for the memory that it takes.
pub fn c_header(clip: &Clip, bytes: &[u8], stem: &str) -> Result<String> {
    // The prefix keeps names such as `EOF` away from those of other headers.
    let name = format!("CLIP_{}", identifier(stem));
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
    // Another clip with this name must not be left out silently, as a plain include guard would do.
    let id = hash(bytes);
    let _ = write!(
        out,
        "#if defined(PANTIN_{name}_ID) && PANTIN_{name}_ID != {id}\n#error \"two clips have the name {name}: rename one of their files\"\n#endif\n"
    );
    let _ = write!(out, "#ifndef PANTIN_{name}_H\n#define PANTIN_{name}_H\n#define PANTIN_{name}_ID {id}\n\n");
    numbers.iter().for_each(|(what, value)| out.push_str(&format!("#define {name}_{what} {value}\n")));
    let names: Vec<String> = facts.names.iter().map(|name| c_literal(name)).collect();
    let _ = write!(
        out,
        "/* Initializes an array of {name}_CHANNELS strings. */\n#define {name}_NAMES {}\n",
        names.join(", \\\n    ")
    );
    let _ = write!(
        out,
        "\n{FLASH}\nstatic const unsigned char {name}[{name}_LEN] PANTIN_FLASH = {{\n{}}};\n\n#endif\n",
        rows(bytes, "    ")
    );
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
        assert_eq!([identifier("dance_2"), identifier("walk")], ["DANCE_2", "WALK"]);
        let odd = ["dance-2", "Dance_2", "2nd", "é", "", "EOF", "while", "walk_frames", "dance_2_5E7D3A10", "_", "a\u{202e}b"];
        let names: std::collections::BTreeSet<String> = odd.iter().map(|stem| identifier(stem)).collect();
        assert_eq!(names.len(), odd.len());
        for name in names {
            assert!(name.starts_with(|c: char| c.is_ascii_uppercase()), "{name}");
            assert!(name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_'), "{name}");
            let digits = &name[name.len() - 9..];
            assert!(digits.starts_with('_') && digits[1..].chars().all(|c| c.is_ascii_hexdigit()), "{name}");
        }
        assert_eq!(plain("a*/b\n\\ 'é' \u{202e}"), "a*_b__ 'é' _");
        assert_eq!(c_literal("a\"\\?\né"), r#""a\"\\\?\012\303\251""#);
    }
}

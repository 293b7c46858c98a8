//! A clip's bytes as source text of firmware: a C header or a Rust module.

use pantin::Clip;
use std::fmt::Write as _;

/// Bytes a line of a C header and of a Rust module.
const PER_LINE: usize = 20;

/// What firmware wants to know of a clip before it plays.
struct Facts {
    frames: u32,
    frame_time_ns: u32,
    channels: usize,
    moving: usize,
    /// A comment line each.
    lines: Vec<String>,
}

impl Facts {
    fn of(clip: &Clip, bytes: usize) -> Facts {
        let rig = clip.rig();
        let fps = 1e9 / f64::from(clip.frame_time_ns());
        let apart = if clip.rig_len() == 0 { "; its rig is apart" } else { "" };
        let mut lines = vec![
            format!("A pantin clip: {bytes} bytes, {} frames at {fps:.3} frames a second{apart}.", clip.frames()),
            "Channels, in the order of a pose:".into(),
        ];
        let of_joints = rig.joints().filter(|joint| joint.kinds.count() > 0).map(|joint| {
            let kinds: Vec<String> = joint.kinds.map(|kind| format!("{kind:?}")).collect();
            (joint.first_channel.into(), format!("{}: {}", plain(joint.name()), kinds.join(", ")))
        });
        let first = rig.joint_channels();
        let of_scalars = rig.scalars().enumerate().map(|(index, scalar)| (first + index, plain(scalar.name())));
        lines.extend(of_joints.chain(of_scalars).map(|(index, name): (usize, String)| format!("{index:4} {name}")));
        Facts {
            frames: clip.frames(),
            frame_time_ns: clip.frame_time_ns(),
            channels: rig.channels(),
            moving: clip.moving(),
            lines,
        }
    }
}

/// A name that ends no comment and no line.
fn plain(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    name.replace("*/", "*_").replace("/*", "_*").replace('\\', "_")
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

/// A C header: the clip's bytes as `static const unsigned char STEM[]`, and its numbers.
pub fn c_header(clip: &Clip, bytes: &[u8], stem: &str) -> String {
    let name = identifier(stem);
    let facts = Facts::of(clip, bytes.len());
    let mut out = String::new();
    facts.lines.iter().for_each(|line| out.push_str(&format!("/* {line} */\n")));
    let numbers = [
        ("LEN", bytes.len().to_string()),
        ("FRAMES", facts.frames.to_string()),
        ("FRAME_TIME_NS", facts.frame_time_ns.to_string()),
        ("CHANNELS", facts.channels.to_string()),
        ("MOVING", facts.moving.to_string()),
    ];
    let _ = write!(out, "#ifndef {name}_H\n#define {name}_H\n\n");
    numbers.iter().for_each(|(what, value)| out.push_str(&format!("#define {name}_{what} {value}\n")));
    let _ = write!(out, "\nstatic const unsigned char {name}[{name}_LEN] = {{\n{}}};\n\n#endif\n", rows(bytes, "    "));
    out
}

/// A Rust module: the clip's bytes as `pub static STEM`, and what a player's memory must hold.
pub fn rust_module(clip: &Clip, bytes: &[u8], stem: &str) -> String {
    let name = identifier(stem);
    let facts = Facts::of(clip, bytes.len());
    let mut out = String::new();
    facts.lines.iter().for_each(|line| out.push_str(&format!("//! {line}\n")));
    let (frames, time) = (facts.frames, facts.frame_time_ns);
    let _ = write!(
        out,
        "
/// Number of frames.
pub const {name}_FRAMES: u32 = {frames};
/// Nanoseconds from a frame to the next.
pub const {name}_FRAME_TIME_NS: u32 = {time};
/// Values of a pose.
pub const {name}_CHANNELS: usize = {};
/// Channel states that a player needs.
pub const {name}_MOVING: usize = {};
/// The clip.
#[rustfmt::skip]
pub static {name}: [u8; {}] = [
{}];
",
        facts.channels,
        facts.moving,
        bytes.len(),
        rows(bytes, "    ")
    );
    out
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
        assert_eq!(plain("a*/b\n\\"), "a*_b__");
    }
}

//! BVH files as they come: what is broken gets one error with its line, what other readers accept is read as they read it.

use crate::told::Told;
use pantin_convert::import::ImportOptions;
use std::path::PathBuf;

const GOOD: &str = "HIERARCHY
ROOT hip
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT left knee
  {
    OFFSET 0 -45 0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 -45 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.01
1 2 3 4 5 6 7
1 2 3 4 5 6 8
";

fn load_bytes(name: &str, bytes: &[u8], options: &ImportOptions) -> anyhow::Result<Told> {
    let folder = std::env::temp_dir().join(format!("pantin-bvh-bad-input-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path: PathBuf = folder.join(format!("{name}.bvh"));
    std::fs::write(&path, bytes).unwrap();
    let loaded = crate::told::load(&path, options);
    std::fs::remove_file(&path).unwrap();
    loaded
}

fn load(name: &str, text: &str) -> anyhow::Result<Told> {
    load_bytes(name, text.as_bytes(), &ImportOptions::new())
}

/// The error for `text` is one line, begins with the file and `line`, and says `part`.
fn refused(name: &str, text: &str, line: usize, part: &str) {
    let error = format!("{:#}", load(name, text).expect_err(name));
    assert!(error.contains(&format!("{name}.bvh:{line}: ")), "{name}: no line {line} in: {error}");
    assert!(error.contains(part), "{name}: no `{part}` in: {error}");
    assert!(!error.contains('\n'), "{name}: several lines: {error}");
}

fn good_but(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from));
    GOOD.replacen(from, to, 1)
}

/// Reads as `GOOD` does.
fn same(name: &str, text: &str) {
    let expected = load(&format!("{name}-good"), GOOD).unwrap().motion;
    assert_eq!(load(name, text).unwrap_or_else(|error| panic!("{name}: {error:#}")).motion, expected, "{name}");
}

#[test]
fn a_good_file_is_read() {
    let Told { motion, warnings, .. } = load("good", GOOD).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!((motion.frames, motion.frame_time), (2, 0.01));
    assert_eq!(motion.values[6], [7.0, 8.0]);
    assert_eq!(motion.rig.joints[1].name, "left knee");
    assert!(motion.rig.joints[2].end_site && motion.rig.joints[2].name.is_empty());
}

#[test]
fn free_layout_reads_the_same() {
    same("crlf", &GOOD.replace('\n', "\r\n"));
    same("cr", &GOOD.replace('\n', "\r"));
    same("tabs", &GOOD.replace("  ", "\t"));
    same("spaces", &GOOD.replace(' ', "   "));
    same("bom", &format!("\u{feff}{GOOD}"));
    same("brace-beside-name", &good_but("left knee\n  {", "left knee{"));
    same("name-on-next-line", &good_but("ROOT hip", "ROOT\nhip"));
    same("end-site-with-name", &good_but("End Site", "End Site toe"));
    same("lower-case", &good_but("Zrotation Xrotation", "zrotation XROTATION"));
    same("exponents", &good_but("1 2 3 4 5 6 7", "1e0 +2 3. .4e1 50E-1 6 7"));
    same("colon-apart", &good_but("Frames: 2", "Frames : 2"));
    same("colon-glued", &good_but("Frame Time: 0.01", "Frame Time:0.01"));
    same("two-rows-on-a-line", &good_but("6 7\n1", "6 7 1"));
    same("row-over-lines", &GOOD.replace("3 4", "3\n4"));
    same("no-last-line-end", GOOD.trim_end());
}

#[test]
fn more_rows_than_the_header_says_warn() {
    for extra in ["1 2 3 4 5 6 9\n", "1 2 3 4 5 6 9\n1 2 3 4"] {
        let read = load("more", &format!("{GOOD}{extra}")).unwrap();
        assert_eq!(read.motion.frames, 2);
        assert!(read.warnings[0].contains("`Frames: 2`"), "{:?}", read.warnings);
    }
}

#[test]
fn fewer_rows_name_both_counts() {
    let text = good_but("Frames: 2", "Frames: 20");
    refused("fewer", &text, 17, "`Frames: 20`, but the data end after 2 frames");
    let part = GOOD.trim_end().trim_end_matches('8');
    refused("part", part, 17, "after 1 frames and 6 of 7 values; line 20 holds 6 numbers where a row has 7");
}

#[test]
fn rows_of_a_wrong_length_are_refused() {
    refused("long-rows", &GOOD.replace("5 6", "5 6 6"), 19, "expected 7 numbers, one a channel, found 8");
    refused("short-rows", &GOOD.replace("5 6", "5"), 17, "line 19 holds 6 numbers");
}

#[test]
fn every_truncation_is_refused() {
    let end = GOOD.trim_end().len();
    for len in 0..end {
        let error = format!("{:#}", load("truncated", &GOOD[..len]).expect_err(&GOOD[..len]));
        assert!(error.contains("truncated.bvh"), "{len}: {error}");
    }
}

#[test]
fn words_in_place_of_numbers_are_named() {
    refused("text", &good_but("5 6 8", "5 six 8"), 20, "expected a number, found `six`");
    refused("nan", &good_but("5 6 8", "5 nan 8"), 20, "expected a finite number");
    refused("inf", &good_but("5 6 8", "5 -inf 8"), 20, "expected a finite number");
    refused("huge", &good_but("5 6 8", "5 1e300 8"), 20, "expected a finite number");
    refused("comma", &good_but("5 6 8", "5 0,6 8"), 20, "found `0,6`");
    refused("offset", &good_but("OFFSET 0 -45 0", "OFFSET 0 -45"), 9, "expected a number, found `CHANNELS`");
    refused("frames", &good_but("Frames: 2", "Frames: two"), 17, "number of frames from 1 after `Frames:`, found `two`");
}

#[test]
fn times_and_counts_that_mean_nothing_are_refused() {
    refused("zero-time", &good_but("0.01", "0"), 18, "expected a frame time above 0, found 0; --fps gives the frames a second");
    refused("negative-time", &good_but("0.01", "-0.01"), 18, "frame time above 0");
    refused("no-frames", &good_but("Frames: 2", "Frames: 0"), 17, "from 1");
    refused("negative-frames", &good_but("Frames: 2", "Frames: -2"), 17, "from 1");
    let fps = ImportOptions::new().fps(50.0);
    assert_eq!(load_bytes("fps", good_but("0.01", "0").as_bytes(), &fps).unwrap().motion.frame_time, 0.02);
    assert_eq!(load_bytes("fps-unused", GOOD.as_bytes(), &fps).unwrap().motion.frame_time, 0.01);
}

#[test]
fn channel_lists_must_match_their_count() {
    refused("too-many", &good_but("CHANNELS 1", "CHANNELS 3"), 9, "CHANNELS says 3, but 1 channel names stand before `End`");
    refused("too-few", &good_but("CHANNELS 6", "CHANNELS 5"), 5, "CHANNELS says 5, but 6");
    refused("no-count", &good_but("CHANNELS 1", "CHANNELS"), 9, "expected a count after CHANNELS, found `Xrotation`");
    refused("unknown", &good_but("1 Xrotation", "1 Wrotation"), 9, "0 channel names stand before `Wrotation`");
    let none = good_but("CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation", "")
        .replace("CHANNELS 1 Xrotation", "");
    refused("none", &none, 17, "nothing can move");
}

#[test]
fn broken_hierarchies_are_refused() {
    refused("two-roots", &good_but("MOTION", "ROOT other { OFFSET 0 0 0 }\nMOTION"), 16, "a second ROOT");
    refused("no-close", &good_but("}\nMOTION", "MOTION"), 15, "that begins at line 2, found `MOTION`");
    refused("no-open", &good_but("hip\n{", "hip\n"), 4, "expected `{` after the joint's name, found `OFFSET`");
    refused("one-close-more", &good_but("MOTION", "}\nMOTION"), 16, "expected `MOTION` after the hierarchy, found `}`");
    refused(
        "no-offset",
        &good_but("    OFFSET 0 -45 0\n    CHANNELS", "    CHANNELS"),
        13,
        "no OFFSET in the joint that begins at line 6",
    );
    refused("no-name", &good_but("left knee", ""), 7, "expected a name");
    refused("binary", "\u{1}\u{2}\u{3}", 1, "expected `HIERARCHY` at the start of a BVH file, found `\\u{1}\\u{2}\\u{3}`");
}

#[test]
fn empty_files_directories_and_absent_files_are_refused() {
    let error = |name: &str, bytes: &[u8]| format!("{:#}", load_bytes(name, bytes, &ImportOptions::new()).unwrap_err());
    assert!(error("empty", b"").ends_with("empty.bvh: the file is empty; expected a motion file"));
    assert!(error("blank", b" \n \n").contains("blank.bvh:3: expected `HIERARCHY`"));
    let of_path = |path: &std::path::Path| format!("{:#}", crate::told::load(path, &ImportOptions::new()).unwrap_err());
    assert!(of_path(&std::env::temp_dir()).contains("a directory; expected a motion file"));
    assert!(of_path("no/such/file.bvh".as_ref()).starts_with("no/such/file.bvh: "));
}

#[test]
fn names_that_are_not_utf8_or_not_unique_are_kept() {
    let mut bytes = GOOD.as_bytes().to_vec();
    bytes[16] = 0xe9;
    let read = load_bytes("latin1", &bytes, &ImportOptions::new()).unwrap();
    assert_eq!(read.motion.rig.joints[0].name, "h\u{fffd}p");
    assert!(read.warnings[0].starts_with("the name `h\u{fffd}p` has letters that are not UTF-8"), "{:?}", read.warnings);
    let read = load("repeated", &good_but("left knee", "hip")).unwrap();
    assert!(read.warnings[0].contains("`hip`"), "{:?}", read.warnings);
}

#[test]
fn angles_run_on_past_half_a_turn() {
    let read = load("turn", &good_but("1 2 3 4 5 6 7", "1 2 3 4 5 6 -350")).unwrap();
    assert_eq!(read.motion.values[6], [-350.0, -352.0]);
}

#[test]
fn a_joint_without_channels_stands_still() {
    let text = GOOD.replace("    CHANNELS 1 Xrotation\n", "").replace("6 7", "6").replace("6 8", "6");
    let motion = load("still", &text).unwrap().motion;
    assert_eq!((motion.rig.joints[1].kinds.len(), motion.values.len()), (0, 6));
}

#[test]
fn bad_options_are_refused() {
    for (cm_per_unit, fps) in [(Some(0.0), None), (Some(f64::NAN), None), (None, Some(-1.0))] {
        assert!(load_bytes("options", GOOD.as_bytes(), &ImportOptions::new().cm_per_unit(cm_per_unit).fps(fps)).is_err());
    }
}

#[test]
fn a_channel_that_a_joint_has_twice_is_named() {
    let text = good_but("Xposition Yposition Zposition", "Xposition Yposition Xposition");
    refused("position-twice", &text, 5, "the joint has the channel Xposition twice");
    let loaded = load("rotation-twice", &good_but("Zrotation Xrotation Yrotation", "Zrotation Xrotation Zrotation")).unwrap();
    let warning = "1 joints have a rotation twice (`hip` has Zrotation)";
    assert!(loaded.warnings.iter().any(|said| said.contains(warning)), "{:?}", loaded.warnings);
}

//! Live Link Face CSV: small recordings are read as they say, and mistakes are named with their place.

use super::outputs::{Folder, err};
use crate::told::load;
use anyhow::Result;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;

fn read_as(name: &str, text: impl AsRef<[u8]>) -> Result<(Motion, Vec<String>)> {
    let path = std::env::temp_dir().join(format!("pantin-livelink-{name}-{}.csv", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let read = load(&path, &ImportOptions::new());
    std::fs::remove_file(&path).unwrap();
    read.map(|imported| (imported.motion, imported.warnings))
}

const HEADER: &str = "Timecode,BlendshapeCount,EyeBlinkLeft,HeadYaw\n";

fn error(name: &str, rows: &str) -> String {
    format!("{:#}", read_as(name, format!("{HEADER}{rows}")).unwrap_err())
}

/// Rows of one recording: value = frame number / 1000.
fn recording(codes: impl IntoIterator<Item = (u32, u32, f64)>) -> String {
    let row = |(number, second, frame): (u32, u32, f64)| {
        format!("23:59:{second:02}:{frame:06.3},2,{},-1.25\n", f64::from(number) / 1000.0)
    };
    HEADER.to_string() + &codes.into_iter().map(row).collect::<String>()
}

#[test]
fn dropped_frames_come_back_between_their_neighbours() {
    let codes =
        (0..90u32).filter(|frame| !(40..43).contains(frame)).map(|frame| (frame, 50 + frame / 60, f64::from(frame % 60) + 0.273));
    let (motion, warnings) = read_as("dropped", recording(codes)).unwrap();
    assert_eq!((motion.frames, motion.frame_time), (90, 1.0 / 60.0));
    assert!((0..90).all(|frame| (motion.values[0][frame] - frame as f64 / 1000.0).abs() < 1e-12));
    assert!(
        warnings.iter().any(|warning| warning.starts_with("3 of 90 frames were dropped") && warning.contains("line 42")),
        "{warnings:?}"
    );
    assert_eq!(motion.rig.scalars[0].full_scale, 1.0);
    assert_eq!(motion.rig.scalars[1].full_scale, 1.25);
    assert!(motion.rig.joints.is_empty());
}

#[test]
fn rates_are_told_apart() {
    let thirty = (0..70u32).map(|frame| (frame, frame / 30, f64::from(frame % 30)));
    assert_eq!(read_as("thirty", recording(thirty)).unwrap().0.frame_time, 1.0 / 30.0);
    // A camera at 59.94 Hz by a clock that counts sixtieths: a frame behind after each thousand.
    let at = |row: u32| f64::from(row) * 1.001;
    let slow = (0..1500u32).map(|row| (row, (at(row) / 60.0) as u32, at(row) % 60.0));
    let (motion, _) = read_as("ntsc", recording(slow)).unwrap();
    assert_eq!((motion.frames, motion.frame_time), (1500, 1.001 / 60.0));
    // Neither: as measured.
    let at = |row: u32| f64::from(row) * 1.0016;
    let slow = (0..2000u32).map(|row| (row, (at(row) / 60.0) as u32, at(row) % 60.0));
    let (motion, warnings) = read_as("measured", recording(slow)).unwrap();
    assert!((motion.frame_time * 60.0 - 1.0016).abs() < 1e-5, "{}", motion.frame_time * 60.0);
    assert!(warnings[0].contains("59.904 times a second"), "{warnings:?}");
    // Every second frame of a clock at 60.
    let half = (0..60u32).map(|row| (row, row / 30, f64::from(row % 30 * 2)));
    assert_eq!(read_as("half", recording(half)).unwrap().0.frame_time, 1.0 / 30.0);
}

#[test]
fn a_recording_runs_on_over_midnight() {
    let text = format!("{HEADER}23:59:59:58.5,2,0.1,0\n23:59:59:59.5,2,0.2,0\n00:00:00:00.5,2,0.3,0\n00:00:00:02.5,2,0.5,0\n");
    let (motion, _) = read_as("midnight", text).unwrap();
    assert!((motion.values[0][3] - 0.4).abs() < 1e-12 && motion.frames == 5);
}

#[test]
fn names_are_live_links_in_every_spelling() {
    for (header, count) in
        [("timecode,blendshapeCount,eyeBlinkLeft,headYaw", 2), ("Timecode,BlendShapeCount,eyeBlink_L,HeadYaw", 2)]
    {
        let (motion, _) = read_as("names", format!("\u{feff}{header}\r\n1:00:00:00,{count},0.5,0\r\n")).unwrap();
        assert_eq!([motion.rig.channel_name(0), motion.rig.channel_name(1)], ["EyeBlinkLeft", "HeadYaw"]);
    }
}

#[test]
fn lost_faces_leave_a_gap() {
    let text = format!("{HEADER}0:0:0:0,2,0,0\n0:0:0:1,2,0.1,0\n0:0:0:2,0\n0:0:0:3,2,0.3,0\n");
    let (motion, warnings) = read_as("lost", text).unwrap();
    assert!((motion.values[0][2] - 0.2).abs() < 1e-12);
    assert!(warnings.iter().any(|warning| warning.starts_with("1 rows hold no values")), "{warnings:?}");
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    assert!(error("empty", "").contains(".csv:1: no row"));
    assert!(error("columns", "0:0:0:0,2,0,0\n0:0:0:1,2,0\n").contains(".csv:3: 3 cells; expected 4"));
    assert!(error("count", "0:0:0:0,61,0,0\n").contains(".csv:2: column 2 (BlendshapeCount): 61 values; the header names 2"));
    assert!(error("nan", "0:0:0:0,2,0,nan\n").contains(".csv:2: column 4 (HeadYaw): expected a finite number"));
    assert!(error("huge", "0:0:0:0,2,1e300,0\n").contains(".csv:2: column 3 (EyeBlinkLeft)"));
    assert!(error("code", "noon,2,0,0\n").contains(".csv:2: column 1 (Timecode): expected HH:MM:SS:FF.fraction, found `noon`"));
    assert!(error("back", "0:0:0:5,2,0,0\n0:0:0:1,2,0,0\n").contains(".csv:3: column 1 (Timecode): this timecode is before"));
    assert!(error("break", "0:0:0:5,2,0,0\n0:9:0:1,2,0,0\n").contains("is to be split"));
    assert!(error("still", "0:0:0:5,2,0,0\n0:0:0:5,2,0,0\n").contains(".csv:3: column 1 (Timecode): the timecode stands still"));
    let unnamed = format!("{:#}", read_as("unnamed", "Timecode,BlendshapeCount\n0:0:0:0,0\n").unwrap_err());
    assert!(unnamed.contains(".csv:1: no channels"), "{unnamed}");
    let strange = format!("{:#}", read_as("strange", b"Timecode,BlendshapeCount,Eye\xff\n").unwrap_err());
    assert!(strange.contains(".csv:1: column 3: `Eye\u{fffd}` is not UTF-8"), "{strange}");
}

#[test]
fn warnings_of_a_face_beside_a_body_are_said() {
    let folder = Folder::new();
    let codes = (0..90u32).filter(|frame| !(40..43).contains(frame)).map(|frame| (frame, 50 + frame / 60, f64::from(frame % 60)));
    folder.put("face.csv", recording(codes));
    let walk = concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/walk.keys");
    let said = err(&folder.done(&["convert", walk, "--with", "face.csv", "--fps", "60", "-o", "both.ptn", "--effort", "fast"]));
    assert!(said.contains("warning: with: 3 of 90 frames were dropped"), "{said}");
}

//! ASF and AMC files as they come: what is broken gets one error with its file and line.

use crate::told::Told;
use pantin_convert::fk;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::{Kind, Motion};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

const ASF: &str = "# a leg with a hand
:version 1.10
:name figure
:units
  mass 1.0
  length 0.5
  angle deg
:documentation
  length 7 is no unit here
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name hip
    direction 1 0 0
    length 1
    axis 0 0 0 XYZ
  end
  begin
    id 2
    name femur
    direction 0 -1 0
    length 2
    axis 0 0 30 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    name hand
    direction 0 1 0
    length 3
    axis 0 0 90 XYZ
    dof rx rz
    limits (-90.0 20.0) (-inf inf)
  end
:hierarchy
  begin
    root hip hand
    hip femur
  end
";

const AMC: &str = "#!OML:ASF C:\\there\\Figure.ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
femur 0 0 0
hand 10 20
2
root 1 2 3 0 90 0
femur 90 0 0
hand 11 21
";

static NEXT: AtomicUsize = AtomicUsize::new(0);

/// A folder of its own with these files; `load` reads the first.
struct Files {
    folder: PathBuf,
    first: PathBuf,
}

impl Files {
    fn new(files: &[(&str, &str)]) -> Files {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("pantin-amc-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        files.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
        Files { first: folder.join(files[0].0), folder }
    }

    fn load(&self, options: &ImportOptions) -> anyhow::Result<Told> {
        crate::told::load(&self.first, options)
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        // Files of a test that failed are of use to no later one.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

fn load(asf: &str, amc: &str) -> anyhow::Result<Told> {
    Files::new(&[("walk.amc", amc), ("walk.asf", asf)]).load(&ImportOptions::new())
}

fn motion(asf: &str, amc: &str) -> Motion {
    load(asf, amc).unwrap_or_else(|error| panic!("{error:#}")).motion
}

fn but(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

fn refused(asf: &str, amc: &str, place: &str, part: &str) {
    let error = format!("{:#}", load(asf, amc).expect_err(part));
    assert!(error.contains(&format!("walk.{place}: ")), "no place {place} in: {error}");
    assert!(error.contains(part), "no `{part}` in: {error}");
    assert!(!error.contains('\n'), "several lines: {error}");
}

fn refused_asf(from: &str, to: &str, line: usize, part: &str) {
    refused(&but(ASF, from, to), AMC, &format!("asf:{line}"), part);
}

fn refused_amc(from: &str, to: &str, line: usize, part: &str) {
    refused(ASF, &but(AMC, from, to), &format!("amc:{line}"), part);
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    let far = (0..3).map(|axis| (found[axis] - expected[axis]).abs()).fold(0.0, f64::max);
    assert!(far < 1e-9, "{found:?}, expected {expected:?}");
}

#[test]
fn a_good_pair_is_read() {
    let Told { motion, warnings, units, .. } = load(ASF, AMC).unwrap();
    assert_eq!((motion.frames, motion.frame_time), (2, 1.0 / 120.0));
    assert_eq!(warnings, ["the format states no frame rate, so 120 a second; --fps overrides"]);
    assert_eq!(units, "units: 5.08 cm, as the file says");
    let names: Vec<&str> = motion.rig.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["root", "hip", "femur", "", "hand", ""]);
    use Kind::*;
    let kinds: Vec<&[Kind]> = motion.rig.joints.iter().map(|joint| joint.kinds.as_slice()).collect();
    assert_eq!(kinds[0], [Xposition, Yposition, Zposition, Zrotation, Yrotation, Xrotation]);
    assert!(kinds[1].is_empty());
    assert_eq!(kinds[2], [Zrotation, Yrotation, Xrotation]);
    // The hand's axes are a quarter of a turn from the world's: x along y, z along z.
    assert_eq!(kinds[4], [Zrotation, Yrotation]);
    assert_eq!(motion.values[9..], [vec![20.0, 21.0], vec![10.0, 11.0]]);
    assert_eq!(motion.values[..3], [[1.0; 2], [2.0; 2], [3.0; 2]]);
}

#[test]
fn bones_stand_where_they_should() {
    let motion = motion(ASF, AMC);
    let places = |frame| fk::positions(&motion.rig, &motion.values, frame).into_iter().map(|place| place.map(|x| x / 5.08));
    let rest: Vec<[f64; 3]> = places(0).collect();
    // Root, hip at its start, femur at the hip's end, the femur's end, the hand at the root's end (its start).
    let expected = [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [2.0, 2.0, 3.0], [2.0, 0.0, 3.0], [1.0, 2.0, 3.0]];
    rest.iter().zip(expected).for_each(|(found, expected)| near(*found, expected));
    // The root turns x to -z. The femur turns by 90 degrees about its own x axis (cos 30, sin 30, 0): of its vector
    // (0, -2, 0) the part along the axis, -1 (cos 30, sin 30, 0), stays, the rest goes along axis x vector = -2 cos 30 z.
    let turned: Vec<[f64; 3]> = places(1).collect();
    near(turned[2], [1.0, 2.0, 2.0]);
    let (along, aside) = (30f64.to_radians().cos(), 30f64.to_radians().sin());
    near(turned[3], [1.0 - 2.0 * along, 2.0 - aside, 2.0 + along]);
}

#[test]
fn radians_and_free_layout_read_the_same() {
    let expected = motion(ASF, AMC);
    let same = |asf: &str, amc: &str| assert_eq!(motion(asf, amc), expected);
    same(&ASF.replace('\n', "\r\n"), &AMC.replace('\n', "\r\n"));
    same(&ASF.replace("XYZ", "xyz").replace("dof rx", "DOF RX"), &AMC.replace("femur", "Femur"));
    same(&ASF.replace("1 0 0\n", "1, 0, 0 # east\n"), &AMC.replace("1\nroot", "\n 1 \n\n root"));
    same(&but(ASF, "    id 1\n", "    bodymass 10\n    cofmass 1\n"), AMC.trim_end());
    let radians = AMC.replace(":DEGREES", ":RADIANS").replace("hand 10 20", "hand 0.17453292519943295 0.3490658503988659");
    let radians = radians.replace(" 90 ", " 1.5707963267948966 ").replace("11 21", "0.19198621771937624 0.3665191429188092");
    let asf = ASF.replace("angle deg", "angle rad").replace("30 XYZ", "0.5235987755982988 XYZ");
    let asf = asf.replace("0 0 90 XYZ", "0 0 1.5707963267948966 XYZ");
    for amc in [radians.clone(), radians.replace(":RADIANS\n", "")] {
        let read = motion(&asf, &amc);
        assert_eq!(read.rig, expected.rig);
        let pairs = read.values.iter().flatten().zip(expected.values.iter().flatten());
        pairs.for_each(|(a, b)| assert!((a - b).abs() < 1e-9, "{a} {b}"));
    }
}

#[test]
fn units_rates_and_offsets_are_read() {
    let read = load(&but(ASF, "length 0.5", "length 1.0"), AMC).unwrap();
    assert!(read.units.contains("--cm-per-unit overrides"), "{}", read.units);
    assert_eq!(motion(&but(ASF, "length 0.5", "length 2.54"), AMC).rig.cm_per_unit, 1.0);
    let stated = but(AMC, ":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 60");
    assert_eq!(motion(ASF, &stated).frame_time, 1.0 / 60.0);
    let files = Files::new(&[("walk.amc", &stated), ("walk.asf", ASF)]);
    // A rate that the file states stands; what --fps asks for is made of it later.
    let read = files.load(&ImportOptions::new().fps(50.0)).unwrap();
    assert_eq!((read.motion.frame_time, read.warnings.len()), (1.0 / 60.0, 0));
    let moved = motion(&but(ASF, "position 0 0 0", "position 5 0 -5"), AMC);
    assert_eq!(moved.values[..3], [[6.0; 2], [2.0; 2], [-2.0; 2]]);
}

#[test]
fn translations_go_along_the_bones_axes() {
    let asf = but(&but(ASF, "dof rx ry rz", "dof rx ry rz tx"), "dof rx rz", "dof rx rz l");
    let amc = AMC.replace("femur 0 0 0", "femur 0 0 0 2").replace("femur 90 0 0", "femur 90 0 0 0");
    let amc = amc.replace("hand 10 20", "hand 10 20 0").replace("hand 11 21", "hand 11 21 0");
    let Told { motion, warnings, .. } = load(&asf, &amc).unwrap();
    assert!(warnings.contains(&"the bone `hand` changes its length, which is left out".to_string()), "{warnings:?}");
    let place = fk::positions(&motion.rig, &motion.values, 0)[2].map(|x| x / 5.08);
    near(place, [2.0 + 2.0 * 30f64.to_radians().cos(), 3.0, 3.0]);
}

#[test]
fn the_skeleton_is_found_by_name_and_comment() {
    let other = but(ASF, "length 3", "length 33");
    let reach = |files: &[(&str, &str)]| {
        let read = Files::new(files).load(&ImportOptions::new()).unwrap_or_else(|error| panic!("{error:#}"));
        (read.motion.rig.joints[5].offset[1], read.warnings.len())
    };
    assert_eq!(reach(&[("walk1.amc", AMC), ("walk1.ASF", ASF), ("walk.asf", &other), ("figure.asf", &other)]), (3.0, 1));
    assert_eq!(reach(&[("walk12.amc", AMC), ("w.asf", &other), ("walk1.asf", ASF), ("wal.asf", &other)]), (3.0, 2));
    assert_eq!(reach(&[("walk.amc", AMC), ("figure.asf", ASF), ("a.asf", &other), ("walking.asf", &other)]), (3.0, 2));
    assert_eq!(reach(&[("walk", AMC), ("walk.asf", ASF)]), (3.0, 1));
    let files = Files::new(&[("walk.amc", AMC), ("walk.asf", ASF), ("given.asf", &other)]);
    let options = ImportOptions::new().skeleton(files.folder.join("given.asf"));
    assert_eq!(files.load(&options).unwrap().motion.rig.joints[5].offset[1], 33.0);
}

#[test]
fn an_absent_skeleton_is_said() {
    let error = |options: &ImportOptions, amc: &str| format!("{:#}", Files::new(&[("walk.amc", amc)]).load(options).unwrap_err());
    let said = error(&ImportOptions::new(), AMC);
    assert!(said.contains("neither walk.asf nor the `Figure.ASF` that the file names; --skeleton FILE gives one"), "{said}");
    let said = error(&ImportOptions::new(), &but(AMC, "#!OML", "#"));
    assert!(said.ends_with("walk.amc:1: no skeleton beside it: no walk.asf; --skeleton FILE gives one"), "{said}");
    let said = error(&ImportOptions::new().skeleton("no/such.asf"), AMC);
    assert!(said.starts_with("no/such.asf: "), "{said}");
    let said = format!("{:#}", Files::new(&[("walk.asf", ASF)]).load(&ImportOptions::new()).unwrap_err());
    assert!(said.contains("AMC (.amc)"), "{said}");
}

#[test]
fn broken_motions_are_refused() {
    refused_amc("hand 11", "hnd 11", 11, "no bone `hnd` in the skeleton");
    refused_amc("hand 11 21", "hand 11", 11, "expected 2 values for the bone `hand`, found 1");
    refused_amc("hand 11 21", "hand 11 21 31", 11, "expected 2 values for the bone `hand`, found 3");
    refused_amc("femur 90", "femur ninety", 10, "expected a number, found `ninety`");
    refused_amc("femur 90", "femur -1.#IND", 10, "expected a number, found `-1.#IND`");
    refused_amc("femur 90", "femur nan", 10, "expected a finite number");
    refused_amc("femur 90 0 0\n", "", 8, "frame 2 has no line of the bone `femur`");
    refused_amc("femur 90 0 0\n", "femur 0 0 0\nfemur 90 0 0\n", 11, "a second line of the bone `femur` in frame 2");
    refused_amc("2\nroot", "3\nroot", 8, "expected frame 2, found `3`");
    refused_amc("2\nroot", "1\nroot", 8, "expected frame 2, found `1`");
    refused_amc("2\nroot", "99999999999999999999\nroot", 8, "expected frame 2, found");
    refused_amc("1\nroot", "root", 4, "expected a line with a frame number, found `root`");
    refused_amc("hand 10 20\n", "hand 10 20\n:RADIANS\n", 8, "`:RADIANS` stands after the first frame");
    refused(ASF, ":FULLY-SPECIFIED\n:DEGREES\n", "amc:3", "no frames");
    refused(ASF, "binary \u{1}\u{0}", "amc:1", "expected a line with a frame number");
    let said = format!("{:#}", load(ASF, "").unwrap_err());
    assert!(said.ends_with("walk.amc: the file is empty; expected a motion file"), "{said}");
}

/// A file cut between two frames is a whole shorter file, and one cut in the last number is as good as another.
#[test]
fn every_other_truncation_is_refused() {
    let last = AMC.trim_end().len() - 1;
    let frames = [AMC.find("\n2\n").unwrap(), AMC.find("\n2\n").unwrap() + 1];
    let first_ends = AMC.find("20\n2").unwrap() + 1;
    for len in (0..last).filter(|len| !frames.contains(len) && *len != first_ends) {
        let error = format!("{:#}", load(ASF, &AMC[..len]).expect_err(&AMC[..len]));
        assert!(error.contains("walk.amc"), "{len}: {error}");
    }
    let end = ASF.find("hip femur").unwrap() + "hip femur".len();
    for len in 0..end {
        let error = format!("{:#}", load(&ASF[..len], AMC).expect_err(&ASF[..len]));
        assert!(error.contains("walk.asf:"), "{len}: {error}");
    }
}

#[test]
fn broken_skeletons_are_refused() {
    refused(" \n", AMC, "asf:2", "no bones; expected an ASF file");
    refused_asf("angle deg", "angle grad", 7, "expected `deg` or `rad` after `angle`, found `grad`");
    refused_asf("length 0.5", "length 0", 6, "expected a length above 0 in `:units`, found 0");
    refused_asf("length 0.5", "length 0.5 0.9", 6, "expected 1 number after the keyword, found 2");
    refused_asf("direction 0 -1 0\n", "direction 9 0 -1 0\n", 26, "expected 3 numbers after the keyword, found 4");
    refused_asf("length 0.5", "length", 6, "expected 1 number after the keyword, found 0");
    refused_asf("order TX TY TZ RX RY RZ", "", 47, "expected `order` in `:root`");
    refused_asf("RX RY RZ", "RX RY RW", 11, "expected tx, ty, tz, rx, ry, rz or l, found `RW`");
    refused_asf("dof rx rz", "dof rx rx", 39, "`rx` stands twice");
    refused_asf("0 0 30 XYZ", "0 0 30 XXZ", 28, "expected an order of axes like XYZ, found `XXZ`");
    refused_asf("0 0 30 XYZ", "0 0 30", 28, "expected an order of axes like XYZ, found the end of the line");
    refused_asf("0 0 30 XYZ", "0 30 XYZ", 28, "expected a number, found `XYZ`");
    refused_asf("direction 0 -1 0\n", "\n", 33, "the bone that begins at line 23 needs a name, a direction and a length");
    refused_asf("name hand", "name hip", 35, "a second bone `hip`");
    refused_asf("name hand", "name", 35, "expected a name");
    refused_asf("hip femur", "hip tibia", 45, "no bone `tibia` in `:bonedata`");
    refused_asf("hip femur", "hip femur hand", 45, "`hand` has a parent already");
    refused_asf("hip femur", "hip root", 45, "`root` has a parent already");
    refused_asf("    hip femur\n", "", 23, "`:hierarchy` does not join the bone `femur` to the root");
    refused_asf("root hip hand", "femur hip\nroot hand", 16, "`:hierarchy` does not join the bone `hip` to the root");
    let read = load(&but(ASF, "    id 1\n", "    colour red\n"), AMC).unwrap();
    assert_eq!(read.warnings[0], "the skeleton's bones say `colour`, which is not read");
}

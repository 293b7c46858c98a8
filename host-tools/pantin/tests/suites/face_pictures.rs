//! What displays show of a face: each unit changes the pixels of its region and no others, nothing is cut off, and the options of the commands that draw.

use pantin_face::{FaceView, Model};
use pantin_figure::Canvas;
use pantin_pictures::face::blueprint::Blueprint;
use pantin_pictures::face::{Face, cartoon, compact, draw, pose};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SMALL: Canvas = Canvas { width: 128, height: 64 };
const ROUND: Canvas = Canvas { width: 240, height: 240 };

fn picture(face: &Blueprint, model: &Model, canvas: Canvas, sum: &str) -> Vec<u8> {
    draw::picture(model, &pose::weights(&pose::parse(face, sum).unwrap()), canvas, FaceView::default())
}

/// A part of the neutral face at 128x64: rows, and columns to either side of the middle.
#[derive(Clone, Copy)]
struct Region {
    rows: [usize; 2],
    columns: [usize; 2],
}

const BROWS: Region = Region { rows: [15, 23], columns: [2, 17] };
const EYES: Region = Region { rows: [22, 29], columns: [3, 17] };
const NOSE: Region = Region { rows: [32, 41], columns: [0, 8] };
const MOUTH: Region = Region { rows: [38, 51], columns: [0, 14] };
/// The cheek's edge is part of the outline.
const CHEEKS: Region = Region { rows: [30, 54], columns: [11, 24] };
/// The jaw's curve beside the chin.
const JAW_SIDES: Region = Region { rows: [48, 54], columns: [7, 14] };
/// Mouth, chin and the outline around them.
const JAW: Region = Region { rows: [38, 63], columns: [0, 22] };

/// Units, their region, and how many pixels change at least.
const UNITS: [(&str, &[Region], usize); 38] = [
    ("open_mouth", &[JAW], 40),
    ("smile", &[MOUTH], 12),
    ("wide_smile", &[MOUTH, CHEEKS], 16),
    ("lower_corners", &[MOUTH], 12),
    ("brow_inner_lower", &[BROWS], 6),
    ("brow_outer_raise", &[BROWS], 4),
    ("puff_cheeks", &[CHEEKS, JAW_SIDES], 12),
    ("joy", &[MOUTH], 12),
    ("sadness", &[MOUTH, BROWS], 18),
    ("surprise", &[JAW, BROWS], 40),
    ("lid", &[EYES], 12),
    ("lid=-0.35", &[EYES], 4),
    ("eye_out", &[EYES], 4),
    ("eye_up", &[EYES], 4),
    ("eye_up=-1", &[EYES], 4),
    ("look_left", &[EYES], 4),
    ("jaw_side_left", &[JAW], 8),
    ("pucker", &[MOUTH], 12),
    ("funnel", &[MOUTH], 12),
    ("lip_press", &[MOUTH], 8),
    ("roll_upper", &[MOUTH], 4),
    ("roll_lower", &[MOUTH], 4),
    ("mouth_side_left", &[MOUTH], 8),
    ("nose_wrinkle", &[NOSE, MOUTH, BROWS], 4),
    ("brow_inner_up", &[BROWS], 6),
    ("brow_lower", &[BROWS, EYES], 6),
    ("brow_raise", &[BROWS], 6),
    ("squint", &[EYES], 4),
    ("cheek_raise", &[EYES, CHEEKS], 2),
    ("upper_lip_raise", &[MOUTH, NOSE], 6),
    ("lower_lip_lower", &[MOUTH], 6),
    ("stretch", &[MOUTH, CHEEKS], 6),
    ("corner_up", &[MOUTH, CHEEKS], 8),
    ("frown", &[MOUTH], 8),
    ("shrug_lower", &[MOUTH, JAW], 4),
    ("shrug_upper", &[MOUTH, NOSE], 4),
    ("open_mouth=0.3,tongue_out", &[JAW], 12),
    ("viseme_u", &[JAW], 12),
];

#[test]
fn at_128x64_each_unit_changes_the_pixels_of_its_region_and_no_others() {
    let face = Face::new().unwrap();
    let model = face.model().unwrap();
    let neutral = picture(&face.blueprint, &model, SMALL, "");
    let middle = usize::from(SMALL.width) / 2;
    let mut wrong = Vec::new();
    let mut judge = |unit: &str, regions: &[Region], least: usize, left: bool, right: bool| {
        let (mut inside, mut outside) = (0, Vec::new());
        for (index, _) in
            picture(&face.blueprint, &model, SMALL, unit).iter().zip(&neutral).enumerate().filter(|(_, (a, b))| a != b)
        {
            let (x, y) = (index % usize::from(SMALL.width), index / usize::from(SMALL.width));
            // The face's left is on the right of the picture; the middle two columns belong to both sides.
            let side = if x >= middle { left || x < middle + 3 } else { right || x + 3 >= middle };
            let away = if x >= middle { x - middle } else { middle - 1 - x };
            let holds = |region: &Region| {
                (region.rows[0]..=region.rows[1]).contains(&y) && (region.columns[0]..=region.columns[1]).contains(&away)
            };
            if side && regions.iter().any(holds) { inside += 1 } else { outside.push((x, y)) }
        }
        if inside < least || !outside.is_empty() {
            wrong.push(format!("{unit}: {inside} pixels of its region change, at least {least} should, and others: {outside:?}"));
        }
    };
    for (unit, regions, least) in UNITS {
        judge(unit, regions, least, true, true);
        let sided = face.blueprint.shape(unit).is_some_and(|shape| face.blueprint.shapes[shape].sided);
        if sided {
            judge(&format!("{unit}_left"), regions, least / 3, true, false);
            judge(&format!("{unit}_right"), regions, least / 3, false, true);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // The table has every unit that moves points of the face; from the front, a jaw that goes ahead and the parts of tongue and lips below do not show alone.
    let listed = |name: &str| {
        UNITS.iter().any(|unit| unit.0.split(',').any(|part| part.split('=').next().unwrap_or("").starts_with(name)))
    };
    let unseen = ["jaw_forward", "mouth_close", "tongue_up", "head_up", "head_left", "head_tilt_left"];
    for shape in &face.blueprint.shapes {
        assert!(listed(&shape.name) || unseen.contains(&shape.name.as_str()), "{} has no region", shape.name);
    }
    for unit in ["head_up", "head_left", "head_tilt_left"] {
        let changed = picture(&face.blueprint, &model, SMALL, unit).iter().zip(&neutral).filter(|(a, b)| a != b).count();
        assert!(changed > 150, "{unit} changes {changed} pixels");
    }
    // Those that need another unit to be seen, beside it alone.
    for (with, alone) in [("open_mouth=0.4,mouth_close=0.7", "open_mouth=0.4"), ("open_mouth=0.3,tongue_up", "open_mouth=0.3")] {
        let [with, alone] = [with, alone].map(|sum| picture(&face.blueprint, &model, SMALL, sum));
        assert!(with.iter().zip(&alone).filter(|(a, b)| a != b).count() >= 3, "{unseen:?} are not seen");
    }
}

/// For each of these rows the distance of its outermost bright pixel from the middle, and the number of bright pixels between that outline and the mouth.
/// Pixels that touch the outline or lie beside it are part of it. A row in which darker lines hide the outline has none.
fn outlines(pixels: &[u8], canvas: Canvas, rows: std::ops::Range<usize>) -> Vec<Option<(usize, usize)>> {
    let width = usize::from(canvas.width);
    let (middle, beside, mouth) = (width / 2, width / 60, width * 15 / 128);
    let outline = |row: usize| {
        let bright = |x: &usize| pixels[row * width + x] >= 150;
        let from = (0..middle).find(bright)?;
        Some((middle - from, (from + beside + 1..middle - mouth).filter(bright).count()))
    };
    rows.map(outline).collect()
}

#[test]
fn puffed_cheeks_push_the_outline_outwards_and_leave_no_line_of_the_jaw_inside() {
    let face = Face::new().unwrap();
    let model = face.model().unwrap();
    for (canvas, rows, least) in [(SMALL, 33..54, 2), (ROUND, 140..190, 8)] {
        let [rest, puffed] = ["", "puff_cheeks"].map(|sum| picture(&face.blueprint, &model, canvas, sum));
        let [rest, puffed] = [rest, puffed].map(|pixels| outlines(&pixels, canvas, rows.clone()));
        let both = puffed.iter().zip(&rest).filter_map(|(puffed, rest)| puffed.zip(*rest));
        let growths: Vec<usize> = both.map(|(puffed, rest)| puffed.0.saturating_sub(rest.0)).collect();
        assert!(growths.len() * 10 >= rows.len() * 9, "{} rows have no outline", rows.len() - growths.len());
        assert!(growths.iter().filter(|&&growth| growth >= least).count() * 10 > growths.len() * 7, "{growths:?}");
        assert!(puffed.iter().flatten().all(|row| row.1 == 0), "bright pixels inside the outline: {puffed:?}");
    }
}

/// All that a face does at once by name: units and sums, but for a head that turns.
fn sums(face: &Face) -> Vec<String> {
    let moved = |name: &str| {
        face.blueprint
            .names
            .iter()
            .filter(|drive| drive.name == name)
            .all(|drive| !face.blueprint.shapes[drive.shape].name.starts_with("head_"))
    };
    let mut names: Vec<String> = face.blueprint.names.iter().map(|drive| drive.name.clone()).filter(|name| moved(name)).collect();
    names.dedup();
    names
}

/// Lit pixels on the edge of a square picture, or outside the circle of a round one.
fn cut_off(pixels: &[u8], canvas: Canvas, round: bool) -> usize {
    let (width, height) = (usize::from(canvas.width), usize::from(canvas.height));
    let lit = (0..width * height).filter(|&index| pixels[index] > 0);
    lit.filter(|index| {
        let (x, y) = (index % width, index / width);
        let [across, down] = [(2 * x + 1).abs_diff(width), (2 * y + 1).abs_diff(height)];
        if round { across * across + down * down > width * width } else { y == height - 1 || y == 0 }
    })
    .count()
}

#[test]
fn no_unit_leaves_a_display_of_128x64_or_a_round_one_of_240x240() {
    let face = Face::new().unwrap();
    let wireframe = face.model().unwrap();
    for sum in sums(&face) {
        // The neck's end lies on the lower edge of a square picture.
        let rest = cut_off(&picture(&face.blueprint, &wireframe, SMALL, ""), SMALL, false);
        assert!(cut_off(&picture(&face.blueprint, &wireframe, SMALL, &sum), SMALL, false) <= rest, "{sum} leaves 128x64");
        let rest = cut_off(&picture(&face.blueprint, &wireframe, ROUND, ""), ROUND, true);
        let lit = cut_off(&picture(&face.blueprint, &wireframe, ROUND, &sum), ROUND, true);
        assert!(lit <= rest, "{sum} lights {lit} pixels outside the circle, the neutral face {rest}");
    }
    for name in ["cartoon", "eyes", "minimal"] {
        let blueprint = cartoon::build(&face.head, &face.blueprint, cartoon::named(name).unwrap()).unwrap();
        let shapes = compact::encode(&blueprint).unwrap();
        let shapes = Model::new_checked(&shapes).unwrap();
        for sum in sums(&face).into_iter().chain(["glasses", "hearts", "tears", "sound"].map(String::from)) {
            let small = picture(&blueprint, &shapes, SMALL, &sum);
            assert_eq!(cut_off(&small, SMALL, false), 0, "{sum} of {name} leaves 128x64");
            let round = picture(&blueprint, &shapes, ROUND, &sum);
            assert_eq!(cut_off(&round, ROUND, true), 0, "{sum} of {name} leaves the circle");
        }
    }
}

fn pantin(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).current_dir(folder).output().unwrap()
}

fn done(folder: &Path, arguments: &[&str], file: &str) -> Vec<u8> {
    let out = pantin(folder, arguments);
    assert!(out.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&out.stderr));
    std::fs::read(folder.join(file)).unwrap()
}

fn motion(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name)
}

#[test]
fn render_draws_faces_of_other_models_and_interpolations() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // A pure unit, half way and whole.
    let keys = "keyframes 1\nfps 10\nframes 3\n\nscalar open_mouth scale 1\n\nkeys linear open_mouth\n  0 0\n  2 1\n";
    std::fs::write(folder.join("open.keys"), keys).unwrap();
    done(folder, &["convert", "open.keys", "--max-scalar-error", "0.5", "-o", "open.ptn"], "open.ptn");
    let drawn = |frame: &str, more: &[&str]| {
        done(
            folder,
            &[&["render", "open.ptn", "-o", "out.png", "--frame", frame, "--size", "240x240", "--pixels"], more].concat(),
            "out.png",
        )
    };
    let linear = ["--interpolation", "open_mouth=linear"];
    assert_ne!(drawn("1", &[]), drawn("1", &linear), "half open, the jaw is on another place");
    assert_eq!(drawn("2", &[]), drawn("2", &linear), "open, it is on the same one");
    assert_eq!(drawn("1", &[]), drawn("1", &["--interpolation", "open_mouth=spherical"]), "spherical is its own");
    let written = [&["face", "model", "-o", "linear.model"][..], &linear].concat();
    done(folder, &written, "linear.model");
    assert_eq!(drawn("1", &linear), drawn("1", &["--face", "linear.model"]));
    // An angle bends the way of a smile.
    let smile = keys.replace("open_mouth", "smile");
    std::fs::write(folder.join("smile.keys"), smile).unwrap();
    let smiling = |kind: &str| {
        let kind = format!("smile={kind}");
        let arguments =
            ["render", "smile.keys", "-o", "out.png", "--frame", "1", "--size", "240x240", "--pixels", "--interpolation", &kind];
        done(folder, &arguments, "out.png")
    };
    assert_ne!(smiling("spherical:20"), smiling("spherical:110"));
    assert_ne!(smiling("linear"), smiling("improved"));
    // The cartoon, and a round display.
    let cartoon = drawn("1", &["--face", "cartoon"]);
    assert_ne!(cartoon, drawn("1", &[]));
    done(folder, &["face", "model", "--cartoon", "-o", "shapes.model"], "shapes.model");
    assert_eq!(cartoon, drawn("1", &["--face", "shapes.model"]));
    done(folder, &["face", "model", "--cartoon", "eyes", "-o", "eyes.model"], "eyes.model");
    assert_eq!(drawn("1", &["--face", "eyes"]), drawn("1", &["--face", "eyes.model"]));
    let corner = |bytes: &[u8]| {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        pixels[..3].to_vec()
    };
    let amber = ["--palette", "102030,ffffff"];
    let round = [&amber[..], &["--round"]].concat();
    assert_eq!(corner(&drawn("1", &amber)), corner(&drawn("1", &round)));
    let refused = |arguments: &[&str], wanted: &str| {
        let out = pantin(folder, arguments);
        let error = String::from_utf8_lossy(&out.stderr).into_owned();
        assert!(!out.status.success() && error.contains(wanted), "{arguments:?}: {error}");
    };
    let walk = motion("walk.ptn");
    refused(&["render", "open.ptn", "-o", "no.png", "--interpolation", "funnel=spherical"], "no centre");
    refused(
        &["render", "open.ptn", "-o", "no.png", "--face", "linear.model", "--interpolation", "smile=linear"],
        "has its interpolations",
    );
    refused(&["render", "open.ptn", "-o", "no.png", "--face", "open.keys"], "open.keys");
    refused(&["render", walk.to_str().unwrap(), "-o", "no.png", "--face", "cartoon"], "drive the face");
    refused(&["render", "open.ptn", "-o", "no.svg", "--round"], "--round");
}

#[test]
fn a_face_on_the_neck_takes_the_cartoon_and_needs_a_body_and_a_face() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let greet = motion("greet.ptn");
    let drawn = |more: &[&str]| {
        let plain = ["render", greet.to_str().unwrap(), "-o", "out.png", "--frame", "40", "--style", "solid", "--view", "front"];
        done(folder, &[&plain, more].concat(), "out.png")
    };
    let neck = drawn(&["--face-at", "neck"]);
    assert_eq!(neck, drawn(&["--face-at", "neck", "--face", "cartoon"]));
    assert_ne!(neck, drawn(&["--face", "cartoon"]));
    assert_eq!(drawn(&[]), drawn(&["--face-at", "beside"]));
    let walk = motion("walk.ptn");
    for (clip, style, wanted) in [(&walk, "solid", "a body and a face"), (&greet, "lines", "--style solid")] {
        let out = pantin(folder, &["render", clip.to_str().unwrap(), "-o", "no.png", "--face-at", "neck", "--style", style]);
        let error = String::from_utf8_lossy(&out.stderr).into_owned();
        assert!(!out.status.success() && error.contains(wanted), "{style}: {error}");
    }
}

#[test]
fn a_pose_is_exported_as_the_picture_that_a_display_shows() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = done(folder.path(), &["face", "export", "-o", "joy.png", "--pose", "joy", "--scale", "2"], "joy.png");
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes[..])).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (256, 128));
    let face = Face::new().unwrap();
    let wanted = picture(&face.blueprint, &face.model().unwrap(), SMALL, "joy");
    let every_second: Vec<u8> = pixels.chunks(6 * 128).step_by(2).flat_map(|row| row.chunks(6).map(|pixel| pixel[0])).collect();
    assert_eq!(every_second, wanted);
}

#[test]
fn morph_targets_without_a_centre_are_never_spherical() {
    let face = Face::new().unwrap();
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["face", "export", "-o", "face.glb"], "face.glb");
    let arguments = ["face", "model", "face.glb", "-o", "face.model", "--interpolation", "smile_left=spherical"];
    let out = pantin(folder.path(), &arguments);
    let error = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(!out.status.success() && error.contains("no centre"), "{error}");
    assert!(!folder.path().join("face.model").exists());
    // Where the rule has a centre, the deltas really move on an arc.
    let mut spherical = face.blueprint.clone();
    spherical.choose("smile=spherical:60").unwrap();
    let places = |face: &Blueprint| pantin_pictures::face::exact::places(face, &pose::parse(face, "smile=0.5").unwrap());
    let mut linear = face.blueprint.clone();
    linear.choose("smile=linear").unwrap();
    let corner = face.head.find("8.3").unwrap();
    let [bent, straight] = [places(&spherical)[corner], places(&linear)[corner]];
    let gap = (0..3).map(|axis| (bent[axis] - straight[axis]).powi(2)).sum::<f64>().sqrt();
    assert!(gap > 0.5, "the arc is {gap} mm from the straight line");
}

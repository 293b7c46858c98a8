//! The model that devices play: the committed bytes, the device's arithmetic against full precision, hostile bytes, names.

use pantin_convert::import;
use pantin_face::model::{ModelError, hash};
use pantin_face::{
    Binding, CARTOON_VERTICES, FaceRenderer, FaceView, Model, Morph, SMALL_HEIGHT, SMALL_VERTICES, Target, VERTICES, Weights,
};
use pantin_figure::Canvas;
use pantin_pictures::face::cast::{Cast, is_face};
use pantin_pictures::face::{Face, cartoon, error, exact, export, fit, onmesh, outside, points, pose, small};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A clip of others, or nothing where there is none.
fn data(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("PANTIN_DATA").map_or_else(|| repository().join("../shared/data"), PathBuf::from);
    let path = folder.join(name);
    if !path.exists() {
        eprintln!("skipped: {name} is not in $PANTIN_DATA");
    }
    path.exists().then_some(path)
}

#[test]
fn the_committed_model_is_what_the_tables_make() {
    let face = Face::new().unwrap();
    assert!(
        pantin_face::MODEL == face.bytes,
        "the face has changed: write its model again by `pantin face model -o firmware/face/face.model --names firmware/face/face.names`"
    );
    assert_eq!(pantin_face::NAMES, face.blueprint.name_list(), "the names have changed: write them again by the same command");
    assert!(face.bytes.len() <= 8 << 10, "{} bytes", face.bytes.len());
    let parts = [size_of::<Morph<VERTICES>>(), size_of::<FaceRenderer<VERTICES>>(), size_of::<Binding>(), size_of::<Weights>()];
    println!("RAM: vertices {}, display {}, names {}, weights {} bytes", parts[0], parts[1], parts[2], parts[3]);
    assert!(parts.iter().sum::<usize>() <= 6 << 10, "{parts:?} bytes");
}

#[test]
fn the_device_keeps_within_a_tenth_of_a_percent() {
    let face = Face::new().unwrap();
    let error = error::greatest(&face.blueprint, &face.bytes).unwrap();
    assert!(error.part < 0.001, "{error:?}");
}

#[test]
fn the_committed_faces_of_blocks_are_what_their_tables_make() {
    let face = Face::new().unwrap();
    for (name, committed) in [("eyes", pantin_face::EYES), ("minimal", pantin_face::MINIMAL)] {
        let built = cartoon::build(&face.head, &face.blueprint, cartoon::named(name).unwrap()).unwrap();
        let bytes = pantin_pictures::face::compact::encode(&built).unwrap();
        assert!(committed == bytes, "write it again by `pantin face model --cartoon {name} -o firmware/face/{name}.model`");
        let error = error::greatest(&built, &bytes).unwrap();
        assert!(error.part < 0.002, "{name}: {error:?}");
        assert_eq!(built.name_list(), face.blueprint.name_list() + "glasses\nhearts\ntears\nsound\n", "{name}");
    }
}

#[test]
fn the_committed_cartoon_is_what_its_table_makes() {
    let face = Face::new().unwrap();
    let cartoon = cartoon::build(&face.head, &face.blueprint, cartoon::TABLE).unwrap();
    let bytes = pantin_pictures::face::compact::encode(&cartoon).unwrap();
    assert!(pantin_face::CARTOON == bytes, "write it again by `pantin face model --cartoon -o firmware/face/cartoon.model`");
    let error = error::greatest(&cartoon, &bytes).unwrap();
    assert!(error.part < 0.002, "{error:?}");
    assert_eq!(cartoon.name_list(), face.blueprint.name_list() + "glasses\nhearts\ntears\nsound\n");
    for (table, wanted) in [
        ("view 90 60 -90", "nothing is drawn"),
        ("fill 255 - lip-corner lip-top lip-bottom", "view"),
        ("view 90 60 -90\nfill 255 - lip-corner nowhere lip-top", "nowhere"),
        ("view 90 60 -90\nzoom ear 2 0 0", "eye, brow or mouth"),
        ("view 90 60 -90\nfill 255 pared eye-inner eye-outer lid-upper", "expected paired or -, found pared"),
        ("view 90 60 -90\nfill 255 eye-inner eye-outer lid-upper lid-lower", "expected paired or -, found eye-inner"),
        ("view 90 60 -90\nzoom eye 200 0 0", "beyond"),
        ("smile", "line 1"),
        ("view 90 60 -90\nview 90 60 -80", "line 2: a second view"),
        ("jaw 0.5\njaw 0.6", "line 2: a second jaw"),
        ("zoom eye 2 0 0\nzoom eye 2 0 1", "line 2: a second zoom eye"),
        ("view 90 60 -90\nhidden 0 1,2 3\nfill 255 - lip-corner lip-top lip-bottom", "no prop opens hidden shape 1"),
        ("hidden 0 1,2 2", "3 to 32 corners"),
        ("hidden 0 1 4", "expected aside,up"),
        ("prop hat 1 0,0", "no hidden shape 1 before it"),
        ("hidden 0 1,2 3\nprop hat 1 0,0 1,1", "3 corners, not 2"),
        ("hidden 0 1,2 3\nprop joy 1 0,0 1,1 2,2", "joy is a name of the face"),
        ("gain joy 2", "no unit joy"),
        ("gain smile 2\ngain smile 1", "line 2: a second gain smile"),
        ("block 255 - 0,1 -2,3 4,5", "aside is 0 or more"),
        ("block 255 paired 0,1 2,3", "3 to 32 corners"),
        ("move lid 1 . . .", "no block 1 before it"),
        ("block 255 paired 0,1 2,3 4,5\nmove lid 1 . .", "block 1 has 3 corners, not 2"),
        ("block 255 paired 0,1 2,3 4,5\nmove head_up 1 . . .", "no unit head_up"),
        ("block 255 paired 0,1 2,3 4,5\nmove lid 1 . . .\nmove lid 1 . . .", "lid moves block 1 already"),
        (
            "view 90 60 -90\nfill 255 paired eye-inner lid-upper eye-outer\nblock 255 paired 0,1 2,3 4,5\nmove lid 1 1,1 . .",
            "lid rotates points that are drawn",
        ),
    ] {
        let refused = format!("{:#}", cartoon::build(&face.head, &face.blueprint, table).unwrap_err());
        assert!(refused.contains(wanted), "{table}: {refused}");
    }
}

/// Compares the lines of two models with equal shapes over mixtures of weights, views and canvases of these heights.
fn assert_same_lines(one: &[u8], other: &[u8], heights: &[u16]) {
    let [one, other] = [one, other].map(|bytes| Model::new_checked(bytes).unwrap());
    let [mut a, mut b] = [Morph::<512>::new(&one).unwrap(), Morph::<512>::new(&other).unwrap()];
    let (mut state, mut seen) = (11u32, 0);
    let mut random = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % below
    };
    for &height in heights {
        for width in [height, 2 * height, height / 2] {
            for _ in 0..40 {
                let view = FaceView { orbit: random(361) as i16 - 180, tilt: random(121) as i16 - 60 };
                let view = if random(3) == 0 { FaceView::default() } else { view };
                let canvas = pantin_figure::Canvas { width, height };
                let mut renderers = [&one, &other].map(|model| FaceRenderer::<512>::new(model, canvas, view));
                for _ in 0..5 {
                    let mut weights = Weights::new();
                    for _ in 0..random(12) {
                        let sides = [[true, true], [true, false], [false, true]][random(3) as usize];
                        weights
                            .add_to(Target::new(random(one.shape_count() as u32) as u8, sides), random(98_304) as i32 - 32_768);
                    }
                    a.apply(&one, &weights);
                    b.apply(&other, &weights);
                    let mut lines = [Vec::new(), Vec::new()];
                    for (((model, morph), renderer), lines) in
                        [(&one, &a), (&other, &b)].into_iter().zip(&mut renderers).zip(&mut lines)
                    {
                        renderer.project(model, morph);
                        renderer.each_line(model, |line| lines.push(line));
                    }
                    seen += usize::from(!lines[0].is_empty());
                    assert!(lines[0] == lines[1], "{width}x{height}, {view:?}, {weights:?}");
                }
            }
        }
    }
    assert!(seen > 100 * heights.len(), "{seen} pictures show a face");
}

#[test]
fn the_face_of_small_displays_is_the_same_with_fewer_vertices() {
    let face = Face::new().unwrap();
    let small = small::small(&face.blueprint);
    let bytes = pantin_pictures::face::compact::encode(&small).unwrap();
    assert!(pantin_face::SMALL == bytes, "write it again by `pantin face model --small -o firmware/face/small.model`");
    assert_eq!(small.vertices(), SMALL_VERTICES);
    assert!(face.blueprint.vertices() <= VERTICES && small.vertices() + 40 <= face.blueprint.vertices());
    let error = error::greatest(&small, &bytes).unwrap();
    assert!(error.part < 0.001, "{error:?}");
    assert_eq!(small.name_list(), face.blueprint.name_list());
    assert_same_lines(&face.bytes, &bytes, &[16, 48, 64, SMALL_HEIGHT]);
}

#[test]
fn points_that_a_cartoon_does_not_draw_change_nothing() {
    let face = Face::new().unwrap();
    let whole = cartoon::whole(&face.head, &face.blueprint, cartoon::TABLE).unwrap();
    let reduced = cartoon::build(&face.head, &face.blueprint, cartoon::TABLE).unwrap();
    assert!(reduced.vertices() < whole.vertices(), "{} vertices", reduced.vertices());
    assert_eq!(reduced.vertices(), CARTOON_VERTICES);
    let [whole, reduced] = [whole, reduced].map(|face| pantin_pictures::face::compact::encode(&face).unwrap());
    assert_same_lines(&whole, &reduced, &[32, 64, 160, 240]);
}

/// Plays and draws a model, whatever it is.
fn play(model: &Model) {
    let Ok(mut morph) = Morph::<512>::new(model) else { return };
    for view in [FaceView::default(), FaceView { orbit: 70, tilt: -30 }] {
        let mut renderer = FaceRenderer::<512>::new(model, pantin_figure::Canvas { width: 240, height: 240 }, view);
        for weight in [0, 20_000, 1 << 15, -(1 << 15)] {
            let mut weights = Weights::new();
            (0..model.shape_count()).for_each(|shape| weights.add_to(Target::new(shape as u8, [true, shape % 2 == 0]), weight));
            morph.apply(model, &weights);
            renderer.project(model, &morph);
            let mut lines = 0;
            renderer.each_line(model, |_| lines += 1);
            assert!(lines < 1 << 16);
        }
    }
}

#[test]
fn hostile_bytes_are_refused_or_harmless() {
    let bytes = Face::new().unwrap().bytes;
    play(&Model::new_checked(&bytes).unwrap());
    play(&Model::new_checked(pantin_face::CARTOON).unwrap());
    for len in 0..bytes.len() {
        assert!(Model::new_checked(&bytes[..len]).is_err(), "{len} bytes are taken for all");
    }
    assert_eq!(Model::new_checked(&[9]).unwrap_err(), ModelError::UnsupportedVersion(9));
    let mut state = 7u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 8
    };
    for bit in (0..bytes.len() * 8).step_by(5) {
        let mut bad = bytes.clone();
        bad[bit / 8] ^= 1 << (bit % 8);
        if let Ok(model) = Model::new_checked(&bad) {
            play(&model);
        }
    }
    for round in 0..3000 {
        let mut bad = if round % 3 == 0 { pantin_face::CARTOON.to_vec() } else { bytes.clone() };
        for _ in 0..1 + random() % 6 {
            let place = random() as usize % bad.len();
            bad[place] = random() as u8;
        }
        if let Ok(model) = Model::new_checked(&bad) {
            play(&model);
        }
    }
}

#[test]
fn names_are_told_apart_by_their_hashes() {
    let face = Face::new().unwrap();
    let names: HashSet<&str> = face.blueprint.names.iter().map(|drive| drive.name.as_str()).collect();
    let hashes: HashSet<u32> = names.iter().map(|name| hash(name.as_bytes())).collect();
    assert_eq!(names.len(), hashes.len());
}

#[test]
fn all_that_arkit_tracks_is_known_but_the_eyes_own_angles() {
    let Some(path) = data("face_neurosync_angry_arkit.csv") else { return };
    let motion = crate::told::load(&path, &import::ImportOptions::new()).unwrap().motion;
    let face = Face::new().unwrap();
    for scalar in &motion.rig.scalars {
        let known = pose::parse(&face.blueprint, &scalar.name).is_ok();
        let angle = scalar.name.starts_with("LeftEye") || scalar.name.starts_with("RightEye");
        assert_ne!(known, angle, "{}", scalar.name);
    }
}

#[test]
fn a_pose_is_taken_apart_into_its_units() {
    let face = Face::new().unwrap();
    for sum in ["joy=0.7,wink_left=1,open_mouth=0.3", "sadness=0.5", "surprise=0.6,look_left=0.5,puff_cheeks_right=0.9"] {
        let pairs = pose::parse(&face.blueprint, sum).unwrap();
        let target = outside::obj_points(std::path::Path::new("pose.obj"), &export::obj(&face, &pairs).unwrap()).unwrap();
        let fit = fit::fit(&face.blueprint, &target).unwrap();
        assert!(fit.residual < 0.05, "{sum}: {} mm are left of {}", fit.residual, fit.before);
        for ((shape, wanted), found) in face.blueprint.shapes.iter().zip(&pairs).zip(&fit.pairs) {
            for (wanted, found) in wanted.iter().zip(found) {
                assert!((wanted - found).abs() < 0.05, "{sum}: {} is found {found}, not {wanted}", shape.name);
            }
        }
    }
}

/// A mesh of others moves, and the units that move it are found by its feature points.
#[test]
fn faces_of_other_meshes_are_taken_apart_by_their_feature_points() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    let mesh = outside::mesh(&folder.join("ball.obj"), &import::Disk::default()).unwrap();
    let points = points::parse(&std::fs::read_to_string(folder.join("ball.points")).unwrap()).unwrap();
    let built = onmesh::build(&mesh, &points).unwrap().blueprint;
    let face = Face::new().unwrap();
    let matched = fit::Matched::new(&face.head, &mesh, &points).unwrap();
    for (unit, shape) in [("smile", "smile"), ("lower_corners", "lower_corners"), ("brow_outer_raise", "brow_outer_raise")] {
        let pose = exact::places(&built, &pose::parse(&built, unit).unwrap());
        let rows = matched.rows(&face.head, &mesh.points, &pose[..mesh.points.len()]).unwrap();
        let fit = fit::fit_rows(&face.blueprint, &rows, fit::Limits { paper: true, most: 4 }).unwrap();
        assert!(fit.residual < 0.7 * fit.before, "{unit}: {} of {} mm are left", fit.residual, fit.before);
        // The round head's mouth is wider and flatter than ours: the unit is found, and it is the one that moves most.
        let own = fit.pairs[face.blueprint.shape(shape).unwrap()];
        let others = fit.pairs.iter().flatten().filter(|&&weight| weight > own[0]).count();
        assert!(own[0] > 0.15 && own[1] > 0.15 && others == 0, "{unit} is found {own:?}");
    }
}

#[test]
fn a_recording_is_taken_apart_into_few_weights_a_frame() {
    let Some(path) = data("fap_xface_joy.fap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("joy.keys");
    let out = std::process::Command::new(env!("CARGO_BIN_EXE_pantin"))
        .args(["face", "fit", "--json", "-o"])
        .args([&keys, &path])
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let report: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    let frames = report["frames"].as_array().unwrap();
    let motion = crate::told::load(&keys, &import::ImportOptions::new()).unwrap().motion;
    assert_eq!(motion.frames, frames.len());
    for frame in frames {
        assert!(frame["weights"].as_u64().unwrap() <= 8, "{frame}");
        let (residual, neutral) = (frame["residual_mm"].as_f64().unwrap(), frame["neutral_residual_mm"].as_f64().unwrap());
        assert!(residual <= 0.3 * neutral + 0.05, "{frame}");
    }
}

#[test]
fn meshes_from_outside_become_models() {
    for (name, vertices, targets) in [("gltf_khronos_morph-cube.glb", 24, 2), ("gltf_khronos_morph-stress.gltf", 1528, 8)] {
        let Some(path) = data(name) else { continue };
        let blueprint = outside::model(&path, &import::Disk::default()).unwrap();
        let bytes = pantin_pictures::face::compact::encode(&blueprint).unwrap();
        let model = Model::new_checked(&bytes).unwrap();
        assert_eq!((model.vertices(), model.shape_count()), (vertices, targets));
        let error = error::greatest(&blueprint, &bytes).unwrap();
        assert!(error.part < 0.001, "{name}: {error:?}");
    }
}

#[test]
fn own_motions_are_small_faces_that_begin_and_end_at_rest() {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(repository().join("motions/face")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "keys"));
    files.sort();
    assert_eq!(files.len(), 16);
    let folder = std::env::temp_dir().join(format!("pantin-face-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut total = 0;
    for file in &files {
        let clip = folder.join(file.file_name().unwrap()).with_extension("ptn");
        let bytes = converted(file, &clip);
        total += bytes.len();
        let clip = pantin::Clip::new_checked(&bytes).unwrap();
        assert!(clip.frames() > 30 && is_face(&clip).unwrap(), "{}", file.display());
        let motion = crate::told::load(file, &import::ImportOptions::new()).unwrap().motion;
        let rests = |values: &Vec<f64>| values[0].abs() < 1e-9 && values[values.len() - 1].abs() < 1e-9;
        assert!(motion.values.iter().all(rests), "{}: begins or ends with a face", file.display());
        let view = pantin_figure::View { orbit: 0, tilt: 0, ..Default::default() };
        let mut cast = Cast::of_clip(&clip, Canvas { width: 128, height: 64 }, &[view]).unwrap().unwrap();
        let mut states = vec![pantin::ChannelState::default(); clip.moving()];
        let mut pose = vec![0; clip.rig().channels()];
        let mut player = pantin::Player::new(clip, &mut states, &mut pose).unwrap();
        let before = cast.lines(player.pose().values, 0);
        player.seek(clip.frames() / 2);
        assert_ne!(cast.lines(player.pose().values, 0), before, "{}: nothing happens", file.display());
    }
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(total <= 2 << 10, "{total} bytes");
}

/// The bytes of `file` converted to `clip` at the scalar error at which our faces are shipped.
fn converted(file: &Path, clip: &Path) -> Vec<u8> {
    let out = std::process::Command::new(env!("CARGO_BIN_EXE_pantin"))
        .args(["convert", "--max-scalar-error", "2", "-o"])
        .args([clip, file])
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    std::fs::read(clip).unwrap()
}

#[test]
fn the_emotes_are_small_loops_that_move_the_face() {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(repository().join("motions/emotes")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let names: Vec<String> = files.iter().map(|file| file.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    let wanted = "angry confident confused cool crying curious delicious embarrassed funny happy kissy laughing listening loving neutral \
        relaxed sad shocked silly sleepy surprised thinking winking";
    assert_eq!(names, wanted.split_whitespace().collect::<Vec<_>>());
    let folder = tempfile::tempdir().unwrap();
    let mut total = pantin_face::MODEL.len() + pantin_face::CARTOON.len();
    for file in &files {
        let clip = folder.path().join("emote.ptn");
        let bytes = converted(file, &clip);
        total += bytes.len();
        let clip = pantin::Clip::new_checked(&bytes).unwrap();
        let seconds = f64::from(clip.frames()) * f64::from(clip.frame_time_ns()) * 1e-9;
        assert!((1.0..=2.01).contains(&seconds) && clip.looped(), "{}: {seconds} s", file.display());
        assert!(is_face(&clip).unwrap(), "{}", file.display());
        let view = pantin_figure::View { orbit: 0, tilt: 0, ..Default::default() };
        let mut cast = Cast::of_clip(&clip, Canvas { width: 128, height: 64 }, &[view]).unwrap().unwrap();
        let mut states = vec![pantin::ChannelState::default(); clip.moving()];
        let mut pose = vec![0; clip.rig().channels()];
        let frames = clip.frames();
        let mut player = pantin::Player::new(clip, &mut states, &mut pose).unwrap();
        let mut pictures = std::collections::HashSet::new();
        for frame in (0..frames).step_by(5) {
            player.seek(frame);
            pictures.insert(format!("{:?}", cast.lines(player.pose().values, 0)));
        }
        assert!(pictures.len() >= 2, "{}: nothing moves", file.display());
    }
    assert!(total <= 12 << 10, "{total} bytes with both models");
}

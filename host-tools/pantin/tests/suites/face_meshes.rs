//! The paper's rules on meshes: Candide-3, a round head of our own, and Pantin's head as a mesh of others.

use pantin_convert::import::Disk;
use pantin_face::shape::Interpolation;
use pantin_face::{FaceView, Model};
use pantin_figure::Canvas;
use pantin_pictures::face::blueprint::Blueprint;
use pantin_pictures::face::head::Vector;
use pantin_pictures::face::points::{self, Points};
use pantin_pictures::face::{Face, compact, draw, error, exact, export, onmesh, outside, pose};
use std::path::{Path, PathBuf};

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes")
}

fn read(points: &str) -> Points {
    points::parse(&std::fs::read_to_string(meshes().join(points)).unwrap()).unwrap()
}

/// A mesh's name, the face, and its feature points.
type Subject = (&'static str, Blueprint, Points);

fn subjects() -> Vec<Subject> {
    let mut subjects = Vec::new();
    let ball = outside::mesh(&meshes().join("ball.obj"), &Disk::default()).unwrap();
    subjects.push(("ball", ball, read("ball.points")));
    let face = Face::new().unwrap();
    let neutral = pose::parse(&face.blueprint, "").unwrap();
    let own = outside::obj(Path::new("ours.obj"), &export::obj(&face, &neutral).unwrap()).unwrap();
    subjects.push(("ours", own, face.head.features().map(|(name, index)| (name.to_string(), index)).collect()));
    let data = std::env::var_os("PANTIN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let candide = data.join("facemodel_candide3.wfm");
    if candide.exists() {
        subjects.push(("candide", outside::mesh(&candide, &Disk::default()).unwrap(), read("candide3.points")));
    } else {
        eprintln!("skipped: facemodel_candide3.wfm is not in $PANTIN_DATA");
    }
    let build = |(name, mesh, points)| {
        let built = onmesh::build(&mesh, &points).unwrap();
        assert!(built.missing.is_empty(), "{name} lacks {}", onmesh::list(&built.missing));
        (name, built.blueprint, points)
    };
    subjects.into_iter().map(build).collect()
}

fn posed(face: &Blueprint, sum: &str) -> Vec<Vector> {
    exact::places(face, &pose::parse(face, sum).unwrap())
}

#[test]
fn the_rules_hold_on_every_mesh_with_feature_points() {
    for (mesh, face, points) in subjects() {
        let neutral = face.neutral();
        let at = |places: &[Vector], point: &str| places[points[point]];
        let width = at(&neutral, "8.3")[0] - at(&neutral, "8.4")[0];
        assert!(width > 0.0, "{mesh}: x points to the left");
        let level = |sum: &str, names: &[&str], neutral_height: &str| {
            let places = posed(&face, sum);
            for name in names {
                let gap = (at(&places, name)[1] - at(&neutral, neutral_height)[1]) / width;
                assert!(gap.abs() < 1e-9, "{mesh}: {sum} brings {name} {gap} mouths above {neutral_height}");
            }
        };
        level("smile", &["8.3", "8.5", "8.10"], "8.10");
        level("smile", &["8.4", "8.6", "8.9"], "8.9");
        level("smile", &["2.4", "2.8"], "8.5");
        level("lower_corners", &["8.3", "8.7", "8.4", "8.8"], "8.2");
        level("lower_corners", &["2.4", "2.6"], "2.8");
        level("brow_outer_raise", &["4.5"], "4.3");
        level("brow_outer_raise_right", &["4.6"], "4.4");
        let places = posed(&face, "open_mouth");
        let (jaw, chin, lip) = (at(&neutral, "2.13"), at(&neutral, "2.1"), at(&places, "2.3"));
        let slope = |place: Vector| (place[1] - jaw[1]).atan2(place[2] - jaw[2]);
        assert!((slope(lip) - slope(chin)).abs() < 1e-9, "{mesh}: 2.3 is not on the line to 2.1");
        for still in ["2.13", "8.3", "2.4", "2.2", "2.6", "8.1", "5.1", "4.1"] {
            assert_eq!(at(&places, still), at(&neutral, still), "{mesh}: {still} moves with the jaw");
        }
        let puffed = posed(&face, "puff_cheeks");
        let cheeks = |places: &[Vector]| {
            let [a, b] = ["5.1", "5.2"].map(|point| at(places, point));
            ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt()
        };
        assert!((cheeks(&puffed) / cheeks(&neutral) - 1.2).abs() < 1e-9, "{mesh}");
        // Lips do not pass through each other.
        for sum in ["smile", "lower_corners", "open_mouth", "wide_smile", "joy", "sadness", "surprise"] {
            let places = posed(&face, sum);
            for (upper, lower) in [("2.2", "2.3"), ("2.6", "2.8"), ("2.7", "2.9")] {
                let gap = (at(&places, upper)[1] - at(&places, lower)[1]) / width;
                assert!(gap > -1e-6, "{mesh}: {sum} brings {upper} below {lower}");
            }
        }
    }
}

#[test]
fn models_of_meshes_keep_the_devices_tolerance_and_show_every_unit() {
    for (mesh, face, _) in subjects() {
        let bytes = compact::encode(&face).unwrap();
        let error = error::greatest(&face, &bytes).unwrap();
        assert!(error.part < 0.002, "{mesh}: {error:?}");
        let model = Model::new_checked(&bytes).unwrap();
        let canvas = Canvas { width: 240, height: 240 };
        let picture =
            |sum: &str| draw::picture(&model, &pose::weights(&pose::parse(&face, sum).unwrap()), canvas, FaceView::default());
        let neutral = picture("");
        assert!(neutral.iter().filter(|&&pixel| pixel > 0).count() > 1000, "{mesh} is hardly drawn");
        for unit in
            ["open_mouth", "smile_left", "lower_corners_right", "brow_inner_lower", "brow_outer_raise", "puff_cheeks", "sadness"]
        {
            let changed = picture(unit).iter().zip(&neutral).filter(|(a, b)| a != b).count();
            assert!(changed > 40, "{mesh}: {unit} changes {changed} pixels");
        }
    }
}

#[test]
fn missing_and_contradicting_points_are_named() {
    let mesh = outside::mesh(&meshes().join("ball.obj"), &Disk::default()).unwrap();
    let all = read("ball.points");
    let mut some = all.clone();
    some.remove("4.5");
    some.remove("5.1");
    let built = onmesh::build(&mesh, &some).unwrap();
    assert_eq!(built.missing["4.5"], ["brow_inner_lower", "brow_outer_raise"]);
    assert_eq!(built.missing["5.1"], ["open_mouth", "puff_cheeks", "wide_smile"]);
    assert!(pose::parse(&built.blueprint, "joy").is_ok() && pose::parse(&built.blueprint, "surprise").is_err());
    let refused = |points: &Points| format!("{:#}", onmesh::build(&mesh, points).err().unwrap());
    assert!(refused(&Points::from([("8.3".into(), 3)])).contains("which way"));
    assert!(refused(&Points::from([("8.3".into(), 3_000)])).contains("no vertex 3000"));
    let mut swapped = all.clone();
    for (left, right) in [("8.3", "8.4"), ("2.4", "2.5"), ("5.1", "5.2")] {
        swapped.insert(left.into(), all[right]);
        swapped.insert(right.into(), all[left]);
    }
    assert!(refused(&swapped).contains("swapped"));
}

#[test]
fn the_points_of_xface_are_read() {
    let data = std::env::var_os("PANTIN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let Ok(text) = std::fs::read_to_string(data.join("facemodel_xface_alice.fdp")) else {
        return eprintln!("skipped: facemodel_xface_alice.fdp is not in $PANTIN_DATA");
    };
    let points = points::parse(&text).unwrap();
    assert_eq!((points["8.3"], points["2.1"], points["4.6"]), (35, 2395, 4313));
    assert!(points.len() >= 30, "{} points", points.len());
}

#[test]
fn a_units_interpolation_and_angle_are_chosen_by_name() {
    let mut face = Face::new().unwrap().blueprint;
    face.choose("smile=spherical:40").unwrap();
    face.choose("puff_cheeks=linear").unwrap();
    let shape = |face: &Blueprint, name: &str| face.shapes[face.shape(name).unwrap()].clone();
    assert_eq!(shape(&face, "puff_cheeks").interpolation, Interpolation::Linear);
    assert_eq!(shape(&face, "smile").arc.unwrap().degrees, 40.0);
    // The device moves on the same arc.
    let bytes = compact::encode(&face).unwrap();
    assert!(error::greatest(&face, &bytes).unwrap().part < 0.001);
    let half = |face: &Blueprint| posed(face, "smile=0.5");
    let far = half(&face);
    face.choose("smile=spherical:90").unwrap();
    assert_ne!(far, half(&face), "the angle bends the arc");
    for (choice, wanted) in [
        ("smile=round", "expected linear"),
        ("grin=linear", "no unit"),
        ("smile=spherical:400", "2 to 120"),
        ("smile=linear:20", "only spherical"),
        ("funnel=spherical", "no centre"),
        ("smile", "unit=kind"),
    ] {
        let refused = format!("{:#}", face.choose(choice).unwrap_err());
        assert!(refused.contains(wanted), "{choice}: {refused}");
    }
}

#[test]
fn what_is_wrong_in_a_mesh_is_named_with_its_line() {
    let folder = tempfile::TempDir::new().unwrap();
    let refused = |name: &str, text: &str, wanted: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let said = format!("{:#}", outside::mesh(&path, &Disk::default()).expect_err(wanted));
        assert!(said.contains(&format!("{name}:{wanted}")), "{text:?}: no `{wanted}` in: {said}");
    };
    let obj = "# three\nv 0 0 0\nv 1 0 0 # right\nv 0 1 0\nf 1/1 2/2 3/3\n";
    for (from, to, wanted) in [
        ("v 1 0 0", "v nan 0 0", "3: expected a finite number of at most 1e9, found `nan`"),
        ("v 1 0 0", "v 0 -inf 0", "3: expected a finite number of at most 1e9, found `-inf`"),
        ("v 1 0 0", "v 0 0 1e308", "3: expected a finite number of at most 1e9, found `1e308`"),
        ("v 1 0 0", "v 0 0 x", "3: expected a number, found `x`"),
        ("v 1 0 0", "v 1 0", "3: expected x, y and z"),
        ("3/3", "999999", "5: no vertex 999999; there are 3"),
        ("3/3", "0", "5: no vertex 0; there are 3"),
        ("3/3", "-4", "5: no vertex -4; there are 3"),
        ("3/3", "-9223372036854775808", "5: no vertex -9223372036854775808"),
        ("3/3", "x", "5: expected the number of a vertex, found `x`"),
        ("3/3", "", "5: a face of 2 corners; expected 3 or more"),
        ("3/3\n", "3/3\n\0\0\0\0", "6: a NUL byte; expected text"),
        ("3/3", "3/3\0", "5: a NUL byte; expected text"),
    ] {
        assert!(obj.contains(from));
        refused("a.obj", &obj.replacen(from, to, 1), wanted);
    }
    let points = format!("{:#}", outside::obj_points(Path::new("b.obj"), "v 1 2\n").unwrap_err());
    assert_eq!(points, "b.obj:1: expected x, y and z");
    let wfm = "# VERTEX LIST:\n3\n0 0 0\n1 0 0\n0 1 0\n\n# FACE LIST:\n1\n0 1 2\n\n# END\n";
    for (from, to, wanted) in [
        ("1 0 0", "1 inf 0", "4: expected a finite number of at most 1e9, found `inf`"),
        ("1 0 0", "1 0", "4: expected x, y and z"),
        ("3\n0", "99999999999\n0", "2: `VERTEX LIST:` has 5 rows; its number says 99999999999"),
        ("3\n0", "-3\n0", "2: expected the number of rows of `VERTEX LIST:`"),
        ("0 1 2", "0 1 3", "9: expected a vertex of 0 to 2, found `3`"),
        ("0 1 2", "0 1 1e300", "9: expected a vertex of 0 to 2, found `1e300`"),
        ("0 1 2", "0 1 NaN", "9: expected a vertex of 0 to 2, found `NaN`"),
        ("0 1 2", "0 1 1.5", "9: expected a vertex of 0 to 2, found `1.5`"),
        ("0 1 2", "0 1", "9: expected a face of three vertices"),
        ("FACE LIST:", "FACES:", " no `FACE LIST:`"),
        ("# END\n", "\0\0", "11: a NUL byte; expected text"),
    ] {
        assert!(wfm.contains(from));
        refused("a.wfm", &wfm.replacen(from, to, 1), wanted);
    }
    for (name, text) in [("a.obj", obj), ("a.wfm", wfm)] {
        std::fs::write(folder.path().join(name), text).unwrap();
        let mesh = outside::mesh(&folder.path().join(name), &Disk::default()).unwrap();
        assert_eq!((mesh.points.len(), &mesh.triangles[..]), (3, &[[0, 1, 2]][..]), "{name}");
    }
}

//! Options that do not apply to an input are refused, and bounds that bound nothing are named.

use super::interchange::WORLD;
use super::manners::prepared;
use super::outputs::err;

/// Options of `render` for figures: a chart is drawn as it is.
const OF_FIGURES: [&[&str]; 14] = [
    &["--size", "99x99"],
    &["--scale", "2"],
    &["--palette", "dusk"],
    &["--pixels"],
    &["--smooth"],
    &["--view", "side"],
    &["--tilt", "5"],
    &["--look", "a.look"],
    &["--up", "x"],
    &["--fixed"],
    &["--from", "1"],
    &["--to", "1"],
    &["--frame", "1"],
    &["--strip", "2"],
];

/// Bounds of joints.
const OF_JOINTS: [&str; 5] = ["--max-error", "--mean-error", "--max-rotation-error", "--max-joint-error", "--cm-per-unit"];

#[test]
fn options_of_other_motion_files_are_refused() {
    let folder = prepared();
    for (option, value, wanted) in [
        ("--animation", "Walk", ["--animation Walk", "one motion"]),
        ("--animation", "all", ["--animation all", "one motion"]),
        ("--skeleton", "walk.keys", ["--skeleton walk.keys", ".amc"]),
    ] {
        let said = folder.refused(&["convert", "run.keys", "-o", "b.ptn", option, value]);
        assert!(wanted.iter().all(|wanted| said.contains(wanted)), "{said}");
    }
    for inputs in [&["in"][..], &["run.keys", "in/light.csv"]] {
        for option in [["--animation", "0"], ["--skeleton", "walk.keys"]] {
            let said = folder.refused(&[&["convert"], inputs, &["-o", "out"], &option].concat());
            assert!(said.contains("none of these files"), "{said}");
        }
    }
    assert!(!folder.path("b.ptn").exists() && !folder.path("out").exists());
}

#[test]
fn among_several_motions_options_are_for_those_that_take_them() {
    let folder = prepared();
    folder.put("in/world.wrl", WORLD);
    folder.done(&["convert", "in", "-o", "out", "--animation", "smile"]);
    folder.done(&["convert", "in/world.wrl", "-o", "smile.ptn", "--animation", "Smile"]);
    assert!(folder.get("out/world.ptn") == folder.get("smile.ptn") && folder.path("out/light.ptn").exists());
}

#[test]
fn options_of_figures_are_refused_for_charts() {
    let folder = prepared();
    folder.done(&["convert", "in/light.csv", "-o", "light.ptn"]);
    for option in OF_FIGURES {
        let said = folder.refused(&[&["render", "light.ptn", "-o", "light.png"], option].concat());
        assert!(said.contains(option[0]) && said.contains("chart"), "{said}");
    }
    for option in [&["--fixed"][..], &["--view", "side"]] {
        let said = folder.refused(&[&["play", "light.ptn", "--plain", "--once"], option].concat());
        assert!(said.contains(&format!("{} has no effect", option[0])), "{said}");
    }
}

#[test]
fn bounds_that_bound_nothing_are_named() {
    let folder = prepared();
    for option in OF_JOINTS {
        let said = err(&folder.done(&["convert", "in/light.csv", "-o", "light.ptn", option, "1"]));
        assert!(said.contains(&format!("{option} has no effect: the motion has no joints")), "{said}");
    }
    let arguments = ["convert", "run.keys", "-o", "run.ptn", "--effort", "fast"];
    let said = err(&folder.done(&[&arguments[..], &["--max-scalar-error", "1"]].concat()));
    assert!(said.contains("--max-scalar-error has no effect: the motion has no scalars"), "{said}");
    // No joint of this figure has three angles.
    for rotations in ["quaternion", "exponential"] {
        let said = err(&folder.done(&[&arguments[..], &["--rotations", rotations]].concat()));
        assert!(said.contains("--rotations has no effect: the motion has no joint"), "{said}");
    }
}

#[test]
fn options_of_pictures_and_colours_are_refused_without_them() {
    let folder = prepared();
    for option in [["--size", "200x200"], ["--scale", "3"]] {
        let said = folder.refused(&[&["face", "export", "-o", "joy.obj"], &option[..]].concat());
        assert!(said.contains(option[0]) && said.contains(".png"), "{said}");
    }
    for option in ["--palette=amber", "--colours=none"] {
        let output = folder.run(&["play", "a.ptn", "--plain", "--once", option]);
        assert!(output.status.code() == Some(2) && err(&output).contains("--plain"), "{option}: {}", err(&output));
    }
}

#[test]
fn a_rig_that_nothing_needs_is_refused() {
    let folder = prepared();
    folder.done(&["convert", "run.keys", "-o", "apart.ptn", "--rig-out", "run.rig", "--effort", "fast"]);
    for arguments in [&["info", "a.ptn"][..], &["expand", "a.ptn", "-o", "a.bvh"], &["render", "a.ptn", "-o", "a.gif"]] {
        let said = folder.refused(&[arguments, &["--rig", "run.rig"]].concat());
        assert!(said.contains("the clip has its own rig"), "{said}");
    }
    folder.done(&["info", "apart.ptn", "--rig", "run.rig"]);
}

#[test]
fn options_of_clips_and_weights_without_meaning_are_refused() {
    let folder = prepared();
    assert!(folder.refused(&["face", "fit", "face.obj", "--frame", "3"]).contains("--frame is for clips"));
    let angles = ["face", "compare", "--angle", "smile=60", "--angle", "smile=61"];
    assert!(folder.refused(&angles).contains("smile comes twice"));
    for weight in ["nan", "1e300", "-101"] {
        let said = folder.refused(&["face", "export", "-o", "joy.obj", "--pose", &format!("joy={weight}")]);
        assert!(said.contains("expected a weight"), "{said}");
    }
    for wrong in [
        &["convert", "--list", "run.keys", "-o", "b.ptn"][..],
        &["stream", "a.ptn", "--to", "tcp:127.0.0.1:1", "--max-scalar-error", "1"],
    ] {
        assert_eq!(folder.run(wrong).status.code(), Some(2), "{wrong:?}");
    }
}

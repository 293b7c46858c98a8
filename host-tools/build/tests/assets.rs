//! What a build script makes of motions, clips and banks, and why it fails.

use pantin_build::{Edits, Length, Options, Recipe, bank, clip};
use std::path::{Path, PathBuf};

fn motions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions")
}

fn written(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

const NOD: &str = "HIERARCHY ROOT hips { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation End Site { OFFSET 0 100 0 } } \
                   MOTION Frames: 3 Frame Time: 0.04\n0 0 0\n1 0 0\n2 0 0\n";

#[test]
fn a_motion_is_converted_by_its_recipe_and_always_to_the_same_text() {
    let recipe = Recipe::new().options(Options::new().max_error(Length::cm(2.0)));
    let asset = clip(motions().join("walk.keys")).recipe(recipe);
    let (first, second) = (asset.generate().unwrap(), asset.generate().unwrap());
    assert_eq!((first.file_name.as_str(), &first.text), ("walk.rs", &second.text));
    assert_eq!(first.inputs, [motions().join("walk.keys")]);
    let lines = [
        "/// Source: walk.keys.\n",
        "/// Verified: error max ",
        "pub type WalkRoom = pantin::Room<WALK_MOVING, WALK_CHANNELS>;\n",
    ];
    assert!(lines.iter().all(|line| first.text.contains(line)), "{}", first.text);
    assert!(!first.text.contains("WalkFigure") && !first.text.contains(env!("CARGO_MANIFEST_DIR")));
    let default = clip(motions().join("walk.keys")).generate().unwrap();
    assert!(default.bytes.len() > first.bytes.len());
}

/// Without feature `keys` of the decoder, such a program does not compile, instead of failing when it runs.
#[test]
fn motions_become_segments_and_a_key_clip_names_its_feature() {
    let vectors = motions().join("../tests/key-vectors");
    let walk = clip(vectors.join("walk.ptn")).generate().unwrap();
    assert!(walk.text.contains("feature `keys`") && walk.text.contains("= pantin::Clip::has_keys;\n"));
    assert!(bank(vectors.join("bank.ptb")).generate().unwrap().text.contains("pantin::Clip::has_keys"));
    assert!(!clip(motions().join("greet.keys")).generate().unwrap().text.contains("has_keys"));
}

#[test]
fn clips_and_banks_are_taken_as_they_are() {
    let walk = clip(motions().join("walk.ptn")).with_figure().generate().unwrap();
    assert_eq!(walk.bytes, std::fs::read(motions().join("walk.ptn")).unwrap());
    assert!(walk.text.contains("pub type WalkFigure = pantin_figure::FigureRenderer<WALK_FIGURE_JOINTS>;"));
    let moves = bank(motions().join("character.ptb")).name("MOVES").generate().unwrap();
    assert_eq!(moves.file_name, "moves.rs");
    assert!(moves.text.contains("pub static MOVES: [u8; ") && moves.text.contains("pub const MOVES_CLIPS: usize = "));
}

#[test]
fn every_file_that_is_read_is_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let nod = written(&folder, "nod.bvh", NOD);
    let face = written(&folder, "face.csv", "time,smile\n0,0\n0.04,0.5\n0.08,1\n");
    let made = clip(&nod).recipe(Recipe::new().edits(Edits::new().with(&face))).generate().unwrap();
    assert_eq!(made.inputs, [face, nod]);
}

#[test]
fn warnings_are_lines_that_name_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let twice = NOD.replace("Zrotation", "Xrotation");
    let made = clip(written(&folder, "nod.bvh", &twice)).generate().unwrap();
    assert_eq!(made.warnings.len(), 1, "{:?}", made.warnings);
    assert!(made.warnings[0].contains("nod.bvh: ") && !made.warnings[0].contains('\n'));
}

#[test]
fn errors_say_what_where_and_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let wrong = written(&folder, "wrong.bvh", "HIERARCHY\nROOT hips\n[");
    let nod = written(&folder, "nod.bvh", NOD);
    let scalars = written(&folder, "face.csv", "time,smile\n0,0\n0.04,0.5\n0.08,1\n");
    let recipe = |options| Recipe::new().options(options);
    let cases = [
        (clip(folder.path().join("none.keys")), "none.keys: cannot be read: ", "check the path"),
        (clip(&wrong), "wrong.bvh:3: ", "mend the file"),
        (clip(&nod).name("nod"), "\"nod\" is no name of a constant", "give `name` a name such as WALK"),
        (
            clip(&nod).recipe(recipe(Options::new().max_error(Length::cm(-1.0)))),
            "largest error: expected a length above 0, at most 10 km",
            "largest error",
        ),
        (
            clip(&nod).recipe(recipe(Options::new().rig_apart(true))),
            "nod.bvh: the recipe keeps the rig out",
            "leave out `rig_apart`",
        ),
        (clip(&scalars).with_figure(), "face.csv: there is no figure in it", "leave out `with_figure`"),
        (clip(motions().join("walk.ptn")).recipe(Recipe::new()), "walk.ptn: converted already", "leave out `recipe`"),
        (clip(motions().join("character.ptb")), "character.ptb: a bank", "use `pantin_build::bank`"),
        (bank(motions().join("walk.keys")), "walk.keys: not a bank", "use `pantin_build::clip`"),
    ];
    for (asset, what, help) in cases {
        let error = asset.generate().unwrap_err();
        let text = format!("{error:?}");
        assert_eq!(text, error.to_string());
        let (first, second) = text.split_once("\n  help: ").unwrap();
        assert!(first.contains(what) && second.contains(help), "{text}");
    }
}

#[test]
fn outside_of_a_build_script_nothing_is_written() {
    if std::env::var_os("OUT_DIR").is_none() {
        let error = clip(motions().join("walk.ptn")).emit().unwrap_err().to_string();
        assert!(error.contains("there is no OUT_DIR"), "{error}");
    }
}

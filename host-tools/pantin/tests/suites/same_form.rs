//! `pantin convert A B --same-form`: clips of one rig get one length exponent and the same joints as exponential maps.

use crate::real::files;
use pantin::Clip;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// What a pose's numbers mean: the length exponent, and the joints coded as exponential maps.
fn form(path: &Path) -> (i8, Vec<usize>) {
    let bytes = std::fs::read(path).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let joints = (0..clip.rig().joint_count()).filter(|&joint| clip.is_exponential(joint));
    (clip.length_exponent(), joints.collect())
}

fn whole_form(path: &Path) -> pantin::Form {
    Clip::new_checked(&std::fs::read(path).unwrap()).unwrap().form()
}

fn convert(motions: &[PathBuf], options: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
    command.arg("convert").args(motions).args(["--effort", "fast"]).args(options);
    command.current_dir(folder).output().unwrap()
}

fn succeeds(motions: &[PathBuf], options: &[&str], folder: &Path) {
    let output = convert(motions, options, folder);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn refusal(motions: &[PathBuf], options: &[&str], folder: &Path) -> String {
    let output = convert(motions, options, folder);
    assert!(!output.status.success());
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Each motion alone, then both together; the forms of both.
fn alone_and_together(motions: &[PathBuf; 2], folder: &Path) -> [[(i8, Vec<usize>); 2]; 2] {
    let clip = |motion: &PathBuf| Path::new(motion.file_stem().unwrap()).with_extension("ptn");
    for motion in motions {
        succeeds(std::slice::from_ref(motion), &["--segments", "-o", clip(motion).to_str().unwrap()], folder);
    }
    succeeds(motions, &["--same-form", "-o", "together"], folder);
    let forms = |folder: &Path| motions.each_ref().map(|motion| form(&folder.join(clip(motion))));
    let [one, other] = motions.each_ref().map(|motion| whole_form(&folder.join("together").join(clip(motion))));
    assert_eq!(one.check(&other), Ok(()), "what a figure renderer compares");
    [forms(folder), forms(&folder.join("together"))]
}

/// Our knee bend, and beside it a motion of its figure that leaps 3 m and bends its left knee about one axis.
fn own(folder: &Path) -> [PathBuf; 2] {
    let bend = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/kneebend.keys");
    let text = std::fs::read_to_string(&bend).unwrap();
    let figure = &text[..text.find("\nkeys ").unwrap()];
    let leap = "\nkeys discrete hips.Yposition\n 0 0\n 72 300\nkeys discrete left-shin.Xrotation\n 0 5\n 60 70\n";
    std::fs::write(folder.join("leap.keys"), [figure, leap].concat()).unwrap();
    [bend, folder.join("leap.keys")]
}

#[test]
fn clips_of_one_rig_get_one_form() {
    let folder = TempDir::new().unwrap();
    let [alone, together] = alone_and_together(&own(folder.path()), folder.path());
    assert!(alone[0].0 < alone[1].0, "a leap of 3 m has the larger length exponent: {alone:?}");
    assert!(!alone[0].1.is_empty() && alone[1].1.is_empty(), "only the knee bend has exponential maps: {alone:?}");
    assert_eq!(together[0], together[1]);
    assert_eq!(together[0].0, alone[1].0);
    assert!(!together[0].1.is_empty(), "the knee bend gains more than the leap loses");
}

#[test]
fn rigs_may_be_apart_and_bounds_of_channels_have_one_form_too() {
    let folder = TempDir::new().unwrap();
    let motions = own(folder.path());
    succeeds(&motions, &["--same-form", "-o", "clips", "--rig-out", "figure.rig", "--exact"], folder.path());
    let rig = std::fs::read(folder.path().join("figure.rig")).unwrap();
    let exponents = ["kneebend", "leap"].map(|name| {
        let bytes = std::fs::read(folder.path().join("clips").join(name).with_extension("ptn")).unwrap();
        let clip = Clip::with_rig(&bytes, &rig).unwrap();
        assert!(clip.rig_len() == 0 && (0..clip.rig().joint_count()).all(|joint| !clip.is_exponential(joint)));
        clip.length_exponent()
    });
    assert_eq!(exponents[0], exponents[1]);
}

#[test]
fn another_rig_is_refused_by_file_and_joint_and_nothing_is_written() {
    let folder = TempDir::new().unwrap();
    let [bend, leap] = own(folder.path());
    let text = std::fs::read_to_string(&leap).unwrap();
    let cases = [
        (text.replace("left-toes", "left-ball"), "joint 21 is `left-ball` instead of `left-toes`"),
        (text.replace("parent left-shin offset 0 -41 0", "parent left-shin offset 0 -40 0"), "joint `left-foot` has the offset"),
        (
            text.replace("-41 0 channels Zrotation Yrotation Xrotation", "-41 0 channels Yrotation Zrotation Xrotation"),
            "joint `left-foot` has the channels Yrotation Zrotation Xrotation instead of Zrotation Yrotation Xrotation",
        ),
        (
            text.replace("parent chest offset 0 23.6 3.4", "parent spine offset 0 23.6 3.4"),
            "joint `neck` is below spine instead of chest",
        ),
        (text.replace("cm-per-unit 1", "cm-per-unit 2"), "its unit is 2 cm instead of 1 cm"),
        (
            text.replace("\nkeys discrete hips", "\nscalar smile scale 1\nkeys discrete hips"),
            "it also has 1 channel that moves no joint: `smile`",
        ),
    ];
    for (other, message) in cases {
        std::fs::write(folder.path().join("other.keys"), &other).unwrap();
        let motions = [bend.clone(), folder.path().join("other.keys")];
        let error = refusal(&motions, &["--same-form", "-o", "clips"], folder.path());
        assert!(error.contains("other.keys: another rig than ") && error.contains(message), "{error}");
    }
    assert!(!folder.path().join("clips").exists());
}

#[test]
fn what_cannot_be_one_set_is_refused() {
    let folder = TempDir::new().unwrap();
    let [bend, leap] = own(folder.path());
    let error = refusal(&[bend.clone(), bend.clone()], &["--same-form", "-o", "clips"], folder.path());
    assert!(error.contains("both would be written to"), "{error}");
    let error = refusal(&[bend, folder.path().into()], &["--same-form", "-o", "clips"], folder.path());
    assert!(error.contains("a folder; --same-form needs motion files"), "{error}");
    std::fs::write(folder.path().join("file"), "").unwrap();
    let error = refusal(&[leap], &["--same-form", "-o", "file"], folder.path());
    assert!(error.contains("a file; --same-form needs a folder"), "{error}");
}

/// The walk and the bow of one captured actor, whose forms differ when each is converted for itself.
#[test]
fn captured_clips_of_one_actor_get_one_form() {
    let of = |name: &str| files(&["bvh"]).into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == name));
    let (Some(walk), Some(bow)) = (of("bvh_bandai1_walk"), of("bvh_bandai1_bow")) else { return };
    let folder = TempDir::new().unwrap();
    let [alone, together] = alone_and_together(&[walk, bow], folder.path());
    assert!(alone[0].0 != alone[1].0 && alone[0].1 != alone[1].1, "{alone:?}");
    assert_eq!(together[0], together[1]);
}

#[test]
fn a_list_gives_each_motion_a_cut_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::create_dir(path("captures")).unwrap();
    let own = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name);
    std::fs::copy(own("walk.keys"), path("captures/my walk.keys")).unwrap();
    std::fs::copy(own("run.keys"), path("captures/run.keys")).unwrap();
    let list = "# Two cuts of the walk, and the run.\n\"my walk.keys\" --name start --to 9 --with face.csv\n\"my walk.keys\" --name end --from 0.5s --with face.csv\nrun.keys --with face.csv\n";
    std::fs::write(path("captures/face.csv"), "time,smile\n0,0\n1,1\n").unwrap();
    std::fs::write(path("face.csv"), "time,frown\n0,0\n1,1\n").unwrap();
    std::fs::write(path("captures/moves.list"), list).unwrap();
    succeeds(&["captures/moves.list".into()], &["--same-form", "-o", "moves.ptb"], folder.path());
    let bytes = std::fs::read(path("moves.ptb")).unwrap();
    let bank = pantin::Bank::new_checked(&bytes).unwrap();
    let clips: Vec<(String, u32, i8)> = bank
        .entries()
        .map(|entry| (entry.name().into(), bank.open(&entry).unwrap()))
        .map(|(name, clip): (String, Clip)| (name, clip.frames(), clip.length_exponent()))
        .collect();
    assert_eq!(clips.iter().map(|(name, ..)| name.as_str()).collect::<Vec<_>>(), ["start", "end", "run"]);
    assert_eq!(clips[0].1, 10);
    let first = bank.open(&bank.entries().next().unwrap()).unwrap();
    assert_eq!(first.rig().scalars().map(|scalar| scalar.name().to_owned()).collect::<Vec<_>>(), ["smile"]);
    assert!(clips.iter().all(|(.., exponent)| *exponent == clips[0].2), "{clips:?}");
    // A line's bounds go before the command's: the same motion three times.
    let list = "my walk.keys --name tight --max-error 0.2cm\nmy walk.keys --name loose\nmy walk.keys --name turns --max-rotation-error 2\n";
    std::fs::write(path("captures/bounds.list"), list.replace("my walk.keys", "\"my walk.keys\"")).unwrap();
    succeeds(&["captures/bounds.list".into()], &["--same-form", "--max-error", "2cm", "-o", "bounds.ptb"], folder.path());
    let bytes = std::fs::read(path("bounds.ptb")).unwrap();
    let bank = pantin::Bank::new_checked(&bytes).unwrap();
    let sizes: Vec<usize> = bank.entries().map(|entry| entry.bytes().len()).collect();
    assert!(sizes[0] > sizes[1] && sizes[2] > sizes[1], "{sizes:?}");
    let refused = |list: &str, options: &[&str]| {
        std::fs::write(path("wrong.list"), list).unwrap();
        refusal(&["wrong.list".into()], &[options, &["-o", "wrong.ptb"]].concat(), folder.path())
    };
    for (list, options, why) in [
        ("captures/run.keys\ncaptures/run.keys --frm 3\n", &[][..], "wrong.list:2: unexpected argument '--frm'"),
        ("captures/run.keys \"--name\n", &[], "wrong.list:1: a quotation mark"),
        ("# nothing\n", &[], "names no motion"),
        ("captures/none.keys\n", &[], "wrong.list:1: captures/none.keys"),
        ("captures/run.keys\n\ncaptures/run.keys --name b --from 9000\n", &[], "wrong.list:3: captures/run.keys"),
        ("captures/run.keys\n", &["--from", "3"], "leave those options out"),
        ("captures/run.keys --max-accel-error 3\n", &[], "wrong.list:1: bounds of channels are for all motions"),
        ("captures/run.keys --max-error 1cm\n", &["--exact"], "wrong.list:1: the command bounds channels one by one"),
    ] {
        let said = refused(list, options);
        assert!(said.contains(why) && !path("wrong.ptb").exists(), "{list}: {said}");
    }
}

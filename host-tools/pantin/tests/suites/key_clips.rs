//! Key clips: `pantin convert --keys`, and what the other commands make of them.

use pantin::{Bank, Clip, OpenError};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn own(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name);
    path.to_str().unwrap().to_owned()
}

fn pantin(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).current_dir(folder).output().unwrap()
}

/// What the command prints to standard error.
fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = pantin(folder, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stderr).unwrap()
}

fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = pantin(folder, arguments);
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

fn has_keys(path: &Path) -> bool {
    Clip::new_checked(&std::fs::read(path).unwrap()).unwrap().has_keys()
}

#[test]
fn the_smaller_clip_is_written_and_a_note_says_which() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (walk, bow) = (own("walk.keys"), own("library/bow.keys"));
    let convert = |motion: &str, name: &str, options: &[&str]| {
        let note = succeeds(folder, &[&["convert", motion, "-o", name, "--effort", "fast"][..], options].concat());
        (note, has_keys(&folder.join(name)))
    };
    let (note, keys) = convert(&walk, "walk.ptn", &[]);
    assert!(keys && note.contains("keys: a key clip of ") && note.contains("; --segments writes"), "{note}");
    let (note, keys) = convert(&bow, "bow.ptn", &["--max-error", "3cm"]);
    assert!(!keys && note.contains("keys: segments within the bound, ") && note.contains("a key clip would take "), "{note}");
    let (note, keys) = convert(&walk, "large.ptn", &["--scale", "1000", "--max-error", "0.5%"]);
    assert!(!keys && note.contains("there is no key clip of this motion"), "{note}");
    // Exact coding keeps rotations to 0.006 degrees and places to a part of the figure.
    assert!(convert(&walk, "exact.ptn", &["--exact"]).1);
    assert_eq!(std::fs::read(folder.join("exact.ptn")).unwrap(), std::fs::read(folder.join("walk.ptn")).unwrap());
    let (note, keys) = convert(&own("wave.proc"), "wave.ptn", &[]);
    assert!(!keys && !note.contains("keys:"), "{note}");
}

#[test]
fn keys_and_segments_can_be_demanded() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (walk, bow) = (own("walk.keys"), own("library/bow.keys"));
    for (name, option) in [("plain.ptn", &["--segments"][..]), ("index.ptn", &["--index", "0.5"])] {
        let note = succeeds(folder, &[&["convert", &walk, "-o", name, "--effort", "fast"][..], option].concat());
        assert!(!has_keys(&folder.join(name)) && !note.contains("keys:"), "{note}");
    }
    let note = succeeds(folder, &["convert", &bow, "-o", "bow.ptn", "--max-error", "3cm", "--effort", "fast", "--keys"]);
    assert!(has_keys(&folder.join("bow.ptn")) && note.contains("segments within the bound would take"), "{note}");
    let error = refusal(folder, &["convert", &walk, "-o", "cut.ptn", "--effort", "fast", "--fps", "47", "--keys"]);
    assert!(error.contains("there is no key clip of this motion") && error.contains("without --keys"), "{error}");
    succeeds(folder, &["convert", &walk, "-o", "moves.ptb", "--effort", "fast"]);
    assert_eq!(std::fs::read(folder.join("moves.ptb")).unwrap()[2], 1);
    succeeds(folder, &["convert", &walk, "-o", "keys.ptb", "--effort", "fast", "--keys"]);
    assert_eq!(std::fs::read(folder.join("keys.ptb")).unwrap()[2], 2);
}

#[test]
fn a_bank_holds_clips_of_both_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let joy = own("face/joy.keys");
    succeeds(folder, &["convert", &joy, "-o", "keys.ptn", "--keys"]);
    succeeds(folder, &["convert", &joy, "-o", "segments.ptn", "--segments"]);
    for (names, version) in [(&["segments.ptn", "keys.ptn"][..], 2), (&["segments.ptn"], 1)] {
        succeeds(folder, &[&["pack"][..], names, &["-o", "faces.ptb"]].concat());
        let mut bytes = std::fs::read(folder.join("faces.ptb")).unwrap();
        assert_eq!(bytes[2], version);
        let bank = Bank::new_checked(&bytes).unwrap();
        assert!(bank.entries().all(|entry| bank.open(&entry).unwrap().has_keys() == (entry.name() == "keys")));
        bytes[2] = 3;
        assert_eq!(Bank::new_checked(&bytes).err(), Some(OpenError::UnsupportedVersion(3)));
    }
    succeeds(folder, &["pack", "segments.ptn", "keys.ptn", "-o", "faces.ptb"]);
    succeeds(folder, &["unpack", "faces.ptb", "-o", "out"]);
    for name in ["keys.ptn", "segments.ptn"] {
        assert_eq!(std::fs::read(folder.join("out").join(name)).unwrap(), std::fs::read(folder.join(name)).unwrap(), "{name}");
    }
}

#[test]
fn boards_get_key_clips_as_segments_unless_keys_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeeds(folder, &["convert", &own("walk.keys"), "-o", "walk.ptn", "--effort", "fast", "--keys"]);
    let walk = std::fs::read(folder.join("walk.ptn")).unwrap();
    let image = ["flash-image", "walk.ptn", "--board", "pico", "--name", "walk"];
    let holds = |name: &str, clip: &[u8]| std::fs::read(folder.join(name)).unwrap().windows(clip.len()).any(|part| part == clip);
    let note = succeeds(folder, &[&image[..], &["-o", "segments.bin"]].concat());
    assert!(note.contains("a key clip, sent as segments") && !holds("segments.bin", &walk), "{note}");
    succeeds(folder, &[&image[..], &["-o", "keys.bin", "--keys"]].concat());
    assert!(holds("keys.bin", &walk));
    succeeds(folder, &["pack", "walk.ptn", "-o", "moves.ptb"]);
    let bank = ["flash-image", "moves.ptb", "--board", "pico", "-o", "bank.bin"];
    let note = succeeds(folder, &bank);
    assert!(note.contains("its key clips are sent as segments"), "{note}");
    std::fs::remove_file(folder.join("bank.bin")).unwrap();
    succeeds(folder, &[&bank[..], &["--keys"]].concat());
    assert!(holds("bank.bin", &std::fs::read(folder.join("moves.ptb")).unwrap()));
    // The clip is read and made segments before the line is opened.
    let error = refusal(folder, &["stream", "walk.ptn", "--to", "tcp:127.0.0.1:9"]);
    assert!(error.contains("a key clip, sent as segments"), "{error}");
    let info = pantin(folder, &["info", "walk.ptn", "--json"]);
    let info: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    assert_eq!((&info["keys"], &info["segments"]), (&107.into(), &serde_json::Value::Null));
}

#[test]
fn expand_writes_the_keys_as_text_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeeds(folder, &["convert", &own("greet.keys"), "-o", "greet.ptn", "--effort", "fast", "--keys"]);
    succeeds(folder, &["expand", "greet.ptn", "-o", "back.keys"]);
    succeeds(folder, &["convert", "back.keys", "-o", "again.ptn", "--effort", "fast", "--keys"]);
    assert_eq!(std::fs::read(folder.join("again.ptn")).unwrap(), std::fs::read(folder.join("greet.ptn")).unwrap());
    succeeds(folder, &["convert", &own("greet.keys"), "-o", "segments.ptn", "--effort", "fast", "--segments"]);
    let error = refusal(folder, &["expand", "segments.ptn", "-o", "none.keys"]);
    assert!(error.contains("the clip holds segments, no keys") && !folder.join("none.keys").exists(), "{error}");
}

//! Banks: `pantin pack`, `unpack`, `list`, and `convert -o moves.ptb`.

use pantin::{Bank, ChannelState, Clip, OpenError, Player};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name)
}

fn pantin(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).current_dir(folder).output().unwrap()
}

fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = pantin(folder, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = pantin(folder, arguments);
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

/// Cuts of our walk, each with other features: plain, with snapshots, with events.
fn cuts() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let walk = own("walk.keys");
    let cuts: [(&str, &[&str]); 3] = [
        ("begin", &["--from", "0", "--to", "24"]),
        ("middle", &["--from", "30", "--to", "90", "--index", "0.1"]),
        ("end", &["--from", "100", "--to", "159", "--footsteps", "--event", "last@159"]),
    ];
    for (name, options) in cuts {
        let clip = format!("{name}.ptn");
        let base = ["convert", walk.to_str().unwrap(), "-o", &clip, "--effort", "fast", "--max-error", "1cm"];
        succeeds(folder.path(), &[&base[..], options].concat());
    }
    folder
}

fn poses(clip: Clip) -> Vec<Vec<i32>> {
    let (mut states, mut pose) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let pose = |frame| {
        player.seek(frame);
        player.pose().values.to_vec()
    };
    (0..clip.frames()).map(pose).collect()
}

#[test]
fn clips_of_a_bank_play_as_their_files_and_come_out_as_they_went_in() {
    let cuts = cuts();
    let folder = cuts.path();
    succeeds(folder, &["pack", "begin.ptn", "middle.ptn", "end.ptn", "-o", "moves.ptb"]);
    let bytes = std::fs::read(folder.join("moves.ptb")).unwrap();
    let bank = Bank::new_checked(&bytes).unwrap();
    assert_eq!(bank.entries().map(|entry| entry.name().to_string()).collect::<Vec<_>>(), ["begin", "middle", "end"]);
    let mut motions = 0;
    for name in ["begin", "middle", "end"] {
        let file = std::fs::read(folder.join(name).with_extension("ptn")).unwrap();
        let (alone, inside) = (Clip::new_checked(&file).unwrap(), bank.clip(name).unwrap());
        assert_eq!(poses(alone), poses(inside), "{name}");
        assert!(alone.events().eq(inside.events()) && alone.event_names().eq(inside.event_names()), "{name}");
        assert_eq!(alone.index_len() > 0, inside.index_len() > 0, "{name}");
        // Name and length, then the file's first bytes with the rig's id.
        let cost = bank.find(name).unwrap().bytes().len() - (file.len() - alone.rig_len());
        assert!(cost <= 4 + 2 * usize::from(alone.index_len() > 0), "{name} costs {cost} bytes more");
        motions += file.len() - alone.rig_len();
    }
    let rig = bank.rig_bytes().len();
    let names = "beginmiddleend".len();
    assert!(bytes.len() < rig + motions + names + 3 * 12 + 8, "{} bytes", bytes.len());
    assert!(matches!(bank.clip("End"), Err(OpenError::NoSuchClip)));
    succeeds(folder, &["unpack", "moves.ptb", "-o", "out"]);
    for name in ["begin.ptn", "middle.ptn", "end.ptn"] {
        assert!(std::fs::read(folder.join(name)).unwrap() == std::fs::read(folder.join("out").join(name)).unwrap(), "{name}");
    }
    succeeds(folder, &["unpack", "moves.ptb", "-o", "one", "--clip", "end"]);
    assert_eq!(std::fs::read_dir(folder.join("one")).unwrap().count(), 1);
    for listed in [succeeds(folder, &["list", "moves.ptb"]), succeeds(folder, &["info", "moves.ptb"])] {
        let lines: Vec<&str> = listed.lines().collect();
        assert_eq!(lines.len(), 6, "{listed}");
        assert!(lines[1].starts_with("begin ") && lines[3].starts_with("end "), "{listed}");
    }
    let json: serde_json::Value = serde_json::from_str(&succeeds(folder, &["list", "moves.ptb", "--json"])).unwrap();
    assert_eq!((json["clips"][1]["name"].as_str(), json["clips"][1]["frames"].as_u64()), (Some("middle"), Some(61)));
}

#[test]
fn a_bank_becomes_source_text_with_the_sizes_that_info_prints() {
    let cuts = cuts();
    let folder = cuts.path();
    succeeds(folder, &["pack", "begin.ptn", "middle.ptn", "end.ptn", "-o", "moves.ptb"]);
    let json: serde_json::Value = serde_json::from_str(&succeeds(folder, &["info", "moves.ptb", "--json"])).unwrap();
    let [moving, channels, joints, workspace] =
        ["moving", "channels", "figure_joints", "workspace"].map(|name| json[name].as_u64().expect(name));
    assert!(succeeds(folder, &["info", "moves.ptb"]).contains(&format!("moving {moving}, ")));
    succeeds(folder, &["expand", "moves.ptb", "-o", "moves.rs"]);
    let text = std::fs::read_to_string(folder.join("moves.rs")).unwrap();
    for wanted in [
        format!("pub const MOVES_MOVING: usize = {moving};"),
        format!("pub const MOVES_CHANNELS: usize = {channels};"),
        format!("pub const MOVES_FIGURE_JOINTS: usize = {joints};"),
        format!("pub const MOVES_WORKSPACE: usize = {workspace};"),
        "pub type MovesRoom = pantin::Room<MOVES_MOVING, MOVES_CHANNELS>;".into(),
    ] {
        assert!(text.contains(&wanted), "{wanted}");
    }
    succeeds(folder, &["expand", "moves.ptb", "--format", "h"]);
    let header = std::fs::read_to_string(folder.join("moves.h")).unwrap();
    assert!(header.contains(&format!("#define BANK_MOVES_MOVING {moving}")), "{header:.600}");
    assert!(refusal(folder, &["expand", "moves.ptb"]).contains("becomes .h or .rs alone"));
}

#[test]
fn packing_refuses_what_is_no_bank_and_leaves_the_files_alone() {
    let cuts = cuts();
    let folder = cuts.path();
    let face = own("face/joy.ptn");
    std::fs::copy(&face, folder.join("joy.ptn")).unwrap();
    std::fs::create_dir(folder.join("other")).unwrap();
    std::fs::copy(folder.join("end.ptn"), folder.join("other/begin.ptn")).unwrap();
    std::fs::write(folder.join("moves.ptb"), "before").unwrap();
    let wrong = refusal(folder, &["pack", "begin.ptn", "joy.ptn", "-o", "moves.ptb"]);
    assert!(wrong.contains("joy.ptn: another rig than begin.ptn"), "{wrong}");
    let wrong = refusal(folder, &["pack", "begin.ptn", "other/begin.ptn", "-o", "moves.ptb"]);
    assert!(wrong.contains("both would be `begin`"), "{wrong}");
    assert!(refusal(folder, &["pack", "begin.ptn", "-o", "begin.ptn"]).contains("a bank's name ends in .ptb"));
    assert!(refusal(folder, &["unpack", "begin.ptn", "-o", "x"]).contains("not a bank"));
    assert_eq!(std::fs::read(folder.join("moves.ptb")).unwrap(), b"before");
    succeeds(folder, &["pack", "begin.ptn", "-o", "moves.ptb"]);
    assert!(refusal(folder, &["unpack", "moves.ptb", "-o", "x", "--clip", "jump"]).contains("no clip `jump`"));
    assert!(refusal(folder, &["expand", "moves.ptb", "-o", "x.bvh"]).contains("a bank of several clips"));
    assert!(!folder.join("x").exists());
}

#[test]
fn clips_without_their_rig_are_packed_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let walk = own("walk.keys");
    let walk = walk.to_str().unwrap();
    succeeds(folder.path(), &["convert", walk, "-o", "a.ptn", "--to", "20", "--rig-out", "a.rig", "--effort", "fast"]);
    assert!(refusal(folder.path(), &["pack", "a.ptn", "-o", "moves.ptb"]).contains("--rig FILE"));
    succeeds(folder.path(), &["pack", "a.ptn", "--rig", "a.rig", "-o", "moves.ptb"]);
    let bytes = std::fs::read(folder.path().join("moves.ptb")).unwrap();
    let bank = Bank::new_checked(&bytes).unwrap();
    assert_eq!(bank.find("a").unwrap().bytes(), std::fs::read(folder.path().join("a.ptn")).unwrap());
    assert_eq!(bank.rig_bytes(), std::fs::read(folder.path().join("a.rig")).unwrap());
}

#[test]
fn motions_become_a_bank_in_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let motions = folder.path().join("motions");
    std::fs::create_dir_all(motions.join("below")).unwrap();
    let text = std::fs::read_to_string(own("kneebend.keys")).unwrap();
    let figure = &text[..text.find("\nkeys ").unwrap()];
    let leap = "\nkeys discrete hips.Yposition\n 0 0\n 72 300\nkeys discrete left-shin.Xrotation\n 0 5\n 60 70\n";
    std::fs::write(motions.join("bend.keys"), &text).unwrap();
    std::fs::write(motions.join("below/leap.keys"), [figure, leap].concat()).unwrap();
    for form in [&[][..], &["--same-form"]] {
        let options = [&["convert", "motions", "-o", "moves.ptb", "--effort", "fast"], form].concat();
        succeeds(folder.path(), &options);
        let bytes = std::fs::read(folder.path().join("moves.ptb")).unwrap();
        let bank = Bank::new_checked(&bytes).unwrap();
        let [bend, leap] = ["bend", "below/leap"].map(|name| bank.clip(name).unwrap());
        assert_eq!(bend.form().check(&leap.form()).is_ok(), !form.is_empty());
    }
    // A name with a folder in it becomes one file.
    succeeds(folder.path(), &["unpack", "moves.ptb", "-o", "clips"]);
    assert!(folder.path().join("clips/below_leap.ptn").is_file());
    std::fs::copy(own("walk.keys"), motions.join("walk.keys")).unwrap();
    let before = std::fs::read(folder.path().join("moves.ptb")).unwrap();
    let wrong = refusal(folder.path(), &["convert", "motions", "-o", "moves.ptb", "--effort", "fast"]);
    assert!(wrong.contains("another rig than") || wrong.contains("walk.keys"), "{wrong}");
    assert_eq!(std::fs::read(folder.path().join("moves.ptb")).unwrap(), before);
}

#[test]
fn unpacking_refuses_what_is_too_much_and_what_would_wait() {
    let cuts = cuts();
    let folder = cuts.path();
    succeeds(folder, &["pack", "begin.ptn", "middle.ptn", "end.ptn", "-o", "moves.ptb"]);
    // Each clip is shorter, all of them together are not.
    let wrong = refusal(folder, &["unpack", "moves.ptb", "-o", "clips", "--max-output", "1000"]);
    assert!(wrong.contains("--max-output") && !folder.join("clips").exists(), "{wrong}");
    let wrong = refusal(folder, &["pack", "begin.ptn", "--rig", "middle.ptn", "-o", "again.ptb"]);
    assert!(!folder.join("again.ptb").exists(), "{wrong}");
    if cfg!(unix) {
        std::fs::create_dir(folder.join("clips")).unwrap();
        assert!(Command::new("mkfifo").arg(folder.join("clips/middle.ptn")).status().unwrap().success());
        let wrong = refusal(folder, &["unpack", "moves.ptb", "-o", "clips"]);
        assert!(wrong.contains("no regular file") && !folder.join("clips/begin.ptn").exists(), "{wrong}");
    }
}

#[test]
fn an_animation_named_as_another_ones_number_makes_no_bank() {
    let folder = tempfile::tempdir().unwrap();
    let animation = |name: &str, node: u32| {
        format!(
            r#"{{"name":"{name}","samplers":[{{"input":0,"output":1}}],"channels":[{{"sampler":0,"target":{{"node":{node},"path":"translation"}}}}]}}"#
        )
    };
    // Two times and two places.
    let mut bytes: Vec<u8> = [0.0f32, 1.0].iter().flat_map(|time| time.to_le_bytes()).collect();
    bytes.extend([0.0f32, 0.0, 0.0, 9.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()));
    std::fs::write(folder.path().join("a.bin"), bytes).unwrap();
    let gltf = |names: [&str; 2]| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"name":"a","children":[1]}},{{"name":"b","translation":[0,50,0]}}],
            "buffers":[{{"uri":"a.bin","byteLength":32}}],"bufferViews":[{{"buffer":0,"byteLength":8}},{{"buffer":0,"byteOffset":8,"byteLength":24}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]}},
            {{"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"}}],"animations":[{},{}]}}"#,
            animation(names[0], 0),
            animation(names[1], 0)
        )
    };
    std::fs::write(folder.path().join("a.gltf"), gltf(["x", "y"])).unwrap();
    succeeds(folder.path(), &["convert", "a.gltf", "--animation", "all", "-o", "a.ptb"]);
    std::fs::write(folder.path().join("a.gltf"), gltf(["1", "0"])).unwrap();
    let wrong = refusal(folder.path(), &["convert", "a.gltf", "--animation", "all", "-o", "b.ptb"]);
    assert!(wrong.contains("another one's number"), "{wrong}");
}

#[test]
fn a_rig_without_effect_is_refused_by_every_command() {
    let folder = super::outputs::Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast"]);
    folder.done(&["convert", "run.keys", "-o", "b.ptn", "--rig-out", "b.rig", "--effort", "fast"]);
    folder.done(&["pack", "a.ptn", "-o", "moves.ptb"]);
    let runs: [&[&str]; 4] = [
        &["play", "a.ptn", "--rig", "b.rig", "--plain", "--once"],
        &["stream", "a.ptn", "--rig", "b.rig", "--to", "tcp:127.0.0.1:1"],
        &["info", "moves.ptb", "--rig", "b.rig"],
        &["pack", "a.ptn", "--rig", "b.rig", "-o", "c.ptb"],
    ];
    for arguments in runs {
        let said = folder.refused(arguments);
        assert!(said.contains("--rig"), "{arguments:?}: {said}");
    }
    folder.done(&["play", "a.ptn", "b.ptn", "--rig", "b.rig", "--plain", "--frames", "1"]);
}

#[test]
fn a_bank_in_place_of_a_clip_is_named_with_the_next_command() {
    let folder = super::outputs::Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast"]);
    folder.done(&["pack", "a.ptn", "-o", "moves.ptb"]);
    folder.put("site/index.html", "");
    let runs: [&[&str]; 6] = [
        &["render", "moves.ptb", "-o", "a.png"],
        &["play", "moves.ptb", "--plain"],
        &["stream", "moves.ptb", "--to", "tcp:127.0.0.1:1"],
        &["expand", "moves.ptb", "-o", "a.bvh"],
        &["pack", "moves.ptb", "-o", "b.ptb"],
        &["serve", "moves.ptb", "--site", "site", "--port", "0"],
    ];
    for arguments in runs {
        let said = folder.refused(arguments);
        assert!(said.contains("`pantin unpack moves.ptb -o FOLDER`"), "{arguments:?}: {said}");
    }
    let said = folder.refused(&["flash-image", "run.keys", "--board", "pico", "-o", "a.uf2"]);
    assert!(said.contains("`pantin convert run.keys"), "{said}");
}

#[test]
fn a_flash_image_holds_a_bank() {
    let folder = super::outputs::Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast", "--segments"]);
    folder.done(&["pack", "a.ptn", "-o", "moves.ptb"]);
    let said = super::outputs::err(&folder.done(&["flash-image", "moves.ptb", "--board", "pico", "-o", "a.bin"]));
    assert!(said.contains("a bank of 1 clips, for firmware that is built with feature `bank`"), "{said}");
    let (bank, image) = (folder.get("moves.ptb"), folder.get("a.bin"));
    assert!(image.windows(bank.len()).any(|part| part == bank));
    let half = bank[..bank.len() / 2].to_vec();
    folder.put("half.ptb", half);
    assert!(folder.refused(&["flash-image", "half.ptb", "--board", "pico", "-o", "b.bin"]).contains("half.ptb"));
}

#[test]
fn names_that_change_are_named_and_those_that_meet_are_refused() {
    let folder = super::outputs::Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a_b.ptn", "--effort", "fast"]);
    let long = "long ".repeat(20) + "name";
    for name in ["a@b", &long] {
        folder.put(&format!("{name}.ptn"), folder.get("a_b.ptn"));
    }
    let long = format!("{long}.ptn");
    folder.done(&["pack", "a@b.ptn", &long, "-o", "moves.ptb"]);
    let said = super::outputs::err(&folder.done(&["unpack", "moves.ptb", "-o", "out"]));
    assert!(said.contains("`a@b` has another name as a file: a_b.ptn") && said.contains("long name` has another name"), "{said}");
    assert!(folder.path("out/a_b.ptn").exists());
    let said = super::outputs::err(&folder.done(&["pack", "a@b.ptn", "a_b.ptn", "-o", "moves.ptb"]));
    assert!(said.contains("warning: the clips `a@b` and `a_b` would both be unpacked to a_b.ptn"), "{said}");
    let said = folder.refused(&["unpack", "moves.ptb", "-o", "both"]);
    assert!(said.contains("--clip writes one of them") && !folder.path("both").exists(), "{said}");
    folder.done(&["unpack", "moves.ptb", "-o", "both", "--clip", "a@b"]);
    let said = folder.refused(&["unpack", "moves.ptb", "-o", "-"]);
    assert!(said.contains("-o -: a bank has several clips"), "{said}");
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::ffi::OsStringExt;
        let odd = std::ffi::OsString::from_vec(b"odd\xff.ptn".to_vec());
        std::fs::copy(folder.path("a_b.ptn"), folder.path("").join(&odd)).unwrap();
        let output = folder.command(&["pack", "-o", "moves.ptb"]).arg(&odd).output().unwrap();
        let said = super::outputs::err(&output);
        assert!(output.status.success() && said.contains("its name is not UTF-8"), "{said}");
    }
}

/// What one conversion reports, those of many report too.
#[test]
fn banks_and_folders_report_what_one_conversion_does() {
    let folder = super::outputs::Folder::new();
    std::fs::copy(own("walk.keys"), folder.path("walk.keys")).unwrap();
    folder.put("in/walk.keys", folder.get("walk.keys"));
    let options =
        ["--index", "1", "--event", "x@3", "--to", "30", "--rate", "50", "--max-scalar-error", "1", "--effort", "fast", "--json"];
    let report = |arguments: &[&str]| -> serde_json::Value {
        let output = folder.done(&[arguments, &options].concat());
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let mut one = report(&["convert", "walk.keys", "-o", "a.ptn"]);
    let one = one.as_object_mut().unwrap();
    one.remove("command");
    one.remove("outputs");
    // The last three are the sentences on sizes and errors in place of which many clips have a table.
    let mut notes = one.remove("notes").unwrap().as_array().unwrap().clone();
    notes.truncate(notes.len() - 3);
    assert!(notes.len() > 3, "{notes:?}");
    let many = [
        report(&["convert", "in", "-o", "out"])["files"].clone(),
        report(&["convert", "walk.keys", "-o", "moves.ptb"])["clips"].clone(),
        report(&["convert", "walk.keys", "--same-form", "-o", "same"])["clips"].clone(),
    ];
    for clips in many {
        for (name, value) in &*one {
            let other = &clips[0][name];
            // A clip that goes into a bank has its rig there.
            assert!(other == value, "{name}: {other}, not {value}");
        }
        assert_eq!(clips[0]["notes"].as_array().unwrap(), &notes);
    }
    folder.put("in/run.keys", folder.get("run.keys"));
    let said = super::outputs::err(&folder.done(&[
        "convert",
        "in",
        "-o",
        "out",
        "--rate",
        "40",
        "--max-scalar-error",
        "1",
        "--effort",
        "fast",
    ]));
    assert!(said.contains("all 2: --max-scalar-error has no effect") && said.contains("walk.keys: rate: 160 frames"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn unpacking_replaces_no_file_that_nobody_named() {
    let (folder, clip) = folder_with_bank(3);
    folder.put("out/c1.ptn", "mine");
    let said = folder.refused(&["unpack", "moves.ptb", "-o", "out"]);
    assert!(said.contains("c1.ptn: exists; --replace replaces it, another folder keeps it"), "{said}");
    assert_eq!(folder.get("out/c1.ptn"), b"mine");
    assert!(!folder.path("out/c0.ptn").exists() && !folder.path("out/c2.ptn").exists());
    // Those that are not asked for may exist.
    folder.done(&["unpack", "moves.ptb", "-o", "out", "--clip", "c2"]);
    folder.done(&["unpack", "moves.ptb", "-o", "out", "--replace"]);
    assert!((0..3).all(|number| folder.get(&format!("out/c{number}.ptn")) == clip));
}

/// A folder with a bank, `moves.ptb`, that holds one clip `clips` times, called c0, c1 and so on. Returns the clip too.
fn folder_with_bank(clips: usize) -> (super::outputs::Folder, Vec<u8>) {
    use pantin_convert::bank::{Named, encode, rig_of};
    let folder = super::outputs::Folder::new();
    folder.done(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast"]);
    let clip = folder.get("a.ptn");
    let rig: std::sync::Arc<[u8]> = rig_of(&clip).unwrap().into();
    let named = |number| Named { name: format!("c{number}"), place: String::new(), clip: clip.clone(), rig: rig.clone() };
    folder.put("moves.ptb", encode(&(0..clips).map(named).collect::<Vec<_>>()).unwrap());
    (folder, clip)
}

#[cfg(target_os = "linux")]
#[test]
fn unpacking_needs_few_open_files() {
    let (folder, clip) = folder_with_bank(200);
    // The second time all files are there already.
    for options in ["", "--replace"] {
        let mut command = Command::new("sh");
        command.args(["-c", &format!("ulimit -n 40; \"$0\" unpack moves.ptb -o out {options}"), env!("CARGO_BIN_EXE_pantin")]);
        let output = command.current_dir(folder.path("")).output().unwrap();
        assert!(output.status.success(), "{}", super::outputs::err(&output));
    }
    assert!((0..200).all(|number| folder.get(&format!("out/c{number}.ptn")) == clip));
    assert_eq!(std::fs::read_dir(folder.path("out")).unwrap().count(), 200);
}

/// Many outputs are begun one after the other: a signal between two of them leaves none.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_leaves_no_temporary_file_of_many() {
    let (folder, _) = folder_with_bank(2000);
    let files = |name: &str| std::fs::read_dir(folder.path(name)).map_or(0, Iterator::count);
    for round in 0..15 {
        let out = format!("out{round}");
        let mut child = folder.command(&["unpack", "moves.ptb", "-o", &out, "-q"]).spawn().unwrap();
        while files(&out) < 1 + 20 * round && child.try_wait().unwrap().is_none() {}
        let _ = Command::new("kill").arg(child.id().to_string()).status().unwrap();
        child.wait().unwrap();
        assert!([0, 2000].contains(&files(&out)), "round {round}: {} files are left", files(&out));
    }
}

/// A signal waits until all files that belong together are in place.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_leaves_all_or_none_of_what_belongs_together() {
    use std::os::unix::fs::MetadataExt;
    const CLIPS: usize = 1500;
    let (folder, clip) = folder_with_bank(CLIPS);
    let path = |number: usize| folder.path("out").join(format!("c{number}.ptn"));
    std::fs::create_dir(folder.path("out")).unwrap();
    (0..CLIPS).for_each(|number| std::fs::write(path(number), "before").unwrap());
    let inode = |number| path(number).metadata().unwrap().ino();
    let before: Vec<u64> = (0..CLIPS).map(inode).collect();
    let mut child = folder.command(&["unpack", "moves.ptb", "-o", "out", "-q", "--replace"]).spawn().unwrap();
    // In the midst of it: the first is in place.
    while inode(0) == before[0] {
        assert!(child.try_wait().unwrap().is_none_or(|status| status.success()));
    }
    let _ = Command::new("kill").arg(child.id().to_string()).status().unwrap();
    child.wait().unwrap();
    let new = (0..CLIPS).filter(|&number| inode(number) != before[number]).count();
    assert_eq!(new, CLIPS);
    assert!((0..CLIPS).all(|number| std::fs::read(path(number)).unwrap() == clip));
    assert_eq!(std::fs::read_dir(folder.path("out")).unwrap().count(), CLIPS, "a temporary file is left");
}

#[test]
fn a_line_of_a_list_has_a_frame_rate_of_its_own() {
    let folder = super::outputs::Folder::new();
    let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.keys");
    let line = |rest: &str| format!("\"{}\" {rest}\n", walk.display());
    folder.put("moves.list", [line("--name slow --fps 30"), line("--name plain"), line("--name unit --cm-per-unit 1")].concat());
    folder.done(&["convert", "moves.list", "-o", "moves.ptb", "--fps", "60"]);
    let bytes = std::fs::read(folder.path("moves.ptb")).unwrap();
    let bank = Bank::new_checked(&bytes).unwrap();
    let rate = |name: &str| (1e9 / f64::from(bank.open(&bank.find(name).unwrap()).unwrap().frame_time_ns())).round();
    assert_eq!(["slow", "plain", "unit"].map(rate), [30.0, 60.0, 60.0]);
}

#[test]
fn a_wrong_body_is_refused_under_its_own_option_in_one_line() {
    let folder = super::outputs::Folder::new();
    let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.keys");
    folder.put("cube.keys", "keyframes 1\nfps 30\nframes 3\ncm-per-unit 1\njoint cube offset 0 9 0 channels Yrotation\nend parent cube offset 0 9 0\nkeys linear cube\n 0 0\n 2 9\n");
    let refused = folder.run(&["convert", walk.to_str().unwrap(), "--body", "cube.keys", "-o", "a.ptn"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("--body: not found in the body: Hips, ") && !said.contains("\\n") && !said.contains("--map"), "{said}");
    let refused = folder.run(&["convert", "cube.keys", "--body", walk.to_str().unwrap(), "-o", "a.ptn"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("--body: not found in the figure: Hips, ") && said.contains("--map FILE names them"), "{said}");
}

/// A file of an animation says what that one turns: as a body its figure turns everywhere.
#[test]
fn a_gltf_file_is_a_body_that_turns_everywhere() {
    let folder = super::outputs::Folder::new();
    let motions = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
    let [walk, greet] = ["walk.ptn", "greet.keys"].map(|name| motions.join(name).to_str().unwrap().to_string());
    folder.done(&["expand", &walk, "-o", "walk.glb"]);
    let done = folder.run(&["convert", &greet, "--body", "walk.glb", "-o", "a.ptn"]);
    let said = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success() && said.contains("legs in the air 0.0"), "{said}");
    assert!(!said.contains("cannot turn in all directions"), "{said}");
}

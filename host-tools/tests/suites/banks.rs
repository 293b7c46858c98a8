//! Banks: `pantin pack`, `unpack`, `list`, and `convert -o moves.ptb`.

use pantin::{Bank, ChannelState, Clip, OpenError, Player};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../motions").join(name)
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
        assert_eq!(lines.len(), 5, "{listed}");
        assert!(lines[1].starts_with("begin ") && lines[3].starts_with("end "), "{listed}");
    }
    let json: serde_json::Value = serde_json::from_str(&succeeds(folder, &["list", "moves.ptb", "--json"])).unwrap();
    assert_eq!((json["clips"][1]["name"].as_str(), json["clips"][1]["frames"].as_u64()), (Some("middle"), Some(61)));
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

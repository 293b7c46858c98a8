//! `pantin info`: how each joint is coded, and the memory that a clip takes.

use pantin::{ChannelState, Clip, Player};
use pantin_convert::facts::MemoryNeeds;
use pantin_figure::{Canvas, FigureRenderer, JointInfo};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn info(clip: &str, options: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pantin")).arg("info").arg(root().join(clip)).args(options).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn info_json(clip: &str) -> Value {
    serde_json::from_str(&info(clip, &["--json"])).unwrap()
}

fn joint<'a>(info: &'a Value, name: &str) -> &'a Value {
    info["rig"]["joints"].as_array().unwrap().iter().find(|joint| joint["name"] == name).unwrap()
}

#[test]
fn joints_are_named_with_how_they_are_coded() {
    let json = info_json("motions/kneebend.ptn");
    let shin = joint(&json, "left-shin");
    assert_eq!(shin["rotation"], "exponential map");
    let kinds: Vec<&str> = shin["channels"].as_array().unwrap().iter().map(|channel| channel["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["Xexponential", "Yexponential", "Zexponential"]);
    assert_eq!(joint(&json, "spine")["rotation"], "Euler angles X");
    assert_eq!(joint(&json, "chest")["rotation"], "");
    let text = info("motions/kneebend.ptn", &[]);
    let line = text.lines().find(|line| line.starts_with("left-shin ")).unwrap();
    assert!(line.contains("exponential map") && line.contains("moving"), "{line}");
    let line = text.lines().find(|line| line.starts_with("hips ")).unwrap();
    assert!(line.contains(" 0 ") && line.contains("position Y") && line.contains("1 moving"), "{line}");
}

#[test]
fn figures_are_told_apart_from_rigs_and_seconds_from_frames() {
    let json = info_json("motions/walk.ptn");
    assert_eq!([&json["joints"], &json["end_sites"], &json["workspace"]].map(|value| value.as_u64().unwrap()), [22, 7, 29]);
    assert_eq!(json["seconds"].as_f64().unwrap(), 1.333);
    let bytes = 20 * json["moving"].as_u64().unwrap() + 4 * json["channels"].as_u64().unwrap();
    assert_eq!(json["player_bytes"], bytes);
}

/// The figure of our walk has `figure_joints` joints: that number is enough, and one less is not.
#[test]
fn the_memory_that_is_stated_is_what_a_figure_takes() {
    const JOINTS: usize = 25;
    let bytes = std::fs::read(root().join("motions/walk.ptn")).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let memory = MemoryNeeds::of(&clip).unwrap();
    assert_eq!(memory.figure_joints, JOINTS);
    let set_up = |workspace: usize| {
        let (mut states, mut pose) = (vec![ChannelState::default(); memory.moving], vec![0; memory.channels]);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let canvas = Canvas { width: 128, height: 64 };
        let mut room = vec![JointInfo::default(); workspace];
        let enough = FigureRenderer::<JOINTS>::empty().set_up(&mut player, canvas, &mut room).is_ok();
        (enough, FigureRenderer::<{ JOINTS - 1 }>::empty().set_up(&mut player, canvas, &mut room).is_ok())
    };
    assert_eq!(set_up(memory.workspace), (true, false));
    assert_eq!(set_up(memory.workspace - 1), (false, false));
}

#[test]
fn channels_that_follow_others_are_reported_and_a_clip_without_joints_has_no_figure() {
    let json = info_json("tests/vectors/followers.ptn");
    let rig = &json["rig"];
    let joints = rig["joints"].as_array().unwrap().iter().flat_map(|joint| joint["channels"].as_array().unwrap());
    let channels: Vec<&Value> = joints.chain(rig["scalars"].as_array().unwrap()).collect();
    let follower = channels.iter().find(|channel| channel["track"] == "follows").unwrap();
    let leader = channels.iter().find(|channel| channel["channel"] == follower["leader"]).unwrap();
    assert_ne!(leader["track"], "constant");
    assert!(leader["channel"].as_u64().unwrap() < follower["channel"].as_u64().unwrap());
    let text = info("tests/vectors/followers.ptn", &[]);
    assert!(text.contains(&format!("follows channel {}", follower["leader"])), "{text}");
    let face = info_json("motions/face/joy.ptn");
    assert_eq!((&face["figure_joints"], &face["workspace"]), (&Value::from(0), &Value::from(0)));
    assert_eq!(face["rig"]["scalars"].as_array().unwrap().len() as u64, face["scalar_channels"].as_u64().unwrap());
}

#[test]
fn boards_that_a_clip_fits_are_listed() {
    let names = ["blackpill", "esp32-c3", "microbit", "microbit-v2", "nrf52840-dk", "nucleo-f411re", "pico", "xiao-nrf52840"];
    let all = serde_json::json!(names);
    let walk = info_json("motions/walk.ptn");
    assert!(walk["boards"] == all && walk["boards_by_update"] == all, "{walk}");
    let large = info_json("tests/vectors/channels-300.ptn");
    assert_eq!(large["boards"], serde_json::json!([]), "more joints than any board has buffers for");
    assert!(info("motions/walk.ptn", &[]).contains("boards                 blackpill, esp32-c3, microbit"));
    // The boards' own numbers.
    let source = |path: &str| std::fs::read_to_string(root().join("firmware/boards").join(path)).unwrap();
    let [channels, moving, joints] = pantin_tools::cmd::info::CAPACITY;
    assert!(source("common/src/capacity.rs").contains(&format!("MaxClip<{channels}, {moving}, {joints}>")));
    assert!(source("build/src/lib.rs").contains(&format!("SMALL: [usize; 3] = {:?}", pantin_tools::cmd::info::SMALL_CAPACITY)));
}

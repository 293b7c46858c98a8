//! `pantin steer`: a recorded session of our own character, whose feet stay on the ground and whose joints do not jump.

use pantin_animator::machine::{FEET_SECTION, Table};
use pantin_animator::session::{Fault, Replay, Session};
use pantin_convert::bank;
use pantin_figure::{CameraTarget, View};
use pantin_pictures::machine::playback::{Stage, joints, play, view_at_start};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

fn motions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions")
}

fn pantin(arguments: &[&str], paths: &[&Path]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).args(paths).output().unwrap()
}

/// Our character's bank, made once.
static BANK: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let [library, bank] = ["library.ptb", "character.ptb"].map(|name| folder.path().join(name));
    let made = pantin(
        &["convert", "--places-only", "--same-form", "--max-error", "0.5cm", "-o"],
        &[&library, &motions().join("library")],
    );
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let made = pantin(&["machine", "-o"], &[&bank, "--bank".as_ref(), &library, &motions().join("character.toml")]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    std::fs::read(bank).unwrap()
});

fn session() -> String {
    std::fs::read_to_string(motions().join("steer.txt")).unwrap()
}

/// `PANTIN_UPDATE=1` writes it again, after a change of the motions, the fit, the formats or the machine.
#[test]
fn the_committed_bank_is_what_the_tool_makes() {
    let path = motions().join("character.ptb");
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        std::fs::write(&path, &*BANK).unwrap();
    }
    assert!(std::fs::read(path).unwrap() == *BANK, "motions/character.ptb is not what the tool makes; PANTIN_UPDATE=1 writes it");
}

const RATE: u16 = 30;
const CM_OF_GROUND: f64 = 1.0;
/// With feet that are held: a foot that leaves the ground in a transition lags behind its clip.
const CM_OF_HELD: f64 = 1.5;
/// How far the tips of the toes may be below the ground while a transition mixes two steps: nothing holds them there.
const CM_IN_TRANSITIONS: f64 = 5.0;

#[test]
fn the_recorded_session_visits_what_it_names_and_stands_on_the_ground() {
    visits_and_stands(&BANK, CM_OF_HELD);
    visits_and_stands(&bank::without_section(&BANK, FEET_SECTION).unwrap(), CM_OF_GROUND);
}

fn visits_and_stands(bytes: &[u8], cm_of_ground: f64) {
    let text = session();
    let table = Table::of_bank(bytes).unwrap();
    let replay = Replay::new(Session::new_checked(&text, &table).unwrap(), RATE);
    let (mut states, mut waved, mut last): (Vec<&str>, bool, Option<Vec<[f64; 3]>>) = (Vec::new(), false, None);
    let (mut fastest, mut lowest, mut pictures) = (0f64, f64::MAX, 0);
    play(bytes, replay, |character| {
        let state = table.state_name(character.state());
        if states.last() != Some(&state) {
            states.push(state);
        }
        waved |= state == "walk" && character.layer_weight(0).to_bits() == 1 << 15;
        let places = joints(character);
        let least = places.iter().map(|[_, y, _]| *y).fold(f64::MAX, f64::min);
        let mixed = character.animator().transition_left() > 0;
        lowest = lowest.min(least);
        assert!(least > -if mixed { CM_IN_TRANSITIONS } else { cm_of_ground }, "{state}: {least} cm");
        // A foot is on the ground, or the figure runs or jumps, or changes over from that.
        let in_the_air = ["run", "leap"].contains(&state) || mixed;
        assert!(in_the_air || least < cm_of_ground, "{state}: {least} cm above the ground");
        if let Some(last) = &last {
            let far = |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            fastest = places.iter().zip(last).map(far).fold(fastest, f64::max);
        }
        last = Some(places);
        pictures += 1;
        Ok(())
    })
    .unwrap();
    for wanted in ["idle", "start", "walk", "run", "leap", "stop", "turn_left", "bow"] {
        assert!(states.contains(&wanted), "{wanted}: {states:?}");
    }
    assert!(waved, "it waves while it walks");
    // The toes of the run move by 25 cm in a picture by themselves.
    assert!(fastest < 30.0, "{fastest} cm in a picture");
    assert_eq!(pictures, replay.pictures());
    println!("{states:?}, lowest {lowest:.2} cm, fastest {fastest:.1} cm a picture");
}

/// The walk stops at any moment of a stride, not only at the one that the recorded session has.
#[test]
fn the_walk_stops_at_any_moment_without_toes_deep_in_the_ground() {
    let table = Table::of_bank(&BANK).unwrap();
    for pictures in 0..32 {
        let released = 4.0 + f64::from(pictures) / f64::from(RATE);
        let text = format!("1.0 hold go\n{released:.4} release go\n{:.4} end\n", released + 1.0);
        let replay = Replay::new(Session::new_checked(&text, &table).unwrap(), RATE);
        let (mut lowest, mut stops) = (f64::MAX, 0);
        play(&BANK, replay, |character| {
            stops += u32::from(table.state_name(character.state()) == "stop");
            lowest = joints(character).iter().map(|[_, y, _]| *y).fold(lowest, f64::min);
            Ok(())
        })
        .unwrap();
        assert!(stops > 0 && lowest > -CM_IN_TRANSITIONS, "released at {released:.2} s: {lowest:.2} cm");
    }
}

#[test]
fn the_renderer_draws_a_figure_where_it_stands_as_it_draws_one_at_the_origin() {
    let text = session();
    let table = Table::of_bank(&BANK).unwrap();
    let replay = Replay::new(Session::new_checked(&text, &table).unwrap(), RATE);
    let mut stage = Stage::new(&BANK, [128, 128], View::default(), None).unwrap();
    let (mut turned, mut pairs) = (0, Vec::new());
    play(&BANK, replay, |character| {
        let [hips_x, _, hips_z] = joints(character)[1];
        let (_, placement) = character.pose();
        let renderer = stage.place(character)?;
        // The camera's target is the hips, but for the height.
        let [x, _, z] = renderer.target().map(f64::from);
        pairs.push([[x, z], [hips_x, hips_z]]);
        turned += u32::from(placement.heading != pantin::Angle::ZERO);
        Ok(())
    })
    .unwrap();
    // Figure units in a centimetre.
    let [[_, far], [_, far_cm]] = *pairs.last().unwrap();
    let unit = far / far_cm;
    assert!(far_cm > 1500.0, "{far_cm}");
    for [seen, cm] in pairs {
        let apart = (seen[0] / unit - cm[0]).hypot(seen[1] / unit - cm[1]);
        assert!(apart < 0.1, "{apart} cm");
    }
    assert!(turned > 100, "{turned}");
}

#[test]
fn a_fixed_camera_sees_the_whole_session() {
    let text = session();
    let table = Table::of_bank(&BANK).unwrap();
    let replay = || Replay::new(Session::new_checked(&text, &table).unwrap(), RATE);
    let size = [240, 135];
    for orbit in View::ORBITS {
        let view = View { orbit, track: CameraTarget::Fixed, ..View::default() };
        let mut stage = Stage::new(&BANK, size, view, Some(&replay())).unwrap();
        let (mut least, mut most) = ([i16::MAX; 2], [i16::MIN; 2]);
        play(&BANK, replay(), |character| {
            stage.place(character)?.each_bone(|line| {
                for (axis, ends) in [0, 1].map(|axis| [line.from[axis], line.to[axis]]).into_iter().enumerate() {
                    least[axis] = least[axis].min(ends[0]).min(ends[1]);
                    most[axis] = most[axis].max(ends[0]).max(ends[1]);
                }
            });
            Ok(())
        })
        .unwrap();
        let inside = |axis: usize| least[axis] >= 0 && usize::from(most[axis] as u16) <= size[axis] * 16;
        // Most of one side is used.
        let used = (0..2).any(|axis| usize::from((most[axis] - least[axis]) as u16) > size[axis] * 8);
        assert!(inside(0) && inside(1) && used, "{orbit} degrees: {least:?} to {most:?}");
    }
}

#[test]
fn what_is_wrong_with_a_session_is_named_with_its_line() {
    let table = Table::of_bank(&BANK).unwrap();
    for (text, line, fault) in [
        ("", 0, Fault::NoEnd),
        ("1 hold go", 1, Fault::NoEnd),
        ("x hold go", 1, Fault::Time),
        ("-1 hold go", 1, Fault::Time),
        ("1. hold go", 1, Fault::Time),
        ("3601 end", 1, Fault::Time),
        ("\n2 hold go\n1 end", 3, Fault::Order),
        ("1 push go", 1, Fault::Word),
        ("1", 1, Fault::Word),
        ("1 press fly", 1, Fault::NoSuchInput),
        ("1 set speed 3", 1, Fault::NoSuchParameter),
        ("1 press go now", 1, Fault::TooLong),
        ("1 end now", 1, Fault::TooLong),
        ("1 end\n2 hold go", 2, Fault::AfterEnd),
    ] {
        let error = Session::new_checked(text, &table).unwrap_err();
        assert_eq!((error.line, error.fault), (line, fault), "{text:?}");
    }
    let session = Session::new_checked("# a comment\n\n1.25 end # here", &table).unwrap();
    assert_eq!((session.end_us(), Replay::new(session, 30).pictures()), (1_250_000, 38));
}

#[test]
fn the_command_writes_pictures_and_places() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("c.ptb"), &*BANK).unwrap();
    std::fs::write(path("s.txt"), "0.1 hold go\n0.5 end\n").unwrap();
    for name in ["a.gif", "a.apng", "a.png", "a.csv"] {
        let made = pantin(&["steer", "-o"], &[&path(name), &path("c.ptb"), &path("s.txt")]);
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    }
    let table = std::fs::read_to_string(path("a.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 16);
    assert!(table.starts_with("seconds,state,clip_frame,heading_degrees,held_left-foot,held_right-foot,root_x,"));
    let part = pantin(&["steer", "--from", "0.2s", "--to", "9", "-o"], &[&path("part.csv"), &path("c.ptb"), &path("s.txt")]);
    assert!(part.status.success(), "{}", String::from_utf8_lossy(&part.stderr));
    let part = std::fs::read_to_string(path("part.csv")).unwrap();
    let rows = |text: &str, from: usize, to: usize| {
        text.lines().skip(1 + from).take(to + 1 - from).map(String::from).collect::<Vec<_>>()
    };
    assert_eq!(part.lines().skip(1).collect::<Vec<_>>(), rows(&table, 6, 9));
    let fixed = pantin(&["steer", "--fixed", "-o"], &[&path("f.gif"), &path("c.ptb"), &path("s.txt")]);
    assert!(fixed.status.success(), "{}", String::from_utf8_lossy(&fixed.stderr));
    for (name, options, why) in [
        ("x.csv", &["--size", "10x10"][..], "--size is for pictures"),
        ("x.csv", &["--palette", "dusk"], "--palette is for pictures"),
        ("x.csv", &["--view", "side"], "--view is for pictures"),
        ("x.csv", &["--fixed"], "--fixed is for pictures"),
        ("x.gif", &["--sheet", "3"], "--sheet is for contact sheets"),
        ("x.gif", &["--from", "2s"], "--from and --to leave no picture of 0.5 s"),
    ] {
        let refused = pantin(&[&["steer"], options, &["-o"]].concat(), &[&path(name), &path("c.ptb"), &path("s.txt")]);
        assert!(String::from_utf8_lossy(&refused.stderr).contains(why) && !path(name).exists(), "{options:?}");
    }
    std::fs::write(path("wrong.txt"), "0.1 hold go\n0.2 press fly\n1 end").unwrap();
    let wrong = pantin(&["steer", "-o"], &[&path("b.gif"), &path("c.ptb"), &path("wrong.txt")]);
    let error = String::from_utf8_lossy(&wrong.stderr).into_owned();
    assert!(error.contains("wrong.txt:2: the state machine has no such input: 0.2 press fly"), "{error}");
    let no_machine = pantin(&["steer", "-o"], &[&path("b.gif"), &motions().join("walk.ptn"), &path("s.txt")]);
    assert!(String::from_utf8_lossy(&no_machine.stderr).contains("no bank with a state machine"));
}

/// A character of a figure that hangs on a joint which stands still, as captures do: its hips go 1 cm a frame along z, and stand.
fn captured(machine: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let joints = "joint still offset 0 0 0 channels Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
                  joint hips parent still offset 0 0 0 channels Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
                  joint foot parent hips offset 0 -90 0 channels Xrotation\nend parent foot offset 0 0 20\n";
    let head = "keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\n";
    let walk = "keys linear hips.Yposition\n 0 90\n 30 90\nkeys linear hips.Zposition\n 0 0\n 30 30\nkeys linear foot.Xrotation\n 0 0\n 30 40\n";
    let stand = "keys linear hips.Yposition\n 0 90\n 30 90\nkeys linear foot.Xrotation\n 0 0\n 30 20\n";
    std::fs::write(path("walk.keys"), format!("{head}{joints}{walk}")).unwrap();
    std::fs::write(path("stand.keys"), format!("{head}{joints}{stand}")).unwrap();
    std::fs::write(path("m.toml"), machine).unwrap();
    let [library, bank] = ["library.ptb", "m.ptb"].map(path);
    let clips = [path("walk.keys"), path("stand.keys")];
    let made = pantin(&["convert", "--places-only", "--same-form", "-o"], &[&library, &clips[0], &clips[1]]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let made = pantin(&["machine", "-o"], &[&bank, "--bank".as_ref(), &library, &path("m.toml")]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    std::fs::read(bank).unwrap()
}

/// Places along z, in cm, and frames of the clip, picture by picture at 30 a second.
fn ways(bank: &[u8], session: &str) -> Vec<(f64, u32)> {
    let replay = Replay::new(Session::new_checked(session, &Table::of_bank(bank).unwrap()).unwrap(), RATE);
    let mut ways = vec![];
    play(bank, replay, |character| {
        let (pose, placement) = character.pose();
        let unit = f64::from(pose.form.to_form().length_exponent()).exp2();
        ways.push((placement.place[0] as f64 * unit, character.animator().track().frame()));
        Ok(())
    })
    .unwrap();
    ways
}

#[test]
fn a_figure_below_a_joint_that_stands_still_travels() {
    let bank = captured(
        "start = \"stand\"\n[[state]]\nname = \"stand\"\ntransitions = [{ to = \"walk\", input = \"go\", kind = \"cut\" }]\n\
         [[state]]\nname = \"walk\"\ntransitions = [{ to = \"stand\", end = true, kind = \"cut\" }]\n",
    );
    // It walks twice: 30 cm each.
    let ways = ways(&bank, "0.5 press go\n2.5 press go\n5 end");
    let (last, _) = ways[ways.len() - 1];
    assert!((last - 60.0).abs() < 0.5, "{last}");
    assert!(ways.windows(2).all(|pair| (-0.1..1.5).contains(&(pair[1].0 - pair[0].0))), "{ways:?}");
}

#[test]
fn the_first_state_plays_at_its_speed() {
    let machine = |speed: &str| format!("[[state]]\nname = \"walk\"\nspeed = {speed}\n[[any]]\nto = \"walk\"\ninput = \"go\"\n");
    let at = |speed: &str| ways(&captured(&machine(speed)), "0.5 end")[15];
    assert_eq!(at("0").1, 0);
    assert_eq!(at("2").1, 30);
    // Backwards, from its last frame on.
    let (place, frame) = at("-1");
    assert!((14..=15).contains(&frame), "{frame}");
    assert!((place + 15.0).abs() < 0.5, "{place}");
}

/// Of clips that face different ways the character turns those that do not face as the figure does at the start: the front is where its face is.
#[test]
fn the_front_is_that_of_the_figure_at_the_start() {
    let folder = super::outputs::Folder::new();
    let walk = motions().join("walk.keys");
    folder.put(
        "moves.list",
        format!("\"{0}\" --name walk\n\"{0}\" --name back --turn 180\n\"{0}\" --name again --turn 180\n", walk.display()),
    );
    folder.put(
        "hero.toml",
        "[[state]]\nname = \"walk\"\ntransitions = [{ to = \"back\", input = \"a\" }, { to = \"again\", input = \"b\" }]\n[[state]]\nname = \"back\"\n[[state]]\nname = \"again\"\n",
    );
    folder.done(&["convert", "moves.list", "--same-form", "-o", "moves.ptb"]);
    folder.done(&["machine", "hero.toml", "--bank", "moves.ptb", "-o", "hero.ptb"]);
    let bytes = std::fs::read(folder.path("hero.ptb")).unwrap();
    let front = View { orbit: 0, ..View::default() };
    let seen = view_at_start(&bytes, front).unwrap();
    // A camera's mean is of a few poses.
    assert!((seen.orbit.rem_euclid(360) - 180).abs() <= 10, "the mean of the clips faces backwards: {}", seen.orbit);
    // Our character: no clip of it faces another way for long.
    let own = view_at_start(&BANK, front).unwrap().orbit;
    assert!(own.abs() <= 10, "{own}");
    println!("our character: the front is {own} degrees from the mean of all clips");
}

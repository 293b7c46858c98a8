//! `--rate`, `--up`, `--close-loop` and `--find-loop` of `pantin convert`.

use pantin::{Clip, Up};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name).with_extension("keys")
}

fn convert(motion: &Path, options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin"))
        .arg("convert")
        .arg(motion)
        .args(["--effort", "fast"])
        .args(options)
        .output()
        .unwrap()
}

/// Converts into `folder`; the clip's bytes.
fn clip(folder: &Path, motion: &Path, options: &[&str]) -> Vec<u8> {
    let path = folder.join("clip.ptn");
    let output = convert(motion, &[&["-o", path.to_str().unwrap()], options].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    std::fs::read(path).unwrap()
}

#[test]
fn a_rate_keeps_the_frames_and_fps_after_it_resamples_them() {
    let folder = tempfile::tempdir().unwrap();
    let walk = own("walk");
    let timed = |options: &[&str]| {
        let bytes = clip(folder.path(), &walk, options);
        let clip = Clip::new_checked(&bytes).unwrap();
        (clip.frames(), clip.frame_time_ns())
    };
    assert_eq!(timed(&[]), (160, 8_333_333));
    assert_eq!(timed(&["--rate", "60"]), (160, 16_666_667));
    assert_eq!(timed(&["--rate", "60", "--fps", "30"]), (80, 33_333_333));
    assert!(!convert(&walk, &["--rate", "0"]).status.success());
}

#[test]
fn up_is_what_the_figure_shows_or_what_the_user_says() {
    let folder = tempfile::tempdir().unwrap();
    let up = |motion: &Path, options: &[&str]| Clip::new_checked(&clip(folder.path(), motion, options)).unwrap().rig().up();
    assert_eq!(up(&own("walk"), &[]), Up::Y);
    assert_eq!(up(&own("walk"), &["--up", "-z"]), Up::new(2, true).unwrap());
    let lying = folder.path().join("z.keys");
    let text = "keyframes 1\nfps 10\nframes 3\ncm-per-unit 1\njoint hips offset 0 0 90 channels Xrotation\n\
        joint head parent hips offset 0 0 60\njoint foot parent hips offset 0 5 -85\nkeys linear hips\n 0 0\n 2 9\n";
    std::fs::write(&lying, text).unwrap();
    assert_eq!(up(&lying, &[]), Up::new(2, false).unwrap());
    assert!(!convert(&own("walk"), &["--up", "w"]).status.success());
}

#[test]
fn a_cycle_is_closed_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let cycle = folder.path().join("cycle.keys");
    let rows: String = (0..20).map(|frame| format!(" {frame} {}\n", 30.0 * (frame as f64 * 18.0).to_radians().sin())).collect();
    let figure = "joint hips offset 0 90 0 channels Xrotation\nend parent hips offset 0 60 0\n";
    std::fs::write(&cycle, format!("keyframes 1\nfps 20\nframes 20\ncm-per-unit 1\n{figure}keys linear hips\n{rows}")).unwrap();
    let bytes = clip(folder.path(), &cycle, &["--close-loop"]);
    let clip = Clip::new_checked(&bytes).unwrap();
    assert!(clip.looped());
    assert_eq!(clip.frames(), 20);
    assert!(!convert(&cycle, &["--close-loop", "--loop"]).status.success());
}

#[test]
fn the_best_loop_of_a_motion_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let motion = folder.path().join("swing.keys");
    // Waves of 25 frames on a way along x, after a begin that is unlike them.
    let rows: String = (0..80)
        .map(|frame: i32| {
            let turn = if frame < 20 { 60 - 3 * frame } else { 0 };
            let wave = 30.0 * (f64::from(frame) * 360.0 / 25.0).to_radians().sin();
            format!(" {frame} {} {}\n", 2 * frame, f64::from(turn) + wave)
        })
        .collect();
    let figure = "joint hips offset 0 90 0 channels Xposition Zrotation\nend parent hips offset 0 60 0\n";
    std::fs::write(&motion, format!("keyframes 1\nfps 30\nframes 80\ncm-per-unit 1\n{figure}keys linear hips\n{rows}")).unwrap();
    let output = convert(&motion, &["--find-loop", "--json"]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let best = &found["loops"][0];
    let (from, to) = (best["from"].as_u64().unwrap(), best["to"].as_u64().unwrap());
    assert!(from >= 20 && (to - from) % 25 == 0, "{best}");
    assert!(best["seam_cm"].as_f64().unwrap() < 0.01, "{best}");
    assert!(!motion.with_extension("ptn").exists(), "nothing is written");
    // Of a cut, frames count as --from and --to do.
    let output = convert(&motion, &["--find-loop", "--json", "--from", "20"]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (later, end) = (found["loops"][0]["from"].as_u64().unwrap(), found["loops"][0]["to"].as_u64().unwrap());
    assert!(later >= 20 && (end - later) % 25 == 0, "{found}");
    let closed = folder.path().join("closed.keys");
    std::fs::write(&closed, std::fs::read_to_string(&motion).unwrap().replace("frames 80\n", "frames 80\nloop\n")).unwrap();
    let output = convert(&closed, &["--find-loop"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("a loop already"), "{output:?}");
    assert!(!convert(&motion, &["--find-loop", "-o", "a.ptn"]).status.success(), "an output that is not written is refused");
    let cut = ["--from", &from.to_string(), "--to", &to.to_string(), "--loop"].map(str::to_string);
    let bytes = clip(folder.path(), &motion, &cut.each_ref().map(String::as_str));
    assert_eq!(u64::from(Clip::new_checked(&bytes).unwrap().frames()), to - from);
}

#[test]
fn proposed_loops_keep_a_bound_on_rotations() {
    let folder = super::outputs::Folder::new();
    // Waves of 25 frames that turn on by 2.5 degrees each.
    let rows: String = (0..80)
        .map(|frame| format!(" {frame} {}\n", 0.1 * f64::from(frame) + 30.0 * (f64::from(frame) * 14.4).to_radians().sin()))
        .collect();
    let figure = "joint hips offset 0 90 0 channels Zrotation\nend parent hips offset 0 60 0\n";
    folder.put("swing.keys", format!("keyframes 1\nfps 30\nframes 80\ncm-per-unit 1\n{figure}keys linear hips\n{rows}"));
    let bounded = |bound| ["convert", "swing.keys", "--find-loop", "--max-rotation-error", bound];
    let printed = String::from_utf8(folder.done(&bounded("3")).stdout).unwrap();
    assert!(!printed.is_empty());
    for line in printed.lines() {
        let (options, result) = line.split_once(": ").unwrap();
        assert!(options.ends_with(" --max-rotation-error 3") && result.contains(" degrees"), "{line}");
        let loops = ["convert", "swing.keys", "-o", "swing.ptn"].into_iter().chain(options.split(' '));
        folder.done(&loops.collect::<Vec<_>>());
    }
    let refused = folder.refused(&bounded("0.0001"));
    assert!(refused.contains("whose seam turns no joint by 0.0001 degrees"), "{refused}");
}

#[test]
fn a_height_that_does_not_come_back_is_no_way() {
    let folder = super::outputs::Folder::new();
    let rows: String = (0..31).map(|frame| format!(" {frame} {} {}\n", 2 * frame, 90.0 + f64::from(frame) / 15.0)).collect();
    let figure = "joint hips offset 0 0 0 channels Xposition Yposition\nend parent hips offset 0 60 0\n";
    folder.put("slope.keys", format!("keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\n{figure}keys linear hips\n{rows}"));
    let looped = |bound| ["convert", "slope.keys", "--loop", "-o", "slope.ptn", "--max-error", bound];
    let said = folder.refused(&looped("1cm"));
    assert!(said.contains("hips is 2.000 cm off in the last frame"), "{said}");
    // Closed with the seam; the way over the ground stays.
    let said = super::outputs::err(&folder.done(&looped("3cm")));
    assert!(said.contains("hips.Xposition goes 60") && !said.contains("Yposition goes"), "{said}");
}

#[test]
fn a_motion_that_is_one_cycle_is_proposed_whole_and_standing_apart() {
    let folder = super::outputs::Folder::new();
    let figure = "joint hips offset 0 90 0 channels Xposition Zrotation\nend parent hips offset 0 60 0\n";
    let put = |name: &str, frames: usize, turn: &dyn Fn(usize) -> f64| {
        let rows: String = (0..frames).map(|frame| format!(" {frame} {} {}\n", 3 * frame, turn(frame))).collect();
        folder.put(name, format!("keyframes 1\nfps 30\nframes {frames}\ncm-per-unit 1\n{figure}keys linear hips\n{rows}"));
    };
    let loops = |name: &str| {
        let found: Value = serde_json::from_slice(&folder.done(&["convert", name, "--find-loop", "--json"]).stdout).unwrap();
        found["loops"].as_array().unwrap().clone()
    };
    // Frame 24 is frame 0 again, and no frame follows it.
    put("cycle.keys", 25, &|frame| 30.0 * (frame as f64 * 15.0).to_radians().cos());
    let found = loops("cycle.keys");
    assert_eq!((&found[0]["from"], &found[0]["to"]), (&0.into(), &24.into()), "{found:?}");
    assert!(found.iter().all(|cut| cut["still"] == false), "{found:?}");
    // Waves, between them two seconds of breath.
    put("rest.keys", 160, &|frame| match frame {
        50..110 => (frame as f64 * 9.0).to_radians().sin(),
        _ => 40.0 * (frame as f64 * 18.0).to_radians().sin(),
    });
    let found = loops("rest.keys");
    let still: Vec<&Value> = found.iter().filter(|cut| cut["still"] == true).collect();
    let [still] = still[..] else { panic!("{found:?}") };
    let (from, to) = (still["from"].as_u64().unwrap(), still["to"].as_u64().unwrap());
    assert!(from >= 48 && to <= 111 && to - from >= 30, "{still}");
    let said = String::from_utf8(folder.done(&["convert", "rest.keys", "--find-loop"]).stdout).unwrap();
    assert!(said.lines().last().unwrap().ends_with("; the figure stands"), "{said}");
    // Where there is no such line, a note says why.
    let noted = |name: &str| String::from_utf8(folder.done(&["convert", name, "--find-loop"]).stderr).unwrap();
    assert!(noted("cycle.keys").contains("no line for standing: "), "{}", noted("cycle.keys"));
    assert!(!noted("rest.keys").contains("no line for standing"), "{}", noted("rest.keys"));
}

/// What `--find-loop` prints of captured motions, run as printed.
#[test]
fn proposals_for_captured_loops_convert_as_they_are_printed() {
    let repository = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let data = std::env::var_os("PANTIN_DATA").map_or_else(|| repository.join("../shared/data"), std::path::PathBuf::from);
    let names = ["bvh_bandai1_walk.bvh", "bvh_xia_strut-walk.bvh", "bvh_mixamo-beta_run-loop.bvh"];
    if !names.iter().all(|name| data.join(name).is_file()) {
        return println!("skipped: no captured clips in {}; set PANTIN_DATA", data.display());
    }
    let folder = super::outputs::Folder::new();
    for name in names {
        let path = data.join(name);
        let printed = String::from_utf8(folder.done(&["convert", path.to_str().unwrap(), "--find-loop"]).stdout).unwrap();
        assert!(printed.lines().count() >= 2, "{name}: {printed}");
        for (number, line) in printed.lines().enumerate() {
            let out = format!("{name}-{number}.ptn");
            let options: Vec<&str> = line.split_once(':').unwrap().0.split(' ').collect();
            folder.done(&[&["convert", path.to_str().unwrap(), "-o", &out], &options[..]].concat());
        }
    }
}

#[test]
fn options_without_effect_are_named_or_refused() {
    let folder = super::outputs::Folder::new();
    folder.put("a.csv", "time,a,b\n0,0,1\n0.1,0.5,1\n0.2,1,1\n0.3,0.25,1\n");
    let said = super::outputs::err(&folder.done(&["convert", "a.csv", "-o", "a.ptn", "--up", "z"]));
    assert!(said.contains("--up has no effect: the motion has no joints"), "{said}");
    let commands: [&[&str]; 2] = [&["play", "a.ptn", "--plain"], &["render", "a.ptn", "-o", "a.png"]];
    for arguments in commands {
        let said = folder.refused(&[arguments, &["--up", "z"]].concat());
        assert!(said.contains("--up"), "{said}");
    }
    // Scalars have no distances.
    let said = super::outputs::err(&folder.done(&["convert", "a.csv", "-o", "b.ptn", "--close-loop"]));
    assert!(said.contains("scalars change by up to 25.00 % of full scale; within the clip by up to 75.00 %"), "{said}");
    assert!(!said.contains(" cm"), "{said}");
    for options in [
        &["--footsteps"][..],
        &["--index", "1"],
        &["--max-error", "1"],
        &["--exact"],
        &["--loop"],
        &["--close-loop"],
        &["--event", "a@1"],
    ] {
        let output = folder.run(&[&["convert", "run.keys", "--find-loop"], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}: {}", super::outputs::err(&output));
    }
    for rate in ["1e-300", "1e300"] {
        let output = folder.run(&["convert", "run.keys", "-o", "c.ptn", "--rate", rate]);
        let said = super::outputs::err(&output);
        assert!(!output.status.success() && said.len() < 300 && said.contains("--rate"), "{said}");
    }
}

/// One cycle of a steady spin, closed at higher rates: it lasts as long as at its own.
#[test]
fn a_closed_cycle_keeps_its_length_at_another_rate() {
    let folder = tempfile::tempdir().unwrap();
    let (motion, clip) = (folder.path().join("spin.bvh"), folder.path().join("spin.ptn"));
    let rows: String = (0..24).map(|frame| format!("0 90 0 {}\n", 15 * frame)).collect();
    let text = format!(
        "HIERARCHY\nROOT hip\n{{\nOFFSET 0 90 0\nCHANNELS 4 Xposition Yposition Zposition Yrotation\nEnd Site\n{{\nOFFSET 40 0 0\n}}\n}}\nMOTION\nFrames: 24\nFrame Time: 0.0333333\n{rows}"
    );
    std::fs::write(&motion, text).unwrap();
    for (fps, frames) in [("60", 48), ("120", 96), ("20", 16), ("30", 24)] {
        let output = convert(&motion, &["--close-loop", "--fps", fps, "--cm-per-unit", "1", "-o", clip.to_str().unwrap()]);
        assert!(output.status.success(), "{output:?}");
        let bytes = std::fs::read(&clip).unwrap();
        assert_eq!(Clip::new_checked(&bytes).unwrap().frames(), frames, "{fps}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let steps: Vec<f64> = said
            .lines()
            .find(|line| line.contains("joints go up to"))
            .unwrap()
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .collect();
        assert!((steps[0] / steps[1] - 1.0).abs() < 0.05, "{fps}: {said}");
    }
}

/// A table is read at the times of --fps: what that means for a cycle is said, and what a shorter face does to it.
#[test]
fn what_a_cycle_of_a_sampled_file_ends_with_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let rows: String =
        (0..24).map(|frame| format!("{:.4},{:.4}\n", f64::from(frame) / 30.0, (f64::from(frame) * 0.2618).sin())).collect();
    std::fs::write(path("cycle.csv"), format!("time,a\n{rows}")).unwrap();
    let said = |input: &str, options: &[&str]| {
        let output = convert(&path(input), &[&["--close-loop", "-o", path("a.ptn").to_str().unwrap()], options].concat());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(said("cycle.csv", &["--fps", "60"]).contains("which one such frame parts from its first"));
    assert!(!said("cycle.csv", &[]).contains("which one such frame"));
    std::fs::write(path("body.keys"), "keyframes 1\nfps 30\nframes 30\ncm-per-unit 1\njoint hip offset 0 90 0 channels Yrotation\nend parent hip offset 9 0 0\nkeys linear hip\n 0 0\n 29 29\n").unwrap();
    let with = path("cycle.csv");
    assert!(said("body.keys", &["--with", with.to_str().unwrap()]).contains("24 of 30 frames become the loop"));
}

/// Between the rows of a table there are straight lines, whether it is converted itself or goes with a body of another rate.
#[test]
fn a_table_that_goes_with_a_body_has_straight_lines() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let body: String = (0..25).map(|frame| format!(" {frame} {frame}\n")).collect();
    std::fs::write(path("body.keys"), format!("keyframes 1\nfps 30\nframes 25\ncm-per-unit 1\njoint hip offset 0 90 0 channels Yrotation\nend parent hip offset 9 0 0\nkeys linear hip\n{body}")).unwrap();
    std::fs::write(path("face.csv"), "time,smile\n0,0\n0.1,0\n0.2,0\n0.3,1\n0.4,1\n0.5,1\n0.6,0\n0.7,0\n0.8,0\n").unwrap();
    let output = convert(
        &path("body.keys"),
        &["--with", path("face.csv").to_str().unwrap(), "--max-scalar-error", "0.05", "-o", path("a.ptn").to_str().unwrap()],
    );
    assert!(output.status.success(), "{output:?}");
    let output = Command::new(env!("CARGO_BIN_EXE_pantin"))
        .arg("expand")
        .arg(path("a.ptn"))
        .arg("-o")
        .arg(path("a.csv"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let table = std::fs::read_to_string(path("a.csv")).unwrap();
    let smile = table.lines().next().unwrap().split(',').position(|name| name == "smile").unwrap();
    for (frame, row) in table.lines().skip(1).enumerate() {
        let value: f64 = row.split(',').nth(smile).unwrap().parse().unwrap();
        let expected = match frame {
            0..=6 => 0.0,
            7..=9 => (frame as f64 - 6.0) / 3.0,
            10..=15 => 1.0,
            16..=18 => 1.0 - (frame as f64 - 15.0) / 3.0,
            _ => 0.0,
        };
        assert!((value - expected).abs() < 6e-4, "{frame}: {value} is not {expected}");
    }
}

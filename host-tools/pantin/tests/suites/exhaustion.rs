//! Small files that ask for much: every command refuses them, in little time and memory.

use super::outputs::{Folder, err};
use super::processor_time::within;
use std::path::Path;
use std::process::Output;

/// Most CPU time of a command that refuses: it does not depend on what else the machine does.
const SOON: f64 = 1.0;
/// Most steps of moving channels by which segments are counted: about half a second.
const STEPS: u64 = 1 << 26;
/// Address space of the commands in kB. What a process has in memory is less.
const MOST_KB: u64 = 1 << 20;

/// Runs the command with a limit on its memory; returns its CPU time in seconds too, where that can be measured.
fn limited(folder: &Folder, arguments: &[&str]) -> (Output, Option<f64>) {
    let program = env!("CARGO_BIN_EXE_pantin");
    if !cfg!(target_os = "linux") {
        return (folder.run(arguments), None);
    }
    let mut command = std::process::Command::new("sh");
    let script = format!("ulimit -v {MOST_KB}; \"$@\"; code=$?; times > times; exit $code");
    command.args(["-c", &script, "sh", program]).args(arguments).current_dir(folder.path(""));
    // Each thread reserves an arena of 64 MB of address space otherwise.
    let output = command.env("RAYON_NUM_THREADS", "2").env("MALLOC_ARENA_MAX", "1").output().unwrap();
    let times = String::from_utf8(folder.get("times")).unwrap();
    std::fs::remove_file(folder.path("times")).unwrap();
    // The second line is of the children: user and system time as `0m0.040s`.
    let seconds = |time: &str| {
        let (minutes, seconds) = time.strip_suffix('s')?.split_once('m')?;
        Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
    };
    let sum = times.lines().nth(1).unwrap_or_default().split_whitespace().map(seconds).sum::<Option<f64>>();
    assert!(sum.is_some(), "{times}");
    (output, sum)
}

/// The command must refuse soon, naming `why`.
fn refused(folder: &Folder, arguments: &[&str], why: &str) {
    let (output, time) = limited(folder, arguments);
    let said = err(&output);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {} {said}", output.status);
    assert!(said.contains(why), "{arguments:?}: {said}");
    assert!(time.is_none_or(|time| time < SOON), "{arguments:?}: {time:?} s");
}

#[test]
fn a_face_parameter_file_of_308_bytes() {
    let folder = Folder::new();
    let (mask, values) = (vec!["1"; 68].join(" "), vec!["1"; 76].join(" "));
    folder.put("b.fap", format!("2.1 x 25 16777216\n{mask}\n0 {values}\n"));
    refused(&folder, &["convert", "b.fap", "-o", "b.ptn"], "--max-memory");
}

#[test]
fn a_table_of_30_bytes() {
    let folder = Folder::new();
    folder.put("b.csv", "time,a\n0,1\n1,2\n2,3\n16000000,4\n");
    refused(&folder, &["convert", "b.csv", "-o", "b.ptn"], "--max-memory");
    folder.put("c.csv", "time,a\n0,1\n10000000,4\n");
    refused(&folder, &["convert", "c.csv", "-o", "b.ptn", "--fps", "1"], "--max-memory");
}

#[test]
fn a_clip_of_few_bytes_that_lasts_for_ever() {
    let folder = Folder::new();
    let still = |channels: &str| format!("procedural 1\nfps 1\nframes 2000\n{channels}");
    folder.put("s.proc", still("scalar a scale 1\na = 0.5"));
    folder.put(
        "j.proc",
        still(
            "joint hip offset 0 0 0 channels Xrotation\njoint arm parent hip offset 0 10 0 channels Xrotation\nhip.Xrotation = 1",
        ),
    );
    for name in ["s", "j"] {
        let done = folder.run(&["convert", &format!("{name}.proc"), "-o", &format!("{name}.ptn")]);
        assert!(done.status.success(), "{}", err(&done));
    }
    refused(&folder, &["expand", "s.ptn", "-o", "s.csv", "--max-output", "1kB"], "--max-output");
    refused(&folder, &["expand", "j.ptn", "-o", "j.bvh", "--max-output", "10kB"], "--max-output");
    refused(&folder, &["expand", "s.ptn", "-o", "s.glb", "--max-memory", "100kB"], "--max-memory");
    refused(&folder, &["render", "s.ptn", "-o", "s.png", "--max-memory", "100kB"], "--max-memory");
    refused(&folder, &["render", "j.ptn", "-o", "j.gif", "--fps", "50"], "pictures");
    refused(&folder, &["play", "s.ptn", "--plain", "--max-memory", "100kB"], "--max-memory");
    let parts = folder.names().into_iter().filter(|name| name.ends_with(".part") || name.ends_with(".csv")).count();
    assert_eq!(parts, 0);
}

#[test]
fn a_gltf_whose_tracks_share_their_keys() {
    let folder = Folder::new();
    let bytes = 4 * 20_000;
    let zeros = "A".repeat(bytes * 4 / 3 + 4 - bytes * 4 / 3 % 4);
    let channels: Vec<String> =
        (0..1000).map(|node| format!(r#"{{"sampler":0,"target":{{"node":{node},"path":"weights"}}}}"#)).collect();
    let nodes = vec!["{}"; 1000].join(",");
    folder.put(
        "b.gltf",
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{nodes}],"buffers":[{{"byteLength":{bytes},"uri":"data:;base64,{zeros}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{bytes}}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":20000,"type":"SCALAR"}}],
            "animations":[{{"samplers":[{{"input":0,"output":0}}],"channels":[{}]}}]}}"#,
            channels.join(",")
        ),
    );
    refused(&folder, &["convert", "b.gltf", "-o", "b.ptn"], "--max-memory");
}

#[test]
fn too_many_of_anything_is_refused_before_it_takes_time() {
    let folder = Folder::new();
    let mut bvh = String::from("HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 1 Xrotation\n");
    (0..100_000).for_each(|_| bvh += "JOINT a { OFFSET 0 1 0 CHANNELS 1 Xrotation\n");
    folder.put("b.bvh", bvh);
    refused(&folder, &["convert", "b.bvh", "-o", "b.ptn"], "joints");
    let mut asf = String::from(":version 1.10\n:units\nlength 1\nangle deg\n:root\norder TX\naxis XYZ\n:bonedata\n");
    (0..60_000)
        .for_each(|bone| asf += &format!("begin\nid {bone}\nname b{bone}\ndirection 1 0 0\nlength 1\naxis 0 0 0 XYZ\nend\n"));
    folder.put("b.asf", asf);
    folder.put("b.amc", "#!OML:ASF b.asf\n:FULLY-SPECIFIED\n1\nroot 0\n");
    refused(&folder, &["convert", "b.amc", "-o", "b.ptn"], "bones");
    let mut lets = String::from("procedural 1\nfps 30\nframes 10\nscalar a scale 1\n");
    (0..40_000).for_each(|name| lets += &format!("let n{name} = t\n"));
    folder.put("b.proc", lets);
    refused(&folder, &["convert", "b.proc", "-o", "b.ptn"], "names");
}

/// Every command that reads a file, with a device that never ends in its place.
#[cfg(target_os = "linux")]
#[test]
fn a_device_without_end_is_refused() {
    let folder = Folder::new();
    folder.put("index.html", "");
    for name in ["zero.ptn", "zero.obj", "zero.glb", "zero.gltf", "zero.keys", "zero.csv", "zero.bin"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path(name)).unwrap();
    }
    let buffer = r#"{"byteLength":4,"uri":"zero.bin"}"#;
    let accessor = r#"{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}"#;
    folder.put(
        "mesh.gltf",
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{buffer}],"bufferViews":[{{"buffer":0,"byteLength":4}}],
            "accessors":[{accessor}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]}}"#
        ),
    );
    let line = "tcp:127.0.0.1:1";
    let runs: [&[&str]; 18] = [
        &["info", "/dev/zero"],
        &["info", "zero.gltf"],
        &["convert", "zero.keys", "-o", "a.ptn"],
        &["convert", "zero.glb", "-o", "a.ptn"],
        &["convert", "--list", "zero.gltf"],
        &["convert", "run.keys", "--with", "zero.csv", "-o", "a.ptn"],
        &["convert", "run.keys", "--retarget", "display", "--map", "zero.obj", "-o", "a.ptn"],
        &["expand", "zero.ptn", "-o", "a.bvh"],
        &["render", "zero.ptn", "-o", "a.gif"],
        &["play", "zero.ptn", "--plain"],
        &["flash-image", "zero.ptn", "--board", "pico", "-o", "a.uf2"],
        &["update", "zero.ptn", "--to", line],
        &["stream", "zero.ptn", "--to", line],
        &["serve", "zero.ptn", "--site", ".", "--port", "0"],
        &["face", "model", "zero.glb", "-o", "a.model"],
        &["face", "fit", "zero.obj"],
        &["face", "fit", "zero.glb"],
        &["face", "fit", "zero.ptn"],
    ];
    for arguments in runs {
        refused(&folder, &[arguments, &["--max-memory", "64MB"]].concat(), "more than");
    }
    // A file that another names must be a regular one.
    refused(&folder, &["face", "model", "mesh.gltf", "-o", "a.model"], "zero.bin: a pipe or a device; expected a regular file");
    folder.done(&["convert", "run.keys", "-o", "run.ptn", "--effort", "fast"]);
    refused(&folder, &["stream", "run.ptn", "--to", line, "--key", "/dev/zero"], "more than");
    // Without the option, the limit holds too.
    refused(&folder, &["update", "/dev/zero", "--to", line], "more than");
}

/// Standard input of `stream --live -`: a line without an end, and none at all until the program is stopped.
#[cfg(target_os = "linux")]
#[test]
fn a_live_line_without_end_is_refused_a_silent_one_is_stopped_and_what_is_cut_is_said() {
    use std::process::Stdio;
    let folder = Folder::new();
    folder.put("face.csv", "time,JawOpen\n0,0\n0.1,1\n0.2,0\n");
    folder.done(&["convert", "face.csv", "-o", "face.ptn"]);
    let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let line = format!("tcp:127.0.0.1:{}", listener.local_addr().unwrap().port());
    let arguments = ["stream", "face.ptn", "--live", "-", "--to", &line];
    let endless = std::fs::File::open("/dev/zero").unwrap();
    let output = folder.command(&arguments).stdin(endless).output().unwrap();
    assert!(output.status.code() == Some(1) && err(&output).contains("more than"), "{}", err(&output));
    // Ninety-nine times what the channel holds is cut, and said.
    let csv = format!("Timecode,BlendshapeCount,JawOpen\n{}", "0:0:0:1.0,1,99\n".repeat(3));
    folder.put("live.csv", csv);
    let lines = std::fs::File::open(folder.path("live.csv")).unwrap();
    let output = folder.command(&arguments).stdin(lines).output().unwrap();
    let said = err(&output);
    assert!(output.status.success() && said.contains("JawOpen: 99 is outside what the clip's channel holds"), "{said}");
    assert!(said.contains("values were outside"), "{said}");
    for begin in ["", "Timecode,BlendshapeCount,JawOpen\n"] {
        let mut child = folder.command(&arguments).stdin(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        std::io::Write::write_all(&mut stdin, begin.as_bytes()).unwrap();
        // Before its signals are handled, one ends the program at once: that is a stop too.
        std::thread::sleep(std::time::Duration::from_millis(200));
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        let begun = std::time::Instant::now();
        while child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed().as_secs() < 60, "it does not stop");
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
    }
}

/// Four thousand animations that share one track of 30,000 keys, which a list would read four thousand times.
#[test]
fn a_list_of_animations_that_share_many_keys_is_refused_at_once() {
    use super::gltf_input::Builder;
    let folder = Folder::new();
    let mut builder = Builder::new(serde_json::json!([{"name": "a"}]));
    let times: Vec<f32> = (0..30_000).map(|key| key as f32 / 30.0).collect();
    builder.animate(0, "translation", "LINEAR", &times, &vec![0.5; 90_000]);
    let animation = builder.root["animations"][0].clone();
    builder.root["animations"] = std::iter::repeat_n(animation, 4000).collect::<Vec<_>>().into();
    folder.put("shared.gltf", builder.text());
    refused(&folder, &["convert", "--list", "shared.gltf"], "too many to list");
}

/// What another file names is read if it is a regular file: nobody writes to the pipe.
#[cfg(unix)]
#[test]
fn a_pipe_that_another_file_names_is_refused() {
    use super::gltf_input::Builder;
    use std::process::{Command, Stdio};
    let folder = Folder::new();
    let mut builder = Builder::new(serde_json::json!([{"name": "a"}]));
    builder.animate(0, "translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    builder.root["buffers"] = serde_json::json!([{"byteLength": 32, "uri": "pipe.bin"}]);
    folder.put("pipe.gltf", builder.root.to_string());
    folder.put("zero.gltf", builder.root.to_string().replace("pipe.bin", "zero.bin"));
    folder.put("dir.gltf", builder.root.to_string().replace("pipe.bin", "meshes"));
    folder.put("walk.amc", "#!OML:ASF walk.asf\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n");
    std::fs::create_dir(folder.path("meshes")).unwrap();
    for pipe in ["pipe.bin", "walk.asf", "meshes/a.obj"] {
        if !Command::new("mkfifo").arg(folder.path(pipe)).status().is_ok_and(|status| status.success()) {
            eprintln!("skipped: no mkfifo");
            return;
        }
    }
    std::os::unix::fs::symlink("/dev/zero", folder.path("zero.bin")).unwrap();
    for (arguments, wanted) in [
        (&["convert", "pipe.gltf", "-o", "a.ptn"][..], "pipe.bin: a pipe or a device; expected a regular file"),
        (&["convert", "zero.gltf", "-o", "a.ptn"], "zero.bin: a pipe or a device; expected a regular file"),
        (&["convert", "dir.gltf", "-o", "a.ptn"], "meshes: a directory; expected a regular file"),
        (&["convert", "walk.amc", "-o", "a.ptn"], "walk.asf: a pipe or a device; expected a regular file"),
        (&["face", "fit", "meshes"], "no .obj files"),
    ] {
        let mut child = folder.command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let begun = std::time::Instant::now();
        while child.try_wait().unwrap().is_none() {
            if begun.elapsed().as_secs() > 60 {
                child.kill().unwrap();
            }
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        let output = child.wait_with_output().unwrap();
        assert!(output.status.code() == Some(1) && err(&output).contains(wanted), "{arguments:?}: {}", err(&output));
    }
}

/// Columns of a live line that the clip has no channel for are named, in one warning.
#[test]
fn columns_that_a_live_line_leaves_out_are_named() {
    use std::process::Stdio;
    let folder = Folder::new();
    folder.put("face.csv", "time,JawOpen\n0,0\n0.1,1\n0.2,0\n");
    folder.done(&["convert", "face.csv", "-o", "face.ptn"]);
    let warnings = |columns: &[String]| {
        let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let line = format!("tcp:127.0.0.1:{}", listener.local_addr().unwrap().port());
        let mut command = folder.command(&["stream", "face.ptn", "--live", "-", "--to", &line]);
        let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
        let rows = format!("Timecode,BlendshapeCount,{}\n0,1{}\n", columns.join(","), ",0".repeat(columns.len()));
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), rows.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", err(&output));
        let said = err(&output);
        said.lines().filter(|line| line.contains("left out")).map(String::from).collect::<Vec<_>>()
    };
    let names = |count: usize| -> Vec<String> {
        ["JawOpen".to_string()].into_iter().chain((0..count).map(|index| format!("Extra{index}"))).collect()
    };
    assert!(warnings(&names(0)).is_empty());
    let few = warnings(&names(2));
    assert!(few.len() == 1 && few[0].ends_with("are left out: Extra0, Extra1"), "{few:?}");
    let many = warnings(&names(30));
    assert!(many.len() == 1 && many[0].ends_with("Extra19 and 10 more"), "{many:?}");
}

/// The most memory that a command had at a time, in bytes, and whether it succeeded; `None` if it refused.
#[cfg(target_os = "linux")]
pub fn peak(folder: &Folder, arguments: &[&str]) -> Option<u64> {
    let mut command = folder.command(arguments);
    command.env("RAYON_NUM_THREADS", "2").stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped());
    let mut child = command.spawn().unwrap();
    let process = Path::new("/proc").join(child.id().to_string());
    let program = |process: &Path| std::fs::read_link(process.join("exe")).ok();
    let tests = program(Path::new("/proc/self"));
    let mut most = 0;
    loop {
        // A process has its parent's memory until it runs its own program: on a busy machine it may not have come to that.
        let began = program(&process).is_some_and(|path| Some(path) != tests);
        let status = std::fs::read_to_string(process.join("status")).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB"));
        if began {
            most = line.and_then(|kb| kb.trim().parse().ok()).unwrap_or(0).max(most);
        }
        if child.try_wait().unwrap().is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let output = child.wait_with_output().unwrap();
    let said = err(&output);
    assert!(output.status.success() || said.contains("--max-memory") || said.contains("too many"), "{arguments:?}: {said}");
    output.status.success().then_some(most * 1024)
}

/// What the limit admits stays below it: every command and importer with twice as many frames each time, until it is refused.
#[cfg(target_os = "linux")]
#[test]
fn what_is_admitted_takes_no_more_than_the_limit() {
    /// The limit, and what the program takes without a motion.
    const LIMIT: u64 = 24 << 20;
    const PROGRAM: u64 = 16 << 20;
    let folder = Folder::new();
    let proc = |frames: u32, joints: u32| {
        let mut text = format!("procedural 1\nfps 30\nframes {frames}\n");
        for joint in 0..joints {
            let parent = if joint > 0 { format!("parent j{} ", joint - 1) } else { String::new() };
            text += &format!("joint j{joint} {parent}offset 0 10 0 channels Zrotation Xrotation Yrotation\n");
        }
        text += if joints == 0 { "scalar a scale 1\na = 0.5 * sin(t * t * 40)\n" } else { "" };
        for joint in 0..joints {
            text += &format!("j{joint}.Xrotation = 20 * sin(t * {})\nj{joint}.Zrotation = 9 * sin(t)\n", joint + 1);
        }
        text
    };
    type Make<'a> = Box<dyn Fn(u32) -> Vec<u8> + 'a>;
    let row = |frames: u32| format!("time,a\n0,1\n1,2\n2,3\n{},4\n", frames - 2).into_bytes();
    let fap = |frames: u32| {
        let (mask, values) = (["1"; 68].join(" "), ["1"; 76].join(" "));
        format!("2.1 x 25 {frames}\n{mask}\n0 {values}\n").into_bytes()
    };
    // Joints without channels have places too.
    let bones = |frames: u32| {
        let mut text = proc(frames, 1);
        let at = text.find("j0.").unwrap();
        let bones: String = (1..150).map(|joint| format!("joint j{joint} parent j{} offset 0 1 0\n", joint - 1)).collect();
        text.insert_str(at, &bones);
        text.into_bytes()
    };
    let cases: [(&str, u32, Make); 6] = [
        ("a.csv", 4096, Box::new(row)),
        ("a.fap", 512, Box::new(fap)),
        ("scalar.proc", 2048, Box::new(|frames| proc(frames, 0).into_bytes())),
        ("joint.proc", 2048, Box::new(|frames| proc(frames, 1).into_bytes())),
        ("joints.proc", 256, Box::new(|frames| proc(frames, 8).into_bytes())),
        ("bones.proc", 32, Box::new(bones)),
    ];
    for (name, least, make) in cases {
        for effort in ["fast", "default"] {
            let (mut frames, mut admitted) = (least, 0);
            loop {
                folder.put(name, make(frames));
                let arguments = ["convert", name, "-o", "a.ptn", "--effort", effort, "--max-memory", "24MB"];
                let Some(bytes) = peak(&folder, &arguments) else { break };
                assert!(bytes < LIMIT + PROGRAM, "{name}, {effort}: {frames} frames took {} MB", bytes >> 20);
                let shown: &[&[&str]] = if effort == "default" {
                    &[]
                } else {
                    &[
                        &["expand", "a.ptn", "-o", "b.glb"],
                        &["expand", "a.ptn", "-o", "b.csv"],
                        &["render", "a.ptn", "-o", "b.png"],
                        &["info", "a.ptn"],
                    ]
                };
                for arguments in shown {
                    let bytes = peak(&folder, &[*arguments, &["--max-memory", "24MB"][..]].concat()).unwrap_or(0);
                    assert!(bytes < LIMIT + PROGRAM, "{arguments:?} of {name}: {frames} frames took {} MB", bytes >> 20);
                }
                (frames, admitted) = (frames * 2, admitted + 1);
            }
            assert!(admitted > 0, "{name}, {effort}");
        }
    }
}

/// The clip with another number of frames: its symbols end, and what a player reads then is zeros.
pub fn with_frames(clip: &[u8], frames: u32) -> Vec<u8> {
    let opened = pantin::Clip::new_checked(clip).unwrap();
    let blocks = &clip[clip.len() - opened.motion_len()..];
    let mut payload: Vec<u8> = blocks.chunks(256).flat_map(|block| &block[..block.len() - 2]).copied().collect();
    // The rate is in the table, so that the frames, below 128, follow it in a byte.
    assert!(payload[0] != 0 && u32::from(payload[1]) == opened.frames());
    let varint = (0..4).map(|digit| (frames >> (7 * digit)) as u8 & 0x7f | if digit < 3 { 0x80 } else { 0 });
    payload.splice(1..2, varint);
    let rig = pantin_convert::bank::rig_of(clip).unwrap();
    pantin_convert::encode::clip::assembled(clip[3], &rig, &payload, None)
}

#[test]
fn a_clip_that_lasts_for_ever_is_described_soon() {
    let folder = Folder::new();
    let mut scalars = String::from("procedural 1\nfps 30\nframes 3\n");
    (0..300).for_each(|scalar| scalars += &format!("scalar s{scalar} scale 1\n"));
    (0..300).for_each(|scalar| scalars += &format!("s{scalar} = 0.5 + 0.5 * sin(t * {scalar})\n"));
    let mut joints = String::from("procedural 1\nfps 30\nframes 3\njoint j0 offset 0 90 0 channels Xrotation\n");
    (1..100).for_each(|joint| joints += &format!("joint j{joint} parent j{} offset 0 9 0 channels Xrotation\n", joint - 1));
    (0..100).for_each(|joint| joints += &format!("j{joint}.Xrotation = 40 * sin(t * {joint} + {joint})\n"));
    for (name, text) in [("scalars", scalars), ("joints", joints)] {
        folder.put("a.proc", text);
        folder.done(&["convert", "a.proc", "-o", "a.ptn"]);
        let clip = folder.get("a.ptn");
        assert!(pantin::Clip::new_checked(&with_frames(&clip, 3)).is_ok_and(|clip| clip.frames() == 3));
        folder.put("long.ptn", with_frames(&clip, 1 << 24));
        let (output, _) = limited(&folder, &["info", "long.ptn", "--json"]);
        assert!(output.status.success(), "{name}: {}", err(&output));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        // What takes the time is a step of each moving channel in each frame that is counted: half a second, which depends on what else the machine does.
        let counted = report["segments_counted_in_frames"].as_u64().unwrap();
        let steps = counted * (report["moving"].as_u64().unwrap() + 1);
        assert!(counted >= 100 && steps <= STEPS, "{name}: {report}");
        assert!(report["segments"].as_u64().unwrap() > 100 * (1 << 24) / 96 / 2, "{name}: {report}");
    }
}

#[test]
fn a_bank_of_many_clips_with_a_large_rig_is_listed_and_written_soon() {
    use pantin_convert::bank::{Named, encode, rig_of};
    let folder = Folder::new();
    let mut text = String::from("procedural 1\nfps 30\nframes 3\n");
    (0..300).for_each(|scalar| text += &format!("scalar s{scalar}{} scale 1\n", "x".repeat(200)));
    text += &format!("s0{} = t\n", "x".repeat(200));
    folder.put("a.proc", text);
    folder.done(&["convert", "a.proc", "-o", "a.ptn"]);
    let clip = folder.get("a.ptn");
    let rig: std::sync::Arc<[u8]> = rig_of(&clip).unwrap().into();
    assert!(rig.len() > 50_000);
    let apart = pantin_convert::bank::without_rig(&clip, &pantin_convert::bank::CheckedRig::new(&rig).unwrap()).unwrap();
    let named = |number| Named { name: format!("clip {number}"), place: String::new(), clip: apart.clone(), rig: rig.clone() };
    let clips: Vec<Named> = (0..4000).map(named).collect();
    folder.put("moves.ptb", within(5.0, || encode(&clips).unwrap()));
    let (output, time) = limited(&folder, &["list", "moves.ptb"]);
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 4003, "{}", err(&output));
    assert!(time.is_none_or(|time| time < SOON), "{time:?} s");
}

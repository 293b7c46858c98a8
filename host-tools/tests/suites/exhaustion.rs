//! Small files that ask for much: every command refuses them, in little time and memory.

use super::outputs::{Folder, err};
use std::process::Output;
use std::time::{Duration, Instant};

/// What the limits of the review allow, for one command on a busy machine.
const SOON: Duration = Duration::from_secs(10);
/// Address space of the commands in kB: the limit of 1 GB of memory, and what threads and libraries reserve.
const MOST_KB: u64 = 3 << 20;

/// Runs the command with a limit on its memory.
fn limited(folder: &Folder, arguments: &[&str]) -> (Output, Duration) {
    let begun = Instant::now();
    let program = env!("CARGO_BIN_EXE_pantin");
    let output = if cfg!(target_os = "linux") {
        let mut command = std::process::Command::new("sh");
        command.args(["-c", &format!("ulimit -v {MOST_KB}; exec \"$@\""), "sh", program]).args(arguments);
        command.current_dir(folder.path("")).env("RAYON_NUM_THREADS", "2").output().unwrap()
    } else {
        folder.run(arguments)
    };
    (output, begun.elapsed())
}

/// The command must refuse soon, naming `why`.
fn refused(folder: &Folder, arguments: &[&str], why: &str) {
    let (output, time) = limited(folder, arguments);
    let said = err(&output);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {} {said}", output.status);
    assert!(said.contains(why), "{arguments:?}: {said}");
    assert!(time < SOON, "{arguments:?}: {time:?}");
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

#[cfg(target_os = "linux")]
#[test]
fn a_device_without_end_is_no_motion() {
    let folder = Folder::new();
    refused(&folder, &["info", "/dev/zero"], "more than");
}

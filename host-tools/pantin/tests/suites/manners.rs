//! What all commands have in common: options, errors, exit codes, the report of `--json`, and names of outputs.

use super::outputs::{Folder, err};
use serde_json::Value;
use std::process::Output;

/// Every command, with arguments that succeed in a folder of [`prepared`]; `serve`, `stream` and `update` need a partner.
const RUNS: [&[&str]; 24] = [
    &["completions", "bash"],
    &["man", "convert"],
    &["convert", "run.keys", "-o", "b.ptn", "--effort", "fast"],
    &["convert", "run.keys", "walk.keys", "-o", "clips", "--effort", "fast"],
    &["convert", "run.keys", "run2.keys", "--same-form", "-o", "same", "--effort", "fast"],
    &["convert", "in", "-o", "out"],
    &["convert", "in", "-o", "in.ptb"],
    &["convert", "--list", "run.keys"],
    &["convert", "walk.keys", "--find-loop"],
    &["pack", "a.ptn", "-o", "packed.ptb"],
    &["unpack", "moves.ptb", "-o", "unpacked", "--replace"],
    &["list", "moves.ptb"],
    &["info", "moves.ptb"],
    &["expand", "a.ptn", "-o", "a.bvh"],
    &["info", "a.ptn"],
    &["render", "a.ptn", "-o", "a.png", "--frame", "0"],
    &["play", "a.ptn", "--plain", "--frames", "1"],
    &["flash-image", "a.ptn", "--board", "pico", "-o", "a.uf2"],
    &["face", "model", "-o", "face.model"],
    &["face", "export", "-o", "face.obj"],
    &["face", "sheet", "-o", "sheet.png"],
    &["face", "speak", "Hello", "--rules", "-o", "hello.keys"],
    &["face", "compare"],
    &["face", "fit", "face.obj"],
];

/// A folder with the inputs of [`RUNS`].
pub fn prepared() -> Folder {
    let folder = Folder::new();
    let motions = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions");
    std::fs::copy(motions.join("walk.keys"), folder.path("walk.keys")).unwrap();
    std::fs::copy(motions.join("run.keys"), folder.path("run2.keys")).unwrap();
    folder.put("in/light.csv", "time,a\n0,0\n0.1,1\n0.2,0.5\n");
    folder.done(&["convert", "run.keys", "-o", "a.ptn", "--effort", "fast"]);
    folder.done(&["face", "export", "-o", "face.obj"]);
    folder.done(&["pack", "a.ptn", "-o", "moves.ptb"]);
    folder
}

/// The one object that a command with `--json` prints.
fn object(output: &Output) -> Value {
    let text = String::from_utf8_lossy(&output.stdout);
    let value: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}{}", err(output)));
    assert!(value.is_object(), "{value}");
    value
}

/// What counts is what the clip holds: figures of modelling programs have more channels than that.
#[test]
fn a_figure_with_too_many_channels_converts_once_joints_are_left_out() {
    let folder = Folder::new();
    let six = "OFFSET 0 10 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
    let joint = |name: &str| format!("JOINT {name}\n{{\n{six}End Site\n{{\nOFFSET 0 1 0\n}}\n}}\n");
    let joints: String = (0..170).map(|index| joint(&format!("hair{index}"))).collect();
    let row = |frame: usize| (0..6 * 171).map(|channel| format!("{} ", (frame * channel) % 7)).collect::<String>();
    let rows: String = (0..4).map(|frame| row(frame) + "\n").collect();
    folder.put("many.bvh", format!("HIERARCHY\nROOT hips\n{{\n{six}{joints}}}\nMOTION\nFrames: 4\nFrame Time: 0.05\n{rows}"));
    let said = folder.refused(&["convert", "many.bvh", "-o", "many.ptn"]);
    assert!(said.contains("1026 channels; a rig holds at most 1023; --drop PATTERN leaves joints out"), "{said}");
    folder.done(&["convert", "many.bvh", "--drop", "hair7*", "-o", "few.ptn"]);
}

#[test]
fn odd_times_are_refused_without_a_panic() {
    let folder = Folder::new();
    let mut bvh = String::from(
        "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n",
    );
    bvh += "End Site\n{\nOFFSET 0 10 0\n}\n}\nMOTION\nFrames: 10\nFrame Time: 1e-30\n";
    (0..10).for_each(|frame| bvh += &format!("{frame} 0 0 0 0 0\n"));
    folder.put("fast.bvh", bvh);
    let said = folder.refused(&["convert", "fast.bvh"]);
    assert!(said.contains("frame time"), "{said}");
    for wrong in ["--cycle=nan", "--cycle=-1", "--ahead=inf"] {
        let output = folder.run(&["stream", "run.keys", "--to", "tcp:127.0.0.1:1", wrong]);
        assert_eq!(output.status.code(), Some(2), "{wrong}: {}", err(&output));
    }
}

#[test]
fn a_loose_bound_beside_a_mean_is_no_obstacle() {
    let folder = Folder::new();
    for bound in ["2cm", "10000cm"] {
        folder.done(&["convert", "run.keys", "-o", "run.ptn", "--mean-error", "0.3cm", "--max-error", bound, "--effort", "fast"]);
    }
    let said = folder.refused(&["convert", "run.keys", "-o", "run.ptn", "--mean-error", "0.3cm", "--max-error", "0.2cm"]);
    assert!(said.contains("--mean-error"), "{said}");
}

#[test]
fn every_command_takes_the_options_of_all() {
    let folder = prepared();
    for arguments in RUNS {
        let quiet = folder.done(&[arguments, &["-q"]].concat());
        assert!(quiet.stderr.is_empty(), "{arguments:?}: {}", err(&quiet));
        let verbose = err(&folder.done(&[arguments, &["-v"]].concat()));
        assert!(verbose.lines().last().is_some_and(|line| line.ends_with(" s")), "{arguments:?}: {verbose}");
        let output = folder.done(&[arguments, &["--json"]].concat());
        let report = if arguments[0] == "play" {
            // The pictures are on standard output.
            serde_json::from_str(err(&output).lines().last().unwrap()).unwrap()
        } else {
            object(&output)
        };
        assert_eq!(report["command"], arguments[0], "{arguments:?}");
        assert!(report.as_object().unwrap().len() > 1, "{arguments:?}: {report}");
        assert_eq!(folder.run(&[arguments, &["-q", "-v"]].concat()).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn a_report_lists_outputs_and_notes() {
    let folder = prepared();
    let report = object(&folder.done(&["convert", "run.keys", "-o", "b.ptn", "--rig-out", "b.rig", "--json", "-q"]));
    let outputs: Vec<(&str, u64)> = report["outputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|output| (output["file"].as_str().unwrap(), output["bytes"].as_u64().unwrap()))
        .collect();
    assert_eq!(outputs, [("b.rig", folder.get("b.rig").len() as u64), ("b.ptn", folder.get("b.ptn").len() as u64)]);
    assert!(report["max_error_cm"].as_f64().unwrap() <= 0.5 && report["frames"].as_u64().unwrap() > 1, "{report}");
    // With the clip on standard output, the report is on standard error.
    let piped = folder.done(&["convert", "run.keys", "-o", "-", "--json", "-q"]);
    assert!(pantin::Clip::new_checked(&piped.stdout).is_ok());
    let report: Value = serde_json::from_str(&err(&piped)).unwrap();
    assert_eq!(report["outputs"][0]["file"], "-");
}

#[test]
fn errors_begin_alike_and_have_the_documented_codes() {
    let folder = prepared();
    let runs: [(&[&str], i32); 9] = [
        (&["convert", "missing.bvh"], 1),
        (&["info", "missing.ptn"], 1),
        (&["expand", "run.keys", "-o", "x.bvh"], 1),
        (&["man", "nothing"], 1),
        (&["convert"], 2),
        (&["nothing"], 2),
        (&["render", "a.ptn", "--size", "big"], 2),
        (&["info", "a.ptn", "--nothing\u{1b}[31m"], 2),
        (&["flash-image", "a.ptn", "--board", "toaster"], 2),
    ];
    for (arguments, code) in runs {
        let output = folder.run(arguments);
        let said = err(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.starts_with("error: ") && !said.contains('\u{1b}'), "{arguments:?}: {said:?}");
        let output = folder.run(&[arguments, &["--json"]].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let reason = object(&output)["error"].as_str().unwrap().to_string();
        assert!(!reason.is_empty() && !reason.starts_with("error") && !reason.contains('\n'), "{arguments:?}: {reason}");
    }
    let help = String::from_utf8(folder.done(&["--help"]).stdout).unwrap();
    assert!(help.contains("Exit codes: 0 done; 1 failed") && help.contains("2 the command line is wrong"), "{help}");
}

#[test]
fn a_folder_with_a_failure_reports_every_file_and_the_error() {
    let folder = prepared();
    folder.put("in/bad.bvh", "HIERARCHY\n");
    let output = folder.run(&["convert", "in", "-o", "out", "--json"]);
    let report = object(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(report["error"].as_str().unwrap().contains("1 of 2 files"), "{report}");
    assert!(report["files"][0]["refused"].is_string() && report["files"][1]["frames"] == 3, "{report}");
}

#[test]
fn several_motions_go_into_a_folder_or_beside_themselves() {
    let folder = prepared();
    folder.done(&["convert", "run.keys", "in/light.csv", "-o", "clips", "-j", "2", "--effort", "fast"]);
    assert!(folder.path("clips/run.ptn").exists() && folder.path("clips/light.ptn").exists());
    folder.done(&["convert", "run.keys", "in/light.csv", "--effort", "fast"]);
    assert!(folder.get("run.ptn") == folder.get("clips/run.ptn") && folder.path("in/light.ptn").exists());
    // Nothing is written where two clips would meet, or the output is one file.
    folder.put("other/run.keys", folder.get("run.keys"));
    let said = folder.refused(&["convert", "run.keys", "other/run.keys", "-o", "met"]);
    assert!(said.contains("run.keys and other/run.keys: both would be written to"), "{said}");
    let said = folder.refused(&["convert", "run.keys", "in/light.csv", "-o", "one.ptn"]);
    assert!(said.contains("several clips need a folder"), "{said}");
    let said = folder.refused(&["convert", "run.keys", "in", "-o", "met"]);
    assert!(said.contains("in: a folder"), "{said}");
    assert!(!folder.path("met").exists() && !folder.path("one.ptn").exists());
    // One that fails does not hold up the others.
    folder.put("bad.bvh", "HIERARCHY\n");
    let said = folder.refused(&["convert", "bad.bvh", "in/light.csv", "-o", "some", "-q"]);
    assert!(said.contains("error: bad.bvh: ") && folder.path("some/light.ptn").exists(), "{said}");
}

#[test]
fn outputs_without_a_name_that_says_so_take_a_format() {
    let folder = prepared();
    folder.done(&["expand", "a.ptn", "-o", "a.csv"]);
    assert!(folder.done(&["expand", "a.ptn", "--format", "csv", "-o", "-"]).stdout == folder.get("a.csv"));
    let header = String::from_utf8(folder.done(&["expand", "a.ptn", "--format", "h", "-o", "-"]).stdout).unwrap();
    assert!(header.contains("CLIP_A_LEN"), "{header}");
    let png = folder.done(&["render", "a.ptn", "--format", "png", "--frame", "0", "-o", "-"]).stdout;
    folder.done(&["render", "a.ptn", "--frame", "0", "-o", "a.png"]);
    assert!(png.starts_with(b"\x89PNG") && png == folder.get("a.png"));
    for command in ["expand", "render"] {
        assert!(folder.refused(&[command, "a.ptn", "-o", "-"]).contains("--format"));
        assert!(folder.refused(&[command, "a.ptn", "-o", "noextension"]).contains("--format"));
    }
    let said = folder.refused(&["expand", "a.ptn", "--format", "bvh", "-o", "b.csv"]);
    assert!(said.contains("--format is bvh"), "{said}");
}

#[test]
fn outputs_have_default_names_and_a_capture_is_kept() {
    let folder = prepared();
    folder.done(&["expand", "a.ptn"]);
    folder.done(&["expand", "a.ptn", "--format", "glb"]);
    folder.done(&["render", "a.ptn", "--to", "3"]);
    folder.done(&["render", "a.ptn", "--frame", "0"]);
    let said = err(&folder.done(&["flash-image", "a.ptn", "--board", "esp32-c3"]));
    assert!(said.contains("a.bin holds "), "{said}");
    for name in ["a.bvh", "a.glb", "a.gif", "a.png", "a.bin"] {
        assert!(folder.path(name).exists(), "{name}");
    }
    folder.put("a.bvh", "the capture");
    let said = folder.refused(&["expand", "a.ptn"]);
    assert!(said.contains("a.bvh: exists; --output a.bvh replaces it"), "{said}");
    assert_eq!(folder.get("a.bvh"), b"the capture");
    folder.done(&["convert", "in/light.csv"]);
    std::fs::remove_file(folder.path("in/light.csv")).unwrap();
    folder.done(&["expand", "in/light.ptn"]);
    assert!(folder.get("in/light.csv").starts_with(b"time,a\n"));
}

#[test]
fn animations_at_rates_that_viewers_do_not_show_are_resampled_with_a_note() {
    let folder = Folder::new();
    let proc = |name: &str, fps: &str| {
        let head = format!("procedural 1\nfps {fps}\nframes 8\njoint hip offset 0 0 0 channels Xrotation\n");
        let arm =
            "joint arm parent hip offset 0 10 0 channels Xrotation\njoint hand parent arm offset 0 10 0\nhip.Xrotation = 9 * t\n";
        folder.put(&format!("{name}.proc"), head + arm);
        folder.done(&["convert", &format!("{name}.proc"), "-o", &format!("{name}.ptn")]);
    };
    proc("fast", "120");
    let said = err(&folder.done(&["render", "fast.ptn", "-o", "fast.gif"]));
    assert!(said.contains("120.000 frames a second are more than viewers show"), "{said}");
    let said = err(&folder.done(&["render", "fast.ptn", "-o", "slow.gif", "--fps", "0.01"]));
    assert!(said.contains("0.1 are drawn"), "{said}");
    let said = err(&folder.done(&["render", "fast.ptn", "-o", "asked.gif", "--fps", "100"]));
    assert!(said.contains("50 are drawn"), "{said}");
    assert!(err(&folder.done(&["render", "fast.ptn", "-o", "asked.gif", "--fps", "100", "-q"])).is_empty());
}

#[test]
fn a_boards_name_for_a_clip_is_not_cut() {
    let folder = prepared();
    let image = |name: &str| {
        let arguments = ["flash-image", "a.ptn", "--board", "pico", "-o", "a.bin", "--name", name];
        folder.run(&arguments)
    };
    let longest = "abcdefghijklmnopqrstuvwxyz12";
    assert!(image(longest).status.success() && folder.get("a.bin")[16..44] == *longest.as_bytes());
    for (wrong, why) in [
        ("abcdefghijklmnopqrstuvwxyz123", "29 bytes"),
        ("ääääääääääääääü", "30 bytes"),
        ("a\u{1b}[31m", "control"),
        ("a\u{202e}b", "control"),
        ("a\nb", "control"),
        ("", "1 to 28"),
    ] {
        let output = image(wrong);
        assert!(output.status.code() == Some(2) && err(&output).contains(why), "{wrong:?}: {}", err(&output));
        let output = folder.run(&["update", "a.ptn", "--to", "tcp:127.0.0.1:1", "--name", wrong]);
        assert!(output.status.code() == Some(2) && err(&output).contains(why), "{wrong:?}: {}", err(&output));
    }
    // A file's own name is cut with a note.
    let file = format!("{longest}345.ptn");
    folder.put(&file, folder.get("a.ptn"));
    let said = err(&folder.done(&["flash-image", &file, "--board", "pico", "-o", "b.bin"]));
    assert!(said.contains(&format!("shows it as `{longest}`")), "{said}");
}

#[test]
fn numbers_out_of_range_are_refused_with_the_range() {
    let folder = prepared();
    for wrong in ["1e9", "1e-9", "nan"] {
        let said = folder.refused(&["convert", "run.keys", "-o", "b.ptn", "--effort", "fast", &format!("--index={wrong}")]);
        assert!(said.contains("--index") && said.contains("expected seconds, from 0.0") && said.contains(" frames)"), "{said}");
    }
    let wrong: [(&[&str], &str); 10] = [
        (&["render", "a.ptn", "--tilt=nan"], "expected whole degrees from -90 to 90"),
        (&["render", "a.ptn", "--tilt", "-91"], "expected whole degrees from -90 to 90"),
        (&["stream", "a.ptn", "--to", "udp:127.0.0.1:99999"], "a port from 1 to 65535"),
        (&["stream", "a.ptn", "--to", "tcp:127.0.0.1:0"], "a port from 1 to 65535"),
        (&["update", "a.ptn", "--to", "tcp:127.0.0.1:99999"], "a port from 1 to 65535"),
        (&["stream", "a.ptn", "--to", "udp:127.0.0.1:9", "--ahead", "1e9"], "more than 0 and at most 60"),
        (&["stream", "a.ptn", "--to", "udp:127.0.0.1:9", "--ahead", "61"], "more than 0 and at most 60"),
        (&["stream", "a.ptn", "--to", "udp:127.0.0.1:9", "--cycle", "1e9"], "more than 0 and at most 60"),
        (&["stream", "a.ptn", "--to", "udp:127.0.0.1:9", "--cycle", "0"], "more than 0 and at most 60"),
        (&["update", "a.ptn", "--to", "udp:127.0.0.1:9"], "expected serial:PORT"),
    ];
    for (arguments, why) in wrong {
        let output = folder.run(arguments);
        assert!(output.status.code() == Some(2) && err(&output).contains(why), "{arguments:?}: {}", err(&output));
    }
}

#[test]
fn a_pose_with_a_unit_twice_is_refused() {
    let folder = Folder::new();
    for pose in ["joy=1,joy=2", "joy + joy=0.5"] {
        let said = folder.refused(&["face", "export", "-o", "joy.obj", "--pose", pose]);
        assert!(said.contains("joy comes twice") && !folder.path("joy.obj").exists(), "{said}");
    }
    folder.done(&["face", "export", "-o", "joy.obj", "--pose", "joy=1,wink_left"]);
}

#[test]
fn an_argument_stays_on_its_line() {
    let folder = Folder::new();
    let wrong: [&[&str]; 4] = [
        &["a\nerror: fake"],
        &["info", "a.ptn", "--no\nerror: fake"],
        &["render", "a.ptn", "--size=big\nerror: fake"],
        &["render", "a.ptn", "--view", "side,up\nerror: fake"],
    ];
    for arguments in wrong {
        let output = folder.run(arguments);
        let said = err(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains("\\nerror: fake") && !said.contains("\nerror: fake"), "{arguments:?}: {said}");
    }
}

#[test]
fn a_very_long_name_is_cut() {
    let folder = Folder::new();
    folder.put("long.csv", format!("time,{}\n0,0\n0.1,1\n0.2,0.5\n", "n".repeat(100_000)));
    let output = folder.run(&["convert", "long.csv", "-o", "long.ptn"]);
    assert!(err(&output).contains('…') && err(&output).len() < 10_000, "{} bytes", err(&output).len());
}

#[test]
fn a_mistyped_key_is_not_printed() {
    let folder = prepared();
    let key = "0123456789abcdef0123456789abcde";
    let said = folder.refused(&["stream", "a.ptn", "--to", "tcp:127.0.0.1:1", "--key", key]);
    assert!(said.contains("neither 32 hexadecimal digits nor a file") && !said.contains("456789"), "{said}");
}

#[test]
fn a_line_without_room_for_refreshes_is_named() {
    let folder = prepared();
    for wrong in ["0", "-1", "101", "nan"] {
        let said = folder.refused(&["stream", "a.ptn", "--to", "tcp:127.0.0.1:1", &format!("--refresh={wrong}")]);
        assert!(said.contains("more than 0, and at most 100"), "{wrong}: {said}");
    }
    let said = folder.refused(&["stream", "a.ptn", "--to", "tcp:127.0.0.1:1@1000000", "--refresh", "0.0001"]);
    assert!(said.contains("a larger --refresh"), "{said}");
}

/// What was given is used, refused, or named: beside bounds of channels, of several animations of one name, of a companion file, of a scale.
#[test]
fn nothing_that_was_given_is_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let run = |line: &str| {
        let out = std::process::Command::new(env!("CARGO_BIN_EXE_pantin"))
            .args(line.split(' '))
            .current_dir(folder.path())
            .output()
            .unwrap();
        (out.status.code(), String::from_utf8_lossy(&out.stderr).into_owned() + &String::from_utf8_lossy(&out.stdout))
    };
    put("nat.keys", "keyframes 1\nfps 30\nframes 31\nscalar smile scale 1\nkeys natural smile\n 0 0\n 10 1\n 20 1\n 30 0\n");
    for option in ["--max-scalar-error 0.1", "--max-rotation-error 0.01"] {
        let (code, said) = run(&format!("convert nat.keys -o n.ptn --max-channel-error 5 {option}"));
        assert!(code == Some(2) && said.contains("cannot be used with"), "{said}");
    }
    for rotations in ["exponential", "quaternion"] {
        let (code, said) = run(&format!("convert nat.keys -o q{rotations}.ptn --max-channel-error 5 --rotations {rotations}"));
        assert!(code == Some(0) && said.contains("channels with bounds of their own are coded as they are"), "{said}");
    }
    let (code, said) = run("convert nat.keys -o n.ptn --exact --effort best");
    assert!(code == Some(0) && said.contains("--effort has no effect"), "{said}");
    // The curve passes its scale between keys, at any rate.
    for fps in ["30", "60"] {
        let (code, said) = run(&format!("convert nat.keys -o n{fps}.ptn --exact --fps {fps}"));
        assert_eq!(code, Some(0), "{said}");
        let (_, table) = run(&format!("expand n{fps}.ptn --format csv -o -"));
        let most = table.lines().flat_map(|line| line.rsplit(',').next()?.parse::<f64>().ok()).fold(0.0, f64::max);
        assert!((most - 1.15).abs() < 1e-3, "{most} at {fps} frames a second");
    }
    // At 1e7 cm a hundredth of one is less than a step.
    put(
        "far.keys",
        "keyframes 1\nfps 30\nframes 31\ncm-per-unit 1\njoint root offset 0 0 0 channels Xposition\nend parent root offset 0 1 0\nkeys linear root\n 0 10000000\n 30 10000000.01\n",
    );
    let (code, said) = run("convert far.keys -o far.ptn --max-channel-error 0.5 --json");
    assert!(code == Some(0) && said.contains("root.Xposition and channels like it keep this bound"), "{said}");
    // A Live Link header with one blend shape under two names.
    let row = |time: &str| format!("{time},2,0.1,0.2\n");
    put(
        "twice.csv",
        &format!("Timecode,BlendshapeCount,EyeBlinkLeft,eyeBlink_L\n{}{}", row("00:00:00:00.000"), row("00:00:00:01.000")),
    );
    let (code, said) = run("convert twice.csv -o twice.ptn");
    assert!(code == Some(1) && said.contains("`EyeBlinkLeft` and `eyeBlink_L` are one blend shape"), "{said}");
}

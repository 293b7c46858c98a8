//! `convert - --stream`: clips of a motion while it is captured, each frame once, within the bound, after the stated delay.

use super::outputs::{Folder, err};
use crate::real::files;
use pantin::Clip;
use pantin_convert::import::ImportOptions;
use pantin_convert::motion::Motion;
use pantin_convert::verify::compare;
use pantin_convert::{Length, Level, Options, RecordedClip, Recording, expand};

const HEAD: &str = "HIERARCHY
ROOT hip
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -45 0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 -45 0
    }
  }
}
MOTION
Frames: 0
Frame Time: 0.02
";

/// A row of a figure that sways and walks `way` units a frame.
fn row(frame: usize, way: f64) -> String {
    let t = frame as f64 / 50.0;
    let (sway, knee) = (20.0 * (2.1 * t).sin(), 30.0 + 25.0 * (5.3 * t).cos());
    format!("{:.4} {:.4} 0 {sway:.4} 0 {:.4} {knee:.4}", way * frame as f64, 90.0 + 2.0 * (4.0 * t).sin(), 3.0 * t)
}

fn rows(frames: usize) -> String {
    (0..frames).map(|frame| row(frame, 1.2) + "\n").collect()
}

fn options() -> Options {
    Options::new().max_error(Length::cm(0.5)).effort(Level::FAST)
}

fn recording(delay: f64) -> Recording {
    Recording::new("-".as_ref(), &ImportOptions::new().cm_per_unit(1.0), &options(), delay).unwrap()
}

/// The clips that come of these bytes, pushed in pieces of `size`, and the error that ended them.
fn clips(mut recording: Recording, bytes: &[u8], size: usize) -> (Recording, Vec<RecordedClip>, Option<String>) {
    let (mut clips, mut error) = (Vec::new(), None);
    for piece in bytes.chunks(size) {
        error = recording.push(piece).err();
        while let Some(clip) = recording.next_clip().unwrap() {
            clips.push(clip);
        }
        if error.is_some() {
            break;
        }
    }
    if error.is_none() {
        error = recording.end().err();
    }
    while let Some(clip) = recording.next_clip().unwrap() {
        clips.push(clip);
    }
    clips.extend(recording.rest().unwrap());
    (recording, clips, error.map(|error| error.to_string()))
}

/// The frames of all clips, one after the other, played by the device's decoder.
fn played(recording: &Recording, clips: &[RecordedClip]) -> Motion {
    let mut all: Option<Motion> = None;
    for clip in clips {
        let opened = Clip::with_rig(&clip.clip, recording.rig()).unwrap();
        assert_eq!(opened.frames() as usize, clip.frames);
        let part = expand::expand(&opened).unwrap();
        match &mut all {
            None => all = Some(part),
            Some(all) => {
                assert_eq!(all.frames as u64, clip.first_frame, "the clips have no gap");
                all.frames += part.frames;
                all.values.iter_mut().zip(part.values).for_each(|(values, more)| values.extend(more));
            }
        }
    }
    all.unwrap()
}

#[test]
fn the_clips_are_the_same_however_the_stream_is_cut() {
    let text = format!("{HEAD}{}", rows(130));
    let expected = clips(recording(1.0), text.as_bytes(), 1 << 20).1;
    assert_eq!(expected.iter().map(|clip| (clip.first_frame, clip.frames)).collect::<Vec<_>>(), [(0, 50), (50, 50), (100, 30)]);
    let returns = text.replace('\n', "\r\n");
    let old = text.replace('\n', "\r");
    let no_end = text.trim_end();
    let one_line = HEAD.trim_end().replace('\n', " ") + " " + &rows(130);
    for text in [&text, &returns, &old, no_end, &one_line] {
        for size in [1, 2, 7, 64, 1000] {
            let (_, found, error) = clips(recording(1.0), text.as_bytes(), size);
            assert_eq!(error, None);
            assert!(found.iter().map(|clip| &clip.clip).eq(expected.iter().map(|clip| &clip.clip)), "pieces of {size} bytes");
        }
    }
}

#[test]
fn frames_wait_for_the_stated_number_of_others() {
    for (delay, frames) in [(0.02, 1), (0.05, 2), (0.3, 15), (1.0, 50)] {
        let mut recording = recording(delay);
        recording.push(HEAD.as_bytes()).unwrap();
        assert_eq!(recording.clip_frames(), Some(frames));
        let mut handed_out = 0;
        for frame in 0..120 {
            recording.push(format!("{}\n", row(frame, 1.0)).as_bytes()).unwrap();
            while let Some(clip) = recording.next_clip().unwrap() {
                assert_eq!(clip.first_frame, handed_out);
                handed_out += clip.frames as u64;
            }
            // The oldest frame that is in no clip has seen fewer than `frames` others.
            assert!(frame as u64 + 1 - handed_out < frames as u64, "frame {frame}, delay {delay}");
        }
    }
}

/// Captured clips are in the bound at every frame, and take few bytes more than in one piece.
#[test]
fn captured_motion_keeps_its_bound() {
    let wanted = ["bvh_cmu131_start-walk-stop.bvh", "bvh_mixamo-beta_gangnam-dance.bvh", "bvh_bandai1_kick.bvh"];
    for path in files(&["bvh"]).iter().filter(|path| wanted.iter().any(|name| path.ends_with(name))) {
        let text = std::fs::read(path).unwrap();
        let import = ImportOptions::new();
        let options = Options::new().max_error(Length::cm(1.0)).max_rotation_error(25.0).effort(Level::FAST);
        let recording = Recording::new(path, &import, &options, 2.0).unwrap();
        let (recording, clips, error) = clips(recording, &text, 4096);
        assert_eq!(error, None, "{}", path.display());
        assert!(clips.len() > 2, "{}: {} clips", path.display(), clips.len());
        let source = crate::told::load(path, &import).unwrap().motion;
        let back = played(&recording, &clips);
        assert_eq!(back.rig.cm_per_unit, source.rig.cm_per_unit);
        let report = compare(&source, &back, pantin_convert::verify::shell_radius_cm(&source)).unwrap();
        let bytes = clips.iter().map(|clip| clip.clip.len()).sum::<usize>();
        println!("{}: {bytes} bytes, shell {:.4} cm", path.display(), report.shell_cm.error);
        assert!(report.shell_cm.error <= 1.0 && report.rotation_deg.error <= 25.0, "{}: {report:?}", path.display());
        let whole = pantin_convert::convert(&source, &options.clone().rig_apart(true), &mut |_| ()).unwrap().clip.len();
        assert!(bytes * 10 <= whole * 13, "{}: {bytes} bytes, {whole} in one clip", path.display());
    }
}

/// A figure that leaves the range of positions and turns about itself: the form changes, the bound stays.
#[test]
fn what_the_form_cannot_hold_changes_it() {
    let far: String = (0..200).map(|frame| row(frame, 120.0) + "\n").collect();
    let (recording, made, error) = clips(recording(1.0), format!("{HEAD}{far}").as_bytes(), 100);
    assert_eq!(error, None);
    let notes: Vec<&str> = made.iter().flat_map(|clip| &clip.notes).map(|note| note.text.as_str()).collect();
    assert!(notes.iter().any(|note| note.contains("coarser steps")), "{notes:?}");
    let source = format!("{HEAD}{far}").replace("Frames: 0", "Frames: 200");
    let files = pantin_convert::import::InMemory::new().with("far.bvh", source.as_bytes());
    let import = ImportOptions::new().cm_per_unit(1.0);
    let source = pantin_convert::import::import(&files, "far.bvh".as_ref(), &import).unwrap().motion;
    let report = compare(&source, &played(&recording, &made), 3.0).unwrap();
    assert!(report.shell_cm.error <= 0.5, "{report:?}");
}

/// Damage is named with its line; every frame before it is in a clip.
#[test]
fn damage_is_named_and_what_came_before_it_is_kept() {
    let good = rows(60);
    let after = |text: &str| format!("{HEAD}{good}{text}");
    let line = HEAD.lines().count() + 60 + 1;
    for (text, wanted, frames) in [
        (after("1 2 3\n"), format!("-:{line}: expected 7 numbers, one a channel, found 3"), 60),
        (after("1 2 3 4 5 6 7 8\n1"), format!("-:{line}: expected 7 numbers, one a channel, found 8"), 60),
        (after("1 2 3 4 5 6 x\n"), format!("-:{line}: expected a number, found `x`"), 60),
        (after("1 2 3 4 5 6 nan\n"), format!("-:{line}: expected a finite number"), 60),
        (after("1 2 3 4 5 6"), format!("-:{line}: expected 7 numbers, one a channel, found 6"), 60),
        (after(&"1".repeat(70_000)), format!("-:{line}: a line of more than 65536 bytes"), 60),
        (after("").replace("Frames: 0", "Frames: 61"), "-:17: `Frames: 61`, but the stream ends after 60 frames".into(), 60),
        (HEAD.into(), "-:17: the stream ends before its first frame".into(), 0),
        (HEAD.replace("0.02", "0"), "-:18: expected a frame time above 0, found 0".into(), 0),
        (HEAD.replace("0.02", "soon"), "-:18: expected a number, found `soon`".into(), 0),
        (HEAD.replace("OFFSET 0 -45 0\n    CHANNELS", "CHANNELS"), "-:13: no OFFSET".into(), 0),
        (
            HEAD[..HEAD.find("MOTION").unwrap()].into(),
            "expected `MOTION` after the hierarchy, found the end of the file".into(),
            0,
        ),
        (String::new(), "-:1: expected `HIERARCHY`".into(), 0),
        ("time,a\n0,1\n".into(), "-:1: expected `HIERARCHY`".into(), 0),
        (" ".repeat(1 << 21), "a header of more than 1048576 bytes".into(), 0),
    ] {
        let (_, clips, error) = clips(recording(0.5), text.as_bytes(), 50);
        let error = error.unwrap_or_default();
        assert!(error.contains(&wanted), "wanted {wanted}, got {error}");
        assert_eq!(clips.iter().map(|clip| clip.frames).sum::<usize>(), frames, "{error}");
    }
}

#[test]
fn a_number_of_frames_that_is_not_known_is_none() {
    let expected = clips(recording(1.0), format!("{HEAD}{}", rows(60)).as_bytes(), 512).1;
    for stated in ["Frames:", "Frames: unknown", "Frames: -1", "Frames: 60", "Frames: 3", "frames 0"] {
        let text = HEAD.replace("Frames: 0", stated) + &rows(60);
        let (_, found, error) = clips(recording(1.0), text.as_bytes(), 512);
        assert_eq!(error, None, "{stated}");
        assert!(found.iter().map(|clip| &clip.clip).eq(expected.iter().map(|clip| &clip.clip)), "{stated}");
    }
}

#[test]
fn the_command_writes_clips_that_pack_into_a_bank() {
    let folder = Folder::new();
    folder.put("live.bvh", format!("{HEAD}{}", rows(130)));
    let mut command =
        folder.command(&["convert", "-", "--stream", "-o", "take", "--delay", "1s", "--cm-per-unit", "1", "--json"]);
    let output = command.stdin(std::fs::File::open(folder.path("live.bvh")).unwrap()).output().unwrap();
    assert!(output.status.success(), "{}", err(&output));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["frames"], &report["clips_in_recording"], &report["delay_frames"]), (&130.into(), &3.into(), &49.into()));
    let clips = ["take/00000000.ptn", "take/00000050.ptn", "take/00000100.ptn"];
    folder.done(&[&["pack", "--rig", "take/figure.rig", "-o", "take.ptb"], &clips[..]].concat());
    assert_eq!(std::fs::read_dir(folder.path("take")).unwrap().count(), 4);
    let said = folder.refused(&["convert", "-", "--stream", "-o", "take"]);
    assert!(said.contains("take: is not empty"), "{said}");
    for (arguments, wanted) in [
        (&["-o", "-"][..], "name a folder"),
        (&["-o", "live.bvh"], "need a folder"),
        (&["-o", "new", "--mirror"], "none of the changes"),
        (&["-o", "new", "--loop"], "none of the changes"),
    ] {
        let said = folder.refused(&[&["convert", "live.bvh", "--stream"], arguments].concat());
        assert!(said.contains(wanted), "{said}");
    }
    for option in [&["--delay", "0"][..], &["--keys"], &["--exact"], &["--fps", "30"], &["--dry-run"]] {
        let output = folder.run(&[&["convert", "live.bvh", "--stream", "-o", "new"], option].concat());
        assert_eq!(output.status.code(), Some(2), "{option:?}: {}", err(&output));
    }
    assert!(!folder.path("new").exists());
}

#[test]
fn the_command_says_what_it_wrote_before_damage() {
    let folder = Folder::new();
    folder.put("live.bvh", format!("{HEAD}{}1 2\n{}", rows(60), rows(5)));
    let said = folder.refused(&["convert", "live.bvh", "--stream", "-o", "take", "--delay", "0.5", "--cm-per-unit", "1"]);
    assert!(said.contains("take: 3 clips and figure.rig; frames 0 to 59"), "{said}");
    assert!(said.contains("live.bvh:79: expected 7 numbers, one a channel, found 2"), "{said}");
    folder.put("empty.bvh", "");
    let said = folder.refused(&["convert", "empty.bvh", "--stream", "-o", "none"]);
    assert!(said.contains("none: nothing was written") && said.contains("empty.bvh:1: expected `HIERARCHY`"), "{said}");
    assert!(!folder.path("none").exists());
    let said = folder.refused(&["convert", "live.bvh", "--stream", "-o", "tight", "--max-error", "1e-9cm"]);
    assert!(said.contains("frames 0 to") && said.contains("nothing was written"), "{said}");
    assert!(!folder.path("tight").exists(), "{said}");
}

/// An interrupt ends the recording; all whole frames that came are in clips.
#[cfg(unix)]
#[test]
fn an_interrupt_keeps_the_frames_that_came() {
    use std::io::Write;
    use std::process::Stdio;
    let folder = Folder::new();
    let mut command = folder.command(&["convert", "-", "--stream", "-o", "take", "--delay", "0.5", "--cm-per-unit", "1"]);
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    // The third clip has not all of its frames; its last row has no end.
    stdin.write_all(format!("{HEAD}{}1 2 3", rows(60)).as_bytes()).unwrap();
    let begun = std::time::Instant::now();
    while !folder.path("take/00000025.ptn").exists() {
        assert!(begun.elapsed().as_secs() < 60 && child.try_wait().unwrap().is_none(), "no second clip");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    drop(stdin);
    assert!(output.status.success(), "{}", err(&output));
    let clip = folder.get("take/00000050.ptn");
    let rig = folder.get("take/figure.rig");
    assert_eq!(Clip::with_rig(&clip, &rig).unwrap().frames(), 10, "{}", err(&output));
}

/// Fifteen times the frames take no more memory.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_length() {
    let folder = Folder::new();
    let peak = |frames: usize| {
        folder.put("long.bvh", format!("{HEAD}{}", rows(frames)));
        let take = format!("take{frames}");
        super::exhaustion::peak(&folder, &["convert", "long.bvh", "--stream", "-o", &take, "--effort", "1", "--delay", "2"])
            .unwrap()
    };
    let [few, many] = [2_000, 30_000].map(peak);
    println!("{few} and {many} bytes at most");
    assert!(many < few + (4 << 20), "{few} bytes became {many}");
}

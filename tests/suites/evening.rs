//! An hour with a board on the host: the program of boards that one can buy, whose buttons a person presses, and which is alone otherwise.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::LazyLock;

use board_drivers::Mono128x64;
use harness::alone::{Clips, Press, SELECT, Session, Shown};
use harness::clips::{self, Drawn};
use pantin::Clip;
use pantin_app::Entry;
use tempfile::TempDir;

/// All our motions: bodies, a body with its face, faces and emotes.
static CLIPS: LazyLock<(TempDir, Clips)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let own: Vec<PathBuf> = clips::own(folder.path(), Drawn::Lines).unwrap();
    let clips = Clips::read(&own).unwrap();
    (folder, clips)
});

const SECOND: u64 = 1_000;
const MINUTE: u64 = 60 * SECOND;

fn short(at_ms: u64) -> Press {
    Press { button: SELECT, at_ms, for_ms: 100 }
}

fn hold(at_ms: u64) -> Press {
    Press { button: SELECT, at_ms, for_ms: 900 }
}

/// A stretch of time in which the board shows the same.
#[derive(Debug)]
struct Stretch {
    from_ms: u64,
    /// Until the next one begins.
    to_ms: u64,
    lines: [String; 2],
    is_dark: bool,
}

/// Plays a session, and returns what it shows, without the pictures' motion.
fn play(session: &Session) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = vec![];
    session.play::<Mono128x64>(|Shown { ms, framebuffer, lines }| {
        let is_dark = framebuffer.cells().iter().all(|cell| *cell == 0);
        if let Some(last) = stretches.last_mut() {
            last.to_ms = ms;
        }
        if stretches.last().is_none_or(|last| last.is_dark != is_dark || last.lines != *lines) {
            stretches.push(Stretch { from_ms: ms, to_ms: ms, lines: lines.clone(), is_dark });
        }
    });
    stretches
}

/// Milliseconds that a clip stays: rounds until ten seconds are over.
fn stay_ms(entry: &Entry) -> u64 {
    let clip = Clip::with_rig(entry.bytes, entry.rig).unwrap();
    let round_ns = u64::from(clip.frame_time_ns()) * u64::from(clip.frames());
    (10_000_000_000_u64.div_ceil(round_ns) * round_ns) / 1_000_000
}

/// The caption of a clip.
fn caption(entry: &Entry) -> [String; 2] {
    [entry.name.to_owned(), format!("{} bytes", entry.bytes.len())]
}

#[test]
fn in_an_hour_every_clip_is_shown_with_its_name_and_size() {
    let entries = CLIPS.1.entries();
    // The menu, its sixth item, "sleep", and the choice: never.
    let presses: Vec<Press> =
        [hold(2_000)].into_iter().chain((0..5).map(|item| short(3_500 + 500 * item))).chain([hold(6_500)]).collect();
    let session = Session { entries: &entries, presses: &presses, seconds: 3600, has_overlay: true, slow_ms: 0..0 };
    let stretches = play(&session);
    assert!(stretches.iter().all(|stretch| !stretch.is_dark), "it was to stay lit");
    let menu: Vec<&str> = stretches.iter().map(|stretch| &*stretch.lines[0]).filter(|line| line.starts_with('>')).collect();
    let words = ["> clip", "> pause", "> style: lines", "> speed: x1", "> view", "> sleep: 10 min", "> sleep: never"];
    assert_eq!(menu, words);
    // The first clip has no caption; the second one comes a minute after the last press.
    let captions: Vec<&Stretch> = stretches.iter().filter(|stretch| stretch.lines[1].ends_with(" bytes")).collect();
    assert!(captions[0].from_ms.abs_diff(7_300 + MINUTE) < 12 * SECOND, "{:?}", captions[0]);
    for (index, pair) in captions.windows(2).enumerate() {
        let entry = &entries[(index + 1) % entries.len()];
        assert_eq!(pair[0].lines, caption(entry));
        let shown = pair[0].to_ms - pair[0].from_ms;
        assert!(shown.abs_diff(2 * SECOND) <= 40, "{}: name and size for {shown} ms", entry.name);
        let stayed = pair[1].from_ms - pair[0].from_ms;
        assert!(stayed.abs_diff(stay_ms(entry)) <= 40, "{}: {stayed} ms, not {}", entry.name, stay_ms(entry));
    }
    let names: BTreeSet<&str> = captions.iter().map(|stretch| &*stretch.lines[0]).collect();
    let expected: BTreeSet<&str> = entries.iter().map(|entry| entry.name).collect();
    assert_eq!(names, expected);
    println!("an hour: {} clips followed one another, of {}", captions.len(), entries.len());
}

#[test]
fn after_ten_minutes_alone_it_is_dark_until_a_press_which_does_nothing_else() {
    let entries = CLIPS.1.entries();
    let visits = [12 * MINUTE, 30 * MINUTE];
    // The first press lights the display, the second one is for the next clip; the menu is left open.
    let presses: Vec<Press> =
        visits.into_iter().flat_map(|at| [short(at), short(at + 5 * SECOND), hold(at + 10 * SECOND)]).collect();
    let session = Session { entries: &entries, presses: &presses, seconds: 3600, has_overlay: true, slow_ms: 0..0 };
    let stretches = play(&session);
    let dark: Vec<[u64; 2]> =
        stretches.iter().filter(|stretch| stretch.is_dark).map(|stretch| [stretch.from_ms, stretch.to_ms]).collect();
    let last_ms = |visit: u64| visit + 10 * SECOND + 700;
    let expected = [
        [10 * MINUTE, visits[0] + 100],
        [last_ms(visits[0]) + 10 * MINUTE, visits[1] + 100],
        [last_ms(visits[1]) + 10 * MINUTE, 60 * MINUTE],
    ];
    assert_eq!(dark.len(), expected.len(), "{dark:?}");
    for (found, expected) in dark.as_flattened().iter().zip(expected.as_flattened()) {
        assert!(found.abs_diff(*expected) <= 60, "{dark:?}, not {expected:?}");
    }
    for visit in visits {
        let during = |from: u64, to: u64| stretches.iter().filter(move |stretch| (from..to).contains(&stretch.from_ms));
        // A caption of a clip that began in the dark may be left.
        let first = during(visit + 200, visit + 5 * SECOND).filter(|stretch| stretch.lines[1].ends_with(" bytes")).count();
        assert_eq!(first, 0, "the press that lights the display chooses nothing");
        let second = during(visit + 5 * SECOND, visit + 6 * SECOND).filter(|stretch| stretch.lines[1].ends_with(" bytes"));
        assert_eq!(second.count(), 1, "the next press is for the next clip");
        let menu = during(visit + 10 * SECOND, visit + 12 * SECOND).find(|stretch| stretch.lines[0] == "> clip").unwrap();
        let closed = menu.to_ms - menu.from_ms;
        assert!(closed.abs_diff(MINUTE) <= 60, "a menu that is left open closes after {closed} ms");
    }
}

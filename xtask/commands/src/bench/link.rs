//! A captured body with a captured face over a line that loses packets: after how long all of it is exact again, and drawn so, and what of
//! the line that takes.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use harness::lossy::{Damage, Lossy, last_frame, play};
use harness::paths;
use pantin::Clip;
use pantin_line::sender::{ByteCounts, LineSettings, Sender, Source};
use pantin_link::{Link, QUEUE_PACKETS};

use super::link_board::{Board, Seen};
use super::{Goal, Setting, table};
use xtask::steps::say;

/// The clip: a body, and a face that plays with it.
const BODY: &str = "bvh_cmu01_hops-and-turn.bvh";
const FACE: &str = "face_neurosync_angry_arkit.csv";
const OPTIONS: [&str; 8] = ["--fps", "30", "--retarget", "display", "--max-error", "2cm", "--max-scalar-error", "2"];

/// Baud, look-ahead in frames, and within how many milliseconds of the last error all is exact.
const LINES: [(u32, u32, f64); 2] = [(9_600, 45, 1000.0), (38_400, 12, 250.0)];
/// Milliseconds in which what is drawn has joined the state.
const JOINED: f64 = 500.0;
/// Percent of the line for zeros, stuffing, kind, sequence and CRC.
const FRAMING: f64 = 12.0;

/// What lines do, and whether packets have parity against it.
const DAMAGES: [(Damage, bool); 8] = [
    (Damage { loss: 0.01, flips: 0.0 }, false),
    (Damage { loss: 0.05, flips: 0.0 }, false),
    (Damage { loss: 0.1, flips: 0.0 }, false),
    (Damage { loss: 0.3, flips: 0.0 }, false),
    (Damage { loss: 0.0, flips: 1e-5 }, false),
    (Damage { loss: 0.0, flips: 1e-4 }, false),
    (Damage { loss: 0.0, flips: 1e-4 }, true),
    (Damage { loss: 0.0, flips: 1e-3 }, true),
];

/// Seconds of a line that damages, and after it of one that does not, in turn.
const DAMAGING: f64 = 1.0;
const WHOLE: f64 = 2.0;
/// Times that the clip is sent for one kind of damage.
const PASSES: u64 = 12;
/// The same to the emulated board.
const BOARD_PASSES: u64 = 3;

/// Times that a receiver joins a clip that is under way.
const JOINS: u32 = 24;

/// All that is measured of lines.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let Some(data) = paths::data() else { return Ok(vec![]) };
    let (body, face) = (data.join(BODY), data.join(FACE));
    if !body.is_file() || !face.is_file() {
        say(&format!("   {BODY} or {FACE}: not there"));
        return Ok(vec![]);
    }
    let clip = clip(setting, &body, &face)?;
    let bytes = std::fs::read(&clip).with_context(|| clip.display().to_string())?;
    let source = Source::new(&Clip::new_checked(&bytes)?)?;
    let board = Board::new(&clip)?;
    say(&format!("   hops-and-turn with the face angry: {} frames, {} channels told", source.frames(), source.moving_channels()));
    let (mut goals, mut rows) = (vec![], vec![]);
    for (baud, ahead, exact) in LINES {
        let fitted = |parity: bool| {
            let wanted = LineSettings { rate: f64::from(baud) / 10.0, ahead, share: 1.0, cycle: 1, parity, key: None };
            wanted.fitted(&source).with_context(|| format!("{baud} baud do not carry the clip"))
        };
        let lines = [fitted(false)?, fitted(true)?];
        let mut runs = vec![];
        for (damage, parity) in DAMAGES {
            let line = lines[usize::from(parity)];
            let mut run = Run::of(&source, line, damage, setting.quick);
            for pass in 0..if setting.quick { 1 } else { BOARD_PASSES } {
                run.seen.add(board.plays(&source, line, damage, pass, |at| harms(at, pass))?);
            }
            runs.push(run);
        }
        rows.extend(runs.iter().map(|run| row(baud, run)));
        goals.extend(judged(baud, exact, &source, lines, &runs));
    }
    print(&rows);
    Ok(goals)
}

fn clip(setting: &Setting, body: &Path, face: &Path) -> Result<PathBuf> {
    let mut options: Vec<String> = OPTIONS.map(Into::into).into();
    options.extend(["--with".into(), face.display().to_string()]);
    Ok(setting.tool.converted(body, "link-hops-angry", &options)?.clip)
}

/// Whether the line damages what leaves at that time, in the `pass`th time that the clip is sent.
fn harms(at: f64, pass: u64) -> bool {
    at > 1.0 && (at + pass as f64 * 0.37) % (DAMAGING + WHOLE) < DAMAGING
}

/// What a kind of damage did.
#[derive(Default)]
struct Run {
    damage: Damage,
    parity: bool,
    /// Milliseconds from the last frame that was damaged until all channels were exact, and from then until all was drawn so.
    exact: Vec<f64>,
    joined: Vec<f64>,
    /// Frames on which a channel was wrongly reported as exact, and clock resets of the receiver.
    wrong: u32,
    resets: u32,
    /// Parts of the channels that are exact, and of frames on which the figure moves, while the line damages all the time.
    held: f64,
    moves: f64,
    /// On the emulated board.
    seen: Seen,
}

impl Run {
    fn of(source: &Source, line: LineSettings, damage: Damage, quick: bool) -> Run {
        let mut run = Run { damage, parity: line.parity, ..Run::default() };
        let played = source.expected_states(line.cycle);
        for pass in 0..if quick { 2 } else { PASSES } {
            run.recover(source, line, &played, pass);
        }
        run.endure(source, line, &played);
        run
    }

    /// Damage for a while, then none: how long until all is exact.
    fn recover(&mut self, source: &Source, line: LineSettings, played: &[(u16, Vec<[i32; 4]>)], seed: u64) {
        let milliseconds = 1000.0 * source.frame_seconds();
        let mut lossy = Lossy::new(seed);
        let (mut last, mut exact_at) = (None::<u16>, None::<u16>);
        let harmed = std::cell::Cell::new(None::<u16>);
        let damaged = |timed: &pantin_line::sender::TimedPacket| {
            // Both ends know what the channels are, so STARTS packets are rare.
            match last_frame(&timed.bytes, line).filter(|_| harms(timed.at, seed)) {
                None => timed.bytes.clone(),
                Some(frame) => {
                    let (bytes, hurt) = lossy.pass(&timed.bytes, self.damage);
                    if hurt {
                        harmed.set(Some(frame));
                    }
                    bytes
                }
            }
        };
        let (mut exact, mut joined, mut wrong) = (vec![], vec![], 0);
        play(Sender::new(1).clip(source, line, Some(1)), source, line, damaged, |link| {
            wrong += u32::from(!agrees(link, played));
            let Some(now) = link.now().map(|now| now as u16) else { return };
            if let Some(frame) = harmed.take() {
                (last, exact_at) = (Some(frame), None);
            }
            let Some(frame) = last.filter(|&frame| now.wrapping_sub(frame) < 1 << 15) else { return };
            if exact_at.is_none() && link.is_synced() {
                exact.push(f64::from(now.wrapping_sub(frame)) * milliseconds);
                exact_at = Some(now);
            }
            if let Some(at) = exact_at.filter(|_| drawn(link)) {
                joined.push(f64::from(now.wrapping_sub(at)) * milliseconds);
                (last, exact_at) = (None, None);
            }
        });
        self.wrong += wrong;
        self.exact.extend(exact);
        self.joined.extend(joined);
    }

    /// Damage all the time.
    fn endure(&mut self, source: &Source, line: LineSettings, played: &[(u16, Vec<[i32; 4]>)]) {
        let mut lossy = Lossy::new(99);
        let (mut frames, mut exact, mut moving, mut heads, mut wrong) = (0.0, 0.0, 0.0, 0, 0);
        let mut before = (None, vec![]);
        let damaged = |timed: &pantin_line::sender::TimedPacket| lossy.pass(&timed.bytes, self.damage).0;
        play(Sender::new(1).clip(source, line, Some(1)), source, line, damaged, |link| {
            wrong += u32::from(!agrees(link, played));
            heads += u32::from(before.0.is_some() && before.0 != link.head().copied());
            if link.frame().is_some_and(|frame| frame > 60) {
                frames += 1.0;
                exact += link.exact_channels() as f64 / source.channels() as f64;
                moving += f64::from(u8::from(before.1 != link.pose().values));
            }
            before = (link.head().copied(), link.pose().values.to_vec());
        });
        self.resets += heads;
        self.wrong += wrong;
        (self.held, self.moves) = (exact / f64::max(frames, 1.0), moving / f64::max(frames, 1.0));
    }
}

/// Whether every channel that says so is exact.
fn agrees(link: &Link<QUEUE_PACKETS>, played: &[(u16, Vec<[i32; 4]>)]) -> bool {
    let Some(frame) = link.frame() else { return true };
    let state = |channel: u16| link.channels().get(usize::from(channel)).and_then(|channel| channel.state());
    played.iter().all(|(channel, states)| state(*channel).is_none_or(|state| states.get(frame as usize) == Some(&state)))
}

/// Whether all is drawn as it is.
fn drawn(link: &Link<QUEUE_PACKETS>) -> bool {
    link.channels().iter().zip(link.pose().values).all(|(channel, &drawn)| channel.state().is_some_and(|state| state[0] == drawn))
}

fn median_and_worst(times: &[f64]) -> [f64; 2] {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    [times.get(times.len() / 2), times.last()].map(|time| time.copied().unwrap_or(0.0))
}

fn words(run: &Run) -> String {
    let parity = if run.parity { ", parity" } else { "" };
    match run.damage {
        Damage { loss, flips: 0.0 } => format!("{} % of packets lost{parity}", loss * 100.0),
        Damage { flips, .. } => format!("bit error rate {flips:.0e}{parity}"),
    }
}

fn row(baud: u32, run: &Run) -> Vec<String> {
    let [exact, joined] = [&run.exact, &run.joined].map(|times| median_and_worst(times));
    let mut row = vec![baud.to_string(), words(run), run.exact.len().to_string()];
    row.extend(exact.iter().chain(&joined).map(|time| format!("{time:.0}")));
    row.extend([run.held, run.moves].map(|part| format!("{:.1} %", 100.0 * part)));
    row.extend(median_and_worst(&run.seen.right).map(|time| format!("{time:.0}")));
    row.push(format!("{:.1} %", 100.0 * run.seen.moves()));
    row.extend([run.wrong, run.resets].map(|count| count.to_string()));
    row
}

fn print(rows: &[Vec<String>]) {
    let header = [
        "baud",
        "damage",
        "times",
        "exact, ms",
        "worst",
        "joined after, ms",
        "worst",
        "channels exact",
        "moves",
        "on the board right, ms",
        "worst",
        "moves",
        "wrong",
        "resets",
    ];
    table::print(&header, rows);
}

/// Milliseconds from the first byte that a receiver hears of a clip under way until all is exact, at worst.
fn late_join(source: &Source, line: LineSettings) -> f64 {
    let join = |number: u32| {
        let from = source.seconds() * f64::from(number) / f64::from(JOINS);
        let timed_packets = Sender::new(1).clip(source, line, Some(2)).filter(|timed| timed.at >= from);
        let (mut frames, mut taken) = (0.0, None);
        play(
            timed_packets,
            source,
            line,
            |timed| timed.bytes.clone(),
            |link| {
                frames += 1.0;
                if link.is_synced() && taken.is_none() {
                    taken = Some(frames);
                }
            },
        );
        taken.unwrap_or(f64::INFINITY)
    };
    (0..JOINS).map(join).fold(0.0, f64::max) * source.frame_seconds() * 1000.0
}

/// What a round of the clip takes.
fn carried(source: &Source, line: LineSettings) -> ByteCounts {
    let mut schedule = Sender::new(1).clip(source, line, Some(1));
    schedule.by_ref().for_each(drop);
    schedule.bytes()
}

fn judged(baud: u32, exact: f64, source: &Source, [line, mending]: [LineSettings; 2], runs: &[Run]) -> Vec<Goal> {
    let ByteCounts { line: all, framing, announced, refresh, motion, .. } = carried(source, line);
    let with = carried(source, mending);
    let rate = |bytes: f64| format!("{:.0} bytes/s ({:.1} %)", bytes / source.seconds(), 100.0 * bytes / all);
    let worst = |times: fn(&Run) -> &Vec<f64>| runs.iter().flat_map(times).copied().fold(0.0, f64::max);
    let count = |counts: fn(&Run) -> u32| f64::from(runs.iter().map(counts).sum::<u32>());
    let of = |what: &str| format!("{baud} baud: {what}");
    let cycle = f64::from(line.cycle) * source.frame_seconds() * 1000.0;
    vec![
        Goal::at_most(of("all channels exact after the last damage, worst"), worst(|run| &run.exact), exact, 0, "ms"),
        Goal::at_most(of("then until all are drawn exactly, worst"), worst(|run| &run.joined), JOINED, 0, "ms"),
        Goal::at_most(
            of("the emulated board's pictures correct after the last damage, worst"),
            worst(|run| &run.seen.right),
            exact + JOINED,
            0,
            "ms",
        ),
        Goal::at_most(of("framing and CRC, share of the line"), 100.0 * framing / all, FRAMING, 1, "%"),
        Goal::told(of("motion"), rate(motion)),
        Goal::told(of("refresh"), format!("{}, each channel within {cycle:.0} ms", rate(refresh))),
        Goal::told(of("heads and starts"), rate(announced)),
        Goal::told(of("all channels exact after a late join, worst"), format!("{:.0} ms", late_join(source, line))),
        Goal::told(of("look-ahead, at most"), format!("{:.0} ms", f64::from(line.ahead) * source.frame_seconds() * 1000.0)),
        Goal::told(
            of("parity at a bit error rate of 1e-3, share of the line"),
            format!("{:.1} %", 100.0 * with.parity / with.line),
        ),
        Goal::told(of("largest deviation from the clip, in channel steps"), format!("{:.3}", source.deviation(line.cycle).0)),
        Goal::at_most(of("frames wrongly reported as exact"), count(|run| run.wrong), 0.0, 0, ""),
        Goal::at_most(of("clock resets"), count(|run| run.resets), 0.0, 0, ""),
    ]
}

//! The same lines at the emulated reference board: how long after the last error its pictures are again those of a line that harms nothing.

use std::path::Path;

use anyhow::{Result, ensure};
use harness::build::Firmware;
use harness::lossy::{Damage, Lossy, arrivals, last_frame};
use harness::qemu::{LM3S6965EVB, Launch};
use harness::simulator;
use harness::sync::Session;
use pantin_line::sender::{BEGIN, LineSettings, Sender, Source};

/// What was seen in and after stretches of damage.
#[derive(Default)]
pub struct Seen {
    /// Milliseconds after which the pictures were right again, one for each stretch.
    pub right: Vec<f64>,
    /// Pictures in such stretches, and those of them that differ from the one before.
    pictures: usize,
    moved: usize,
}

impl Seen {
    /// Takes in what was seen another time.
    pub fn add(&mut self, other: Seen) {
        self.right.extend(other.right);
        self.pictures += other.pictures;
        self.moved += other.moved;
    }

    /// The part of the pictures in stretches of damage that differ from the one before.
    pub fn moves(&self) -> f64 {
        self.moved as f64 / self.pictures.max(1) as f64
    }
}

/// The board's program with the clip that gives its figure.
pub struct Board<'a> {
    clip: &'a Path,
    firmware: Firmware,
}

/// What arrives in each frame's time, and the frames of the clip of which harmed packets told last, by the frame's time in which they came.
type Arrivals = (Vec<Vec<u8>>, Vec<(usize, u32)>);

impl Board<'_> {
    /// Builds it.
    pub fn new(clip: &Path) -> Result<Board<'_>> {
        let firmware = Firmware::featuring("face,link", LM3S6965EVB.name, LM3S6965EVB.name, LM3S6965EVB.target, &[clip])?;
        Ok(Board { clip, firmware })
    }

    /// Plays a line that is damaged, as the seed has it, while `harms` says so of a timed's time.
    pub fn plays(
        &self,
        source: &Source,
        line: LineSettings,
        damage: Damage,
        seed: u64,
        harms: impl Fn(f64) -> bool,
    ) -> Result<Seen> {
        let words: &[&str] = if line.parity { &["fec"] } else { &[] };
        let (bytes, harmed) = damaged(source, line, damage, seed, harms);
        let whole = simulator::link(self.clip, words, &damaged(source, line, damage, seed, |_| false).0)?;
        let launch = words.iter().fold(Launch::new(LM3S6965EVB, self.firmware.elf()), |launch, word| launch.argument(*word));
        let mut session = Session::start(launch.argument("link"))?;
        let (mut wrong, mut moved, mut before) = (vec![], vec![], None);
        for (at, (bytes, (number, right))) in std::iter::once(&vec![]).chain(&bytes).zip(whole).enumerate() {
            let (shown, picture) = session.hear(bytes)?;
            ensure!(shown == number, "picture {at}: the board is at frame {shown}, not {number}");
            if picture != right {
                wrong.push((at, shown));
            }
            moved.push(before.as_ref() != Some(&picture));
            before = Some(picture);
        }
        let code = session.end()?.code;
        ensure!(code == 0, "the board ended with code {code}");
        Ok(seen(&harmed, &wrong, &moved, source.frame_seconds()))
    }
}

fn damaged(source: &Source, line: LineSettings, damage: Damage, seed: u64, harms: impl Fn(f64) -> bool) -> Arrivals {
    let (mut lossy, mut harmed) = (Lossy::new(seed), vec![]);
    let frames = arrivals(Sender::new(1).clip(source, line, Some(1)), source, line, |at, timed| {
        let Some(frame) = last_frame(&timed.bytes, line).filter(|_| harms(timed.at)) else { return timed.bytes };
        let (bytes, hurt) = lossy.pass(&timed.bytes, damage);
        if hurt {
            harmed.push((at, u32::from(frame) - BEGIN));
        }
        bytes
    });
    (frames, harmed)
}

/// A stretch of damage ends where nothing is harmed for a second.
fn seen(harmed: &[(usize, u32)], wrong: &[(usize, u32)], moved: &[bool], frame_seconds: f64) -> Seen {
    let quiet = (1.0 / frame_seconds) as usize;
    let mut seen = Seen::default();
    let stretches: Vec<_> = harmed.chunk_by(|a, b| b.0 - a.0 < quiet).collect();
    for (index, stretch) in stretches.iter().enumerate() {
        let (Some(&(from, _)), Some(&(to, told))) = (stretch.first(), stretch.last()) else { continue };
        let next = stretches.get(index + 1).map_or(usize::MAX, |next| next[0].0);
        let last = wrong.iter().rev().find(|(at, _)| (from..next).contains(at));
        seen.right.push(last.map_or(0.0, |(_, number)| f64::from((number + 1).saturating_sub(told)) * frame_seconds * 1000.0));
        let stretch = moved.get(from..=to).unwrap_or(&[]);
        seen.pictures += stretch.len();
        seen.moved += stretch.iter().filter(|&&moved| moved).count();
    }
    seen
}

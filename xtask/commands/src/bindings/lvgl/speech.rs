//! A sentence of espeak-ng, spoken by a face on LVGL's test display: a video, and when the lips open and close.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use pantin_images::animation::Animation;
use pantin_images::gif::Gif;
use pantin_images::image::Image;

use super::output;

/// What is said.
const SENTENCE: &str = "Hello! My name is Pantin. Bob and Mary made a map, and people may become puppets.";

/// Width and height of the pictures, and the time between two of them in milliseconds.
const SIZE: usize = 240;
const PICTURE_MS: usize = 40;

/// The jaw at most for closed lips and at least for an open vowel, in thousandths.
const CLOSED: u32 = 100;
const OPEN: u32 = 350;
/// The latest that the jaw is half open after the beginning of an open vowel, and that lips are closed after the end of a closed sound.
const LATE_MS: usize = 60;

/// A sound of the sentence.
struct Phoneme {
    begin: usize,
    end: usize,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// p, b or m, audible as a gap.
    Closed,
    /// An open vowel.
    Open,
    Other,
}

/// Writes target/lvgl/speech.gif, with the sound beside it, and prints how well the lips fit. Without espeak-ng it says so and passes.
pub fn speech() -> Result<()> {
    let folder = paths::root().join("target/lvgl");
    std::fs::create_dir_all(&folder)?;
    let [sound, pictures, gif] = ["speech.pcm", "speech.rgb565", "speech.gif"].map(|name| folder.join(name));
    let mut python = Command::new("python3");
    python.arg(super::super::home().join("tests/talk_speech.py")).args(["--say", SENTENCE]).arg(&sound);
    let printed = String::from_utf8(output(python).context("speech of espeak-ng")?.stdout)?;
    let mut lines = printed.lines();
    let Some(rate) = lines.next().and_then(|line| line.parse::<u32>().ok()) else {
        println!("   skipped: {}", printed.trim());
        return Ok(());
    };
    let phonemes = lines.map(phoneme).collect::<Result<Vec<_>>>()?;
    let mut program = Command::new(super::program("examples/speech.c", &["-O2"])?);
    program.arg(&sound).arg(rate.to_string()).arg(&pictures);
    let jaws: Vec<u32> = String::from_utf8(output(program)?.stdout)?.lines().map(str::parse).collect::<Result<_, _>>()?;
    let count = video(&pictures, &gif)?;
    std::fs::remove_file(&pictures)?;
    println!("   {} pictures in {}", count, gif.display());
    judge(&phonemes, &jaws)
}

fn phoneme(line: &str) -> Result<Phoneme> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [begin, end, kind, ..] = words[..] else { anyhow::bail!("{line}: expected begin, end and kind") };
    let kind = match kind {
        "closed" => Kind::Closed,
        "open" => Kind::Open,
        _ => Kind::Other,
    };
    Ok(Phoneme { begin: begin.parse()?, end: end.parse()?, kind })
}

/// Compares the jaw, every 10 ms, with the sounds.
fn judge(phonemes: &[Phoneme], jaws: &[u32]) -> Result<()> {
    let part = |phoneme: &Phoneme| {
        let last = (phoneme.end / 10 + 3).min(jaws.len());
        jaws.get(phoneme.begin / 10..last).unwrap_or_default()
    };
    let of = |kind| phonemes.iter().filter(move |phoneme| phoneme.kind == kind).map(part);
    let closed: Vec<bool> = of(Kind::Closed).map(|jaws| jaws.iter().any(|&jaw| jaw <= CLOSED)).collect();
    let mut late = vec![];
    let mut opened = 0;
    for jaws in of(Kind::Open) {
        let most = jaws.iter().copied().max().unwrap_or(0);
        opened += usize::from(most >= OPEN);
        late.push((jaws.iter().position(|&jaw| 2 * jaw >= most).unwrap_or(0) + 1) * 10);
    }
    let worst = late.iter().copied().max().context("the sentence has open vowels")?;
    let mean = late.iter().sum::<usize>() / late.len();
    println!(
        "   {} of {} gaps of p, b and m closed; the jaw open at {opened} of {} open vowels,",
        closed.iter().filter(|&&is| is).count(),
        closed.len(),
        late.len()
    );
    println!("   half open {mean} ms after their start in the mean, {worst} ms at most");
    ensure!(closed.len() > 4 && closed.iter().all(|&is| is), "lips are open at a p, b or m");
    ensure!(opened == late.len() && worst <= LATE_MS, "the jaw opens too late or too little");
    Ok(())
}

/// Turns RGB565 pictures into a GIF. Returns their number.
fn video(pictures: &Path, gif: &Path) -> Result<usize> {
    let pixels = super::colours(&std::fs::read(pictures)?);
    let mut colours = pixels.clone();
    colours.sort_unstable();
    colours.dedup();
    let mut writer = Gif::new(BufWriter::new(File::create(gif)?), &colours, PICTURE_MS as f64 / 1000.0);
    let frames = pixels.chunks_exact(SIZE * SIZE);
    let count = frames.len();
    for frame in frames {
        writer.push(&Image::of(SIZE, frame.to_vec()))?;
    }
    Ok(count)
}

//! The decoder's memory on the smallest processor: code and tables from the ELF files of images, RAM and stack from a run.

use std::path::Path;

use anyhow::{Context, Result};
use harness::image::{DECODERS, Image};
use harness::paths;
use harness::qemu::MICROBIT;

use super::guest::Guest;
use super::{Goal, Setting, reference, table, tool};
use xtask::steps::say;

/// The most bytes of code that each of [`DECODERS`] should have.
const MOST: [f64; DECODERS.len()] = [4096.0, 5120.0, 7168.0, 8192.0];

/// Functions shown.
const SHOWN: usize = 12;

/// Builds, reads, runs.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let empty = Image::read("image-empty")?;
    let images = DECODERS.iter().map(|(name, _)| Image::read(name)).collect::<Result<Vec<_>>>()?;
    let (step, decoder) = images.first().zip(images.last()).context("no image of the decoder")?;
    let own = decoder.symbols.iter().filter(|symbol| !empty.symbols.contains(symbol));
    let rows: Vec<_> = own.take(SHOWN).map(|(name, size)| vec![name.clone(), size.to_string()]).collect();
    table::print(&["largest functions and tables, Cortex-M0", "bytes"], &rows);
    let euler = Image::read("image-euler")?;
    let unwanted: Vec<&str> = images.iter().chain([&euler]).flat_map(Image::unwanted).collect();
    if !unwanted.is_empty() {
        say(&format!("   panic, formatting, float, divide or heap in the images: {}", unwanted.join(", ")));
    }
    let mut goals: Vec<Goal> = DECODERS
        .iter()
        .zip(&images)
        .zip(MOST)
        .map(|(((_, what), image), most)| {
            Goal::at_most(format!("code on Cortex-M0: {what}"), (image.code - empty.code) as f64, most, 0, "bytes")
        })
        .collect();
    goals.extend([
        Goal::told("the compiler's memory functions, in addition", format!("{} bytes", decoder.memory)),
        Goal::at_most("tables", (decoder.tables - empty.tables) as f64, 2048.0, 0, "bytes"),
        Goal::at_most(
            "code and tables of finding a joint and reading its Euler angles",
            (euler.size() - step.size()) as f64,
            3072.0,
            0,
            "bytes",
        ),
        Goal::at_most("symbols of panic, formatting, float, divide or heap", unwanted.len() as f64, 0.0, 0, ""),
    ]);
    let (name, clip) = clip(setting)?;
    goals.extend(memory(&name, &clip)?);
    Ok(goals)
}

/// A clip of 31 joints where there is one, else our walk.
pub fn clip(setting: &Setting) -> Result<(String, std::path::PathBuf)> {
    let (name, path, unit) = match reference::named("bvh_xia_strut-walk")? {
        Some(clip) => (clip.name.clone(), clip.path.clone(), clip.cm_per_unit()),
        None => ("walk".into(), paths::root().join("motions/walk.keys"), None),
    };
    let made = setting.tool.converted(&path, &format!("{name}-1cm"), &tool::options(1.0, unit))?;
    Ok((name, made.clip))
}

fn memory(name: &str, clip: &Path) -> Result<Vec<Goal>> {
    let log = Guest::new(MICROBIT, "memory")?.log(clip)?;
    let numbers: Vec<(&str, f64)> = log
        .iter()
        .filter_map(|line| {
            let mut words = line.split(' ').skip(1);
            Some((words.next()?, words.next()?.parse().ok()?))
        })
        .collect();
    let rows: Vec<_> = numbers.iter().map(|(what, bytes)| vec![(*what).to_owned(), bytes.to_string()]).collect();
    table::print(&[&format!("RAM of a channel and a player, stack of the calls; {name}"), "bytes"], &rows);
    let of = |what: &str| numbers.iter().find(|(name, _)| *name == what).map(|(_, bytes)| *bytes);
    let stack = numbers.iter().filter(|(name, _)| !["channel", "player"].contains(name)).map(|(_, bytes)| *bytes);
    Ok(vec![
        Goal::at_most("RAM per moving channel", of("channel").context("no size of a channel")?, 20.0, 0, "bytes"),
        Goal::at_most(
            "RAM of a player, without channels and pose",
            of("player").context("no size of a player")?,
            128.0,
            0,
            "bytes",
        ),
        Goal::at_most("stack of any call", stack.fold(0.0, f64::max), 512.0, 0, "bytes"),
    ])
}

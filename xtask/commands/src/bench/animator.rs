//! Guest instructions of transitions, layers, inverse kinematics and a character's set-up, on two processors, and the animator's code.

use anyhow::{Context, Result};
use harness::image::Image;
use harness::paths;
use harness::qemu::{LM3S6965EVB, MICROBIT, Machine};

use super::footprint;
use super::guest::Guest;
use super::{Goal, Setting, table};
use xtask::steps::say;

/// Frames of each run of `animator` in `firmware/testsuite`.
const FRAMES: usize = 30;

/// What a processor should take: a frame, a transition and two layers, of plain decoding; the rest in instructions.
struct Most {
    still: f64,
    transition: f64,
    layers: f64,
    /// A switch to frame 0, and one into the middle of the clip.
    switches: [f64; 2],
    /// `Character::new`, `lend_layer`, and the first and the second lap of a loop.
    character: [f64; 4],
    breath: f64,
    leg: f64,
    look: f64,
}

/// The goals on both processors but for a leg.
const MOST: Most = Most {
    still: 1.25,
    transition: 1.6,
    layers: 1.4,
    switches: [45_000.0, 70_000.0],
    character: [120_000.0, 20_000.0, 5_000.0, 2_000.0],
    breath: 1_000.0,
    leg: 6_000.0,
    look: 6_000.0,
};

const MACHINES: [(&str, Machine, Most); 2] =
    [("Cortex-M0", MICROBIT, MOST), ("Cortex-M3", LM3S6965EVB, Most { leg: 4_000.0, ..MOST })];

/// Measures a clip of 31 joints where there is one, else our walk, and our character.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let (name, clip) = footprint::clip(setting)?;
    let (mut goals, mut rows) = (vec![], vec![]);
    for (core, machine, most) in MACHINES {
        say(&format!("   instructions a frame on {core}, {name}"));
        let counts = Guest::new(machine, "animator")?.counts(Some(&clip))?;
        let mut rest = &counts[..];
        let mut next = |count: usize| -> Result<f64> {
            let (now, after) = rest.split_at_checked(count).context("the program marks fewer regions than expected")?;
            rest = after;
            Ok(now.iter().sum::<u64>() as f64 / count as f64)
        };
        let plain = next(FRAMES)?;
        let [still, to_start, to_middle, transition] = [next(FRAMES)?, next(1)?, next(1)?, next(FRAMES)?];
        let [breath, layers, add, leg, look] = [next(1)?, next(FRAMES)?, next(1)?, next(1)?, next(1)?];
        let character = Guest::new(machine, "character")?.counts(Some(&paths::root().join("motions/character.ptb")))?;
        let character: [u64; 4] =
            character.try_into().ok().context("the program marks another number of regions than expected")?;
        let character = character.map(|count| count as f64);
        let numbers = [plain, still, transition, to_start, to_middle, layers, add, breath, leg, look];
        rows.push([vec![core.to_owned()], numbers.map(|number| format!("{number:.0}")).into()].concat());
        let mut ratio =
            |what: &str, value: f64, most: f64| goals.push(Goal::at_most(format!("{core}: {what}"), value, most, 2, ""));
        ratio("a frame of a transition, of plain decoding", transition / plain, most.transition);
        ratio("a frame of the animator without a transition, of plain decoding", still / plain, most.still);
        ratio("two full layers with masks, of two plain decodings", layers / (2.0 * plain), most.layers);
        let [most_to_start, most_to_middle] = most.switches;
        let [set_up, lend_layer, first_lap, lap] = character;
        let [most_set_up, most_lend_layer, most_first_lap, most_lap] = most.character;
        for (what, value, most) in [
            ("a switch to frame 0", to_start, most_to_start),
            ("a switch into the middle of the clip", to_middle, most_to_middle),
            ("the set-up of our character", set_up, most_set_up),
            ("the set-up of its layer", lend_layer, most_lend_layer),
            ("the first lap of its loop", first_lap, most_first_lap),
            ("another lap", lap, most_lap),
            ("a breath on 6 joints", breath, most.breath),
            ("two-bone inverse kinematics of a leg", leg, most.leg),
            ("a look of 3 joints", look, most.look),
        ] {
            goals.push(Goal::at_most(format!("{core}: {what}"), value, most, 0, "instructions"));
        }
    }
    let header = [
        "instructions",
        "plain",
        "animator",
        "transition",
        "to frame 0",
        "to middle",
        "two layers",
        "additive",
        "breath",
        "leg",
        "look",
    ];
    table::print(&header, &rows);
    goals.extend(code()?);
    Ok(goals)
}

/// Code of everything on the smallest processor, beyond the decoder's.
fn code() -> Result<Vec<Goal>> {
    let (decoder, image) = (Image::read("image-step")?, Image::read("image-animator")?);
    let own = image.symbols.iter().filter(|symbol| !decoder.symbols.contains(symbol));
    let rows: Vec<_> = own.take(12).map(|(name, size)| vec![name.clone(), size.to_string()]).collect();
    table::print(&["largest functions and tables beyond the decoder's, Cortex-M0", "bytes"], &rows);
    let bytes = (image.code + image.tables) as f64 - (decoder.code + decoder.tables) as f64;
    let unwanted = image.unwanted();
    if !unwanted.is_empty() {
        say(&format!("   panic, formatting, float or heap in the image: {}", unwanted.join(", ")));
    }
    Ok(vec![Goal::at_most("code and tables with everything linked, Cortex-M0", bytes, 32_768.0, 0, "bytes")])
}

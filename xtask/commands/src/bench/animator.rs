//! Guest instructions of transitions, layers and inverse kinematics, on two processors, and the animator's code.

use anyhow::{Context, Result};
use harness::image::Image;
use harness::qemu::{LM3S6965EVB, MICROBIT, Machine};

use super::footprint;
use super::guest::Guest;
use super::{Goal, Setting, table};
use xtask::steps::say;

/// Frames of each run of `animator` in `firmware/testsuite`.
const FRAMES: usize = 30;

/// What a processor should take: a transition and two layers, of plain decoding; a breath, a leg and a look, in instructions.
struct Most {
    transition: f64,
    layers: Option<f64>,
    breath: f64,
    leg: f64,
    look: Option<f64>,
}

const MACHINES: [(&str, Machine, Most); 2] = [
    ("Cortex-M0", MICROBIT, Most { transition: 1.5, layers: None, breath: 1000.0, leg: 4000.0, look: Some(3000.0) }),
    ("Cortex-M3", LM3S6965EVB, Most { transition: 1.5, layers: Some(1.25), breath: 1000.0, leg: 2000.0, look: None }),
];

/// Measures a clip of 31 joints where there is one, else our walk.
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
        let [still, switch, transition, breath, layers, add] =
            [next(FRAMES)?, next(1)?, next(FRAMES)?, next(1)?, next(FRAMES)?, next(1)?];
        let [leg, look] = [next(1)?, next(1)?];
        let numbers = [plain, still, transition, switch, layers, add, breath, leg, look];
        rows.push([vec![core.to_owned()], numbers.map(|number| format!("{number:.0}")).into()].concat());
        let what = |what: &str| format!("{core}: {what}");
        let ratio = transition / plain;
        goals.push(Goal::at_most(what("a frame of a transition, of plain decoding"), ratio, most.transition, 2, ""));
        goals.push(Goal::told(
            what("a frame of the animator without a transition, of plain decoding"),
            format!("{:.2}", still / plain),
        ));
        goals.push(Goal::told(what("the switch itself, once"), format!("{switch:.0} instructions")));
        let layers = layers / (2.0 * plain);
        let label = what("two full layers with masks, of two plain decodings");
        goals.push(match most.layers {
            Some(most) => Goal::at_most(label, layers, most, 2, ""),
            None => Goal::told(label, format!("{layers:.2}")),
        });
        goals.push(Goal::at_most(what("a breath on 6 joints"), breath, most.breath, 0, "instructions"));
        goals.push(Goal::at_most(what("two-bone inverse kinematics of a leg"), leg, most.leg, 0, "instructions"));
        let label = what("a look of 3 joints");
        goals.push(match most.look {
            Some(most) => Goal::at_most(label, look, most, 0, "instructions"),
            None => Goal::told(label, format!("{look:.0} instructions")),
        });
    }
    let header = ["instructions", "plain", "animator", "transition", "switch", "two layers", "additive", "breath", "leg", "look"];
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
    Ok(vec![Goal::at_most("code and tables with everything linked, Cortex-M0", bytes, 10_240.0, 0, "bytes")])
}

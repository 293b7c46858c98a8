//! The paper's argument: additions are cheaper than polynomials, and a small clip is sooner there than a per-frame file.

use anyhow::{Context, Result, ensure};
use harness::paths;
use harness::qemu::{LM3S6965EVB, MICROBIT};

use super::guest::Guest;
use super::{Goal, Setting, decode, reference, table, tool};

/// The kinds of regions of the program, in its order, and its channels a region.
const KINDS: [&str; 4] =
    ["three additions", "Horner's cubic, 32 bits", "Horner's cubic, 16 bits", "cubic rebuilt from keys, 32 bits"];
const CHANNELS: f64 = 64.0;

/// Bits a second, and bits a byte on a serial line: start, 8, stop.
const LINKS: [f64; 5] = [9_600.0, 19_200.0, 38_400.0, 115_200.0, 1_000_000.0];
const BITS: f64 = 10.0;

/// Clock of the processor that decodes, and cycles an instruction: flash may be slower than the processor.
const CLOCK_HZ: f64 = 50e6;
const CYCLES: f64 = 2.0;

/// Both tables.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let mut goals = polynomials()?;
    let guest = Guest::new(LM3S6965EVB, "decode")?;
    let walk = paths::root().join("motions/walk.keys");
    goals.extend(link(setting, &guest, "our walk", &walk, "walk-0.5cm", &tool::places_options(0.5, None))?);
    if let Some(clip) = reference::named("bvh_xia_strut-walk")? {
        let options = tool::options(1.0, clip.cm_per_unit());
        goals.extend(link(setting, &guest, &clip.name, &clip.path, &format!("{}-1cm", clip.name), &options)?);
    }
    Ok(goals)
}

fn polynomials() -> Result<Vec<Goal>> {
    let mut columns = vec![];
    for machine in [MICROBIT, LM3S6965EVB] {
        let counts = Guest::new(machine, "argument")?.counts(None)?;
        ensure!(counts.len() == KINDS.len(), "{} regions, expected {}", counts.len(), KINDS.len());
        columns.push(counts.iter().map(|&count| count as f64 / CHANNELS).collect::<Vec<_>>());
    }
    let row = |(index, name): (usize, &&str)| {
        vec![(*name).to_owned(), format!("{:.1}", columns[0][index]), format!("{:.1}", columns[1][index])]
    };
    let rows: Vec<_> = KINDS.iter().enumerate().map(row).collect();
    table::print(&["instructions a value and frame", "Cortex-M0", "Cortex-M3"], &rows);
    let shown = |core: usize| columns[core].iter().map(|number| format!("{number:.0}")).collect::<Vec<_>>().join(" / ");
    let what = "instructions per value: additions / Horner, 32 bits / Horner, 16 bits / from keys";
    Ok(vec![Goal::told(format!("{what}, Cortex-M0"), shown(0)), Goal::told(format!("{what}, Cortex-M3"), shown(1))])
}

/// Transfer and decoding of a clip against transfer of 16 bits for every frame of every moving channel.
fn link(
    setting: &Setting,
    guest: &Guest,
    name: &str,
    motion: &std::path::Path,
    clip: &str,
    options: &[String],
) -> Result<Option<Goal>> {
    let made = setting.tool.converted(motion, clip, options)?;
    let bytes = std::fs::read(&made.clip).with_context(|| made.clip.display().to_string())?;
    let cost = decode::cost(guest, &bytes, &made.clip)?;
    let decode = (cost.open + cost.steps) as f64 * CYCLES / CLOCK_HZ;
    let per_frame = made.info.frames * made.info.moving * 2.0;
    let mut rows = vec![];
    let mut fastest = None;
    for link in LINKS {
        let (sent, plain) = (made.info.motion_bytes * BITS / link, per_frame * BITS / link);
        let times = plain / (sent + decode);
        fastest = Some((link, times));
        let numbers = [sent, decode, sent + decode, plain].map(|seconds| format!("{:.1}", seconds * 1e3));
        rows.push([vec![format!("{link}")], numbers.to_vec(), vec![format!("{times:.1}")]].concat());
    }
    let header = format!("{name}, {} bytes of motion against {per_frame}: baud", made.info.motion_bytes);
    table::print(&[&header, "sent ms", "decoded ms", "both", "per-frame sent ms", "times sooner"], &rows);
    Ok(fastest.map(|(link, times)| {
        let what = format!("{name}: transfer at {link} baud and decoding (Cortex-M3, 50 MHz), against its per-frame file");
        Goal::told(what, format!("{times:.1} times sooner"))
    }))
}

//! `pantin flash-image`.

use super::default_output;
use crate::board_clip;
use crate::output::{check, note, report, write_whole};
use anyhow::{Context, Result, bail};
use clap::builder::PossibleValuesParser;
use pantin_line::update::image;
use pantin_store::region::{REGIONS, Region};
use serde_json::json;
use std::path::PathBuf;

/// Write an image of a board's clip flash; the firmware stays as it is.
///
/// The output's extension selects the format: .bin is the whole region, for the address that the command prints; .hex (Intel HEX, with
/// addresses) is the clip and what invalidates a newer one; .uf2 is the same in whole sectors, to drag onto the Pico's drive.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin flash-image walk.ptn --board pico -o clips.uf2        hold BOOTSEL, plug it in, drag the file onto RPI-RP2
  pantin flash-image walk.ptn --board blackpill -o clips.hex
  probe-rs download --chip STM32F411CEUx --binary-format hex clips.hex
  pantin flash-image walk.ptn --board esp32-c3 -o clips.bin --name \"my walk\"
  espflash write-bin 0x3e0000 clips.bin

The firmware must be built with feature `update`, and for a bank with feature `bank`.")]
pub struct Arguments {
    /// The clip, which must contain its rig, or a bank, whose clips the board plays one after the other
    input: PathBuf,
    /// The file to write: .bin, .hex or .uf2 [default: the clip's name, ending in what the board's flash tool takes; a file that is there
    /// already is kept]
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The board; `microbit` is the one that QEMU emulates, for its firmware does not run on a real one
    #[arg(long, value_parser = PossibleValuesParser::new(REGIONS.map(|region| region.board)))]
    board: String,
    #[command(flatten)]
    sent: board_clip::Sent,
}

/// The extension that a board's flash tool takes: drives take UF2 files, espflash writes plain bytes.
fn extension(region: &Region) -> &'static str {
    match region.board {
        _ if region.family.is_some() => "uf2",
        "esp32-c3" => "bin",
        _ => "hex",
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let region = Region::of(&arguments.board).context("no board has this name")?;
    let output = &match &arguments.output {
        Some(output) => output.clone(),
        None => default_output(&arguments.input, extension(region))?,
    };
    check(&[&arguments.input], &[output])?;
    let (clip, info) = board_clip::read(&arguments.input, &arguments.sent)?;
    let place = || arguments.input.display().to_string();
    let bytes = match output.extension().and_then(|extension| extension.to_str()) {
        Some("bin") => image::binary(region, &clip, &info).with_context(place)?,
        Some("hex") => image::hex(region, &clip, &info).with_context(place)?.into_bytes(),
        Some("uf2") => image::uf2(region, &clip, &info).with_context(place)?,
        _ => bail!("{}: expected a name that ends in .bin, .hex or .uf2", output.display()),
    };
    write_whole(output, &bytes)?;
    let Region { board, address, slot, sector, word, .. } = region;
    report(json!({"board": board, "clip_bytes": clip.len(), "slot_bytes": slot, "address": address, "sector_bytes": sector}));
    note!(
        "{board}: {} holds {} bytes of clip; two slots of {slot} bytes at {address:#010x}, sectors of {sector}, words of {word}",
        output.display(),
        clip.len()
    );
    Ok(())
}

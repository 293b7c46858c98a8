//! `pantin expand`.

use super::render::read_look;
use super::{Files, default_output, format_of};
use crate::memory;
use crate::open::is_bank;
use crate::output::{self, Staged, Wanted, note, refuse_foreign};
use anyhow::{Context, Result, bail, ensure};
use pantin::{Bank, Clip};
use pantin_convert::expand::{Expanded, gather};
use pantin_convert::expand_keys;
use pantin_convert::export::{self, bvh::Columns};
use pantin_convert::motion::{Frames, Motion};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Turn a clip back into per-frame motion, or a clip, a bank or a character into source text for firmware.
///
/// The output's extension selects the format: .bvh has the same joints and frames, and three Euler angles a joint, which stand for its quaternion or exponential map, too; .glb is a
/// tree of nodes, with scalars as morph weights; .keys is key-frame text, with the keys of a clip that holds keys (`pantin convert --keys`); .csv has one row per frame with the time in seconds and
/// all channels' values; .h and .rs hold the bytes of the clip or the bank, names, and the sizes of the memory that it takes: in Rust as a
/// type, `WalkRoom`. A .look file, a character of solid figures, becomes a .h for C.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin expand walk.ptn -o walk.bvh
  pantin expand walk.ptn --format csv -o - | head -1
  pantin expand walk.ptn --rig figure.rig -o walk.bvh
  pantin expand walk.ptn -o walk.glb
  pantin expand face.ptn -o face.csv
  pantin expand walk-keys.ptn -o walk.keys
  pantin expand walk.ptn -o walk.h
  pantin expand walk.ptn -o src/walk.rs
  pantin expand moves.ptb -o src/moves.rs
  pantin expand motions/looks/cat.look -o cat.h")]
pub struct Arguments {
    /// The clip, the bank for .h and .rs, or the .look file for .h
    input: PathBuf,
    /// The file to write: .bvh, .glb (glTF), .keys, .csv, .h or .rs [default: the clip's name, ending in .bvh, or in .csv without joints;
    /// a file that is there already is kept]
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The format, where the output's name does not say it, as in `-o -`
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// What the file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Biovision hierarchy
    Bvh,
    /// Binary glTF
    Glb,
    /// Key-frame text
    Keys,
    /// A table
    Csv,
    /// A C header
    H,
    /// A Rust module
    Rs,
}

impl Arguments {
    /// Checks the output before any work.
    fn check(&self, output: &Path) -> Result<()> {
        let inputs: Vec<&Path> = [self.input.as_path()].into_iter().chain(self.rig.as_deref()).collect();
        output::check(&inputs, &[output])?;
        let is_keys = output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("keys"));
        refuse_foreign(output, if is_keys { Wanted::Keys } else { Wanted::Motion })
    }

    /// What names in source text are made of: the output's name, or the input's where standard output has none.
    fn stem(&self, output: &Path) -> String {
        let named = if output.as_os_str() == "-" { &self.input } else { output };
        named.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The name of an output that the user does not name.
    fn default_output(&self, clip: &Clip) -> Result<PathBuf> {
        let format = match self.format {
            Some(Format::Bvh) => "bvh",
            Some(Format::Glb) => "glb",
            Some(Format::Keys) => "keys",
            Some(Format::Csv) => "csv",
            Some(Format::H) => "h",
            Some(Format::Rs) => "rs",
            None if clip.rig().joint_count() == 0 => "csv",
            None => "bvh",
        };
        let output = default_output(&self.input, format)?;
        self.check(&output)?;
        Ok(output)
    }
}

/// Source text of a bank and its bytes, with names made of a stem.
type WriteBank = fn(&Bank, &[u8], &str) -> Result<String>;

/// Writes a bank as source text: other files hold one motion.
fn bank(arguments: &Arguments, bytes: &[u8]) -> Result<()> {
    let place = || arguments.input.display().to_string();
    ensure!(arguments.rig.is_none(), "{}: --rig is for clips without one, and a bank holds its rig", place());
    let format = match (&arguments.output, arguments.format) {
        (Some(output), format) => format_of(output, format)?,
        (None, format) => format,
    };
    let (extension, write): (&str, WriteBank) = match format {
        Some(Format::H) => ("h", export::source::c_header_of_bank),
        Some(Format::Rs) => ("rs", export::source::rust_module_of_bank),
        _ => bail!(
            "{0}: a bank of several clips becomes .h or .rs alone; `pantin unpack {0} -o FOLDER` writes its clips as files",
            place()
        ),
    };
    let output = match &arguments.output {
        Some(output) => output.clone(),
        None => default_output(&arguments.input, extension)?,
    };
    arguments.check(&output)?;
    output::check_size(&output, 3 * bytes.len() as u64)?;
    let bank = Bank::new_checked(bytes).with_context(place)?;
    let text = write(&bank, bytes, &arguments.stem(&output)).with_context(place)?;
    output::write_whole(&output, text.as_bytes())?;
    output::report(json!({"clips": bank.len()}));
    if arguments.output.is_none() {
        note!("{}: written", output.display());
    }
    Ok(())
}

/// Writes a character as a C header.
fn look(arguments: &Arguments) -> Result<()> {
    let place = || arguments.input.display().to_string();
    ensure!(arguments.rig.is_none(), "{}: --rig is for clips without one, and this is a character", place());
    let output = match &arguments.output {
        Some(output) => output.clone(),
        None => default_output(&arguments.input, "h")?,
    };
    let is_header = format_of(&output, arguments.format)? == Some(Format::H);
    ensure!(is_header, "{}: a character becomes .h alone", place());
    arguments.check(&output)?;
    let look = read_look(&arguments.input)?;
    let text = export::source::c_header_of_look(look.bytes(), &arguments.stem(&output));
    output::write_whole(&output, text.as_bytes())?;
    output::report(json!({"bytes": look.bytes().len()}));
    if arguments.output.is_none() {
        note!("{}: written", output.display());
    }
    Ok(())
}

impl Format {
    /// How often the clip is played to write it; source text holds its bytes.
    fn plays(self) -> u64 {
        match self {
            Format::Csv => 2,
            Format::Bvh | Format::Glb | Format::Keys | Format::H | Format::Rs => 1,
        }
    }
}

fn glb(clip: &Clip, frames: &impl Frames, out: &mut impl Write) -> Result<()> {
    memory::limit().check(frames.frames(), frames.rig().channels())?;
    let motion = Motion { looped: clip.looped(), ..gather(frames)? };
    Ok(out.write_all(&export::gltf::write(&motion)?)?)
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if let Some(output) = &arguments.output {
        arguments.check(output)?;
        format_of(output, arguments.format)?;
    }
    if arguments.input.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("look")) {
        return look(arguments);
    }
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    let place = || arguments.input.display().to_string();
    if is_bank(files.clip()) {
        return bank(arguments, files.clip());
    }
    let clip = files.open_alone().with_context(place)?;
    let output = &match &arguments.output {
        Some(output) => output.clone(),
        None => arguments.default_output(&clip)?,
    };
    let Some(format) = format_of(output, arguments.format)? else {
        bail!("{}: expected a name that ends in .bvh, .glb, .keys, .csv, .h or .rs, or --format", output.display());
    };
    let stem = arguments.stem(output);
    let expanded = Expanded::new(&clip);
    let rig = expanded.rig();
    // A digit and a comma or a space a value; four bytes a number in glTF; as text, a digit and a comma a byte.
    let values = expanded.frames() as u64 * (rig.channels() as u64 + 1);
    let least = match format {
        Format::Glb => 4 * values,
        Format::H | Format::Rs => 3 * files.clip_len() as u64,
        Format::Keys => files.clip_len() as u64,
        // Four components of a quaternion become three angles.
        Format::Bvh => 3 * values / 2,
        Format::Csv => 2 * values,
    };
    output::check_size(output, least)?;
    if clip.event_count() > 0 && matches!(format, Format::Bvh) {
        note!("{}: {} events are left out: this kind of file holds none here", output.display(), clip.event_count());
    }
    if clip.has_keys() && matches!(format, Format::H | Format::Rs) {
        let help = "`pantin convert --segments` makes a clip for all players";
        note!("{}: a key clip, for players with feature `keys`, in C with PANTIN_KEYS; {help}", output.display());
    }
    if matches!(format, Format::Bvh) {
        let names = export::bvh::names(rig);
        let changed = rig.joints.iter().zip(&names).filter(|(joint, name)| !joint.end_site && joint.name != **name);
        for (joint, name) in changed {
            note!(
                "{}: the joint `{}` is called `{name}`: BVH takes no braces, control characters or empty names",
                output.display(),
                joint.name
            );
        }
    }
    let mut out = Staged::create(output)?;
    let bar = output::progress(format.plays() * expanded.frames() as u64, "writing {wide_bar} {percent} % {eta} left")?;
    let tick = || bar.inc(1);
    let expanded = expanded.watched(&tick);
    let written = match format {
        Format::Bvh => export::bvh::write(&expanded, Columns::ThreeRotations, &mut out),
        Format::Csv => export::table::write(&expanded, &mut out),
        Format::Glb => glb(&clip, &expanded, &mut out),
        Format::Keys => expand_keys::write(&clip).and_then(|text| Ok(out.write_all(text.as_bytes())?)),
        Format::H => export::source::c_header(&clip, files.clip(), &stem).and_then(|text| Ok(out.write_all(text.as_bytes())?)),
        Format::Rs => {
            export::source::rust_module(&clip, files.clip(), &stem).and_then(|text| Ok(out.write_all(text.as_bytes())?))
        }
    };
    bar.finish_and_clear();
    out.explain(written, place)?;
    output::commit(vec![out])?;
    output::report(json!({"frames": clip.frames(), "channels": clip.rig().channels()}));
    if arguments.output.is_none() {
        note!("{}: written", output.display());
    }
    Ok(())
}

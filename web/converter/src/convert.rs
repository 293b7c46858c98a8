//! Converts files to a clip and a report.

use crate::sources::{self, Chosen, Given};
use pantin::Clip;
use pantin_convert::Level;
use pantin_convert::expand::{Expanded, gather};
use pantin_convert::export::gltf;
use pantin_convert::export::source::c_header;
use pantin_convert::import::animations;
use pantin_convert::motion::Motion;
use pantin_convert::raw;
use pantin_convert::{Converted, Error, Length, Note, Options, Progress, Recipe, Setting, UseKeys};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The results of a conversion: the report, the clip, its C header, its rig, the motion's own poses, and the clip as a .glb, empty if nothing moves.
#[derive(Default)]
pub struct Outputs {
    pub parts: [Vec<u8>; 6],
}

impl Outputs {
    /// The results of a failed conversion: a report with the reason.
    pub fn failed(error: &Error) -> Outputs {
        let mut outputs = Outputs::default();
        outputs.parts[0] = Value::from(error.fields()).to_string().into_bytes();
        outputs
    }
}

/// What the page asks for.
pub struct Asked(Value);

impl Asked {
    fn new(options: &[u8]) -> Result<Asked, Error> {
        serde_json::from_slice(options).map(Asked).map_err(|error| Error::source(format!("options: {error}")))
    }

    /// The recipe for the motion `path`. `fps` states the rate of a file without one, and is the clip's.
    pub fn recipe(&self, path: &Path) -> Result<Recipe, Error> {
        let Asked(options) = self;
        let cm = options["max_error_cm"].as_f64();
        let cm = cm.ok_or_else(|| Error::setting(Setting::MaxError, "expected a length above 0"))?;
        let level = options["effort"].as_str().and_then(|text| text.parse().ok()).unwrap_or(Level::DEFAULT);
        let mut recipe = Recipe::new().options(Options::new().max_error(Length::cm(cm)).effort(level).keys(UseKeys::IfSmaller));
        recipe.import.fps = options["fps"].as_f64();
        recipe.import.cm_per_unit = options["cm_per_unit"].as_f64();
        // The page has one field for all files.
        recipe.import.animation = options["animation"].as_str().filter(|_| animations::chooses(path)).map(str::to_owned);
        recipe.edits.fps = recipe.import.fps;
        Ok(recipe)
    }
}

/// Converts the motion of `files`. The values of a face that another one holds are added to a body's; other files are those that a motion refers
/// to, and the report names what was left out.
pub fn convert(files: Vec<(PathBuf, Vec<u8>)>, options: &[u8], progress: Progress<'_>) -> Result<Outputs, Error> {
    let asked = Asked::new(options)?;
    let given = Given::new(files);
    let Chosen { motion, face, mut notes } = sources::choose(&given, &asked)?;
    let mut recipe = asked.recipe(&motion)?;
    recipe.edits.with.clone_from(&face);
    let converted = match (recipe.convert(given.files(), &motion, progress), face) {
        (Err(error @ Error::Setting(Setting::With, _)), Some(face)) => {
            notes.push(sources::left_out(&face, &error));
            recipe.edits.with = None;
            recipe.convert(given.files(), &motion, progress)?
        }
        (done, Some(face)) => {
            notes.push(sources::together(&face));
            done?
        }
        (done, None) => done?,
    };
    outputs(&motion, &converted, notes).map_err(|error| Error::of(&error, Error::source))
}

/// The results of a conversion of the file `path`; `notes` are those about its files.
fn outputs(path: &Path, converted: &Converted, notes: Vec<Note>) -> anyhow::Result<Outputs> {
    let Converted { clip, rig, motion, report, .. } = converted;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let notes: Vec<_> = notes.iter().chain(&converted.notes).map(Note::fields).collect();
    let mut fields = report.to_json(motion);
    let facts = [
        ("stem", json!(stem)),
        ("notes", json!(notes)),
        ("channels", json!(report.channels)),
        ("frame_time_ns", json!(report.frame_time_ns)),
        ("length_exponent", json!(report.length_exponent)),
    ];
    fields.extend(facts.map(|(name, value)| (name.to_owned(), value)));
    let opened = Clip::new_checked(clip)?;
    let header = c_header(&opened, clip, &stem)?;
    let glb = gltf::write(&Motion { looped: opened.looped(), ..gather(&Expanded::new(&opened))? }).unwrap_or_default();
    let poses = poses(motion, report.length_exponent)?;
    Ok(Outputs {
        parts: [Value::from(fields).to_string().into_bytes(), clip.clone(), header.into_bytes(), rig.clone(), poses, glb],
    })
}

/// Returns the motion as raw values, frame by frame, little-endian: what an exact clip would play.
fn poses(motion: &Motion, length_exponent: i8) -> anyhow::Result<Vec<u8>> {
    let channels = motion.rig.channel_kinds().into_iter().zip(raw::scales(&motion.rig, length_exponent));
    let targets: Vec<Vec<f64>> =
        motion.values.iter().zip(channels).map(|(values, ((_, kind), scale))| raw::target(values, kind, scale)).collect();
    anyhow::ensure!(targets.iter().all(|target| target.len() == motion.frames), "a channel has lost frames");
    // Angles wrap, as on the device.
    let pose = |frame: usize| targets.iter().flat_map(move |target| (target[frame].round() as i64 as i32).to_le_bytes());
    Ok((0..motion.frames).flat_map(pose).collect())
}

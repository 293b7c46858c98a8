//! Converts files to a clip and a report.

use anyhow::{Context, Result, ensure};
use pantin::Clip;
use pantin_tools::edit::join::join;
use pantin_tools::edit::resample::resample;
use pantin_tools::encode::{clip, rig};
use pantin_tools::export::source::c_header;
use pantin_tools::fit::descent::Level;
use pantin_tools::fit::{fit, raw};
use pantin_tools::import::{self, Files, Options};
use pantin_tools::motion::Motion;
use pantin_tools::pose_bound::PoseBound;
use pantin_tools::{errors, verify};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Largest error of channels that move no joint, as a fraction of their full scale: the host tool's default.
const SCALAR_PART: f64 = 0.02;

/// The results of a conversion: the report, the clip, its C header, its rig, and the motion's own poses.
#[derive(Default)]
pub struct Converted {
    pub parts: [Vec<u8>; 5],
}

impl Converted {
    /// The results of a failed conversion: a report with the reason.
    pub fn failed(error: &anyhow::Error) -> Converted {
        let mut converted = Converted::default();
        converted.parts[0] = json!({ "error": format!("{error:#}") }).to_string().into_bytes();
        converted
    }
}

/// Converts the first motion of `files`. The values of a face that another one holds are added to a body's; other files are those that it refers to, and
/// the report names what was left out. The device's decoder verifies the bound.
pub fn convert(files: Vec<(PathBuf, Vec<u8>)>, options: &[u8], progress: &mut dyn FnMut(f64)) -> Result<Converted> {
    let options: Value = serde_json::from_slice(options).context("options")?;
    let cm = options["max_error_cm"].as_f64().filter(|cm| *cm > 0.0).context("greatest error: expected a length above 0")?;
    let level = match options["effort"].as_str() {
        Some("fast") => Level::Fast,
        Some("best") => Level::Best,
        _ => Level::Default,
    };
    let (fps, cm_per_unit) = (options["fps"].as_f64(), options["cm_per_unit"].as_f64());
    let animation = options["animation"].as_str().map(str::to_owned);
    let mut motions: Vec<PathBuf> = files.iter().map(|(path, _)| path).filter(|path| import::is_motion(path)).cloned().collect();
    if motions.is_empty() {
        motions.extend(files.first().map(|(path, _)| path.clone()));
    }
    let unused = unused(&files, &motions);
    let files = Files::Given(files.into());
    let load = |path: &PathBuf, animation: Option<String>| {
        import::load(path, &Options { fps, cm_per_unit, animation, files: files.clone(), ..Options::default() })
    };
    let (path, others) = motions.split_first().context("no file")?;
    let (mut path, mut imported) = (path.clone(), load(path, animation)?);
    let mut said = vec![];
    for other in others {
        let name = other.display();
        match load(other, None).and_then(|read| Ok((together(&imported.motion, &read.motion)?, read))) {
            Ok((motion, read)) => {
                // The body's file gives the clip its name and its unit.
                if !is_body(&imported.motion) {
                    path.clone_from(other);
                    imported = read;
                }
                imported.motion = motion;
                said.push(format!("{name}: body and face are one clip"));
            }
            Err(error) => said.push(format!("{name} was left out: {error:#}")),
        }
    }
    said.extend(unused.iter().map(|name| format!("{name} was left out: nothing refers to it")));
    said.extend(imported.warnings);
    said.push(imported.units);
    let mut motion = imported.motion;
    // The bound is one against the file.
    ensure!(
        imported.error_cm < 0.5 * cm,
        "the file is only known within {:e} cm, which is too much of the bound",
        imported.error_cm
    );
    let cm = cm - imported.error_cm;
    if let Some(fps) = fps {
        motion = resample(&motion, fps)?;
    }
    let bound = PoseBound::shell(cm, verify::shell_radius_cm(&motion));
    let rig = rig::encode(&motion.rig)?;
    let coded = fit(&motion, level.plan(bound), SCALAR_PART, progress)?;
    let bytes = clip::encode(&coded, &rig, false)?;
    let report = verify::verify(&bytes, &rig, &motion, &bound, SCALAR_PART)?;
    let mut fields = errors::to_json(&report, &motion);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let facts = json!({
        "stem": stem,
        "said": said,
        "frames": motion.frames,
        "channels": motion.rig.channels(),
        "frame_time_ns": coded.frame_time_ns,
        "length_exponent": coded.length_exponent,
    });
    fields.extend(facts.as_object().cloned().unwrap_or_default());
    let header = c_header(&Clip::new_checked(&bytes)?, &bytes, &stem)?;
    let poses = poses(&motion, coded.length_exponent)?;
    Ok(Converted { parts: [Value::from(fields).to_string().into_bytes(), bytes, header.into_bytes(), rig, poses] })
}

fn is_body(motion: &Motion) -> bool {
    motion.rig.joint_channels() > 0
}

/// A body and a face as one motion.
fn together(one: &Motion, other: &Motion) -> Result<Motion> {
    let kind = if is_body(one) { "body" } else { "face" };
    ensure!(is_body(one) != is_body(other), "one {kind} can be converted at a time");
    if is_body(one) { join(one, other) } else { join(other, one) }
}

/// The files that are no motion, and that no motion names: a skeleton belongs to any motion that has none of its own.
fn unused(files: &[(PathBuf, Vec<u8>)], motions: &[PathBuf]) -> Vec<String> {
    let named = |name: &str| {
        let encoded = name.replace(' ', "%20");
        files
            .iter()
            .filter(|(path, _)| motions.contains(path))
            .any(|(_, bytes)| [name, &encoded].iter().any(|name| bytes.windows(name.len()).any(|part| part == name.as_bytes())))
    };
    let is_skeleton = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("asf"))
            && motions.iter().any(|path| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("amc")))
    };
    let others = files.iter().map(|(path, _)| path).filter(|path| !motions.contains(path) && !is_skeleton(path));
    others.map(|path| path.display().to_string()).filter(|name| !name.is_empty() && !named(name)).collect()
}

/// Returns the motion as raw values, frame by frame, little-endian: what an exact clip would play.
fn poses(motion: &Motion, length_exponent: i8) -> Result<Vec<u8>> {
    let channels = motion.rig.channel_kinds().into_iter().zip(raw::scales(&motion.rig, length_exponent));
    let targets: Vec<Vec<f64>> =
        motion.values.iter().zip(channels).map(|(values, ((_, kind), scale))| raw::target(values, kind, scale)).collect();
    ensure!(targets.iter().all(|target| target.len() == motion.frames), "a channel has lost frames");
    // Angles wrap, as on the device.
    let pose = |frame: usize| targets.iter().flat_map(move |target| (target[frame].round() as i64 as i32).to_le_bytes());
    Ok((0..motion.frames).flat_map(pose).collect())
}

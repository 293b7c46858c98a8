//! Recorded faces at 2 % of full scale: bits a second with and without the channels' names, how smooth they are played, and what a plain
//! coder of first differences takes at best for the same error. Then what our own clips, the models and a frame take.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use harness::paths;
use harness::qemu::{LM3S6965EVB, MICROBIT, Machine};
use pantin_convert::expand::expand;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::motion::Motion;
use pantin_face::{Binding, FaceRenderer, Morph, VERTICES, Weights};

use super::board::{self, played};
use super::{Goal, Setting, table};
use xtask::steps::say;

/// Greatest error, in percent of full scale.
const PERCENT: f64 = 2.0;
/// Name, file, and kbit a second at most with the names.
const RECORDINGS: [(&str, &str, f64); 2] =
    [("angry", "face_neurosync_angry_arkit.csv", 0.75), ("fearful", "face_neurosync_fearful_arkit.csv", 0.4)];
/// What ours may take of the plain coder's bits.
const OF_PLAIN: f64 = 0.7;
/// What a second difference may be of the source's greatest.
const BEND: f64 = 1.5;

/// All that is measured of faces.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let (mut goals, mut played) = recordings(setting)?;
    goals.push(own(setting, &mut played)?);
    for style in &STYLES {
        goals.extend(frames(&played, style)?);
        let memory = board::memory(style.feature, &played[0].1, &[])?;
        goals.push(Goal::at_most(
            format!("RAM without the framebuffer, {} on Cortex-M3{}", played[0].0, style.label),
            memory as f64,
            RAM,
            0,
            "bytes",
        ));
    }
    let own = size_of::<Morph<VERTICES>>() + size_of::<FaceRenderer<VERTICES>>() + size_of::<Binding>() + size_of::<Weights>();
    goals.push(Goal::told("share of vertices, display, names and weights", format!("{own} bytes")));
    let model = pantin_face::MODEL.len();
    goals.push(Goal::at_most("the face's model in flash", model as f64, MODEL, 0, "bytes"));
    let cartoon = pantin_face::CARTOON.len();
    goals.push(Goal::at_most("the model of filled shapes in flash", cartoon as f64, MODEL, 0, "bytes"));
    Ok(goals)
}

/// Clips, with what they are called.
type Clips = Vec<(String, PathBuf)>;

/// Most bytes of our own clips together, of RAM and of the model.
const OWN: f64 = 2048.0;
const RAM: f64 = 6144.0;
const MODEL: f64 = 8192.0;
/// Least frames and seconds of one of our own clips, and how many there are at least.
const LEAST_FRAMES: u32 = 30;
const LEAST_SECONDS: f64 = 1.0;
const LEAST_CLIPS: usize = 16;

/// Our own clips, at least a second each, at 30 frames a second or more.
fn own(setting: &Setting, clips: &mut Clips) -> Result<Goal> {
    let folder = paths::root().join("motions/face");
    let mut sources: Vec<_> = std::fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    sources.retain(|path| path.extension().is_some_and(|extension| extension == "keys"));
    sources.sort();
    ensure!(sources.len() >= LEAST_CLIPS, "{}: {} clips, not {LEAST_CLIPS}", folder.display(), sources.len());
    let mut sum = 0;
    let mut rows = vec![];
    for source in &sources {
        let name = source.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let options = ["--max-scalar-error".to_owned(), PERCENT.to_string()];
        let made = setting.tool.converted(source, &format!("face-own-{name}"), &options)?;
        let bytes = std::fs::read(&made.clip)?;
        let clip = pantin::Clip::new_checked(&bytes)?;
        let seconds = f64::from(clip.frames()) * f64::from(clip.frame_time_ns()) / 1e9;
        ensure!(clip.frames() >= LEAST_FRAMES && seconds >= LEAST_SECONDS, "{name} lasts {seconds} s");
        rows.push(vec![name.clone(), bytes.len().to_string(), clip.frames().to_string(), format!("{seconds:.1}")]);
        sum += bytes.len();
        clips.push((name, made.clip));
    }
    table::print(&["own clip", "bytes", "frames", "seconds"], &rows);
    Ok(Goal::at_most(format!("our {} clips together, {PERCENT} % of full scale", rows.len()), sum as f64, OWN, 0, "bytes"))
}

/// Machines, and most instructions of a frame.
const FRAMES: [(&str, Machine, f64); 2] = [("M3, 128x64, 4 bits", LM3S6965EVB, 60e3), ("M0, 128x64, 1 bit", MICROBIT, 120e3)];

/// A face that the boards can show.
struct Style {
    /// The boards' feature.
    feature: &'static str,
    /// Follows the names of what is measured.
    label: &'static str,
}

const STYLES: [Style; 2] = [Style { feature: "face", label: "" }, Style { feature: "cartoon", label: ", filled shapes" }];

/// Instructions of a frame in the whole program: weights, morph and projection, then clear and draw.
fn frames(clips: &Clips, style: &Style) -> Result<Vec<Goal>> {
    let mut goals = vec![];
    for (machine_name, machine, most) in FRAMES {
        let label = style.label;
        say(&format!("   instructions per frame of a face, {machine_name} ({}){label}, mean of the clip", machine.name));
        let (mut rows, mut own) = (vec![], vec![]);
        let files = clips.iter().map(|(_, clip)| Ok((clip.as_path(), frames_of(clip)?))).collect::<Result<Vec<_>>>()?;
        for ((name, _), stats) in clips.iter().zip(played(machine, style.feature, &files, &[])?) {
            let cost = stats[1].mean() + stats[2].mean();
            rows.push(vec![
                name.clone(),
                format!("{:.0}", stats[1].mean()),
                format!("{:.0}", stats[2].mean()),
                format!("{cost:.0}"),
            ]);
            if name.starts_with(RECORDED) {
                goals.push(Goal::at_most(format!("instructions per frame, {machine_name}{label}: {name}"), cost, most, 0, ""));
            } else {
                own.push(cost);
            }
        }
        table::print(&["clip", "morph and project", "clear and draw", "together"], &rows);
        let worst = own.iter().copied().fold(0.0, f64::max);
        goals.push(Goal::at_most(
            format!("instructions per frame, {machine_name}{label}: the most expensive of our own clips"),
            worst,
            most,
            0,
            "",
        ));
    }
    Ok(goals)
}

fn frames_of(clip: &Path) -> Result<usize> {
    Ok(pantin::Clip::new_checked(&std::fs::read(clip)?)?.frames() as usize)
}

/// Begins the names of recordings.
const RECORDED: &str = "recorded";

/// One recording; rates in kbit a second.
struct Row {
    name: &'static str,
    most: f64,
    bytes: [usize; 2],
    rates: [f64; 2],
    plain: f64,
    bends: Bends,
}

/// What is measured of recordings, and their clips.
fn recordings(setting: &Setting) -> Result<(Vec<Goal>, Clips)> {
    let (mut rows, mut clips) = (vec![], vec![]);
    let Some(data) = paths::data() else { return Ok((vec![], clips)) };
    for (name, file, most) in RECORDINGS {
        let path = data.join(file);
        if path.is_file() {
            let (row, clip) = measure(setting, name, &path, most)?;
            rows.push(row);
            clips.push((format!("{RECORDED} {name}"), clip));
        } else {
            say(&format!("   {}: not there", path.display()));
        }
    }
    print(&rows);
    Ok((rows.iter().flat_map(goals).collect(), clips))
}

fn measure(setting: &Setting, name: &'static str, path: &Path, most: f64) -> Result<(Row, PathBuf)> {
    let motion = import::load(path, &ImportOptions::new())?.motion;
    let options = ["--max-scalar-error".to_owned(), PERCENT.to_string()];
    let made = setting.tool.converted(path, &format!("face-{name}-{PERCENT}percent"), &options)?;
    let bytes = std::fs::read(&made.clip).with_context(|| made.clip.display().to_string())?;
    let clip = pantin::Clip::new_checked(&bytes)?;
    let seconds = motion.frames as f64 * motion.frame_time;
    let rate = |bits: f64| bits / seconds / 1000.0;
    let bytes = [bytes.len(), bytes.len() - clip.rig_len()];
    let row = Row {
        name,
        most,
        bytes,
        rates: bytes.map(|bytes| rate(8.0 * bytes as f64)),
        plain: rate(plain_bits(&motion)),
        bends: Bends::of(&motion, &expand(&clip)?),
    };
    Ok((row, made.clip))
}

/// Bits of every channel's first differences, its values rounded to steps of twice the bound, under an ideal static code of its own that costs
/// nothing to tell.
fn plain_bits(motion: &Motion) -> f64 {
    let channel = |(values, full_scale): (&Vec<f64>, f64)| {
        let step = 2.0 * PERCENT / 100.0 * full_scale;
        let rounded: Vec<i64> = values.iter().map(|value| (value / step).round() as i64).collect();
        let mut counts = BTreeMap::<i64, f64>::new();
        rounded.windows(2).for_each(|pair| *counts.entry(pair[1] - pair[0]).or_default() += 1.0);
        let total: f64 = counts.values().sum();
        counts.values().map(|count| -count * (count / total).log2()).sum::<f64>()
    };
    motion.values.iter().zip(motion.rig.scalars.iter().map(|scalar| scalar.full_scale)).map(channel).sum()
}

/// Greatest second differences of what is played, as parts of the source's.
struct Bends {
    /// Of any channel's against any channel's.
    all: f64,
    /// Of a channel's against its own, and that channel's name.
    worst: (f64, String),
}

impl Bends {
    fn of(source: &Motion, played: &Motion) -> Bends {
        let greatest = |values: &Vec<f64>| values.windows(3).fold(0.0, |most: f64, x| most.max((x[0] + x[2] - 2.0 * x[1]).abs()));
        let [ours, theirs] = [played, source].map(|motion| motion.values.iter().map(greatest).collect::<Vec<_>>());
        let most = |bends: &[f64]| bends.iter().copied().fold(0.0, f64::max);
        let parts = ours.iter().zip(&theirs).map(|(ours, theirs)| if *ours == 0.0 { 0.0 } else { ours / theirs });
        let worst = parts.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        Bends { all: most(&ours) / most(&theirs), worst: (worst.1, source.rig.channel_name(worst.0)) }
    }
}

fn print(rows: &[Row]) {
    let header =
        ["recording", "bytes", "without rig", "kbit/s", "without rig", "plain", "0.7 of it", "bend", "worst channel", ""];
    let line = |row: &Row| {
        let mut line = vec![row.name.to_owned()];
        line.extend(row.bytes.map(|bytes| bytes.to_string()));
        line.extend(row.rates.map(|rate| format!("{rate:.3}")));
        line.extend([row.plain, OF_PLAIN * row.plain].map(|rate| format!("{rate:.3}")));
        line.extend([row.bends.all, row.bends.worst.0].map(|part| format!("{part:.2}")));
        line.push(row.bends.worst.1.clone());
        line
    };
    table::print(&header, &rows.iter().map(line).collect::<Vec<_>>());
}

fn goals(row: &Row) -> Vec<Goal> {
    let of = |what: &str| format!("face {}, {PERCENT} % of full scale: {what}", row.name);
    vec![
        Goal::at_most(of("with its channels' names"), row.rates[0], row.most, 3, "kbit/s"),
        Goal::at_most(of("relative to the ideal entropy of a first-difference coder"), row.rates[0] / row.plain, OF_PLAIN, 2, ""),
        Goal::told(of("motion alone"), format!("{:.3} kbit/s", row.rates[1])),
        Goal::at_most(of("largest second difference, relative to the source"), row.bends.all, BEND, 2, ""),
        Goal::at_most(of("the same, worst channel"), row.bends.worst.0, BEND, 2, ""),
    ]
}

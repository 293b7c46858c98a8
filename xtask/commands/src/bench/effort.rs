//! Bytes against processor time at every effort of the encoder, beside the bytes of other coders at the same error.

use anyhow::{Context, Result};

use super::error::{self, Distance};
use super::reference::{self, Reference};
use super::tool::Info;
use super::{Goal, Setting, plot, table, tool};
use xtask::steps::say;

/// Different rigs, rates and moods.
const CLIPS: [&str; 6] = [
    "bvh_bandai1_kick",
    "bvh_cmu131_start-walk-stop",
    "bvh_diema_anger",
    "bvh_mixamo-beta_gangnam-dance",
    "bvh_mixamo-mia_gesture",
    "bvh_xia_strut-walk",
];
const BOUND_CM: f64 = 1.0;
const EFFORTS: std::ops::RangeInclusive<u8> = 1..=9;
/// The default effort, and the goals: the time of each effort relative to the one below, and the bytes of the best relative to the default's.
const DEFAULT: u8 = 6;
const MOST_TIME: f64 = 1.8;
const MOST_BYTES: f64 = 0.965;

/// All clips at one effort.
#[derive(Default)]
struct Sum {
    bytes: f64,
    processor: f64,
}

/// Encodes the clips at each effort. Times are of all processors together, reading and verifying included.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let mut clips = vec![];
    for name in CLIPS {
        let Some(clip) = reference::named(name)? else { return Ok(vec![]) };
        clips.push(clip);
    }
    let mut sums = vec![];
    let (mut seconds, mut peers) = (0.0, [Some(0.0), Some(0.0)]);
    for effort in EFFORTS {
        let mut sum = Sum::default();
        for clip in &clips {
            let (info, processor, got) = measure(setting, clip, effort, effort == DEFAULT)?;
            sum.bytes += info.motion_bytes;
            sum.processor += processor;
            if let Some(got) = got {
                seconds += info.seconds();
                let bytes = clip.peers.as_ref().map(|peers| peers.at(got.shell)).unwrap_or_default();
                peers = [add(peers[0], bytes.acl), add(peers[1], bytes.ideal)];
            }
        }
        say(&format!("   effort {effort}: {} bytes, {:.1} s", sum.bytes, sum.processor));
        sums.push(sum);
    }
    print(&sums, seconds);
    draw(setting, &sums, seconds, peers)?;
    Ok(goals(&sums, seconds))
}

fn add(sum: Option<f64>, bytes: Option<f64>) -> Option<f64> {
    Some(sum? + bytes?)
}

/// One clip: what it became, its processor time, and its error where that is asked for.
fn measure(setting: &Setting, clip: &Reference, effort: u8, compare: bool) -> Result<(Info, f64, Option<Distance>)> {
    let unit = clip.cm_per_unit();
    let mut options = tool::shell_options(BOUND_CM, unit);
    options.extend(["--effort".to_owned(), effort.to_string()]);
    let made = setting.tool.convert(&clip.path, &format!("{}-{BOUND_CM}cm-effort-{effort}", clip.name), &options)?;
    let processor = made.processor.context("this system does not report the processor time of a program")?;
    if !compare {
        return Ok((made.info, processor, None));
    }
    let back = tempfile::Builder::new().suffix(".bvh").tempfile()?;
    setting.tool.expand(&made.clip, back.path())?;
    Ok((made.info, processor, Some(error::between(&clip.path, back.path(), unit)?)))
}

fn print(sums: &[Sum], seconds: f64) {
    let default = &sums[usize::from(DEFAULT) - 1];
    let row = |(index, sum): (usize, &Sum)| {
        let before = index.checked_sub(1).map(|before| sum.processor / sums[before].processor);
        vec![
            (index + 1).to_string(),
            format!("{:.0}", sum.bytes),
            format!("{:.3}", sum.bytes / default.bytes),
            format!("{:.3}", sum.processor / seconds),
            table::number(before, 2),
        ]
    };
    let rows: Vec<_> = sums.iter().enumerate().map(row).collect();
    let header = [&format!("effort, {} clips, {BOUND_CM} cm", CLIPS.len()), "bytes", "/default", "s a second", "/effort below"];
    table::print(&header.map(|title| title), &rows);
}

fn goals(sums: &[Sum], seconds: f64) -> Vec<Goal> {
    let default = &sums[usize::from(DEFAULT) - 1];
    let greatest = |of: fn(&Sum, &Sum) -> f64| sums.windows(2).map(|pair| of(&pair[0], &pair[1])).fold(0.0, f64::max);
    let times = greatest(|less, more| more.processor / less.processor);
    let bytes = greatest(|less, more| more.bytes / less.bytes);
    let best = sums[sums.len() - 1].bytes / default.bytes;
    let row = |(index, sum): (usize, &Sum)| {
        let (part, time) = (sum.bytes / default.bytes, sum.processor / seconds);
        Goal::told(
            format!("effort {}: bytes relative to the default", index + 1),
            format!("{part:.3} ({time:.3} s of processor time per second)"),
        )
    };
    let mut goals: Vec<Goal> = sums.iter().enumerate().map(row).collect();
    goals.push(Goal::at_most("processor time relative to the effort below, greatest", times, MOST_TIME, 2, ""));
    goals.push(Goal::at_most("bytes relative to the effort below, greatest", bytes, 0.9999, 3, ""));
    goals.push(Goal::at_most("bytes, best relative to default", best, MOST_BYTES, 3, ""));
    goals
}

/// Bytes a second against processor time. Other coders have no time here: their bytes at our error are lines.
fn draw(setting: &Setting, sums: &[Sum], seconds: f64, [acl, ideal]: [Option<f64>; 2]) -> Result<()> {
    let points: Vec<(f64, f64)> = sums.iter().map(|sum| (sum.processor / seconds, sum.bytes / seconds)).collect();
    let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) else { return Ok(()) };
    let line = |name: &str, bytes: f64| plot::Series {
        name: name.into(),
        points: vec![(first.0, bytes / seconds), (last.0, bytes / seconds)],
    };
    let mut series = vec![plot::Series { name: "pantin, efforts 1 to 9".into(), points }];
    series.extend(acl.map(|bytes| line("ACL", bytes)));
    series.extend(ideal.map(|bytes| line("ideal second-difference coder", bytes)));
    let path = setting.out.join("effort.svg");
    plot::logarithmic(&path, ["processor time, s a second of motion", "bytes a second of motion"], &series)?;
    say(&format!("   wrote {}", path.display()));
    Ok(())
}

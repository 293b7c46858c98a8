//! Guest instructions a pose: opening, every step and a seek over the whole clip, each counted alone on three processors.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use harness::paths;
use harness::qemu::{LM3S6965EVB, MICROBIT, MPS2_AN386, Machine};
use pantin::{ChannelState, Clip, Player};

use super::guest::Guest;
use super::table::mean;
use super::{Goal, Setting, decode_keys, reference, table, tool, turns};
use xtask::steps::say;

const BOUND_CM: f64 = 1.0;

/// The name of a clip of ours.
const WALK: &str = "our walk";

/// The most instructions that playing should take.
#[derive(Clone, Copy)]
struct Most {
    /// Of a pose, a moving channel: on average over all clips, and of the worst clip.
    pose: f64,
    worst: f64,
    /// Of a seek, a segment passed, of the worst clip.
    segment: f64,
}

/// The processors, and what they should take.
const MACHINES: [(&str, Machine, Option<Most>); 3] = [
    ("Cortex-M0", MICROBIT, Some(Most { pose: 42.0, worst: 75.0, segment: 300.0 })),
    ("Cortex-M3", LM3S6965EVB, Some(Most { pose: 35.0, worst: 70.0, segment: 250.0 })),
    ("Cortex-M4F", MPS2_AN386, None),
];

/// Instructions a moving channel, except where said.
pub struct Cost {
    /// Opening, in all.
    pub open: u64,
    /// All steps together, in all.
    pub steps: u64,
    mean: f64,
    first: f64,
    worst: f64,
    segment: f64,
}

/// A clip to play.
struct Played {
    name: String,
    bytes: Vec<u8>,
    path: std::path::PathBuf,
}

/// Plays each reference clip, and our walk and run, on each machine.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let mut clips = vec![];
    for clip in reference::all(setting)?.unwrap_or_default() {
        let options = tool::options(BOUND_CM, clip.cm_per_unit());
        let made = setting.tool.converted(&clip.path, &format!("{}-{BOUND_CM}cm", clip.name), &options)?;
        clips.push(Played { name: clip.name, bytes: std::fs::read(&made.clip)?, path: made.clip });
    }
    let reference = clips.len();
    for name in ["walk", "run"] {
        let path = paths::root().join("motions").join(name).with_extension("keys");
        let made = setting.tool.converted(&path, &format!("{name}-{BOUND_CM}cm"), &tool::places_options(BOUND_CM, None))?;
        clips.push(Played { name: format!("our {name}"), bytes: std::fs::read(&made.clip)?, path: made.clip });
    }
    let mut goals = vec![];
    for (core, machine, most) in MACHINES {
        say(&format!("   instructions per moving channel on {core}, {BOUND_CM} cm"));
        let guest = Guest::new(machine, "decode")?;
        let costs = clips.iter().map(|clip| cost(&guest, &clip.bytes, &clip.path).with_context(|| clip.name.clone()));
        let costs = costs.collect::<Result<Vec<_>>>()?;
        print(&clips, &costs);
        // Our own motions stand in only where there are no others.
        let judged = if reference == 0 { 0..costs.len() } else { 0..reference };
        goals.extend(judge(core, most, &costs[judged.clone()]));
        if core == "Cortex-M3" {
            goals.extend(backwards(machine, &clips[judged.clone()], &costs[judged])?);
        }
    }
    let walk = clips.iter().find(|clip| clip.name == WALK).context("our walk is not among the clips")?;
    goals.extend(turns::run(&walk.path)?);
    goals.extend(decode_keys::run(setting)?);
    Ok(goals)
}

/// Going back, and seeking, with memory lent (`back` in `firmware/testsuite` says how much), on the machine that has it.
fn backwards(machine: Machine, clips: &[Played], costs: &[Cost]) -> Result<Vec<Goal>> {
    let guest = Guest::new(machine, "back")?;
    let (mut back, mut restores, mut rows) = (vec![], vec![], vec![]);
    for (clip, cost) in clips.iter().zip(costs) {
        let counts = guest.counts(Some(&clip.path)).with_context(|| clip.name.clone())?;
        let &[forth, home, seek, restore] = &counts[..] else { anyhow::bail!("{} regions: expected 4", counts.len()) };
        let times = |count: u64| count as f64 / cost.steps as f64;
        back.push(times(home));
        restores.push(restore as f64);
        let seeks = [seek, restore].map(|count| count.to_string());
        rows.push(
            [vec![clip.name.clone(), format!("{:.2}", times(forth)), format!("{:.2}", times(home))], seeks.into()].concat(),
        );
    }
    table::print(&["clip, with memory lent", "forth / step", "back / step", "seek to the end", "to a snapshot"], &rows);
    Ok(vec![
        Goal::at_most(
            "Cortex-M3: stepping back with a seek cache, relative to stepping forward, mean",
            mean(&back).unwrap_or(0.0),
            5.0,
            2,
            "",
        ),
        Goal::at_most(
            "Cortex-M3: instructions of a seek to a cached snapshot, worst clip",
            restores.into_iter().fold(0.0, f64::max),
            15_000.0,
            0,
            "",
        ),
    ])
}

/// What a clip costs on a machine.
pub fn cost(guest: &Guest, bytes: &[u8], path: &Path) -> Result<Cost> {
    let (moving, segments) = passed(bytes)?;
    let counts = guest.counts(Some(path))?;
    let [open, steps @ .., seek] = &counts[..] else { anyhow::bail!("{} regions: expected at least 2", counts.len()) };
    ensure!(!steps.is_empty() && moving > 0, "nothing moves");
    let channels = moving as f64;
    Ok(Cost {
        open: *open,
        steps: steps.iter().sum(),
        mean: steps.iter().sum::<u64>() as f64 / steps.len() as f64 / channels,
        first: steps[0] as f64 / channels,
        worst: steps[1..].iter().copied().max().unwrap_or(0) as f64 / channels,
        segment: *seek as f64 / segments as f64,
    })
}

/// Moving channels of a clip, and the segments that a player passes from its first to its last frame.
fn passed(bytes: &[u8]) -> Result<(usize, usize)> {
    let clip = Clip::new_checked(bytes)?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let moving = states.len();
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let (mut before, mut segments) = (dues(&player), 0);
    for _ in 1..clip.frames() {
        player.step();
        let now = dues(&player);
        segments += before.iter().zip(&now).filter(|(before, now)| before != now).count();
        before = now;
    }
    ensure!(before.len() == moving, "the player's debug form lists {} channels of {moving}", before.len());
    Ok((moving, segments.max(1)))
}

/// The frame at which each channel's segment ends, which changes with each segment: told by the debug form alone.
fn dues(player: &Player) -> Vec<u8> {
    let text = format!("{player:?}");
    text.split("due: ").skip(1).filter_map(|rest| rest.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()).collect()
}

fn print(clips: &[Played], costs: &[Cost]) {
    let rows: Vec<_> = clips
        .iter()
        .zip(costs)
        .map(|(clip, cost)| {
            let mut row = vec![clip.name.clone()];
            row.extend([cost.mean, cost.first, cost.worst, cost.segment].map(|number| format!("{number:.1}")));
            row.push(cost.open.to_string());
            row
        })
        .collect();
    table::print(&["clip", "a pose", "first", "worst frame", "seek, a segment", "open, in all"], &rows);
}

fn judge(core: &str, most: Option<Most>, costs: &[Cost]) -> Vec<Goal> {
    let all = |of: fn(&Cost) -> f64| costs.iter().map(of).collect::<Vec<_>>();
    let worst = |values: Vec<f64>| values.into_iter().fold(0.0, f64::max);
    let average = mean(&all(|cost| cost.mean)).unwrap_or(0.0);
    let what = |what: &str| format!("{core}: instructions per moving channel, {what}");
    let pose = what(&format!("a pose, mean of {} clips at {BOUND_CM} cm", costs.len()));
    let Some(Most { pose: most, worst: most_worst, segment: seek }) = most else {
        return vec![Goal::told(pose, format!("{average:.1}"))];
    };
    vec![
        Goal::at_most(pose, average, most, 1, ""),
        Goal::at_most(what("a pose of the worst clip"), worst(all(|cost| cost.mean)), most_worst, 1, ""),
        Goal::at_most(what("the worst frame"), worst(all(|cost| cost.worst)), 160.0, 1, ""),
        Goal::at_most(what("the first frame, worst clip"), worst(all(|cost| cost.first)), 300.0, 1, ""),
        Goal::at_most(
            format!("{core}: instructions of a seek, per segment passed, worst clip"),
            worst(all(|cost| cost.segment)),
            seek,
            1,
            "",
        ),
    ]
}

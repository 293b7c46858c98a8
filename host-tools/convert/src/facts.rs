//! Describes how a clip codes each joint and what memory it takes to play and draw it: for `pantin info` and exported source text.

use crate::encode::entropy::{Alphabet, Sink, cost};
use crate::encode::segment::{Running, Segment};
use anyhow::Result;
use pantin::codec::layout::{BANK_MAGIC, MAGIC, START_MODE, segment_type};
use pantin::codec::segment::{SLOPE, step};
use pantin::{Bank, ChannelState, Clip, Kind, Player};
use pantin_figure::{Canvas, FigureRenderer, JointInfo};

/// What a file of pantin's format holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// One clip (`.ptn`).
    Clip,
    /// Clips of one rig (`.ptb`).
    Bank,
}

impl FileKind {
    /// What the first bytes of a file say; `None` for other files.
    pub fn of(bytes: &[u8]) -> Option<FileKind> {
        let kinds = [(MAGIC, FileKind::Clip), (BANK_MAGIC, FileKind::Bank)];
        kinds.into_iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, kind)| kind)
    }
}

/// Memory that playing and drawing a clip takes, in elements of the arrays that a program reserves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryNeeds {
    /// Channel states of a player.
    pub moving: usize,
    /// Values of a pose.
    pub channels: usize,
    /// Joints of the figure that is drawn, End Sites of drawn bones included and fingers and toes left out; 0 if the clip has no figure.
    pub figure_joints: usize,
    /// Elements of the workspace that sets the figure up: one for each joint of the rig, End Sites included.
    pub workspace: usize,
}

/// One number of [`MemoryNeeds`] under the name that it has in source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// The end of its name: `MOVING` of `WALK_MOVING`.
    pub name: &'static str,
    /// The name in reports: `moving`.
    pub field: &'static str,
    /// The number.
    pub value: usize,
    /// What it is, as a sentence.
    pub meaning: &'static str,
}

impl MemoryNeeds {
    /// The memory that `clip` takes.
    pub fn of(clip: &Clip<'_>) -> Result<MemoryNeeds> {
        let (moving, channels, workspace) = (clip.moving(), clip.rig().channels(), clip.rig().joint_count());
        let mut states = vec![ChannelState::default(); moving];
        let mut pose = vec![0; channels];
        let mut player = Player::new(*clip, &mut states, &mut pose)?;
        let mut renderer = Box::new(FigureRenderer::<{ pantin::codec::layout::MAX_JOINTS }>::empty());
        let canvas = Canvas { width: 128, height: 64 };
        // A clip of scalars alone has no figure, and none can be set up for it.
        let set_up = renderer.set_up(&mut player, canvas, &mut vec![JointInfo::default(); workspace]);
        let figure_joints = if set_up.is_ok() { renderer.skeleton().bones.len() } else { 0 };
        Ok(MemoryNeeds { moving, channels, figure_joints, workspace })
    }

    /// The most that any clip of `bank` takes, number by number. Fails for a bank with a damaged clip.
    pub fn of_bank(bank: &Bank<'_>) -> Result<MemoryNeeds> {
        bank.entries().try_fold(MemoryNeeds { moving: 0, channels: 0, figure_joints: 0, workspace: 0 }, |most, entry| {
            let of_clip = MemoryNeeds::of(&bank.open(&entry)?)?;
            Ok(MemoryNeeds {
                moving: most.moving.max(of_clip.moving),
                channels: most.channels.max(of_clip.channels),
                figure_joints: most.figure_joints.max(of_clip.figure_joints),
                workspace: most.workspace.max(of_clip.workspace),
            })
        })
    }

    /// All numbers with their names in source text, which are the same in C and in Rust.
    pub fn sizes(&self) -> [Size; 4] {
        let size = |name, field, value, meaning| Size { name, field, value, meaning };
        [
            size("CHANNELS", "channels", self.channels, "Values of a pose."),
            size("MOVING", "moving", self.moving, "Channel states that a player needs."),
            size(
                "FIGURE_JOINTS",
                "figure_joints",
                self.figure_joints,
                "Joints of the figure: `N` of a `pantin_figure::FigureRenderer`. 0 if the clip has no figure.",
            ),
            size(
                "WORKSPACE",
                "workspace",
                self.workspace,
                "Elements of the workspace that sets the figure up: one `pantin_figure::JointInfo` for each joint of the rig.",
            ),
        ]
    }

    /// Bytes of a player's channel states and pose on any machine.
    pub fn player_bytes(&self) -> usize {
        self.moving * size_of::<ChannelState>() + self.channels * size_of::<i32>()
    }

    /// Bytes of the workspace.
    pub fn workspace_bytes(&self) -> usize {
        self.workspace * size_of::<JointInfo>()
    }
}

/// Segments of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segments {
    /// Those that a seek from frame 0 to the last frame of `frames` passes.
    pub count: usize,
    /// Frames in which they were counted: the clip's, or fewer of a clip that takes too long to play.
    pub frames: u32,
}

/// Most values of moving channels that are played to count segments: about half a second.
const MOST_COUNTED: u64 = 1 << 26;

/// Keys of all channels of a key clip; `None` for another clip.
pub fn keys(clip: &Clip<'_>) -> Result<Option<usize>> {
    if !clip.has_keys() {
        return Ok(None);
    }
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let player = Player::new(*clip, &mut states, &mut pose)?;
    let keys = (0..player.states().len()).filter_map(|index| player.channel_keys(index));
    Ok(Some(keys.map(|keys| keys.iter().count()).sum()))
}

/// Counts the segments of a clip, of which a key clip has none: in all of its frames, or in as many as take half a second.
pub fn segments(clip: &Clip<'_>) -> Result<Segments> {
    segments_within(clip, MOST_COUNTED)
}

fn segments_within(clip: &Clip<'_>, most: u64) -> Result<Segments> {
    if clip.has_keys() {
        return Ok(Segments { count: 0, frames: clip.frames() });
    }
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(*clip, &mut states, &mut pose)?;
    let mut due: Vec<u8> = player.states().iter().map(ChannelState::due).collect();
    let frames = (most / (due.len() as u64 + 1)).clamp(1, clip.frames().into()) as u32;
    let mut count = 0;
    for _ in 1..frames {
        player.step();
        for (due, state) in due.iter_mut().zip(player.states()) {
            // A channel that follows reads none: it copies its leader's.
            count += usize::from(*due != state.due() && state.follows().is_none());
            *due = state.due();
        }
    }
    Ok(Segments { count, frames })
}

/// Adds up what symbols cost by their probabilities.
#[derive(Default)]
struct Bits(f64);

impl Sink for Bits {
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32) {
        self.0 += cost(alphabet.table(), symbol);
    }

    fn bits(&mut self, _: u32, count: u32) {
        self.0 += f64::from(count);
    }
}

/// Bits that the segments of each channel of the pose take in the clip's file, by the probabilities of their symbols; 0 for a channel that has none of its
/// own. How channels begin is not in it, nor are the head and the CRCs.
pub fn segment_bits(clip: &Clip<'_>) -> Result<Vec<f64>> {
    if clip.has_keys() {
        return Ok(vec![0.0; clip.rig().channels()]);
    }
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(*clip, &mut states, &mut pose)?;
    let begin = |state: &ChannelState| {
        let [v, w, k] = state.rates();
        (state.due(), Running { v, w, k, turn: 0, mode: START_MODE, step: state.step_index().unwrap_or(0) })
    };
    let mut running: Vec<(u8, Running)> = player.states().iter().map(begin).collect();
    let mut bits = vec![0.0; clip.rig().channels()];
    for _ in 1..clip.frames() {
        player.step();
        for (state, (due, before)) in player.states().iter().zip(&mut running) {
            if *due == state.due() || state.follows().is_some() {
                continue;
            }
            *due = state.due();
            let mode = state.mode();
            let (length, kind) = (mode & 15, mode >> 4);
            let [_, w, k] = state.rates();
            let steps = |value: i32, unit: u32| value / unit.max(1) as i32;
            let has = |kinds: [u8; 2]| kinds.contains(&kind);
            // The state is a frame past the segment's start: its acceleration has grown by the slope.
            let segment = Segment {
                mode,
                w: if has([segment_type::W, segment_type::WK]) { steps(w.wrapping_sub(k), step(length, before.step)) } else { 0 },
                k: if has([segment_type::K, segment_type::WK]) { steps(k, step(length | SLOPE, before.step)) } else { 0 },
            };
            let mut sum = Bits::default();
            before.put_mode(mode, &mut sum);
            before.start(segment, Some(&mut sum));
            before.run(segment.length());
            if let Some(bits) = bits.get_mut(state.slot()) {
                *bits += sum.0;
            }
        }
    }
    Ok(bits)
}

/// Time of a seek for each segment that it passes, on a Cortex-M0 of 48 MHz at one instruction a cycle: 360 instructions (docs/BENCHMARKS.md).
pub const SEEK_MS_PER_SEGMENT: f64 = 360.0 / 48_000.0;
/// Most segments that a seek should pass: they take that processor a frame's time at 30 frames a second.
const SEEK_SEGMENTS: usize = 4444;

/// The greatest spacing of snapshots, in seconds, with which no seek passes more than `SEEK_SEGMENTS`; `None` for a clip that needs none.
pub fn index_spacing(seconds: f64, segments: usize) -> Option<f64> {
    let spacing = seconds * SEEK_SEGMENTS as f64 / segments as f64;
    (segments > SEEK_SEGMENTS).then(|| ((spacing * 10.0).floor() / 10.0).max(0.1))
}

/// What a channel of a pose is and does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// The kind as the clip codes it: not the rig's where Euler angles are coded as an exponential map.
    pub kind: Kind,
    /// What the channel does over the clip.
    pub status: Status,
}

/// What a channel does over a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It keeps its value.
    Constant,
    /// It has segments of its own.
    Moving,
    /// It has the values of the channel of this index.
    Follows(usize),
}

/// The channels of a clip's pose, in its order.
pub fn channels(clip: &Clip<'_>) -> Result<Vec<Channel>> {
    let rig = clip.rig();
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; rig.channels()];
    let player = Player::new(*clip, &mut states, &mut pose)?;
    let kinds = (0..rig.joint_count()).flat_map(|joint| clip.kinds(joint));
    let kinds = kinds.chain(rig.scalars().map(|_| Kind::Scalar));
    let mut channels: Vec<Channel> = kinds.map(|kind| Channel { kind, status: Status::Constant }).collect();
    let states = player.states();
    for (index, state) in states.iter().enumerate() {
        let leader = state.follows().filter(|_| !clip.has_keys()).and_then(|back| states.get(index.checked_sub(back)?));
        if let Some(channel) = channels.get_mut(state.slot()) {
            channel.status = leader.map_or(Status::Moving, |leader| Status::Follows(leader.slot()));
        }
    }
    Ok(channels)
}

/// How kinds rotate a joint, as words: `Euler angles ZXY`, `exponential map`, `quaternion`; empty if they do not.
pub fn rotation(kinds: &[Kind]) -> String {
    let order: String = kinds.iter().filter(|kind| kind.is_rotation()).filter_map(|kind| axis(*kind)).collect();
    let mut parts = Vec::new();
    if !order.is_empty() {
        parts.push(format!("Euler angles {order}"));
    }
    if kinds.iter().any(|kind| kind.is_exponential()) {
        parts.push("exponential map".into());
    }
    if kinds.iter().any(|kind| kind.is_quaternion()) {
        parts.push("quaternion".into());
    }
    parts.join(", ")
}

/// Which of the position channels kinds have: `XYZ`.
pub fn positions(kinds: &[Kind]) -> String {
    kinds.iter().filter(|kind| kind.is_position()).filter_map(|kind| axis(*kind)).collect()
}

fn axis(kind: Kind) -> Option<char> {
    ['X', 'Y', 'Z'].get(kind.axis()?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode::{clip, rig};
    use crate::expand;
    use crate::fit::fit;
    use crate::fit::level::Level;
    use crate::pose_bound::PoseBound;

    #[test]
    fn bits_of_segments_are_those_that_the_encoder_wrote() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.ptn");
        let bytes = std::fs::read(path).unwrap();
        let motion = expand::expand(&Clip::new_checked(&bytes).unwrap()).unwrap();
        let motion = crate::motion::Motion { looped: false, ..motion };
        let coded = fit(&motion, Level::FAST.plan(PoseBound::places(0.5)), 0.02, &mut |_| ()).unwrap();
        let figure = rig::encode(&motion.rig).unwrap();
        let file = clip::encode(&coded, &figure, false).unwrap();
        let opened = Clip::new_checked(&file).unwrap();
        let found = segment_bits(&opened).unwrap();

        // Without segments, the symbols are those of the starts.
        let parsed = pantin::Rig::new_checked(&figure).unwrap();
        let (mut all, mut starts) = (Bits::default(), Bits::default());
        clip::symbols(&coded, &parsed, &mut all);
        clip::symbols(&clip::Coded { frames: 1, ..coded.clone() }, &parsed, &mut starts);
        let sum: f64 = found.iter().sum();
        assert!((sum - (all.0 - starts.0)).abs() < 1e-6 * all.0, "{sum}, not {}", all.0 - starts.0);
        // rANS takes what the probabilities say, and its state's 4 bytes.
        let motion_bytes = file.len() - opened.rig_len() - opened.head_len() - opened.crc_len();
        assert!((all.0 / 8.0 - motion_bytes as f64).abs() < 16.0, "{} of {motion_bytes}", all.0 / 8.0);
        for (bits, channel) in found.iter().zip(&coded.channels) {
            assert_eq!(*bits > 0.0, !channel.segments.is_empty());
        }
    }

    #[test]
    fn clips_in_which_seeks_pass_many_segments_need_an_index() {
        assert_eq!([0, SEEK_SEGMENTS].map(|segments| index_spacing(60.0, segments)), [None; 2]);
        assert_eq!(index_spacing(60.0, 3 * SEEK_SEGMENTS), Some(20.0));
        assert_eq!(index_spacing(60.0, 14_000), Some(19.0));
        assert_eq!(index_spacing(0.2, 100 * SEEK_SEGMENTS), Some(0.1));
    }
}

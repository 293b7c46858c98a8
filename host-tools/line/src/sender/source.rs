//! A clip taken apart: what its channels are, their segments, and the states that these give frame by frame.

use pantin::Form;
use pantin::codec::layout::{START_MODE, segment_type};
use pantin::codec::segment;
use pantin::{ChannelState, Clip, Player, TooSmall};
use pantin_link::{ChannelKind, EXPONENTIAL_BYTES, Head, MAX_PACE, fits, pace};

/// A segment of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Segment {
    pub frame: u32,
    pub mode: u8,
    /// New acceleration and slope in steps, 0 where the type has none.
    pub w: i32,
    pub k: i32,
}

/// A channel that moves and leads itself.
#[derive(Clone, Debug)]
pub(crate) struct MovingChannel {
    pub channel: u16,
    pub step: u8,
    pub segments: Vec<Segment>,
    /// p, v, w, k at every frame, once its segments are read.
    pub states: Vec<[i32; 4]>,
}

/// A clip as it is sent.
#[derive(Clone, Debug)]
pub struct Source {
    /// What the head says; session, clip and begin are the sender's.
    pub(crate) head: Head,
    pub(crate) starts: Vec<ChannelKind>,
    pub(crate) tracks: Vec<MovingChannel>,
    /// Frame, id and name of each event.
    pub(crate) events: Vec<(u32, u32, String)>,
}

/// Why a clip cannot be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceError {
    /// More joints have a choice of how they turn than a head has bits for; `--rotations euler` makes a clip that leaves it.
    Exponentials,
    /// It is a key clip, whose segments exist only in the player.
    Keys,
    /// It does not open.
    Player(TooSmall),
}

impl core::fmt::Display for SourceError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            SourceError::Exponentials => write!(
                f,
                "more than {} joints could be exponential maps; `pantin convert --rotations euler` makes a clip that can be sent",
                8 * EXPONENTIAL_BYTES
            ),
            SourceError::Keys => {
                write!(f, "a key clip cannot be sent as segments; `pantin convert --segments` makes a clip that can")
            }
            SourceError::Player(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for SourceError {}

/// Half a second: in as long what is drawn has joined the state.
const JOIN_NS: u64 = 500_000_000;

impl Source {
    /// Takes a clip apart.
    pub fn new(clip: &Clip<'_>) -> Result<Source, SourceError> {
        if clip.has_keys() {
            return Err(SourceError::Keys);
        }
        let channels = clip.rig().channels();
        let (mut states, mut pose) = (vec![ChannelState::default(); clip.moving()], vec![0; channels]);
        let mut player = Player::new(*clip, &mut states, &mut pose).map_err(SourceError::Player)?;
        let join = (JOIN_NS / u64::from(clip.frame_time_ns())).max(1);
        let mut starts: Vec<ChannelKind> = player.pose().values.iter().map(|&p| ChannelKind::Constant(p)).collect();
        let mut tracks = vec![];
        for (index, state) in player.states().iter().enumerate() {
            if let Some(step) = state.step_index() {
                let channel = state.slot() as u16;
                tracks.push((index, MovingChannel { channel, step, segments: vec![], states: vec![] }));
            } else if let Some(leader) = state.follows().and_then(|back| player.states().get(index.checked_sub(back)?)) {
                starts[state.slot()] = ChannelKind::Follower((state.slot() - leader.slot()) as u16);
            }
        }
        record(&mut player, &mut tracks);
        let tracks: Vec<MovingChannel> = tracks.into_iter().map(|(_, track)| track).collect();
        for track in &tracks {
            starts[usize::from(track.channel)] = ChannelKind::Moving { step: track.step, pace: track.pace(join) };
        }
        let events = clip.events().filter(|event| event.frame < clip.frames());
        let events = events.map(|event| (event.frame, event.id, clip.event_name(event.id).unwrap_or_default().to_owned()));
        Ok(Source { head: head_of(clip)?, starts, tracks, events: events.collect() })
    }

    /// Frames of the clip.
    pub fn frames(&self) -> u32 {
        self.head.frames
    }

    /// Channels of a pose.
    pub fn channels(&self) -> usize {
        self.starts.len()
    }

    /// What its values mean.
    pub fn form(&self) -> Form {
        self.head.form
    }

    /// Seconds of a frame.
    pub fn frame_seconds(&self) -> f64 {
        f64::from(self.head.frame_time_ns) / 1e9
    }

    /// Seconds that the clip plays.
    pub fn seconds(&self) -> f64 {
        f64::from(self.head.frames) * self.frame_seconds()
    }

    /// Returns the states that every synchronized receiver has for a line of this cycle: for each transmitted channel its place in the pose, and p, v, w, k by frame.
    pub fn expected_states(&self, cycle: u32) -> Vec<(u16, Vec<[i32; 4]>)> {
        super::refresh::expected_states(self, cycle)
    }

    /// The greatest distance of what is played from the file's, in parts of the channel's step, and of which channel of the pose.
    pub fn deviation(&self, cycle: u32) -> (f64, u16) {
        let off = |(track, (channel, states)): (&MovingChannel, (u16, Vec<[i32; 4]>))| {
            let apart = track.states.iter().zip(&states).map(|(a, b)| a[0].wrapping_sub(b[0]).unsigned_abs()).max();
            (f64::from(apart.unwrap_or(0)) / f64::from(pantin::codec::step_size(track.step)), channel)
        };
        self.tracks.iter().zip(self.expected_states(cycle)).map(off).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0))
    }

    /// Returns the number of transmitted channels.
    pub fn moving_channels(&self) -> usize {
        self.tracks.len()
    }
}

fn head_of(clip: &Clip<'_>) -> Result<Head, SourceError> {
    Ok(Head {
        form: Some(clip.form()).filter(fits).ok_or(SourceError::Exponentials)?,
        frames: clip.frames(),
        looped: clip.looped(),
        frame_time_ns: clip.frame_time_ns(),
        channels: clip.rig().channels() as u16,
        ..Head::default()
    })
}

/// Plays the clip and writes down what it reads.
fn record(player: &mut Player<'_, '_>, tracks: &mut [(usize, MovingChannel)]) {
    let frames = player.clip().frames();
    for frame in 0..frames {
        let before: Vec<(i32, ChannelState)> =
            player.states().iter().map(|state| (player.pose().values[state.slot()], *state)).collect();
        let last = frame + 1 == frames;
        if !last {
            player.step();
        }
        for (index, track) in tracks.iter_mut() {
            let (p, was) = before[*index];
            let [_, w, k] = player.states()[*index].rates();
            let w = if last { w } else { w.wrapping_sub(k) };
            track.states.push([p, was.rates()[0], w, k]);
            // A segment at a frame first moves the position two frames later.
            if frame + 2 < frames && was.due() == frame as u8 {
                let mode = player.states()[*index].mode();
                track.segments.push(track.segment(frame, mode, w, k));
            }
        }
    }
    for (_, track) in tracks.iter_mut().filter(|(_, track)| track.segments.is_empty()) {
        track.segments.push(Segment { frame: 0, mode: segment_type::CARRY << 4, w: 0, k: 0 });
    }
}

impl MovingChannel {
    fn segment(&self, frame: u32, mode: u8, w: i32, k: i32) -> Segment {
        if mode >> 4 == segment_type::CARRY
            && k != 0
            && let Some(before) = self.segments.last()
        {
            // A message that is lost must not take the slope with it.
            return Segment { frame, mode: segment_type::K << 4 | before.mode & 15, w: 0, k: before.k };
        }
        let new = pantin_link::Message { mode: mode.min(START_MODE - 1), ..Default::default() }.is_new();
        // Both are multiples: no well-formed clip's wrap.
        let steps = |new: bool, value: i32, which: u8| if new { value / segment::step(which, self.step) as i32 } else { 0 };
        let which = mode & 15;
        Segment { frame, mode, w: steps(new[0], w, which), k: steps(new[1], k, which | segment::SLOPE) }
    }

    /// Index of the pace that brings the drawn value from one end of the channel's way to the other in `join` frames, and is twice its
    /// greatest speed.
    fn pace(&self, join: u64) -> u8 {
        let ps = || self.states.iter().map(|state| i64::from(state[0]));
        // Angles go over the seam of their range by the shortest way.
        let way = (ps().max().unwrap_or(0) - ps().min().unwrap_or(0)).min(1 << 31) as u64;
        let speed = self.states.iter().map(|state| u64::from(state[1].unsigned_abs())).max().unwrap_or(0);
        let wanted = (2 * speed).max((3 * way + 64).div_ceil(join));
        (0..=MAX_PACE).find(|&index| pace(index) as u64 >= wanted).unwrap_or(MAX_PACE)
    }
}

//! Plays a clip: step, seek to any frame, step back. Bit for bit the same poses by every route.

use crate::channel::ChannelState;
use crate::clip::Clip;
use crate::entropy::{Cursor, Symbols};
use crate::history::{History, Undo};
use crate::play_state::{Channels, PlayState, reads};
use crate::snapshots::{SnapshotPos, Snapshots};
use crate::start::{ChannelStarts, Opened};
use crate::{TooSmall, index};

/// Plays a [`Clip`] in memory of the caller's: a [`ChannelState`] for each of the clip's moving channels, and a pose of
/// one raw value for each of the rig's channels.
///
/// ```
/// # fn play(clip: pantin::Clip) -> Result<(), pantin::TooSmall> {
/// let (mut states, mut pose) = ([pantin::ChannelState::default(); 80], [0; 100]);
/// let mut player = pantin::Player::new(clip, &mut states, &mut pose)?;
/// while !player.ended() {
///     player.step();
///     let knee = pantin::units::angle(player.pose()[7]);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Player<'a, 'm> {
    clip: Clip<'a>,
    states: &'m mut [ChannelState],
    pose: &'m mut [i32],
    position: PlayState,
}

/// Memory lent to a [`Player`] that steps back or seeks much. What is kept in it is of that player's clip alone.
#[derive(Debug)]
pub struct SeekCache<'m> {
    history: History<'m>,
    snapshots: Snapshots<'m>,
}

impl<'m> SeekCache<'m> {
    /// `undo` holds a record for each segment read of late: with one a moving channel it reaches back about 8 frames of lively
    /// motion, and everything beyond is played anew. Each snapshot takes one of `marks` and as many of `states` and `values` as
    /// the clip has moving channels. Any of them may be empty.
    pub fn new(
        player: &Player<'_, '_>,
        undo: &'m mut [Undo],
        marks: &'m mut [SnapshotPos],
        states: &'m mut [ChannelState],
        values: &'m mut [i32],
    ) -> SeekCache<'m> {
        let snapshots = Snapshots::new(marks, states, values, player.states.len(), player.clip.frames());
        SeekCache { history: History::new(undo), snapshots }
    }
}

/// Reads how channels start, up to the last position at which a start is sure to be whole: where the segments begin, and how many channels
/// move; as many as `usize` holds if there are more than `states`, or if not all of them are there.
#[inline(never)]
fn open(clip: &Clip<'_>, dry_at: u32, states: &mut [ChannelState], pose: &mut [i32]) -> (Cursor, usize) {
    let input = clip.input();
    let mut starts = ChannelStarts::new(&clip.rig(), clip.length_exponent());
    let mut symbols = Symbols { at: Cursor::start(&input, clip.symbols()), input };
    let opened = starts.read(&mut symbols, dry_at, states, pose);
    (symbols.at, if opened == Opened::Done { usize::from(starts.moving) } else { usize::MAX })
}

impl<'a, 'm> Player<'a, 'm> {
    /// Starts at frame 0. `states` needs [`Clip::moving`] elements, `pose` needs [`crate::Rig::channels`].
    pub fn new(clip: Clip<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Self, TooSmall> {
        let pose = pose.get_mut(..clip.rig().channels()).ok_or(TooSmall { needed: clip.rig().channels() })?;
        let (cursor, moving) = open(&clip, u32::MAX, states, pose);
        let states = states.get_mut(..moving).ok_or_else(|| TooSmall { needed: clip.moving() })?;
        Ok(Player { clip, states, pose, position: PlayState { cursor, frame: 0, next: 0 } })
    }

    /// [`Player::new`], for a clip of which the front alone may be there; `None` while its channels' starts have not come. `states` needs
    /// [`crate::Rig::channels`] elements.
    pub(crate) fn from_partial(
        clip: Clip<'a>,
        dry_at: u32,
        states: &'m mut [ChannelState],
        pose: &'m mut [i32],
    ) -> Result<Option<Self>, TooSmall> {
        let needed = clip.rig().channels();
        let (Some(states), Some(pose)) = (states.get_mut(..needed), pose.get_mut(..needed)) else {
            return Err(TooSmall { needed });
        };
        let (cursor, moving) = open(&clip, dry_at, states, pose);
        let Some(states) = states.get_mut(..moving) else { return Ok(None) };
        Ok(Some(Player { clip, states, pose, position: PlayState { cursor, frame: 0, next: 0 } }))
    }

    /// Goes on by one frame if its segments have come: those that begin at `dry_at` at the latest.
    pub(crate) fn step_partial(&mut self, clip: &Clip<'a>, dry_at: u32) -> bool {
        self.clip.motion = clip.motion;
        if self.ended() {
            return false;
        }
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let (position, mut channels) = self.parts();
        if reads(position.frame, frames) && !position.read_due(&mut channels, &input, dry_at, None) {
            return false;
        }
        position.advance(&mut channels);
        true
    }

    /// Seeks in `clip`, which is the same one: more of it may have come.
    pub(crate) fn seek_partial(&mut self, clip: &Clip<'a>, frame: u32, memory: &mut SeekCache<'_>) {
        self.clip.motion = clip.motion;
        self.go::<false>(frame, Some(&mut memory.snapshots));
    }

    /// The clip that plays.
    pub fn clip(&self) -> &Clip<'a> {
        &self.clip
    }

    /// The frame that the pose shows.
    pub fn frame(&self) -> u32 {
        self.position.frame
    }

    /// Whether this is the last frame: the next step goes to frame 0.
    pub fn ended(&self) -> bool {
        self.position.frame + 1 >= self.clip.frames()
    }

    /// One raw value a channel of the rig. The channel's kind says what it is (see [`crate::units`]): an angle in 2^-32
    /// turns, a position in 2^[`Clip::length_exponent`] units of the source, a quaternion's component in 2^-30, a scalar in
    /// 2^([`crate::Scalar::exponent`] - 31).
    pub fn pose(&self) -> &[i32] {
        self.pose
    }

    /// The moving channels, in the order of the pose; before the segments that begin at this frame are read.
    pub fn states(&self) -> &[ChannelState] {
        self.states
    }

    /// The ids of the event markers at this frame.
    pub fn events(&self) -> impl Iterator<Item = u32> + '_ {
        self.clip.events().filter(|event| event.frame == self.position.frame).map(|event| event.id)
    }

    fn parts(&mut self) -> (&mut PlayState, Channels<'_>) {
        (&mut self.position, Channels { states: &mut *self.states, pose: &mut *self.pose })
    }

    /// Goes on by one frame; from the last frame to frame 0.
    #[inline(never)]
    pub fn step(&mut self) {
        if self.ended() {
            return self.rewind();
        }
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let (position, mut channels) = self.parts();
        if reads(position.frame, frames) {
            position.step(&mut channels, &input);
        } else {
            position.advance(&mut channels);
        }
    }

    /// Goes back to frame 0.
    pub fn rewind(&mut self) {
        // The memory sufficed when the player was made.
        let (cursor, _) = open(&self.clip, u32::MAX, self.states, self.pose);
        self.position = PlayState { cursor, frame: 0, next: 0 };
    }

    /// Goes to `frame`, or to the last one if there are fewer. Forward it costs a hop a segment on the way; backward it
    /// starts from the file's last snapshot before it (`pantin convert --index`), or from frame 0.
    pub fn seek(&mut self, frame: u32) {
        self.go::<true>(frame, None);
    }

    /// [`Player::step`], and keeps what going back needs.
    pub fn step_with(&mut self, memory: &mut SeekCache<'_>) {
        if self.ended() {
            return self.rewind();
        }
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let (position, mut channels) = self.parts();
        memory.history.begin(position.frame);
        if reads(position.frame, frames) {
            position.read_due(&mut channels, &input, u32::MAX, Some(&mut memory.history));
        }
        position.advance(&mut channels);
        memory.snapshots.keep(position, &channels);
    }

    /// [`Player::seek`], from the nearest snapshot in `memory` if that is closer; keeps the snapshots that it comes past.
    pub fn seek_with(&mut self, frame: u32, memory: &mut SeekCache<'_>) {
        self.go::<true>(frame, Some(&mut memory.snapshots));
    }

    /// `STORED` tells whether snapshots in the file serve too.
    #[inline(never)]
    fn go<const STORED: bool>(&mut self, frame: u32, mut snapshots: Option<&mut Snapshots<'_>>) {
        let (input, frames, index) = (self.clip.input(), self.clip.frames(), self.clip.index().filter(|_| STORED));
        let target = frame.min(frames - 1);
        let now = self.position.frame;
        let mut from = if now <= target { now } else { 0 };
        let stored = index.and_then(|index| index::nearest(&index, target)).filter(|entry| entry.frame > from);
        from = stored.map_or(from, |entry| entry.frame);
        let kept = snapshots.as_ref().and_then(|snapshots| snapshots.nearest(target)).filter(|&(_, frame)| frame > from);
        if let (Some((kept, _)), Some(snapshots)) = (kept, &snapshots) {
            let (position, mut channels) = self.parts();
            snapshots.restore(kept, position, &mut channels);
        } else if let (Some(entry), Some(index)) = (stored, index) {
            let (position, mut channels) = self.parts();
            index::restore(&index, entry, position, &mut channels);
        } else if target < now {
            self.rewind();
        }
        let (position, mut channels) = self.parts();
        while position.frame < target {
            let stop = snapshots.as_ref().map_or(target, |snapshots| snapshots.next_after(position.frame).min(target));
            position.run_to(&mut channels, &input, frames, stop);
            if let Some(snapshots) = &mut snapshots {
                snapshots.keep(position, &channels);
            }
        }
    }

    /// Goes back by one frame; from frame 0 to the last one. Takes back the additions and the segments in `memory`; where that
    /// does not reach, it plays some frames before anew.
    pub fn step_back(&mut self, memory: &mut SeekCache<'_>) {
        let Some(target) = self.position.frame.checked_sub(1) else { return self.seek_with(u32::MAX, memory) };
        let (position, mut channels) = self.parts();
        if memory.history.step_back(position, &mut channels) {
            return;
        }
        let again = memory.history.refill();
        self.seek_with(target.saturating_sub(again), memory);
        while self.position.frame < target {
            self.step_with(memory);
        }
    }

    /// Writes a snapshot of this frame, as `pantin convert --index` puts it into a file.
    pub fn write_snapshot(&self, put: &mut dyn FnMut(u8)) {
        index::write(&self.position, self.states, self.pose, put);
    }
}

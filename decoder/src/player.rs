//! Plays a clip: step, seek to any frame, step back, whichever way to bit for bit the same poses.

use crate::channel::ChannelState;
use crate::clip::Clip;
use crate::clock::Clock;
use crate::error::Memory;
use crate::form::WrongForm;
use crate::history::{History, Undo};
use crate::joint::JointRef;
#[cfg(feature = "keys")]
use crate::keys;
use crate::play_state::{Channels, PlayState};
use crate::pose::Pose;
use crate::scalar::ScalarRef;
use crate::snapshots::{SnapshotPos, Snapshots};
use crate::turn::Turn;
use crate::units::Fraction;
use crate::{TooSmall, index, seam};
use fixed::types::U0F16;

/// Plays a [`Clip`] in memory of the caller's: a [`ChannelState`] for each of the clip's moving channels, and one raw value for
/// each of the rig's channels. [`crate::Room`] holds both.
///
/// ```
/// # fn play(clip: pantin::Clip) -> Result<(), Box<dyn std::error::Error>> {
/// let (mut states, mut values) = ([pantin::ChannelState::NEW; 80], [0; 100]);
/// let mut player = pantin::Player::new(clip, &mut states, &mut values)?;
/// let knee = clip.find("LeftKnee").ok_or("no knee")?;
/// let order = knee.euler_order().unwrap_or(pantin::EulerOrder::ZXY);
/// for _ in 0..clip.frames() {
///     let [a, b, c] = player.turn(&knee)?.euler(order).map(|angle| angle.centidegrees());
///     println!("frame {}: {a} {b} {c} hundredths of a degree, in the order {order:?}", player.frame());
///     player.step();
/// }
/// # Ok(())
/// # }
/// ```
///
/// [`Player::step`] plays frame by frame, [`Player::advance`] by time. Several players can play at once, each in memory of its own.
#[derive(Debug)]
pub struct Player<'a, 'm> {
    clip: Clip<'a>,
    states: &'m mut [ChannelState],
    pose: &'m mut [i32],
    position: PlayState,
}

/// Most frames that [`Player::go_to`] steps; farther ones it seeks.
const NEAR: u32 = 8;

/// Memory lent to a [`Player`] that steps back or seeks much. What is kept in it is of that player's clip alone.
#[derive(Debug)]
pub struct SeekCache<'m> {
    history: History<'m>,
    snapshots: Snapshots<'m>,
}

impl<'m> SeekCache<'m> {
    /// `undo` holds a record for each recently read segment: with one record per moving channel it reaches back about 8 frames of lively
    /// motion, and earlier frames are replayed. Each snapshot takes one of `marks` and as many of `states` and `values` as
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

/// The part of `values` that a pose takes.
pub(crate) fn values(values: &mut [i32], needed: usize) -> Result<&mut [i32], TooSmall> {
    let given = values.len();
    values.get_mut(..needed).ok_or(TooSmall { memory: Memory::Values, needed, given })
}

impl<'a, 'm> Player<'a, 'm> {
    /// Starts at frame 0. `states` needs [`Clip::moving`] elements, `pose` needs [`crate::Rig::channels`].
    pub fn new(clip: Clip<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Self, TooSmall> {
        let pose = values(pose, clip.rig().channels())?;
        #[cfg(feature = "keys")]
        if clip.has_keys() {
            let (needed, given) = (clip.moving(), states.len());
            let states = states.get_mut(..needed).ok_or(TooSmall { memory: Memory::States, needed, given })?;
            let position = keys::open(&clip, states, pose);
            return Ok(Player { clip, states, pose, position });
        }
        let (cursor, moving) = clip.starts(u32::MAX, states, pose);
        let given = states.len();
        let states = states.get_mut(..moving).ok_or(TooSmall { memory: Memory::States, needed: moving, given })?;
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
        let pose = values(pose, needed)?;
        #[cfg(feature = "keys")]
        if clip.has_keys() {
            // All keys come before the first frame.
            return if dry_at == u32::MAX { Player::new(clip, states, pose).map(Some) } else { Ok(None) };
        }
        let given = states.len();
        let states = states.get_mut(..needed).ok_or(TooSmall { memory: Memory::States, needed, given })?;
        let (cursor, moving) = clip.starts(dry_at, states, pose);
        let Some(states) = states.get_mut(..moving) else { return Ok(None) };
        Ok(Some(Player { clip, states, pose, position: PlayState { cursor, frame: 0, next: 0 } }))
    }

    /// What a player is without the memory that it was lent: the number of moving channels, and where it is.
    pub(crate) fn pause(self) -> (usize, PlayState) {
        (self.states.len(), self.position)
    }

    /// Continues with the states and values that [`Player::pause`] left.
    pub(crate) fn resume(
        clip: Clip<'a>,
        moving: usize,
        position: PlayState,
        states: &'m mut [ChannelState],
        pose: &'m mut [i32],
    ) -> Option<Self> {
        let (states, pose) = (states.get_mut(..moving)?, pose.get_mut(..clip.rig().channels())?);
        Some(Player { clip, states, pose, position })
    }

    /// Goes on by one frame if its segments are there: those that begin at `dry_at` at the latest.
    pub(crate) fn step_partial(&mut self, clip: &Clip<'a>, dry_at: u32) -> bool {
        self.clip.motion = clip.motion;
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            let ended = self.ended();
            if !ended {
                self.step();
            }
            return !ended;
        }
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let (position, mut channels) = self.parts();
        position.try_step(&mut channels, &input, frames, dry_at, None)
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

    /// Whether this is the last frame, of a loop too: the next step goes to frame 0. ([`crate::Clock::ended`] is about time.)
    pub fn ended(&self) -> bool {
        self.position.frame + 1 >= self.clip.frames()
    }

    /// The pose of this frame, with its form.
    pub fn pose(&self) -> Pose<'_> {
        Pose { values: self.pose, form: self.clip.form_ref() }
    }

    /// The rotation of a joint at this frame, however the clip codes it: [`Pose::turn`].
    pub fn turn(&self, joint: &JointRef<'_>) -> Result<Turn, WrongForm> {
        self.pose().turn(joint)
    }

    /// A scalar at this frame as a fraction of its range: [`Pose::scalar`].
    pub fn scalar(&self, scalar: &ScalarRef) -> Result<Fraction, WrongForm> {
        self.pose().scalar(scalar)
    }

    /// Writes the pose between this frame and the next to `out`, which needs [`crate::Rig::channels`] elements: `part` of the way
    /// from one to the other, on a straight line a channel. 0 gives this frame's pose exactly.
    ///
    /// From the last frame of a loop the way leads to frame 0, for which the channels' starts are read again. A position that is more than 5 cm from its
    /// start by then goes on as it did, and so does a rotation that is more than an eighth of a turn away: a figure that travels or turns jumps back at
    /// frame 0. On the last frame of another clip, the motion goes on as it did.
    pub fn interpolate<'o>(&'o self, part: U0F16, out: &'o mut [i32]) -> Result<Pose<'o>, TooSmall> {
        let out = values(out, self.pose.len())?;
        if self.ended() && self.clip.looped() && part != U0F16::ZERO {
            seam::interpolate(&self.clip, self.states, self.states().len(), self.pose, part.to_bits(), out);
            return Ok(Pose { values: out, form: self.clip.form_ref() });
        }
        for (out, value) in out.iter_mut().zip(self.pose.iter()) {
            *out = *value;
        }
        for state in self.states() {
            // A segment that begins at this frame changes the velocity from the next one on: p + v is the next frame's p.
            if let Some(value) = out.get_mut(usize::from(state.slot)) {
                *value = value.wrapping_add(((i64::from(state.v) * i64::from(part.to_bits())) >> 16) as i32);
            }
        }
        Ok(Pose { values: out, form: self.clip.form_ref() })
    }

    /// Lets a time pass on `clock` and goes to the frame that is due. Returns whether that is another frame than before.
    pub fn advance(&mut self, clock: &mut Clock, elapsed_us: u32) -> bool {
        clock.advance(elapsed_us);
        let (before, due) = (self.frame(), clock.frame());
        self.go_to(due);
        before != due
    }

    /// Goes to `frame`, or to the last one if there are fewer: by steps if it is at most 8 frames ahead, else by [`Player::seek`].
    pub fn go_to(&mut self, frame: u32) {
        let ahead = frame.min(self.clip.frames() - 1).wrapping_sub(self.frame());
        if ahead > NEAR {
            self.seek(frame);
        } else {
            (0..ahead).for_each(|_| self.step());
        }
    }

    /// The moving channels, in the order of the pose; before the segments that begin at this frame are read.
    pub fn states(&self) -> &[ChannelState] {
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return self.states.get(..self.position.next.into()).unwrap_or(&[]);
        }
        self.states
    }

    /// The keys of a moving channel of a key clip, by its index in [`Player::states`]; `None` for another clip.
    #[cfg(feature = "keys")]
    pub fn channel_keys(&self, index: usize) -> Option<keys::ChannelKeys<'_>> {
        if !self.clip.has_keys() {
            return None;
        }
        let (moving, words) = self.states.split_at_checked(self.position.next.into())?;
        Some(keys::ChannelKeys::new(words, moving.get(index)?))
    }

    /// Whether the symbols of a key clip break a rule of FORMAT.md: its encoder is at fault, and the rig rests at all frames.
    #[cfg(feature = "keys")]
    pub fn is_malformed(&self) -> bool {
        self.clip.has_keys() && keys::is_malformed(&self.position)
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
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            let looped = self.clip.looped();
            let (position, mut channels) = self.parts();
            return keys::step(position, &mut channels, looped);
        }
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let (position, mut channels) = self.parts();
        position.step(&mut channels, &input, frames);
    }

    /// Goes back to frame 0.
    pub fn rewind(&mut self) {
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return self.seek_keys(0);
        }
        // The memory sufficed when the player was made.
        let (cursor, _) = self.clip.starts(u32::MAX, self.states, self.pose);
        self.position = PlayState { cursor, frame: 0, next: 0 };
    }

    /// Goes to a frame of a key clip, which takes as long for every frame.
    #[cfg(feature = "keys")]
    fn seek_keys(&mut self, frame: u32) {
        let looped = self.clip.looped();
        let (position, mut channels) = self.parts();
        keys::seek(position, &mut channels, frame, looped);
    }

    /// Goes to `frame`, or to the last one if there are fewer. It starts from this frame or, if that is later, from frame 0, or from the file's
    /// last snapshot before `frame` (`pantin convert --index`) if that is closer. Each segment on the way takes about 330 instructions on a
    /// Cortex-M0; `pantin info` suggests an index for clips that have many.
    pub fn seek(&mut self, frame: u32) {
        self.go::<true>(frame, None);
    }

    /// [`Player::step`], and keeps what going back needs.
    pub fn step_with(&mut self, memory: &mut SeekCache<'_>) {
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return self.step();
        }
        if self.ended() {
            return self.rewind();
        }
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let (position, mut channels) = self.parts();
        memory.history.begin(position.frame);
        position.try_step(&mut channels, &input, frames, u32::MAX, Some(&mut memory.history));
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
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return self.seek_keys(target);
        }
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
    /// does not reach, it replays some earlier frames.
    pub fn step_back(&mut self, memory: &mut SeekCache<'_>) {
        let Some(target) = self.position.frame.checked_sub(1) else { return self.seek_with(u32::MAX, memory) };
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return self.seek_keys(target);
        }
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
}

/// Writes a snapshot of the player's frame, as `pantin convert --index` puts it into a file.
pub fn write_snapshot(player: &Player<'_, '_>, put: &mut dyn FnMut(u8)) {
    index::write(&player.position, player.states, player.pose, put);
}

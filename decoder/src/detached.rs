//! A player apart from the memory that it plays in, for programs that keep both in one structure and change clips.

use crate::channel::ChannelState;
use crate::clip::Clip;
use crate::entropy::Cursor;
use crate::layout::START_MODE;
use crate::play_state::{Channels, PlayState};
use crate::player::Player;
use crate::pose::Pose;
use crate::seam;

/// A [`Player`] without its memory, which is lent call by call. A structure can hold it beside the memory, and give the memory to
/// the player of another clip later.
///
/// The memory has to be the same from call to call, as the player left it. In other memory the poses are wrong, and nothing panics.
#[derive(Clone, Copy, Debug)]
pub struct DetachedPlayer<'a> {
    clip: Clip<'a>,
    moving: u16,
    position: PlayState,
}

/// Where the motion of a clip begins: [`DetachedPlayer::loop_start`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopStart(Cursor);

impl<'a> Player<'a, '_> {
    /// Gives the memory back.
    pub fn detach(self) -> DetachedPlayer<'a> {
        let clip = *self.clip();
        let (moving, position) = self.pause();
        DetachedPlayer { clip, moving: moving as u16, position }
    }
}

impl<'a> DetachedPlayer<'a> {
    /// A player of a clip that has not begun: it is made in constant time and reads no starts. Before the clip plays, a player of [`Player::new`] has to take
    /// its place. `None` if the clip may need more states than these.
    pub fn idle(clip: Clip<'a>, states: usize) -> Option<DetachedPlayer<'a>> {
        #[cfg(feature = "keys")]
        let most = if clip.has_keys() { clip.moving() } else { clip.rig().channels() };
        #[cfg(not(feature = "keys"))]
        let most = clip.rig().channels();
        (most <= states).then_some(DetachedPlayer { clip, moving: most as u16, position: PlayState::default() })
    }

    /// The player in its memory again; `None` if there is less of it than before.
    pub fn attach<'m>(&self, states: &'m mut [ChannelState], values: &'m mut [i32]) -> Option<Player<'a, 'm>> {
        Player::resume(self.clip, self.moving.into(), self.position, states, values)
    }

    /// The clip that plays.
    pub fn clip(&self) -> &Clip<'a> {
        &self.clip
    }

    /// The frame that the pose shows.
    pub fn frame(&self) -> u32 {
        self.position.frame
    }

    /// Number of states in use: [`Clip::moving`].
    pub fn moving(&self) -> usize {
        self.moving.into()
    }

    /// Number of moving channels, whose states are the first ones. The states behind them hold the keys of a key clip.
    pub fn moving_channels(&self) -> usize {
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return self.position.next.into();
        }
        self.moving.into()
    }

    /// The pose of this frame, whose values are in the player's memory.
    pub fn pose<'p>(&self, values: &'p [i32]) -> Pose<'p>
    where
        'a: 'p,
    {
        Pose { values: values.get(..self.clip.rig().channels()).unwrap_or(values), form: self.clip.form_ref() }
    }

    /// Goes on by one frame; from the last frame to frame 0, as [`Player::step`].
    #[inline(never)]
    pub fn step(&mut self, states: &mut [ChannelState], values: &mut [i32]) {
        let (input, frames) = (self.clip.input(), self.clip.frames());
        if self.position.frame + 1 >= frames {
            return self.seek(0, states, values);
        }
        let Some(states) = states.get_mut(..self.moving.into()) else { return };
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            let looped = self.clip.looped();
            return crate::keys::step(&mut self.position, &mut Channels { states, pose: values }, looped);
        }
        self.position.step(&mut Channels { states, pose: values }, &input, frames);
    }

    /// [`DetachedPlayer::step`] of states to which other motions were added, such as what is left of a transition: to the channels' values, and to
    /// velocity, acceleration and slope ([`ChannelState::set_rates`]). These are linear, so that the sums go on as their parts do; but where a segment
    /// begins, `added` has to return the acceleration and slope that were added to the channel of an index in the pose, as they are at this frame. On the
    /// last frame, and in a key clip, it does nothing. Channels that follow others have to be as their leaders.
    #[inline(never)]
    pub fn step_added(&mut self, added: &mut dyn FnMut(usize) -> [i32; 2], states: &mut [ChannelState], values: &mut [i32]) {
        let (input, frames) = (self.clip.input(), self.clip.frames());
        let Some(states) = states.get_mut(..self.moving.into()).filter(|states| states.len() == self.moving_channels()) else {
            return;
        };
        if self.position.frame + 1 < frames {
            self.position.step_added(&mut Channels { states, pose: values }, &input, frames, added);
        }
    }

    /// On the last frame of a loop: makes the velocities of `states` ([`ChannelState::rates`]) lead to frame 0, as [`Player::interpolate`] describes, until
    /// the next step or seek. The accelerations become the channels' values at frame 0. It reads the channels' starts, as a step to frame 0 does.
    /// Elsewhere it does nothing.
    pub fn lead_to_start(&self, states: &mut [ChannelState], values: &[i32]) {
        let states =
            states.get_mut(..self.moving.into()).filter(|_| self.clip.looped() && self.position.frame + 1 >= self.clip.frames());
        if let Some(states) = states {
            seam::close(&self.clip, states, self.moving_channels(), values);
        }
    }

    /// At frame 0, what [`DetachedPlayer::restart`] takes; `None` at other frames, and in a key clip.
    pub fn loop_start(&self) -> Option<LoopStart> {
        #[cfg(feature = "keys")]
        if self.clip.has_keys() {
            return None;
        }
        (self.position.frame == 0).then_some(LoopStart(self.position.cursor))
    }

    /// Goes to frame 0 without reading how the channels start, which takes most of the time of a lap: `starts` are the values and velocities
    /// ([`ChannelState::rates`]) that the states in use had there, in their order, and `start` is what [`DetachedPlayer::loop_start`] returned then.
    pub fn restart(
        &mut self,
        start: LoopStart,
        starts: impl Iterator<Item = [i32; 2]>,
        states: &mut [ChannelState],
        values: &mut [i32],
    ) {
        for (state, [p, v]) in states.iter_mut().take(self.moving.into()).zip(starts) {
            (state.v, state.w, state.k) = (v, 0, 0);
            (state.due, state.mode, state.prev_sign, state.next) = (0, START_MODE, 0, 0);
            if let Some(value) = values.get_mut(usize::from(state.slot)) {
                *value = p;
            }
        }
        self.position = PlayState { cursor: start.0, frame: 0, next: 0 };
    }

    /// Goes to `frame`, or to the last one if there are fewer: [`Player::seek`].
    pub fn seek(&mut self, frame: u32, states: &mut [ChannelState], values: &mut [i32]) {
        if let Some(mut player) = self.attach(states, values) {
            player.seek(frame);
            (_, self.position) = player.pause();
        }
    }
}

//! Memory for a player, as one value that can be a `static`.

use crate::{ChannelState, Clip, Player, TooSmall};

/// Memory for a [`Player`] of clips with up to `MOVING` moving channels and `CHANNELS` channels.
///
/// `pantin info` prints both numbers of a clip. `pantin expand -o walk.rs` and crate `pantin-build` write them as a type, `WalkRoom`; for a bank
/// the type has the largest numbers of any clip. One room serves several clips in turn: the player gives it back when it goes out of scope.
///
/// ```
/// # fn play(walk: pantin::Clip, wave: pantin::Clip) -> Result<(), pantin::TooSmall> {
/// let mut room = pantin::Room::<80, 100>::new();
/// for clip in [walk, wave] {
///     let mut player = room.player(clip)?;
///     for _ in 0..clip.frames() {
///         let _pose = player.pose();
///         player.step();
///     }
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Room<const MOVING: usize, const CHANNELS: usize> {
    states: [ChannelState; MOVING],
    values: [i32; CHANNELS],
}

impl<const MOVING: usize, const CHANNELS: usize> Room<MOVING, CHANNELS> {
    /// An empty room: `20 * MOVING + 4 * CHANNELS` bytes.
    pub const fn new() -> Self {
        Room { states: [ChannelState::NEW; MOVING], values: [0; CHANNELS] }
    }

    /// A player at frame 0 of a clip.
    pub fn player<'a>(&mut self, clip: Clip<'a>) -> Result<Player<'a, '_>, TooSmall> {
        Player::new(clip, &mut self.states, &mut self.values)
    }
}

impl<const MOVING: usize, const CHANNELS: usize> Default for Room<MOVING, CHANNELS> {
    fn default() -> Self {
        Self::new()
    }
}

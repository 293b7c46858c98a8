//! A clip that plays while it is received.

use crate::facts::Trouble;
use crate::memory::Buffers;
use pantin::{Clip, PartialClip, Player, Pose, SeekCache};

/// The received beginning of a file, and its player.
pub struct Arriving {
    front: PartialClip<'static>,
    player: Player<'static, 'static>,
    memory: SeekCache<'static>,
    /// Number of playable frames.
    pub playable: u32,
    /// Whether the file is complete and valid.
    pub whole: bool,
}

impl Arriving {
    /// Opens the received beginning of a file, whose rig is `rig` if it has none; `None` while frame 0 has not arrived.
    #[inline(never)]
    pub fn new(file: &'static [u8], rig: &'static [u8], buffers: &'static mut Buffers) -> Result<Option<Arriving>, Trouble> {
        let front = match PartialClip::with_rig(file, rig) {
            Err(pantin::OpenError::Truncated) => return Ok(None),
            front => front?,
        };
        let Buffers { states, pose, past } = buffers;
        let Some(player) = front.player(states, pose)? else { return Ok(None) };
        let memory = SeekCache::new(&player, &mut [], &mut past.marks, &mut past.states, &mut past.values);
        Ok(Some(Arriving { front, player, memory, playable: 1, whole: false }))
    }

    /// Takes a longer beginning of the file, and runs ahead to find how far it can be played.
    pub fn extend(&mut self, file: &'static [u8]) -> Result<(), Trouble> {
        let outcome = self.front.extend(file);
        let shown = self.player.frame();
        self.go(self.playable - 1);
        while self.front.step(&mut self.player) {}
        self.playable = self.player.frame() + 1;
        self.go(shown);
        Ok(outcome?)
    }

    /// Checks the whole file.
    pub fn finish(&mut self, file: &'static [u8]) -> Result<(), Trouble> {
        self.front.finish(file)?;
        self.whole = true;
        Ok(())
    }

    /// Moves to a playable frame. Steps are seeks of one frame, and steps back start from a nearby snapshot, so no history of steps is needed.
    pub fn go(&mut self, frame: u32) -> Pose<'_> {
        self.front.seek(&mut self.player, frame, &mut self.memory);
        self.player.pose()
    }

    /// Fills in the facts about the clip.
    pub fn clip(&self) -> &Clip<'static> {
        self.front.clip()
    }

    /// Returns the player at the current frame.
    pub fn player(&self) -> &Player<'static, 'static> {
        &self.player
    }
}

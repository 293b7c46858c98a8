//! A clip that plays while it comes.

use crate::facts::Trouble;
use crate::memory::{past, seat};
use pantin::{Clip, PartialClip, Player, SeekCache};

/// The front of a file, and what plays it.
pub struct Arriving {
    front: PartialClip<'static>,
    player: Player<'static, 'static>,
    memory: SeekCache<'static>,
    /// Frames that can be shown.
    pub playable: u32,
    /// All of it is there, and good.
    pub whole: bool,
}

impl Arriving {
    /// Of what has come of a file; `None` while frame 0 has not. Not to be called once there is one.
    #[inline(never)]
    pub fn new(file: &'static [u8]) -> Result<Option<Arriving>, Trouble> {
        let front = match PartialClip::new(file) {
            Err(pantin::OpenError::Truncated) => return Ok(None),
            front => front?,
        };
        // SAFETY: whoever sat there is gone.
        let (seat, past) = unsafe { (seat(), past()) };
        let Some(player) = front.player(&mut seat.states, &mut seat.pose)? else { return Ok(None) };
        let memory = SeekCache::new(&player, &mut [], &mut past.marks, &mut past.states, &mut past.values);
        Ok(Some(Arriving { front, player, memory, playable: 1, whole: false }))
    }

    /// Takes a longer front of the file, and runs ahead to see how far it can be played.
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

    /// Shows a frame that is playable. Steps are seeks of one frame, and those back start from a snapshot near by: without records of each step.
    pub fn go(&mut self, frame: u32) -> &[i32] {
        self.front.seek(&mut self.player, frame, &mut self.memory);
        self.player.pose()
    }

    /// What is known of the clip.
    pub fn clip(&self) -> &Clip<'static> {
        self.front.clip()
    }

    /// Who shows the frame.
    pub fn player(&self) -> &Player<'static, 'static> {
        &self.player
    }
}

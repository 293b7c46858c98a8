//! Poses of a clip in memory.

use super::{Source, Status};
use pantin::{Player, Pose};

impl Source for Player<'_, '_> {
    const LIVE: bool = false;

    #[inline(always)]
    fn advance(&mut self, frames: i32) {
        for _ in 0..frames {
            self.step();
        }
        for _ in frames..0 {
            let last = self.clip().frames() - 1;
            self.seek(Player::frame(self).checked_sub(1).unwrap_or(last));
        }
    }

    #[inline(always)]
    fn pose(&self) -> Pose<'_> {
        Player::pose(self)
    }

    #[inline(always)]
    fn frame(&self) -> u32 {
        Player::frame(self)
    }

    #[inline(always)]
    fn frame_time_ns(&self) -> u32 {
        self.clip().frame_time_ns()
    }

    #[cfg(feature = "events")]
    fn hear(&mut self, since: crate::events::Since, frames: i32, heard: &mut dyn FnMut(crate::HeardEvent)) {
        crate::events::passed(self.clip(), since, frames, Player::frame(self), heard);
    }

    fn status(&self) -> Status {
        Status::Clip { frame: Player::frame(self), frames: self.clip().frames() }
    }

    #[inline(always)]
    fn with_player(&mut self, then: impl FnOnce(&mut Player)) {
        then(self)
    }
}

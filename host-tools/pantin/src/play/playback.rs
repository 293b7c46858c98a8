//! A player with the memory that it needs to go back.

use anyhow::Result;
use pantin::{ChannelState, Clip, Player, Pose, SeekCache, SnapshotPos, Undo};

/// Frames of lively motion that steps back reach without playing again, and snapshots of the clip.
const FRAMES_BACK: usize = 8;
const SNAPSHOTS: usize = 64;

/// Room for the memory.
pub struct Room {
    states: Vec<ChannelState>,
    pose: Vec<i32>,
    undo: Vec<Undo>,
    marks: Vec<SnapshotPos>,
    kept_states: Vec<ChannelState>,
    kept_values: Vec<i32>,
}

impl Room {
    /// As much as a clip needs.
    pub fn of(clip: &Clip) -> Room {
        let moving = clip.moving();
        Room {
            states: vec![ChannelState::default(); moving],
            pose: vec![0; clip.rig().channels()],
            undo: vec![Undo::default(); FRAMES_BACK * moving],
            marks: vec![SnapshotPos::default(); SNAPSHOTS],
            kept_states: vec![ChannelState::default(); SNAPSHOTS * moving],
            kept_values: vec![0; SNAPSHOTS * moving],
        }
    }
}

/// Goes to any frame, cheaply to those nearby.
pub struct Playback<'a, 'm> {
    player: Player<'a, 'm>,
    memory: SeekCache<'m>,
}

impl<'a, 'm> Playback<'a, 'm> {
    /// Begins at frame 0.
    pub fn new(clip: Clip<'a>, room: &'m mut Room) -> Result<Playback<'a, 'm>> {
        let player = Player::new(clip, &mut room.states, &mut room.pose)?;
        let (undo, marks) = (&mut room.undo, &mut room.marks);
        let memory = SeekCache::new(&player, undo, marks, &mut room.kept_states, &mut room.kept_values);
        Ok(Playback { player, memory })
    }

    /// The pose of a frame.
    pub fn pose(&mut self, frame: u32) -> Pose<'_> {
        let now = self.player.frame();
        if frame == now + 1 {
            self.player.step_with(&mut self.memory);
        } else if frame + 1 == now {
            self.player.step_back(&mut self.memory);
        } else if frame != now {
            self.player.seek_with(frame, &mut self.memory);
        }
        self.player.pose()
    }
}

//! Where a seek begins, where it ends, and what a player reports on the way.
//!
//! To find out where a seek begins, a value in the player's memory is changed: motion that goes on from there keeps the difference, a snapshot
//! or a rewind replaces the value.

use pantin::{ChannelState, Clip, Clock, PartialClip, Player, Room, SeekCache, SnapshotPos, Undo};

static WALK: &[u8] = include_bytes!("../walk.ptn");
static RUN: &[u8] = include_bytes!("../run.ptn");

type Memories = Room<96, 144>;

/// One of the repository's vectors; `None` where the package has none.
fn vector(name: &str) -> Option<Vec<u8>> {
    std::fs::read(format!("{}/../tests/vectors/{name}.ptn", env!("CARGO_MANIFEST_DIR"))).ok()
}

/// What is added to a value.
const MARK: i32 = 1000;

/// A clip's memory, its poses by stepping, and the first moving channel.
struct Marked<'a> {
    clip: Clip<'a>,
    states: Vec<ChannelState>,
    values: Vec<i32>,
    truth: Vec<i32>,
    slot: usize,
}

impl<'a> Marked<'a> {
    fn new(file: &'a [u8]) -> Marked<'a> {
        let clip = Clip::new_checked(file).unwrap();
        let (mut states, mut values) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
        let mut player = Player::new(clip, &mut states, &mut values).unwrap();
        let slot = player.states()[0].slot();
        let mut truth = vec![];
        for _ in 0..clip.frames() {
            truth.push(player.pose().values[slot]);
            player.step();
        }
        Marked { clip, states, values, truth, slot }
    }

    /// Whether the mark that is made at frame `now` is still there after `go`, which leads to `target`.
    fn keeps(&mut self, now: u32, target: u32, mut go: impl FnMut(&mut Player<'_, '_>, u32)) -> bool {
        let mut player = Player::new(self.clip, &mut self.states, &mut self.values).unwrap();
        // By steps: the memory of a seek stays as it is.
        (0..now).for_each(|_| player.step());
        let detached = player.detach();
        self.values[self.slot] += MARK;
        let mut player = detached.attach(&mut self.states, &mut self.values).unwrap();
        go(&mut player, target);
        assert_eq!(player.frame(), target);
        match player.pose().values[self.slot].wrapping_sub(self.truth[target as usize]) {
            0 => false,
            MARK => true,
            other => panic!("{other} from frame {now} to {target}"),
        }
    }
}

/// Two frames in time order, the latest first: no seek keeps a snapshot for a later pair. Few in Miri.
fn pairs(frames: u32) -> impl Iterator<Item = (u32, u32)> {
    let pace = if cfg!(miri) { 5 } else { 1 };
    (0..frames).rev().step_by(pace).flat_map(move |now| (now..frames).step_by(pace).map(move |target| (now, target)))
}

#[test]
fn a_seek_begins_at_the_files_snapshot_only_where_that_is_closer() {
    let Some(bytes) = vector("index") else { return };
    let mut marked = Marked::new(&bytes);
    let index = bytes.len() - marked.clip.index_len();
    // The index states how far apart its snapshots are, and how many.
    let (spacing, count) = (u32::from(bytes[index]), u32::from(bytes[index + 1]));
    assert!(spacing > 2 && count > 1, "{count} snapshots, one in {spacing} frames");
    for (now, target) in pairs(marked.clip.frames()) {
        let passed = (1..=count).any(|index| (now + 1..=target).contains(&(index * spacing)));
        assert_eq!(marked.keeps(now, target, |player, target| player.seek(target)), !passed, "from frame {now} to {target}");
    }
    for target in [0, 1, spacing - 1, spacing, spacing + 1] {
        assert!(!marked.keeps(spacing + 2, target, |player, target| player.seek(target)), "back to {target}");
    }
}

#[test]
fn a_player_goes_to_a_near_frame_by_steps() {
    let Some(bytes) = vector("index") else { return };
    let mut marked = Marked::new(&bytes);
    let spacing = u32::from(bytes[bytes.len() - marked.clip.index_len()]);
    // Steps pass the snapshot, a seek begins there.
    let now = spacing - 1;
    for ahead in 0..12 {
        let stepped = marked.keeps(now, now + ahead, |player, target| player.go_to(target));
        assert_eq!(stepped, ahead <= 8, "{ahead} frames ahead");
    }
}

#[test]
fn a_seek_begins_at_a_kept_snapshot_only_where_that_is_closer() {
    let mut marked = Marked::new(RUN);
    let (clip, moving) = (marked.clip, marked.states.len());
    // Three snapshots of 26 frames are 8 frames apart.
    assert_eq!(clip.frames(), 26);
    let mut marks = [SnapshotPos::default(); 3];
    let (mut states, mut values) = (vec![ChannelState::NEW; 3 * moving], vec![0; 3 * moving]);
    let mut room = Memories::new();
    let mut first = room.player(clip).unwrap();
    let mut memory = SeekCache::new(&first, &mut [], &mut marks, &mut states, &mut values);
    first.seek_with(u32::MAX, &mut memory);
    for (now, target) in pairs(clip.frames()) {
        let passed = target / 8 > now / 8;
        let kept = marked.keeps(now, target, |player, target| player.seek_with(target, &mut memory));
        assert_eq!(kept, !passed, "from frame {now} to {target}");
    }
}

#[test]
fn steps_keep_the_same_snapshots_as_seeks() {
    let mut marked = Marked::new(RUN);
    let (clip, moving) = (marked.clip, marked.states.len());
    let mut marks = [SnapshotPos::default(); 3];
    let (mut undo, mut states, mut values) = ([Undo::default(); 4], vec![ChannelState::NEW; 3 * moving], vec![0; 3 * moving]);
    let mut room = Memories::new();
    let mut first = room.player(clip).unwrap();
    let mut memory = SeekCache::new(&first, &mut undo, &mut marks, &mut states, &mut values);
    for until in [7, 8, 15, 17] {
        while first.frame() < until {
            first.step_with(&mut memory);
        }
        for target in 1..=until {
            let kept = marked.keeps(0, target, |player, target| player.seek_with(target, &mut memory));
            assert_eq!(kept, target < 8, "frame {target} of {until}");
        }
    }
}

/// Steps back from the frame of `player`: the number of steps that its memory takes back before others replay some frames.
fn taken_back(marked: &mut Marked<'_>, player: &mut pantin::DetachedPlayer<'_>, memory: &mut SeekCache<'_>) -> usize {
    for count in 0.. {
        marked.values[marked.slot] += MARK;
        let mut attached = player.attach(&mut marked.states, &mut marked.values).unwrap();
        attached.step_back(memory);
        let difference = attached.pose().values[marked.slot].wrapping_sub(marked.truth[attached.frame() as usize]);
        *player = attached.detach();
        if difference == 0 {
            return count;
        }
        assert_eq!(difference, MARK);
        marked.values[marked.slot] -= MARK;
    }
    unreachable!("frame 0 ends it")
}

#[test]
fn records_take_steps_back_and_exhausted_ones_are_refilled() {
    let mut marked = Marked::new(WALK);
    let mut undo = vec![Undo::default(); 200];
    let mut player = Player::new(marked.clip, &mut marked.states, &mut marked.values).unwrap();
    let mut memory = SeekCache::new(&player, &mut undo, &mut [], &mut [], &mut []);
    player.seek(100);
    let mut player = player.detach();
    // 16 frames are replayed at least, then twice as many as the step before the last one reached back.
    for (steps, frame) in [(0, 99), (16, 82), (30, 51)] {
        assert_eq!((taken_back(&mut marked, &mut player, &mut memory), player.frame()), (steps, frame));
    }
}

#[test]
fn the_oldest_records_make_room_for_new_ones() {
    let mut marked = Marked::new(WALK);
    let mut player = Player::new(marked.clip, &mut marked.states, &mut marked.values).unwrap();
    let mut undo = vec![Undo::default(); player.states().len()];
    let mut memory = SeekCache::new(&player, &mut undo, &mut [], &mut [], &mut []);
    (0..100).for_each(|_| player.step_with(&mut memory));
    let mut player = player.detach();
    assert!(taken_back(&mut marked, &mut player, &mut memory) > 3);
}

#[test]
fn a_partial_clip_seeks_among_the_frames_that_are_there() {
    let clip = Clip::new_checked(WALK).unwrap();
    let (mut room, mut states, mut values) = (Memories::new(), vec![ChannelState::NEW; 96], vec![0; 144]);
    let mut whole = room.player(clip).unwrap();
    let partial = PartialClip::new(WALK).unwrap();
    let mut player = partial.player(&mut states, &mut values).unwrap().unwrap();
    let mut memory = SeekCache::new(&player, &mut [], &mut [], &mut [], &mut []);
    for frame in [30, 7, 8, 159] {
        whole.seek(frame);
        partial.seek(&mut player, frame, &mut memory);
        assert_eq!((player.frame(), player.pose().values), (frame, whole.pose().values));
    }
}

#[test]
fn past_the_last_frame_is_the_last_frame() {
    let clip = Clip::new_checked(RUN).unwrap();
    let (mut room, last) = (Memories::new(), clip.frames() - 1);
    let mut player = room.player(clip).unwrap();
    (0..last).for_each(|_| player.step());
    let pose = player.pose().values.to_vec();
    for from in [0, last - 3, last] {
        for frame in [last, last + 1, last + 2, u32::MAX] {
            for go in [Player::seek, Player::go_to] {
                player.rewind();
                (0..from).for_each(|_| player.step());
                go(&mut player, frame);
                assert_eq!((player.frame(), player.pose().values), (last, &pose[..]), "frame {frame} from {from}");
            }
        }
    }
}

#[test]
fn after_the_last_frame_a_player_steps_to_the_first() {
    let clip = Clip::new_checked(RUN).unwrap();
    let mut room = Memories::new();
    let mut player = room.player(clip).unwrap();
    let first = player.pose().values.to_vec();
    let mut undo = [Undo::default(); 64];
    let mut memory = SeekCache::new(&player, &mut undo, &mut [], &mut [], &mut []);
    for with_memory in [false, true] {
        for frame in 0..clip.frames() {
            assert_eq!((player.frame(), player.ended()), (frame, frame == clip.frames() - 1));
            if with_memory { player.step_with(&mut memory) } else { player.step() }
        }
        assert_eq!((player.frame(), player.pose().values), (0, &first[..]));
    }
}

#[test]
fn advancing_reports_whether_the_frame_is_another() {
    let clip = Clip::new_checked(RUN).unwrap();
    let mut room = Memories::new();
    let mut player = room.player(clip).unwrap();
    let mut clock = Clock::new(&clip);
    let frame_us = clip.frame_time_ns() / 1000;
    for (elapsed_us, changed) in [(0, false), (frame_us / 2, false), (frame_us, true), (1, false), (frame_us, true)] {
        assert_eq!(player.advance(&mut clock, elapsed_us), changed, "frame {} after {elapsed_us} us", player.frame());
    }
    assert_eq!(player.frame(), 2);
}

#[test]
fn a_player_reports_the_events_of_its_frame() {
    let Some(bytes) = vector("events") else { return };
    let clip = Clip::new_checked(&bytes).unwrap();
    let mut room = Memories::new();
    let mut player = room.player(clip).unwrap();
    let mut seen = vec![];
    for frame in 0..clip.frames() {
        seen.extend(player.events().map(|id| pantin::Event { frame, id }));
        player.step();
    }
    assert!(seen.len() > 2 && clip.events().eq(seen));
}

//! Playing by time, in pieces and from a growing buffer gives the frames that stepping gives.

use fixed::types::{I16F16, U0F16};
use pantin::{
    ChannelState, Clip, Clock, CollectError, Memory, PartialClip, Player, Progress, Rig, RigCollector, Room, SeekCache,
    SnapshotPos, Stream, TooSmall, Undo, WrongForm,
};

static WALK: &[u8] = include_bytes!("../walk.ptn");
static RUN: &[u8] = include_bytes!("../run.ptn");

type Memories = Room<96, 144>;

fn frames(file: &[u8]) -> Vec<Vec<i32>> {
    let clip = Clip::new_checked(file).unwrap();
    let mut room = Memories::new();
    let mut player = room.player(clip).unwrap();
    let mut frames = vec![player.pose().values.to_vec()];
    for _ in 1..clip.frames() {
        player.step();
        frames.push(player.pose().values.to_vec());
    }
    frames
}

/// The states of the moving channels at each frame.
fn states(file: &[u8]) -> Vec<Vec<ChannelState>> {
    let clip = Clip::new_checked(file).unwrap();
    let mut room = Memories::new();
    let mut player = room.player(clip).unwrap();
    let mut states = vec![player.states().to_vec()];
    for _ in 1..clip.frames() {
        player.step();
        states.push(player.states().to_vec());
    }
    states
}

#[test]
fn memory_can_be_a_static_and_serves_clips_in_turn() {
    static ROOM: std::sync::Mutex<Memories> = std::sync::Mutex::new(Room::new());
    let mut room = ROOM.lock().unwrap();
    for file in [WALK, RUN] {
        let clip = Clip::new_checked(file).unwrap();
        let player = room.player(clip).unwrap();
        assert_eq!(player.pose().values, frames(file)[0]);
    }
}

#[test]
fn too_little_memory_is_named_with_what_is_needed_and_given() {
    let clip = Clip::new_checked(WALK).unwrap();
    let (moving, channels) = (clip.moving(), clip.rig().channels());
    let (mut states, mut values) = ([ChannelState::NEW; 96], [0; 144]);
    let short = Player::new(clip, &mut states[..moving - 1], &mut values).map(|_| ());
    assert_eq!(short, Err(TooSmall { memory: Memory::States, needed: moving, given: moving - 1 }));
    let short = Player::new(clip, &mut states, &mut values[..3]).map(|_| ());
    assert_eq!(short, Err(TooSmall { memory: Memory::Values, needed: channels, given: 3 }));
}

#[test]
fn a_clock_shows_each_frame_at_its_time_at_any_display_rate_and_speed() {
    for file in [WALK, RUN] {
        let truth = frames(file);
        let clip = Clip::new_checked(file).unwrap();
        for (rate, speed) in [(24, 1.0), (60, 1.0), (90, 0.5), (1000, 2.0), (50, -1.0), (30, -3.25), (60, 16.0)] {
            let mut room = Memories::new();
            let mut player = room.player(clip).unwrap();
            let mut clock = Clock::new(&clip);
            clock.set_speed(I16F16::from_num(speed));
            let elapsed_us = 1_000_000 / rate;
            for picture in 1u64..if cfg!(miri) { 30 } else { 600 } {
                player.advance(&mut clock, elapsed_us);
                let at_us = picture as f64 * f64::from(elapsed_us) * speed;
                let exact = (at_us * 1000.0 / f64::from(clip.frame_time_ns())).floor();
                let want = if clip.looped() {
                    exact.rem_euclid(f64::from(clip.frames()))
                } else {
                    exact.clamp(0.0, f64::from(clip.frames() - 1))
                };
                assert_eq!(f64::from(player.frame()), want, "{rate} Hz, speed {speed}, picture {picture}");
                assert_eq!(player.pose().values, truth[player.frame() as usize]);
                if speed == 1.0 {
                    assert_eq!(clip.frame_at(picture * u64::from(elapsed_us)), player.frame());
                }
                if clock.ended() {
                    assert!(!clip.looped());
                    break;
                }
            }
        }
    }
}

#[test]
fn a_loop_of_one_frame_plays() {
    let clip = Clip::new_checked(WALK).unwrap();
    let mut clock = Clock::new(&clip);
    clock.seek(u32::MAX);
    assert_eq!(clock.frame(), clip.frames() - 1);
    assert_eq!(clock.part(), U0F16::ZERO);
    assert_eq!(clip.duration_ns(), u64::from(clip.frame_time_ns()) * u64::from(clip.frames() - u32::from(!clip.looped())));
}

#[test]
fn between_two_frames_a_pose_lies_on_the_straight_line() {
    for file in [WALK, RUN] {
        let truth = frames(file);
        let clip = Clip::new_checked(file).unwrap();
        let mut room = Memories::new();
        let mut player = room.player(clip).unwrap();
        let mut out = vec![0; clip.rig().channels()];
        for frame in 0..truth.len() - 1 {
            for part in [0.0, 0.25, 0.75] {
                let pose = player.interpolate(U0F16::from_num(part), &mut out).unwrap();
                for (channel, value) in pose.values.iter().enumerate() {
                    let way = f64::from(truth[frame + 1][channel].wrapping_sub(truth[frame][channel]));
                    let gone = f64::from(value.wrapping_sub(truth[frame][channel]));
                    assert!((gone - way * part).abs() <= 1.0, "frame {frame}, channel {channel}");
                }
            }
            player.step();
        }
    }
}

#[test]
fn from_a_loops_last_frame_a_pose_leads_to_frame_0() {
    for file in [WALK, RUN] {
        let truth = frames(file);
        let clip = Clip::new_checked(file).unwrap();
        assert!(clip.looped());
        let (mut room, mut out) = (Memories::new(), vec![0; clip.rig().channels()]);
        let mut player = room.player(clip).unwrap();
        let last = truth.len() - 1;
        player.seek(last as u32);
        let rates: Vec<_> = player.states().iter().map(|state| (state.slot(), state.rates()[0])).collect();
        let mut travel = 0;
        for part in [0.0, 0.25, 0.75] {
            let pose = player.interpolate(U0F16::from_num(part), &mut out).unwrap();
            for (channel, value) in pose.values.iter().enumerate() {
                let way = f64::from(truth[0][channel].wrapping_sub(truth[last][channel]));
                let gone = f64::from(value.wrapping_sub(truth[last][channel]));
                if (gone - way * part).abs() > 1.0 {
                    // The way of the walk goes on.
                    let v = rates.iter().find(|(slot, _)| *slot == channel).map_or(0, |(_, v)| *v);
                    assert!((gone - f64::from(v) * part).abs() <= 1.0, "channel {channel} at {part}: {gone} of {way}, {v}");
                    travel += 1;
                }
            }
        }
        assert_eq!(travel, 2);
    }
    let mut clock = Clock::new(&Clip::new_checked(WALK).unwrap());
    clock.seek(u32::MAX);
    clock.advance(1_000);
    assert!(clock.part() > U0F16::ZERO);
}

#[test]
fn bytes_written_to_the_streams_own_space_play_as_fed_ones_do() {
    let truth = frames(WALK);
    let rig = Clip::new_checked(WALK).unwrap().rig();
    for size in [1, 7, 100, 255, 4096] {
        let mut buffer = [0; Stream::BUFFER];
        let (mut states, mut values) = ([ChannelState::NEW; 96], [0; 144]);
        let mut stream = Stream::new(rig, &mut buffer, &mut states, &mut values).unwrap();
        let (mut rest, mut frame) = (WALK, 0);
        loop {
            match stream.step() {
                Progress::NeedMore => {
                    let space = stream.space();
                    let count = rest.len().min(size).min(space.len());
                    space[..count].copy_from_slice(&rest[..count]);
                    stream.filled(count);
                    assert!(count > 0, "no space for {} bytes", rest.len());
                    rest = &rest[count..];
                }
                Progress::Frame => {
                    assert_eq!(stream.pose().values, truth[frame]);
                    frame += 1;
                }
                Progress::End => break,
                Progress::Opened | Progress::Event(_) => {}
                failed => panic!("{failed:?}"),
            }
        }
        assert_eq!(frame, truth.len());
    }
}

#[test]
fn a_rig_may_come_with_its_clip() {
    let truth = frames(WALK);
    let (mut buffer, mut states, mut values) = ([0; Stream::BUFFER], [ChannelState::NEW; 96], [0; 144]);
    let mut rig = [0; 2048];
    let mut collector = RigCollector::new(&mut rig);
    let mut fed = 0;
    while !collector.is_complete() {
        fed += collector.feed(&WALK[fed..(fed + 5).min(WALK.len())]).unwrap();
    }
    let mut stream = collector.stream(&mut buffer, &mut states, &mut values).unwrap();
    let mut frame = 0;
    loop {
        match stream.step() {
            Progress::NeedMore => fed += stream.feed(&WALK[fed..]),
            Progress::Frame => {
                assert_eq!(stream.pose().values, truth[frame]);
                frame += 1;
            }
            Progress::End => break,
            Progress::Opened | Progress::Event(_) => {}
            failed => panic!("{failed:?}"),
        }
    }
    assert_eq!(frame, truth.len());
    let mut small = [0; 10];
    let refused = RigCollector::new(&mut small).feed(WALK);
    assert!(matches!(refused, Err(CollectError::TooSmall(TooSmall { memory: Memory::Rig, given: 10, .. }))), "{refused:?}");
}

#[test]
fn a_buffer_that_grows_is_played_without_holding_it() {
    let truth = frames(WALK);
    let (mut states, mut values) = ([ChannelState::NEW; 144], [0; 144]);
    let mut file: Vec<u8> = Vec::new();
    let (mut paused, mut frame) = (None::<pantin::PausedClip>, 0);
    for more in WALK.chunks(9) {
        file.extend_from_slice(more);
        let started = match &paused {
            Some(paused) => Some(paused.resume(&file, &mut states, &mut values).unwrap()),
            None => PartialClip::new(&file).ok().and_then(|partial| {
                let player = partial.player(&mut states, &mut values).unwrap()?;
                assert_eq!(player.pose().values, truth[0]);
                Some((partial, player))
            }),
        };
        let Some((partial, mut player)) = started else { continue };
        while partial.step(&mut player) {
            frame += 1;
            assert_eq!(player.pose().values, truth[frame]);
        }
        paused = Some(partial.pause(player));
    }
    assert_eq!(frame + 1, truth.len());
}

#[test]
fn a_joint_of_another_rig_is_refused_by_name() {
    let walk = Clip::new_checked(WALK).unwrap();
    let mut room = Memories::new();
    let player = room.player(walk).unwrap();
    let mut other = walk.rig();
    let changed = {
        // The same rig with another name for its first joint: another id.
        let mut bytes = WALK.to_vec();
        let name = bytes.windows(3).position(|window| window == b"hip").expect("a hip");
        bytes[name] = b'H';
        bytes
    };
    let rig_len = usize::from(changed[4] & 0x7f) | usize::from(changed[5]) << 7;
    let body = &changed[6..6 + rig_len - 2];
    let with_crc = [body, &pantin::codec::crc::of(body).to_le_bytes()].concat();
    let bytes: &'static [u8] = Box::leak(with_crc.into_boxed_slice());
    other = Rig::new_checked(bytes).unwrap_or(other);
    assert_ne!(other.id(), walk.rig().id());
    let joint = other.joint_ref(0).unwrap();
    assert_eq!(player.turn(&joint), Err(WrongForm::Rig));
    assert_eq!(walk.form().check(&walk.form()), Ok(()));
    assert!(walk.find("no such joint").is_none() && walk.find("").is_none());
}

/// The clips beside this file are those of `motions/`: the package holds what its examples and tests read.
#[test]
fn the_packages_clips_are_the_repositorys() {
    let motions = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../motions");
    if !motions.exists() {
        return println!("skipped: the package stands alone");
    }
    assert_eq!(std::fs::read(motions.join("walk.ptn")).unwrap(), WALK);
    assert_eq!(std::fs::read(motions.join("run.ptn")).unwrap(), RUN);
}

#[test]
fn steps_are_taken_back_with_any_memory() {
    for file in [WALK, RUN] {
        let (truth, states) = (frames(file), states(file));
        let last = truth.len().min(if cfg!(miri) { 16 } else { 60 }) - 4;
        for (undos, marks) in [(0, 0), (0, 2), (1, 0), (2, 1), (7, 0), (300, 3)] {
            let mut room = Memories::new();
            let mut player = room.player(Clip::new_checked(file).unwrap()).unwrap();
            let moving = player.clip().moving();
            let mut lent = (vec![Undo::default(); undos], vec![SnapshotPos::default(); marks]);
            let mut more = (vec![ChannelState::NEW; marks * moving], vec![0; marks * moving]);
            let mut memory = SeekCache::new(&player, &mut lent.0, &mut lent.1, &mut more.0, &mut more.1);
            // Steps that lead elsewhere are forgotten.
            for (steps, to, more) in [(5, last, 0), (5, last, 1), (0, 3, 2)] {
                player.rewind();
                (0..steps).for_each(|_| player.step_with(&mut memory));
                player.seek(to as u32);
                (0..more).for_each(|_| player.step_with(&mut memory));
                for back in (to / 2..player.frame() as usize).rev() {
                    player.step_back(&mut memory);
                    assert_eq!(player.pose().values, truth[back], "frame {back} from {to}, {undos} undos");
                    assert_eq!(player.states(), states[back], "frame {back} from {to}, {undos} undos");
                }
            }
            player.rewind();
            for target in [last, 1, last / 2] {
                while (player.frame() as usize) < target {
                    player.step_with(&mut memory);
                    assert_eq!(player.pose().values, truth[player.frame() as usize], "{undos} undos, {marks} snapshots");
                }
                for back in (0..target).rev() {
                    player.step_back(&mut memory);
                    assert_eq!(player.frame() as usize, back);
                    assert_eq!(player.pose().values, truth[back], "frame {back}, {undos} undos, {marks} snapshots");
                    assert_eq!(player.states(), states[back], "frame {back}, {undos} undos, {marks} snapshots");
                    // What was read is not read twice.
                    for ahead in 1..=3 {
                        player.step_with(&mut memory);
                        assert_eq!(player.pose().values, truth[back + ahead], "frame {back} and {ahead}, {undos} undos");
                    }
                    for ahead in (0..3).rev() {
                        player.step_back(&mut memory);
                        assert_eq!(player.pose().values, truth[back + ahead], "frame {back} and {ahead}, {undos} undos");
                    }
                }
            }
        }
    }
}

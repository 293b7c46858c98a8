//! Laws of the decoder, on the golden vectors: the same poses whether stepping, seeking, reversing or streaming, for both ways to open a clip, and no damaged byte that passes.

use std::ops::ControlFlow;

use harness::vectors::synthetic::SECTIONS;
use harness::vectors::{self, Vector};
use hostile::noise::Noise;
use pantin::codec::layout::HAS_SECTIONS;
use pantin::{ChannelState, Clip, OpenError, PartialClip, Player, Progress, Rig, SeekCache, SnapshotPos, Stream, Undo};
use pantin_convert::encode::clip::{self, Channel, Coded, Start};
use pantin_convert::encode::rig;
use pantin_convert::encode::segment::Segment;
use pantin_convert::motion;

/// Every pose of the clip, by steps.
fn poses(clip: Clip<'_>) -> Vec<Vec<i32>> {
    let (mut states, mut pose) = memory(&clip);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let mut poses = vec![player.pose().values.to_vec()];
    while !player.ended() {
        player.step();
        poses.push(player.pose().values.to_vec());
    }
    poses
}

fn memory(clip: &Clip<'_>) -> (Vec<ChannelState>, Vec<i32>) {
    (vec![ChannelState::default(); clip.moving()], vec![0; clip.rig().channels()])
}

/// The vectors, without the sections that this version does not define: it may find no damage in them.
fn all() -> Vec<Vector> {
    let mut all = vectors::load(&vectors::folder()).unwrap();
    for Vector { clip, .. } in all.iter_mut().filter(|vector| vector.clip[3] & HAS_SECTIONS != 0) {
        clip.truncate(clip.len() - SECTIONS.len());
    }
    all
}

/// Moves a player through a clip in every way it offers, with the given numbers of history records and snapshots lent.
fn wander(clip: Clip<'_>, undo: usize, marks: usize, noise: &mut Noise) {
    let poses = poses(clip);
    let last = poses.len() - 1;
    let (mut states, mut pose) = memory(&clip);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let mut lent = (
        vec![Undo::default(); undo],
        vec![SnapshotPos::default(); marks],
        vec![ChannelState::default(); marks * clip.moving()],
        vec![0; marks * clip.moving()],
    );
    let mut memory = SeekCache::new(&player, &mut lent.0, &mut lent.1, &mut lent.2, &mut lent.3);
    let mut frame = 0;
    for turn in 0..600 {
        let far = noise.below(last + 2);
        // Long runs one way, so that history fills and runs out.
        let way = if turn % 40 < 25 { turn / 40 % 4 } else { noise.below(7) };
        frame = match way {
            0 => {
                player.step();
                if frame == last { 0 } else { frame + 1 }
            }
            1 | 3 => {
                player.step_back(&mut memory);
                if frame == 0 { last } else { frame - 1 }
            }
            2 => {
                player.step_with(&mut memory);
                if frame == last { 0 } else { frame + 1 }
            }
            4 => {
                player.seek(far as u32);
                far.min(last)
            }
            5 => {
                player.seek_with(far as u32, &mut memory);
                far.min(last)
            }
            _ => {
                player.rewind();
                0
            }
        };
        assert_eq!(player.frame() as usize, frame, "turn {turn}, way {way}");
        assert!(player.pose().values == poses[frame], "turn {turn}, way {way}: frame {frame} is another pose");
        assert_eq!(player.ended(), frame == last);
    }
}

#[test]
fn every_route_leads_to_the_same_pose_with_any_memory_lent() {
    for vector in all() {
        let clip = vector.open().unwrap();
        for (undo, marks) in [(0, 0), (1, 0), (0, 1), (7, 2), (40, 5), (3 * clip.moving() + 1, 40)] {
            println!("{}: {undo} records, {marks} snapshots", vector.name);
            wander(clip, undo, marks, &mut Noise::new((undo * 100 + marks) as u64));
        }
    }
}

#[test]
fn a_player_that_plays_and_goes_back_ping_pong_never_leaves_the_clip() {
    for vector in all() {
        let clip = vector.open().unwrap();
        let poses = poses(clip);
        let (mut states, mut pose) = memory(&clip);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let mut undo = vec![Undo::default(); 2 * clip.moving()];
        let mut memory = SeekCache::new(&player, &mut undo, &mut [], &mut [], &mut []);
        for _ in 0..2 {
            while !player.ended() {
                player.step_with(&mut memory);
                assert!(player.pose().values == poses[player.frame() as usize]);
            }
            while player.frame() > 0 {
                player.step_back(&mut memory);
                assert!(player.pose().values == poses[player.frame() as usize]);
            }
        }
    }
}

/// What comes of pushing `bytes` in pieces of the sizes that `piece` tells: frames as they appear, until `seen` has had enough.
fn push(
    rig: Rig<'_>,
    bytes: &[u8],
    buffer: usize,
    mut piece: impl FnMut() -> usize,
    mut seen: impl FnMut(Progress, &Stream<'_, '_>) -> ControlFlow<()>,
) -> Progress {
    let mut buffer = vec![0; buffer];
    let (mut states, mut pose) = (vec![ChannelState::default(); rig.channels()], vec![0; rig.channels()]);
    let mut stream = Stream::new(rig, &mut buffer, &mut states, &mut pose).unwrap();
    let mut rest = bytes;
    loop {
        match stream.step() {
            Progress::NeedMore if rest.is_empty() => return Progress::NeedMore,
            Progress::NeedMore => {
                let taken = stream.feed(&rest[..piece().min(rest.len())]);
                // A full buffer that can't be played on would wait for ever.
                assert!(taken > 0, "{} bytes left, none taken", rest.len());
                rest = &rest[taken..];
            }
            step => {
                let done = seen(step, &stream).is_break();
                if done || matches!(step, Progress::End | Progress::Damaged(_) | Progress::TooSmall) {
                    return step;
                }
            }
        }
    }
}

/// The rig that a receiver knows: in a file it stands behind its length, one or two bytes of varint.
fn rig_of(vector: &Vector) -> Vec<u8> {
    if let Some(rig) = &vector.rig {
        return rig.clone();
    }
    let clip = vector.open().unwrap();
    let digits = if vector.clip[4] & 0x80 == 0 { 1 } else { 2 };
    vector.clip[4 + digits..4 + clip.rig_len()].to_vec()
}

#[test]
fn pieces_of_any_size_play_as_the_whole() {
    for vector in all() {
        let clip = vector.open().unwrap();
        let (rig, poses) = (rig_of(&vector), poses(clip));
        let events: Vec<_> = clip.events().collect();
        let mut noise = Noise::new(5);
        for size in [1, 2, 3, 7, 64, 255, 256, 257, 700, 1 << 20, 0] {
            for buffer in [Stream::BUFFER, Stream::BUFFER + 1, 3000] {
                let (mut frame, mut marks) = (0, vec![]);
                let mut piece = || if size == 0 { 1 + noise.below(300) } else { size };
                let end = push(Rig::new_checked(&rig).unwrap(), &vector.clip, buffer, &mut piece, |step, stream| {
                    match step {
                        Progress::Opened => {
                            assert_eq!((stream.frames(), stream.frame_time_ns()), (clip.frames(), clip.frame_time_ns()));
                            assert_eq!((stream.looped(), stream.pose().form), (clip.looped(), clip.form_ref()));
                        }
                        Progress::Event(event) => marks.push(event),
                        Progress::Frame => {
                            assert_eq!(stream.frame() as usize, frame);
                            assert!(stream.pose().values == poses[frame], "{} in pieces of {size}: frame {frame}", vector.name);
                            frame += 1;
                        }
                        _ => {}
                    }
                    ControlFlow::Continue(())
                });
                assert_eq!((end, frame), (Progress::End, poses.len()), "{} in pieces of {size}, buffer of {buffer}", vector.name);
                assert_eq!(marks, events, "{} in pieces of {size}", vector.name);
            }
        }
    }
}

/// Plays a file as it comes, there and back, and returns the frames that could be played and what was said at the end.
fn arrive(
    file: &[u8],
    poses: &[Vec<i32>],
    mut piece: impl FnMut() -> usize,
    noise: &mut Noise,
) -> (usize, Result<(), OpenError>) {
    let mut come = 0;
    let mut more = || {
        come = (come + piece()).min(file.len());
        (&file[..come], come == file.len())
    };
    let (mut front, mut player) = loop {
        let (bytes, last) = more();
        match PartialClip::new(bytes) {
            Err(OpenError::Truncated) if !last => continue,
            Err(error) => return (0, Err(error)),
            Ok(mut front) => {
                let channels = front.clip().rig().channels();
                let (states, pose) = (vec![ChannelState::default(); channels].leak(), vec![0; channels].leak());
                match front.player(states, pose).unwrap() {
                    Some(player) => break (front, player),
                    None if last => return (0, front.finish(bytes)),
                    None => {}
                }
            }
        }
    };
    let moving = player.states().len();
    let mut lent = (vec![SnapshotPos::default(); 5], vec![ChannelState::default(); 5 * moving], vec![0; 5 * moving]);
    let mut memory = SeekCache::new(&player, &mut [], &mut lent.0, &mut lent.1, &mut lent.2);
    let mut playable = 1;
    loop {
        let (bytes, last) = more();
        let outcome = front.extend(bytes);
        front.seek(&mut player, playable as u32 - 1, &mut memory);
        assert!(player.pose().values == poses[playable - 1]);
        while front.step(&mut player) {
            assert!(player.pose().values == poses[player.frame() as usize], "frame {} of what came", player.frame());
        }
        playable = player.frame() as usize + 1;
        for _ in 0..3 {
            let frame = noise.below(playable);
            front.seek(&mut player, frame as u32, &mut memory);
            assert!(player.frame() as usize == frame && player.pose().values == poses[frame], "frame {frame} of {playable}");
        }
        if last {
            return (playable, outcome.and_then(|()| front.finish(bytes)));
        }
    }
}

#[test]
fn the_front_of_a_file_plays_as_the_whole_does_and_no_damaged_byte_passes() {
    for vector in all().into_iter().filter(|vector| vector.rig.is_none()) {
        let (file, poses) = (&vector.clip, poses(vector.open().unwrap()));
        let mut noise = Noise::new(11);
        for size in [1, 7, 255, 256, 257, 1 << 20] {
            let outcome = arrive(file, &poses, || size, &mut noise);
            assert_eq!(outcome, (poses.len(), Ok(())), "{} in pieces of {size}", vector.name);
        }
        for _ in 0..40 {
            let len = noise.below(file.len());
            let (playable, outcome) = arrive(&file[..len], &poses, || 100, &mut noise);
            assert!(playable <= poses.len() && outcome == Err(OpenError::Truncated), "{} cut to {len}: {outcome:?}", vector.name);
            let mut damaged = file.clone();
            damaged[noise.below(file.len())] ^= 1 << noise.below(8);
            assert!(arrive(&damaged, &poses, || 100, &mut noise).1.is_err(), "{}", vector.name);
        }
    }
}

#[test]
fn playing_begins_before_the_last_byte_has_come() {
    let vector = all().into_iter().max_by_key(|vector| vector.open().unwrap().motion_len()).unwrap();
    let clip = vector.open().unwrap();
    let rig = rig_of(&vector);
    let mut frames = 0;
    let half = &vector.clip[..vector.clip.len() - clip.motion_len() / 2];
    let end = push(
        Rig::new_checked(&rig).unwrap(),
        half,
        Stream::BUFFER,
        || 1,
        |step, _| {
            frames += u32::from(step == Progress::Frame);
            ControlFlow::Continue(())
        },
    );
    assert_eq!(end, Progress::NeedMore);
    // A quarter at least: a block of 256 bytes and a segment's worth wait.
    assert!(4 * frames > clip.frames(), "{}: {frames} frames of {} from half of the motion", vector.name, clip.frames());
}

/// Bytes that follow a clip's motion.
fn tail(clip: &Clip<'_>) -> usize {
    let digits = |len: usize| if len < 0x80 { 1 } else { 2 };
    [clip.index_len(), clip.event_names_len()].into_iter().filter(|len| *len > 0).map(|len| digits(len) + len).sum()
}

#[test]
fn every_file_cut_short_is_refused_whole_and_waited_for_in_pieces() {
    for vector in all() {
        let clip = vector.open().unwrap();
        let (rig, poses) = (rig_of(&vector), poses(clip));
        let complete = vector.clip.len() - tail(&clip);
        let stride = (vector.clip.len() / 120).max(1);
        for len in (0..vector.clip.len()).step_by(stride) {
            let cut = &vector.clip[..len];
            assert!(Clip::with_rig(cut, &rig).is_err(), "{} cut to {len}", vector.name);
            let mut frame = 0;
            let end = push(
                Rig::new_checked(&rig).unwrap(),
                cut,
                Stream::BUFFER,
                || 33,
                |step, stream| {
                    if step == Progress::Frame {
                        assert!(stream.pose().values == poses[frame], "{} cut to {len}: frame {frame}", vector.name);
                        frame += 1;
                    }
                    ControlFlow::Continue(())
                },
            );
            assert!(end == Progress::NeedMore || len >= complete, "{} cut to {len}: {end:?}", vector.name);
        }
    }
}

#[test]
fn every_flipped_bit_is_found_before_a_wrong_pose_is_shown() {
    for vector in all() {
        let clip = vector.open().unwrap();
        let (rig, poses) = (rig_of(&vector), poses(clip));
        // A stream knows its rig and passes over the file's, and never comes to what follows the motion.
        let motion = vector.clip.len() - tail(&clip);
        let stride = (vector.clip.len() * 8 / 1500).max(1);
        for bit in (0..vector.clip.len() * 8).step_by(stride) {
            let mut damaged = vector.clip.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(Clip::with_rig(&damaged, &rig).is_err(), "{}: bit {bit} flipped and not found", vector.name);
            let mut frame = 0;
            let end = push(
                Rig::new_checked(&rig).unwrap(),
                &damaged,
                Stream::BUFFER,
                || 100,
                |step, stream| {
                    if step == Progress::Frame {
                        assert!(stream.pose().values == poses[frame], "{}: bit {bit} flipped, frame {frame}", vector.name);
                        frame += 1;
                    }
                    ControlFlow::Continue(())
                },
            );
            let in_rig = bit / 8 >= 4 && bit / 8 < 4 + clip.rig_len();
            let passes = bit / 8 >= motion || in_rig;
            assert!(end != Progress::End || passes, "{}: bit {bit} flipped and played to the end", vector.name);
        }
    }
}

#[test]
fn damage_stays_damage() {
    let vector = all().into_iter().find(|vector| vector.name == "segments").unwrap();
    let rig = rig_of(&vector);
    let mut damaged = vector.clip.clone();
    let at = damaged.len() - 300;
    damaged[at] ^= 4;
    let rig = Rig::new_checked(&rig).unwrap();
    let mut buffer = [0; Stream::BUFFER];
    let (mut states, mut pose) = (vec![ChannelState::default(); rig.channels()], vec![0; rig.channels()]);
    let mut stream = Stream::new(rig, &mut buffer, &mut states, &mut pose).unwrap();
    let mut rest = &damaged[..];
    let first = loop {
        match stream.step() {
            Progress::NeedMore => rest = &rest[stream.feed(rest)..],
            Progress::Damaged(error) => break error,
            Progress::End => panic!("played to the end"),
            _ => {}
        }
    };
    let _ = stream.feed(&vector.clip);
    assert_eq!(stream.step(), Progress::Damaged(first));
}

/// A clip of scalars that all move, and its rig.
fn scalars(frames: u32, channels: usize) -> (Vec<u8>, Vec<u8>) {
    let scalar = |index: usize| motion::Scalar { name: format!("s{index}"), full_scale: 1.0 };
    let figure =
        motion::Rig { joints: vec![], scalars: (0..channels).map(scalar).collect(), cm_per_unit: 1.0, ..Default::default() };
    let rig = rig::encode(&figure).unwrap();
    let channel = |index: usize| {
        let (mut segments, mut frame) = (vec![], 0);
        while frame + 2 < frames {
            // Lengths of 1 to 96 frames; accelerations to either side.
            let mode = ((index + segments.len() * 5) % 16) as u8;
            let side = if segments.len() % 2 == 0 { 1 } else { -1 };
            segments.push(Segment { mode, w: side * (1 + index as i32 % 5), k: 0 });
            frame += u32::from(pantin::codec::segment_frames(mode));
        }
        // From one end of the range: it runs through it and comes round.
        Channel { start: Start::Moving { p: i32::MAX >> 20, v: 3, step: 42 }, segments }
    };
    let coded = Coded {
        frames,
        frame_time_ns: 33_333_333,
        length_exponent: 0,
        exponentials: vec![],
        channels: (0..channels).map(channel).collect(),
        events: vec![],
        event_names: vec![],
        looped: false,
    };
    (clip::encode(&coded, &rig, false).unwrap(), rig)
}

#[test]
fn long_clips_and_many_channels_play_by_every_route() {
    for (frames, channels) in [(65_536, 2), (40, 1000), (40, 1023), (4, 0), (1, 1000)] {
        let (bytes, rig) = scalars(frames, channels);
        let clip = Clip::new_checked(&bytes).unwrap();
        assert_eq!((clip.frames(), clip.moving()), (frames, channels));
        let poses = poses(clip);
        assert_eq!(poses.len(), frames as usize);
        wander(clip, 50, 3, &mut Noise::new(u64::from(frames)));
        let mut frame = 0;
        let end = push(
            Rig::new_checked(&rig).unwrap(),
            &bytes,
            Stream::BUFFER,
            || 500,
            |step, stream| {
                if step == Progress::Frame {
                    assert!(stream.pose().values == poses[frame], "frame {frame} of {frames}, {channels} channels");
                    frame += 1;
                }
                ControlFlow::Continue(())
            },
        );
        assert_eq!((end, frame), (Progress::End, poses.len()));
    }
}

#[test]
fn more_channels_than_the_format_has_are_refused_by_name() {
    let scalar = |index: usize| motion::Scalar { name: format!("s{index}"), full_scale: 1.0 };
    let figure = motion::Rig { joints: vec![], scalars: (0..1024).map(scalar).collect(), cm_per_unit: 1.0, ..Default::default() };
    let error = rig::encode(&figure).unwrap_err().to_string();
    assert!(error.contains("1023") || error.contains("1024"), "{error}");
}

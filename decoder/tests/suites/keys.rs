//! Key clips: the vectors in tests/key-vectors, by every way to a frame, in memory that is exactly as large as they say.

use std::path::Path;

use pantin::codec::crc;
use pantin::{Bank, ChannelState, Clip, Clock, Interpolation, OpenError, PartialClip, Player, Progress, Room, SeekCache, Stream};

/// Most frames of a clip that are played: Miri is some hundred times slower than the machine.
const FRAMES: u32 = if cfg!(miri) { 24 } else { pantin::codec::keys::MAX_KEY_FRAMES };
const IN_MIRI: [&str; 5] = ["kinds", "loop", "events", "malformed-noise", "rig-apart"];

struct Vector {
    name: String,
    clip: Vec<u8>,
    rig: Vec<u8>,
    crcs: Vec<u16>,
}

impl Vector {
    fn open(&self) -> Clip<'_> {
        Clip::with_rig(&self.clip, &self.rig).unwrap()
    }
}

/// None in a packaged crate, which has no vectors.
fn vectors() -> Vec<Vector> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/key-vectors");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is not there", folder.display());
        return vec![];
    };
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "ptn"));
    paths.sort();
    let vector = |path: std::path::PathBuf| {
        let record = std::fs::read_to_string(path.with_extension("json")).unwrap();
        let (_, list) = record.split_once("\"crcs\": [").unwrap();
        let crc = |text: &str| u16::from_str_radix(text.trim().trim_matches('"'), 16).unwrap();
        Vector {
            name: path.file_stem().unwrap().to_string_lossy().into_owned(),
            clip: std::fs::read(&path).unwrap(),
            rig: std::fs::read(path.with_extension("rig")).unwrap_or_default(),
            crcs: list.split_once(']').unwrap().0.split(',').map(crc).collect(),
        }
    };
    paths.into_iter().map(vector).filter(|vector| !cfg!(miri) || IN_MIRI.contains(&&*vector.name)).collect()
}

fn crc_of(values: &[i32]) -> u16 {
    values.iter().fold(crc::INITIAL, |crc, value| crc::update(crc, &value.to_le_bytes()))
}

/// A clip's memory: states and a pose.
fn memory(clip: &Clip<'_>) -> (Vec<ChannelState>, Vec<i32>) {
    (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()])
}

#[test]
fn every_way_to_a_frame_gives_the_recorded_pose() {
    for vector in vectors() {
        let clip = vector.open();
        assert!(clip.has_keys() && clip.frames() as usize == vector.crcs.len(), "{}", vector.name);
        let (mut states, mut pose) = memory(&clip);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        assert_eq!(player.is_malformed(), vector.name.starts_with("malformed"), "{}", vector.name);
        let frames = clip.frames().min(FRAMES);
        let mut stepped = vec![];
        for frame in 0..frames {
            assert_eq!((player.frame(), crc_of(player.pose().values)), (frame, vector.crcs[frame as usize]), "{}", vector.name);
            stepped.push(player.states().to_vec());
            player.step();
        }
        for index in 0..40 {
            let frame = if index == 0 { frames - 1 } else { index * 7919 % frames };
            player.seek(frame);
            assert_eq!(crc_of(player.pose().values), vector.crcs[frame as usize], "{}, frame {frame} by seeking", vector.name);
            assert_eq!(player.states(), stepped[frame as usize], "{}, frame {frame} by seeking", vector.name);
        }
        player.seek(frames - 1);
        let mut cache = SeekCache::new(&player, &mut [], &mut [], &mut [], &mut []);
        for frame in (0..frames - 1).rev().take(70) {
            player.step_back(&mut cache);
            assert_eq!(crc_of(player.pose().values), vector.crcs[frame as usize], "{}, frame {frame} going back", vector.name);
        }
        player.rewind();
        player.step_with(&mut cache);
        assert_eq!(player.frame(), if frames == 1 { 0 } else { 1 });
        player.seek_with(frames / 2, &mut cache);
        assert_eq!(crc_of(player.pose().values), vector.crcs[frames as usize / 2], "{}", vector.name);
    }
}

#[test]
fn memory_must_be_as_large_as_the_clip_says() {
    for vector in vectors() {
        let clip = vector.open();
        let (mut states, mut pose) = memory(&clip);
        let needed = states.len();
        if needed > 0 {
            let small = Player::new(clip, &mut states[1..], &mut pose).unwrap_err();
            assert_eq!((small.needed, small.given), (needed, needed - 1));
        }
        // More is allowed, and holds nothing.
        states.push(ChannelState::NEW);
        let player = Player::new(clip, &mut states, &mut pose).unwrap();
        assert_eq!(crc_of(player.pose().values), vector.crcs[0], "{}", vector.name);
        assert_eq!(player.states().len(), player.detach().moving_channels());
        assert_eq!(states[needed], ChannelState::NEW);
    }
}

#[test]
fn a_clip_that_comes_in_pieces_plays_once_it_is_whole() {
    for vector in vectors().into_iter().filter(|vector| vector.rig.is_empty() && !cfg!(miri)) {
        let clip = vector.open();
        let (mut states, mut pose) = memory(&clip);
        let motion_end = vector.clip.len() - clip.event_names_len() - usize::from(clip.event_names_len() > 0);
        for len in (0..vector.clip.len()).step_by(7) {
            let Ok(partial) = PartialClip::new(&vector.clip[..len]) else { continue };
            let player = partial.player(&mut states, &mut pose).unwrap();
            assert_eq!(player.is_some(), len >= motion_end, "{}, {len} bytes", vector.name);
        }
        let mut partial = PartialClip::new(&vector.clip).unwrap();
        let mut player = partial.player(&mut states, &mut pose).unwrap().unwrap();
        for crc in &vector.crcs[1..] {
            assert!(partial.step(&mut player));
            assert_eq!(crc_of(player.pose().values), *crc, "{}", vector.name);
        }
        assert!(!partial.step(&mut player));
        assert_eq!(partial.finish(&vector.clip), Ok(()));
    }
}

#[test]
fn a_stream_names_the_version_that_it_cannot_play() {
    for vector in vectors() {
        let clip = vector.open();
        let (mut states, mut pose, mut buffer) = (vec![ChannelState::NEW; 4], vec![0; 1023], [0; Stream::BUFFER]);
        let mut stream = Stream::new(clip.rig(), &mut buffer, &mut states, &mut pose).unwrap();
        let mut rest = &vector.clip[..];
        let refused = loop {
            match stream.step() {
                Progress::NeedMore => rest = &rest[stream.feed(&rest[..rest.len().min(50)])..],
                other => break other,
            }
        };
        assert_eq!(refused, Progress::Damaged(OpenError::UnsupportedVersion(2)), "{}", vector.name);
    }
}

#[test]
fn any_damaged_byte_is_found() {
    for vector in vectors().into_iter().filter(|vector| vector.clip.len() < 700 && vector.name != "sections") {
        let mut bytes = vector.clip.clone();
        for at in (0..bytes.len()).step_by(if cfg!(miri) { 17 } else { 1 }) {
            bytes[at] ^= 1 << (at % 8);
            assert!(Clip::with_rig(&bytes, &vector.rig).is_err(), "{}, byte {at}", vector.name);
            bytes[at] ^= 1 << (at % 8);
            assert!(Clip::with_rig(&bytes[..at], &vector.rig).is_err(), "{}, the first {at} bytes", vector.name);
        }
    }
}

#[test]
fn flags_and_a_head_out_of_bounds_are_refused() {
    let Some(vector) = vectors().into_iter().find(|vector| vector.name == "events") else { return };
    let rig_len = vector.open().rig_len();
    let mended = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = vector.clip.clone();
        change(&mut bytes);
        let at = 4 + rig_len;
        let len = usize::from(bytes[at]);
        let seed = crc::update(crc::of(&bytes[..4]), &(len as u32).to_le_bytes());
        let crc = crc::update(seed, &bytes[at + 1..at + len - 1]);
        bytes[at + len - 1..at + len + 1].copy_from_slice(&crc.to_le_bytes());
        Clip::new_checked(&bytes).map(|clip| clip.frames())
    };
    assert_eq!(mended(&|_| ()), Ok(30));
    // Exponential maps, an index, and the bit that no version has.
    for flag in [4, 16, 128] {
        assert_eq!(mended(&|bytes| bytes[3] |= flag), Err(OpenError::Malformed), "flag {flag}");
    }
    // The number of frames, one byte, is at 6 behind the rig; 8192 frames and 14131 states take two.
    let two = |at: usize, value: u16| {
        mended(&move |bytes: &mut Vec<u8>| {
            let at = 4 + rig_len + at;
            bytes.splice(at..=at, [value as u8 | 0x80, (value >> 7) as u8]);
            bytes[4 + rig_len] += 1;
        })
    };
    assert_eq!((two(2, 8191), two(2, 8192)), (Ok(8191), Err(OpenError::Malformed)));
    assert_eq!((two(4, 14_130).is_ok(), two(4, 14_131)), (true, Err(OpenError::Malformed)));
    assert_eq!(mended(&|bytes| bytes[2] = 3), Err(OpenError::UnsupportedVersion(3)));
}

#[test]
fn keys_are_those_that_were_written() {
    let Some(vector) = vectors().into_iter().find(|vector| vector.name == "walk") else { return };
    let clip = vector.open();
    let mut room = Room::<96, 144>::new();
    let player = room.player(clip).unwrap();
    let shin = clip.find("left-shin").unwrap();
    let index = player.states().iter().position(|state| state.slot() == shin.first_channel()).unwrap();
    let keys = player.channel_keys(index).unwrap();
    assert_eq!(keys.interpolation(), Interpolation::Discrete);
    let written = [(0, 20_400), (32, 5400), (80, 23_700), (112, 73_600), (160, 20_400)];
    assert!(keys.iter().eq(written), "{:?}", keys.iter().collect::<Vec<_>>());
    assert!(player.channel_keys(player.states().len()).is_none());
}

#[test]
fn time_and_a_detached_player_go_as_in_any_clip() {
    let Some(vector) = vectors().into_iter().find(|vector| vector.name == "run") else { return };
    let clip = vector.open();
    let (mut states, mut pose) = memory(&clip);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let mut clock = Clock::new(&clip);
    for _ in 0..300 {
        player.advance(&mut clock, 7001);
        assert_eq!(crc_of(player.pose().values), vector.crcs[player.frame() as usize]);
    }
    let mut out = vec![0; clip.rig().channels()];
    assert!(player.interpolate(fixed::types::U0F16::ZERO, &mut out).unwrap().values == player.pose().values);
    let mut detached = player.detach();
    for _ in 0..2 * clip.frames() {
        detached.step(&mut states, &mut pose);
        assert_eq!(crc_of(detached.pose(&pose).values), vector.crcs[detached.frame() as usize]);
    }
    detached.seek(3, &mut states, &mut pose);
    assert_eq!(crc_of(&pose), vector.crcs[3]);
}

#[test]
fn a_bank_of_version_2_opens_and_one_of_version_3_does_not() {
    let bank = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/vectors/bank.ptb"));
    let Ok(mut bank) = bank else { return };
    bank[2] = 2;
    assert!(Bank::new_checked(&bank).is_ok());
    bank[2] = 3;
    assert_eq!(Bank::new_checked(&bank).err(), Some(OpenError::UnsupportedVersion(3)));
}

#[test]
fn a_loop_leads_from_its_last_frame_to_its_first() {
    for vector in vectors().into_iter().filter(|vector| ["run", "library-dance"].contains(&&*vector.name)) {
        let clip = vector.open();
        let (mut states, mut pose) = memory(&clip);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let first = player.pose().values.to_vec();
        player.seek(u32::MAX);
        let last = player.pose().values.to_vec();
        let velocities: Vec<_> = player.states().iter().map(|state| (state.slot(), state.rates()[0])).collect();
        let mut out = vec![0; last.len()];
        player.interpolate(fixed::types::U0F16::from_num(0.5), &mut out).unwrap();
        let half = |way: i32| ((i64::from(way) * 0x8000) >> 16) as i32;
        let mut returned = 0;
        for &(slot, v) in &velocities {
            let back = last[slot].wrapping_add(half(first[slot].wrapping_sub(last[slot])));
            assert!([back, last[slot].wrapping_add(half(v))].contains(&out[slot]), "{}, channel {slot}", vector.name);
            returned += usize::from(out[slot] == back);
        }
        // All channels but those of a root that travels.
        assert!(returned + 3 >= velocities.len() && !velocities.is_empty(), "{}: {returned} channels return", vector.name);
        let detached = player.detach();
        detached.lead_to_start(&mut states, &pose);
        let to = |state: &ChannelState| last[state.slot()].wrapping_add(half(state.rates()[0]));
        assert!(states[..detached.moving_channels()].iter().all(|state| to(state) == out[state.slot()]), "{}", vector.name);
    }
}

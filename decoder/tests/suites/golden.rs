//! The repository's golden vectors, played by stepping, seeking, reversing, streaming and from a growing buffer. Mutation tests and Miri run this: it
//! takes a few seconds at most.

use std::path::{Path, PathBuf};

use pantin::codec::{crc, layout::HAS_SECTIONS};
use pantin::{ChannelState, Clip, PartialClip, Player, Progress, SeekCache, SnapshotPos, Stream, Undo};

/// Miri is some hundred times slower than the machine.
const FRAMES: usize = if cfg!(miri) { 24 } else { usize::MAX };
/// Bytes of the sections of the only vector that has some: this version does not define them, and may find no damage in them.
const SECTIONS: usize = 7;
/// Vectors that Miri plays: each kind of channel, events, followers, an index, a rig apart.
const IN_MIRI: [&str; 6] = ["events", "followers", "index", "mixed", "quaternion", "rig-apart"];

struct Vector {
    name: String,
    clip: Vec<u8>,
    rig: Option<Vec<u8>>,
    record: String,
}

impl Vector {
    fn open(&self) -> Clip<'_> {
        match &self.rig {
            Some(rig) => Clip::with_rig(&self.clip, rig).unwrap(),
            None => Clip::new_checked(&self.clip).unwrap(),
        }
    }

    /// The value of one of the record's fields, without blanks and the brackets of a list.
    fn field(&self, name: &str) -> String {
        let (_, value) =
            self.record.split_once(&format!("\n  \"{name}\": ")).unwrap_or_else(|| panic!("{}: no {name}", self.name));
        let end = [value.find("\n  \""), value.find("\n}")].into_iter().flatten().min().unwrap();
        let value: String = value[..end].split_whitespace().collect();
        let value = value.trim_end_matches(',');
        value.strip_prefix('[').and_then(|value| value.strip_suffix(']')).unwrap_or(value).to_owned()
    }

    fn number(&self, name: &str) -> i64 {
        self.field(name).parse().unwrap()
    }

    /// The CRC of each pose.
    fn crcs(&self) -> Vec<u16> {
        let crc = |text: &str| u16::from_str_radix(text.trim_matches('"'), 16).unwrap();
        self.field("crcs").split(',').map(crc).take(FRAMES).collect()
    }
}

/// `None` in a packaged crate, which has no vectors.
fn vectors() -> Option<Vec<Vector>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/vectors");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is not there", folder.display());
        return None;
    };
    let mut clips: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    clips.retain(|path| path.extension().is_some_and(|extension| extension == "ptn"));
    clips.sort();
    let vectors = clips.into_iter().map(|path| Vector {
        name: path.file_stem().unwrap().to_string_lossy().into_owned(),
        clip: std::fs::read(&path).unwrap(),
        rig: std::fs::read(path.with_extension("rig")).ok(),
        record: std::fs::read_to_string(path.with_extension("json")).unwrap(),
    });
    Some(vectors.filter(|vector| !cfg!(miri) || IN_MIRI.contains(&&*vector.name)).collect())
}

fn crc_of(values: &[i32]) -> u16 {
    values.iter().fold(crc::INITIAL, |crc, value| crc::update(crc, &value.to_le_bytes()))
}

#[test]
fn what_a_clip_states_is_what_the_record_has() {
    for vector in vectors().into_iter().flatten() {
        let clip = vector.open();
        let stated = [
            ("frames", i64::from(clip.frames())),
            ("frame_time_ns", i64::from(clip.frame_time_ns())),
            ("joints", clip.rig().joint_count() as i64),
            ("channels", clip.rig().channels() as i64),
            ("moving", clip.moving() as i64),
            ("length_exponent", i64::from(clip.length_exponent())),
        ];
        for (name, value) in stated {
            assert_eq!(value, vector.number(name), "{}: {name}", vector.name);
        }
        assert_eq!(clip.looped().to_string(), vector.field("looped"), "{}", vector.name);
        let exponential = (0..clip.rig().joint_count()).filter(|&joint| clip.is_exponential(joint));
        let listed = exponential.map(|joint| joint.to_string()).collect::<Vec<_>>().join(",");
        assert_eq!(listed, vector.field("exponential_joints"), "{}", vector.name);
        let events = clip.events().map(|event| format!("[{},{}]", event.frame, event.id)).collect::<Vec<_>>().join(",");
        assert_eq!(events, vector.field("events"), "{}", vector.name);
        assert_eq!(clip.event_count(), clip.events().count());
    }
}

#[test]
fn every_way_to_a_frame_gives_the_recorded_pose() {
    for vector in vectors().into_iter().flatten() {
        let clip = vector.open();
        let (crcs, channels, moving) = (vector.crcs(), clip.rig().channels(), clip.moving());
        let (mut states, mut pose) = (vec![ChannelState::NEW; moving], vec![0; channels]);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let mut stepped = vec![];
        for (frame, &crc) in crcs.iter().enumerate() {
            assert_eq!(crc_of(player.pose().values), crc, "{}, frame {frame} by stepping", vector.name);
            stepped.push(player.states().to_vec());
            player.step();
        }
        let check = |player: &Player<'_, '_>, frame: usize, way: &str| {
            assert_eq!(player.frame() as usize, frame, "{}, {way}", vector.name);
            assert_eq!(crc_of(player.pose().values), crcs[frame], "{}, frame {frame} by {way}", vector.name);
            assert_eq!(player.states(), stepped[frame], "{}, frame {frame} by {way}", vector.name);
        };
        for index in 0..12 {
            let frame = if index == 0 { crcs.len() - 1 } else { index * 7919 % crcs.len() };
            player.seek(frame as u32);
            check(&player, frame, "seeking");
        }
        player.rewind();
        check(&player, 0, "rewinding");
        let mut lent =
            ([Undo::default(); 9], [SnapshotPos::default(); 3], vec![ChannelState::NEW; 3 * moving], vec![0; 3 * channels]);
        let mut memory = SeekCache::new(&player, &mut lent.0, &mut lent.1, &mut lent.2, &mut lent.3);
        for target in [crcs.len() - 1, crcs.len() / 3, crcs.len() / 2] {
            player.seek_with(target as u32, &mut memory);
            check(&player, target, "seeking with memory");
            for back in 1..=target.min(40) {
                player.step_back(&mut memory);
                check(&player, target - back, "going back");
            }
        }
    }
}

#[test]
fn bytes_in_pieces_give_the_recorded_poses() {
    for vector in vectors().into_iter().flatten() {
        let (clip, crcs) = (vector.open(), vector.crcs());
        let channels = clip.rig().channels();
        for size in if cfg!(miri) { [13, 257].as_slice() } else { &[13, 255, 256, 257, 100_000] }.iter().copied() {
            let (mut states, mut pose, mut buffer) = (vec![ChannelState::NEW; channels], vec![0; channels], [0; Stream::BUFFER]);
            let mut stream = Stream::new(clip.rig(), &mut buffer, &mut states, &mut pose).unwrap();
            let (mut rest, mut frame, mut events) = (&vector.clip[..], 0, vec![]);
            while frame < crcs.len() {
                match stream.step() {
                    Progress::NeedMore => rest = &rest[stream.feed(&rest[..size.min(rest.len())])..],
                    Progress::Frame => {
                        assert_eq!(crc_of(stream.pose().values), crcs[frame], "{}, frame {frame} by streaming", vector.name);
                        assert_eq!(stream.frame() as usize, frame);
                        frame += 1;
                    }
                    Progress::Opened => {}
                    Progress::Event(event) => events.push(event),
                    other => panic!("{}: {other:?}", vector.name),
                }
            }
            assert!(clip.events().eq(events.iter().copied()), "{}", vector.name);
            if frame == clip.frames() as usize {
                assert_eq!(stream.step(), Progress::End, "{}", vector.name);
            }
        }
        if vector.rig.is_none() {
            let (mut states, mut pose) = (vec![ChannelState::NEW; channels], vec![0; channels]);
            let (mut paused, mut frame) = (None::<pantin::PausedClip>, 0);
            for len in (0..vector.clip.len()).step_by(11).chain([vector.clip.len()]) {
                let file = &vector.clip[..len];
                let started = match &paused {
                    Some(paused) => Some(paused.resume(file, &mut states, &mut pose).unwrap()),
                    None => PartialClip::new(file).ok().and_then(|partial| {
                        let player = partial.player(&mut states, &mut pose).unwrap()?;
                        assert_eq!(crc_of(player.pose().values), crcs[0]);
                        Some((partial, player))
                    }),
                };
                let Some((mut partial, mut player)) = started else { continue };
                while frame + 1 < crcs.len() && partial.step(&mut player) {
                    frame += 1;
                    assert_eq!(crc_of(player.pose().values), crcs[frame], "{}, frame {frame} of a growing buffer", vector.name);
                }
                if len == vector.clip.len() {
                    assert_eq!(partial.finish(file), Ok(()), "{}", vector.name);
                }
                paused = Some(partial.pause(player));
            }
            assert_eq!(frame + 1, crcs.len(), "{}", vector.name);
        }
    }
}

#[test]
fn any_damaged_byte_is_found() {
    for vector in vectors().into_iter().flatten().filter(|vector| vector.clip.len() < 600) {
        let mut bytes = vector.clip.clone();
        if bytes[3] & HAS_SECTIONS != 0 {
            bytes.truncate(bytes.len() - SECTIONS);
        }
        let rig = vector.rig.as_deref().unwrap_or(&[]);
        for at in (0..bytes.len()).step_by(if cfg!(miri) { 17 } else { 1 }) {
            bytes[at] ^= 1 << (at % 8);
            assert!(Clip::with_rig(&bytes, rig).is_err(), "{}, byte {at}", vector.name);
            bytes[at] ^= 1 << (at % 8);
            assert!(Clip::with_rig(&bytes[..at], rig).is_err(), "{}, the first {at} bytes", vector.name);
        }
    }
}

#[test]
fn a_player_writes_the_snapshots_that_the_file_holds() {
    for vector in vectors().into_iter().flatten().filter(|vector| vector.name == "index") {
        let clip = vector.open();
        let (mut states, mut pose) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        let mut found = 0;
        for _ in 1..clip.frames() {
            player.step();
            let mut bytes = vec![];
            pantin::codec::write_snapshot(&player, &mut |byte| bytes.push(byte));
            // A snapshot across two blocks has a CRC inside.
            found += usize::from(vector.clip.windows(bytes.len()).any(|own| own == bytes));
        }
        assert!(found >= 2, "{found}");
    }
}

//! What clips, clocks and errors say about themselves.

use fixed::types::{I16F16, U0F16};
use pantin::codec::layout::{BLOCK_BYTES, CRC_BYTES};
use pantin::{Clip, Clock, Memory, OpenError, TooSmall};

static WALK: &[u8] = include_bytes!("../walk.ptn");
static RUN: &[u8] = include_bytes!("../run.ptn");

/// A clip that is no loop; `None` where the package has no vectors.
fn open() -> Option<Vec<u8>> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/vectors/segments.ptn")).ok()
}

/// Most bytes of a file beside rig and motion, where it has neither an index nor names of events.
const FIXED: usize = 24;

#[test]
fn the_parts_of_a_file_add_up() {
    for file in [WALK, RUN] {
        let clip = Clip::new_checked(file).unwrap();
        let blocks = (clip.motion_len() - CRC_BYTES).div_ceil(BLOCK_BYTES + CRC_BYTES);
        assert_eq!((clip.crc_len(), clip.index_len(), clip.event_names_len()), (CRC_BYTES * blocks, 0, 0));
        assert!(clip.rig_len() > clip.rig().joint_count() && clip.head_len() > 0 && clip.head_len() < clip.motion_len());
        let parts = clip.rig_len() + clip.motion_len();
        assert!(parts < file.len() && parts + FIXED > file.len(), "{parts} of {}", file.len());
        assert!(clip.find("head").is_some() && clip.find("wing").is_none());
        assert!(clip.find_scalar("head").is_none());
        assert!(clip.kinds(clip.rig().joint_count()).next().is_none() && clip.kinds(0).next().is_some());
    }
}

#[test]
fn a_clip_knows_its_time() {
    let Some(open) = open() else { return };
    for (file, looped) in [(&open[..], false), (WALK, true), (RUN, true)] {
        let clip = Clip::new_checked(file).unwrap();
        let (frames, frame_ns) = (clip.frames(), u64::from(clip.frame_time_ns()));
        assert_eq!(clip.looped(), looped);
        let steps = if looped { frames } else { frames - 1 };
        assert_eq!(clip.duration_ns(), u64::from(steps) * frame_ns);
        // Ten microseconds behind the beginning of a frame, which times in microseconds do not meet.
        let begin = |frame: u32| u64::from(frame) * frame_ns / 1000 + 10;
        for frame in [0, 1, frames - 1] {
            assert_eq!(clip.frame_at(begin(frame)), frame);
        }
        for (late, shown) in [(frames, 0), (frames + 2, 2), (3 * frames + 1, 1)] {
            assert_eq!(clip.frame_at(begin(late)), if looped { shown } else { frames - 1 });
        }
    }
}

#[test]
fn a_clock_seeks_ends_and_says_how_far_it_is() {
    let Some(open) = open() else { return };
    let clip = Clip::new_checked(&open).unwrap();
    let (last, frame_us) = (clip.frames() - 1, clip.frame_time_ns() / 1000);
    let mut clock = Clock::new(&clip);
    assert_eq!((clock.frame(), clock.part(), clock.speed(), clock.ended()), (0, U0F16::ZERO, I16F16::ONE, false));
    for (asked, speed) in [(20, 16), (-20, -16), (3, 3)] {
        clock.set_speed(I16F16::from_num(asked));
        assert_eq!(clock.speed(), I16F16::from_num(speed));
    }
    clock.set_speed(I16F16::ONE);
    for (asked, frame) in [(7, 7), (last, last), (last + 1, last), (u32::MAX, last)] {
        clock.seek(frame);
        clock.seek(asked);
        assert_eq!((clock.frame(), clock.part()), (frame, U0F16::ZERO));
    }
    clock.seek(5);
    clock.advance(frame_us / 4);
    let part = clock.part().to_num::<f64>();
    assert!(clock.frame() == 5 && (part - 0.25).abs() < 0.01, "{part}");
    clock.seek(last - 1);
    clock.advance(frame_us / 2);
    assert!(clock.part() > U0F16::from_num(0.4));
    // The last frame has no next one, and is shown for its time.
    clock.advance(frame_us);
    assert_eq!((clock.frame(), clock.part(), clock.ended()), (last, U0F16::ZERO, false));
    clock.advance(frame_us);
    assert_eq!((clock.frame(), clock.ended()), (last, true));
    clock.set_speed(I16F16::from_num(-1));
    assert!(!clock.ended());
    clock.seek(0);
    clock.advance(0);
    assert!(!clock.ended());
    clock.advance(1);
    assert_eq!((clock.frame(), clock.ended()), (0, true));
    clock.seek(3);
    assert!(!clock.ended());
    // The end itself is the end.
    clock.set_speed(I16F16::ONE);
    clock.seek(last);
    clock.advance(frame_us + 1);
    assert!(clock.ended());
}

#[test]
fn errors_say_what_is_wrong() {
    let errors = [
        (OpenError::BadMagic, "not a pantin clip"),
        (OpenError::UnsupportedVersion(7), "0x07"),
        (OpenError::Truncated, "truncated"),
        (OpenError::BadCrc, "CRC"),
        (OpenError::Malformed, "malformed"),
        (OpenError::WrongRig, "another rig"),
        (OpenError::NoSuchClip, "no clip of this name"),
        (OpenError::IsBank, "a bank"),
    ];
    for (error, words) in errors {
        assert!(error.to_string().contains(words), "{error}");
    }
    for (memory, words) in
        [(Memory::States, "states"), (Memory::Values, "values"), (Memory::Buffer, "buffer"), (Memory::Rig, "rig")]
    {
        let said = TooSmall { memory, needed: 12, given: 3 }.to_string();
        assert!(said.contains(words) && said.contains("needs 12") && said.contains("3 were given"), "{said}");
    }
}

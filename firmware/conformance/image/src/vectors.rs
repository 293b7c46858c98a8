//! The vectors in the image, and the program that is the same everywhere.

use conformance::Play;
use pantin::{ChannelState, Clip};
use pantin_animator::{LayerMemory, Workspace};

/// Channels that the memory here suffices for.
const CHANNELS: usize = 300;

/// A clip in the image, and its rig if it stands apart.
struct Vector {
    name: &'static str,
    clip: &'static [u8],
    rig: &'static [u8],
}

const VECTORS: &[Vector] = include!(concat!(env!("OUT_DIR"), "/vectors.rs"));

/// Our character and a session of it.
static BANK: &[u8] = include_bytes!("../../../../motions/character.ptb");
const SESSION: &str = include_str!("../../../../motions/steer.txt");
/// Channels of the character.
const CHARACTER: usize = 64;

/// Plays all vectors and the session, and gives `print` the lines; false if one does not play.
pub fn run(print: &mut dyn FnMut(&[u8])) -> bool {
    clips(print) && steer(print)
}

#[inline(never)]
fn steer(print: &mut dyn FnMut(&[u8])) -> bool {
    let mut memory = Workspace::<CHARACTER, CHARACTER>::new();
    let (mut states, mut values, mut sampled) = ([ChannelState::NEW; CHARACTER], [0; CHARACTER], [0; CHARACTER]);
    let mut words = [0; 2];
    let layer = LayerMemory { states: &mut states, values: &mut values, sampled: &mut sampled, words: &mut words };
    print(conformance::STEERED.as_bytes());
    print(b"\n");
    conformance::steer(BANK, SESSION, memory.lend(), layer, &mut |way, crc| print(&line(way, crc)))
}

#[inline(never)]
fn clips(print: &mut dyn FnMut(&[u8])) -> bool {
    let mut states = [ChannelState::default(); CHANNELS];
    let mut pose = [0; CHANNELS];
    for vector in VECTORS {
        print(vector.name.as_bytes());
        print(b"\n");
        let clip = if vector.rig.is_empty() { Clip::new_checked(vector.clip) } else { Clip::with_rig(vector.clip, vector.rig) };
        let played = clip.map(|clip| {
            let pose = pose.get_mut(..clip.rig().channels()).unwrap_or(&mut []);
            conformance::play(clip, &mut states, pose, &mut |way, crc| print(&line(way, crc)))
        });
        if !matches!(played, Ok(Ok(()))) {
            return false;
        }
    }
    true
}

/// `step 01ef`
fn line(way: Play, crc: u16) -> [u8; 10] {
    let mut line = match way {
        Play::Progress => *b"step 0000\n",
        Play::Seek => *b"seek 0000\n",
    };
    for (digit, shift) in line[5..9].iter_mut().zip([12, 8, 4, 0]) {
        *digit = b"0123456789abcdef"[usize::from(crc >> shift & 15)];
    }
    line
}

//! Key clips: motions that keep their keys, FORMAT.md sections 18 to 22. Opening reads the keys into memory that the caller lends and solves for the
//! curves' second differences. From then on every channel plays by the same three additions as any clip, and begins again from its exact value at each key.

mod channels;
mod grid;
pub mod layout;
mod numbers;
mod range;
mod span;
mod spline;
mod view;
mod words;

pub use view::{ChannelKeys, Interpolation};

use crate::channel::ChannelState;
use crate::clip::Clip;
use crate::entropy::Cursor;
use crate::joint::Joints;
use crate::kind::Kind;
use crate::play_state::{Channels, PlayState};
use crate::scalar::Scalars;
use crate::start::shifted;
use channels::{Channel, Keys, Reading};
use grid::Frames;
use layout::MAX_THOUSANDTHS;
use numbers::{Scale, class, shift_rounded};
use range::Bits;
use spline::Solver;

/// Whether the clip of this player was malformed. A key clip has no use for a cursor otherwise.
pub(crate) fn is_malformed(position: &PlayState) -> bool {
    position.cursor.position != 0
}

/// Opens a key clip into states, exactly as many as it needs, and a pose, which then is that of frame 0. A malformed clip rests at all frames.
#[inline(never)]
pub(crate) fn open(clip: &Clip<'_>, states: &mut [ChannelState], pose: &mut [i32]) -> PlayState {
    let (moving, malformed) = read(clip, states, pose);
    let mut position = PlayState { cursor: Cursor::at(u32::from(malformed), 0), frame: 0, next: moving };
    seek(&mut position, &mut Channels { states, pose }, 0, clip.looped());
    position
}

/// Reads the channels and solves for their curves. Returns how many have keys, and whether a rule is broken.
#[inline(never)]
fn read(clip: &Clip<'_>, states: &mut [ChannelState], pose: &mut [i32]) -> (u16, bool) {
    let frames = Frames::new(clip.frames(), clip.looped());
    let mut reading = Reading::new(Bits::new(clip.input(), clip.symbols()), states, frames);
    read_channels(clip, &mut reading, pose);
    let scratch = reading.finish();
    if !reading.malformed {
        reading.malformed = solve(&mut reading, scratch).is_none();
    }
    if reading.malformed {
        // The channels before the broken rule rest too.
        read_channels(clip, &mut reading, pose);
        reading.moving = 0;
    }
    (reading.moving as u16, reading.malformed)
}

/// Solves for the curves of all channels, one grid's numbers at a time.
#[inline(never)]
fn solve(reading: &mut Reading<'_, '_>, scratch: [usize; 2]) -> Option<()> {
    let mut prepared = usize::MAX;
    for index in 0..reading.moving {
        let state = reading.states.get(index)?;
        let (keys, scale) = (Keys::of(reading.states, state), Scale(state.mode));
        if keys.grid.is_spline() {
            let solver = Solver { grid: keys.grid, scratch, looped: reading.frames.looped };
            if prepared != keys.grid.at {
                solver.prepare(reading.states)?;
                prepared = keys.grid.at;
            }
            solver.solve(reading.states, &keys, scale)?;
        }
    }
    Some(())
}

/// Reads every channel of the rig, in the order of the pose. Once a rule is broken, channels rest.
#[inline(never)]
fn read_channels(clip: &Clip<'_>, reading: &mut Reading<'_, '_>, pose: &mut [i32]) {
    let rig = clip.rig();
    let (unit, own) = (clip.length_exponent(), rig.length_exponent());
    let mut joints: Joints<'_> = rig.joints();
    let mut scalars = None;
    let mut slot = 0;
    for value in pose.iter_mut() {
        let (mut kind, mut offset, mut exponent) = (Kind::Scalar, 0, 0);
        loop {
            if scalars.is_none() {
                if let Some(next) = joints.joint.kinds.next() {
                    kind = next;
                    // The first three kinds are positions, in the order of the axes.
                    offset = joints.joint.offset.get(kind as usize).copied().unwrap_or(0);
                    break;
                }
                if joints.read() {
                    continue;
                }
            }
            let count = (rig.channels() - rig.joint_channels()) as u16;
            exponent = scalars.get_or_insert_with(|| Scalars::new(joints.reader, count)).read().exponent;
            break;
        }
        *value = shifted(offset, i32::from(own) - i32::from(unit));
        if !reading.malformed {
            let channel = Channel { slot, class: class(kind), scale: Scale::of(kind, unit, exponent), rest: rest(offset, own) };
            reading.channel(&channel, value);
        }
        slot += 1;
    }
}

/// An offset of a rig in thousandths of its unit; 0 if that is out of bounds.
fn rest(offset: i32, exponent: i8) -> i32 {
    // Below 2^42.
    let thousandths = i64::from(offset) * 1000;
    let rest = match u32::try_from(exponent) {
        // Offsets of a unit of 2^20 are out of bounds, and those of more.
        Ok(exponent) => thousandths << exponent.min(20),
        Err(_) => shift_rounded(thousandths, u32::from(exponent.unsigned_abs())),
    };
    if rest.abs() < MAX_THOUSANDTHS { rest as i32 } else { 0 }
}

/// A channel's value at frame 0. `words` are the states behind those of all channels.
pub(crate) fn first_value(state: &ChannelState, words: &[ChannelState]) -> i32 {
    Scale(state.mode).raw(Keys::of(words, state).value(words, 0)) as i32
}

/// Goes on by one frame, which is not the last.
#[inline(never)]
pub(crate) fn step(position: &mut PlayState, channels: &mut Channels<'_>, looped: bool) {
    let frame = position.frame + 1;
    let Some((moving, words)) = channels.states.split_at_mut_checked(position.next.into()) else { return };
    for state in moving {
        state.add(channels.pose);
        if state.due == frame as u8 {
            let Some(p) = channels.pose.get_mut(state.slot()) else { continue };
            span::start(state, p, words, frame, looped);
        }
    }
    position.frame = frame;
}

/// Goes to any frame of the clip.
#[inline(never)]
pub(crate) fn seek(position: &mut PlayState, channels: &mut Channels<'_>, frame: u32, looped: bool) {
    let Some((moving, words)) = channels.states.split_at_mut_checked(position.next.into()) else { return };
    for state in moving {
        let Some(p) = channels.pose.get_mut(state.slot()) else { continue };
        let into = span::start(state, p, words, frame, looped);
        state.hop(p, into);
    }
    position.frame = frame;
}

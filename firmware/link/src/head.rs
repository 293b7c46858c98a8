//! HEAD and STARTS packets, which describe a clip and its channels.

use crate::symbols::{Coder, SymbolReader};
use pantin::Form;
use pantin::codec::crc;
use pantin::codec::layout::MAX_STEP;

/// Version of the payloads: the first byte of an identity.
const VERSION: u8 = 1;
/// The check of a HEAD.
pub const HEAD_CHECK: u16 = VERSION as u16;
/// Most bytes of exponential bits (FORMAT.md 4) that a HEAD packet carries: those of 8 joints with a choice each.
pub const EXPONENTIAL_BYTES: usize = 16;

/// Whether a HEAD packet can carry this form: whether no joint past the first 128 with a choice is coded as an exponential map.
pub fn fits(form: &Form) -> bool {
    form.exponentials().skip(EXPONENTIAL_BYTES).all(|byte| byte == 0)
}

/// The exponential bits as they go over the line.
fn exponentials(form: &Form) -> [u8; EXPONENTIAL_BYTES] {
    let mut bytes = [0; EXPONENTIAL_BYTES];
    bytes.iter_mut().zip(form.exponentials()).for_each(|(byte, own)| *byte = own);
    bytes
}

/// The description of a clip that is sent. `Default` describes no valid clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// A random number chosen when the sender starts: it tells the packets of two senders apart.
    pub session: u16,
    /// The number of the clip within the session, modulo 256.
    pub clip: u8,
    /// What the values of its poses mean.
    pub form: Form,
    /// Number of frames.
    pub frames: u32,
    /// Whether frame 0 follows the last frame.
    pub looped: bool,
    /// Nanoseconds per frame.
    pub frame_time_ns: u32,
    /// Channels of a pose.
    pub channels: u16,
    /// The line frame at which the clip's frame 0 is shown. Line frames keep counting through the repetitions of a clip.
    pub begin: u32,
}

impl Head {
    /// Writes this description and the sender's line frame to an encoder, or reads both from a decoder.
    pub fn code<C: Coder>(&self, coder: &mut C, now: u32) -> (Head, u32) {
        let form = self.form;
        let mut head = Head {
            session: coder.bits(16, u32::from(self.session)) as u16,
            clip: coder.bits(8, u32::from(self.clip)) as u8,
            form: Form::new(
                coder.bits(32, form.rig_id()),
                coder.bits(8, u32::from(form.length_exponent() as u8)) as u8 as i8,
                [],
            ),
            frames: coder.bits(25, self.frames),
            looped: coder.bits(1, u32::from(self.looped)) != 0,
            frame_time_ns: coder.bits(32, self.frame_time_ns),
            channels: coder.bits(10, u32::from(self.channels)) as u16,
            begin: coder.bits(32, self.begin),
        };
        let own = exponentials(&form);
        let used = own.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
        let used = coder.bits(5, used as u32) as usize;
        let bytes = own.iter().take(used).map(|&own| coder.bits(8, u32::from(own)) as u8);
        head.form = Form::new(head.form.rig_id(), head.form.length_exponent(), bytes);
        (head, coder.bits(32, now))
    }

    /// Reads the payload of a HEAD packet: the description, and the sender's line frame. Returns `None` if it is damaged or describes no valid clip.
    pub fn read(payload: &[u8]) -> Option<(Head, u32)> {
        let mut reader = SymbolReader::new(payload);
        let read = Head::default().code(&mut reader, 0);
        let sound = read.0.frames > 0 && read.0.frame_time_ns > 0;
        (sound && reader.ends_with(HEAD_CHECK)).then_some(read)
    }

    /// Returns the check of the clip's STARTS packets, from which that of its MOTION packets derives.
    pub fn identity(&self) -> u16 {
        let mut sum = crc::of(&[VERSION, self.clip, u8::from(self.looped), self.form.length_exponent() as u8]);
        for part in
            [self.form.rig_id(), self.frames, self.frame_time_ns, self.begin, u32::from(self.session), u32::from(self.channels)]
        {
            sum = crc::update(sum, &part.to_le_bytes());
        }
        crc::update(sum, &exponentials(&self.form))
    }

    /// Returns the check of a MOTION packet with this first line frame.
    pub fn check(&self, frame: u32) -> u16 {
        crc::update(self.identity(), &(frame >> 16).to_le_bytes())
    }
}

/// What a channel does during the whole clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelKind {
    /// It has this raw value at all frames.
    Constant(i32),
    /// It moves.
    Moving {
        /// Index of its step, 0 to [`MAX_STEP`]: FORMAT.md 7.
        step: u8,
        /// Index of its [`pace`], the largest change per frame of the drawn value.
        pace: u8,
    },
    /// It equals the channel that many places before it in the pose.
    Follower(u16),
}

/// Greatest index of a [`pace`].
pub const MAX_PACE: u8 = 61;

/// Returns a pace in raw units per frame: 0, 1, 2, 3, 4, 6, 8, 12, ..., 2^31 - 1.
pub const fn pace(index: u8) -> i32 {
    match index {
        0 => 0,
        1 => 1,
        MAX_PACE.. => i32::MAX,
        _ => (2 | (index & 1) as i32) << (index / 2 - 1),
    }
}

const CONSTANT: u32 = 0;
const MOVING: u32 = 1;
const FOLLOWER: u32 = 2;
/// Constant at 0.
const ZERO: u32 = 3;

impl ChannelKind {
    /// Reads a description, or writes this one.
    pub fn code<C: Coder>(&self, coder: &mut C) -> ChannelKind {
        let (kind, constant, moves, back) = match *self {
            ChannelKind::Constant(0) => (ZERO, 0, (0, 0), 0),
            ChannelKind::Constant(p) => (CONSTANT, p, (0, 0), 0),
            ChannelKind::Moving { step, pace } => (MOVING, 0, (step, pace), 0),
            ChannelKind::Follower(back) => (FOLLOWER, 0, (0, 0), back),
        };
        match coder.bits(2, kind) {
            MOVING => ChannelKind::Moving {
                step: coder.bits(6, u32::from(moves.0)).min(u32::from(MAX_STEP)) as u8,
                pace: coder.bits(6, u32::from(moves.1)) as u8,
            },
            FOLLOWER => ChannelKind::Follower(coder.bits(10, u32::from(back)) as u16),
            ZERO => ChannelKind::Constant(0),
            _ => {
                let zeros = coder.bits(5, constant.trailing_zeros() & 31);
                let digits = constant >> (constant.trailing_zeros() & 31);
                let count = coder.bits(6, if digits == 0 { 0 } else { 33 - (digits ^ digits >> 31).leading_zeros() }).min(32);
                let read = coder.bits(count, digits as u32 & (u32::MAX >> (32 - count.max(1))));
                let sign = 32 - count.max(1);
                ChannelKind::Constant((((read << sign) as i32) >> sign) << zeros)
            }
        }
    }
}

/// Bits of the first channel in a STARTS.
pub const FIRST_BITS: u32 = 10;
/// Bits of the number of channels in a STARTS.
pub const COUNT_BITS: u32 = 8;

/// Reads the payload of a STARTS packet whose check is the clip's [`Head::identity`], and passes each channel of the pose and its kind to `show`.
/// Returns false, and calls `show` for none, if the payload is damaged.
pub fn read_starts(payload: &[u8], identity: u16, mut show: impl FnMut(u16, ChannelKind)) -> bool {
    let go = |show: &mut dyn FnMut(u16, ChannelKind)| {
        let mut reader = SymbolReader::new(payload);
        let first = reader.bits(FIRST_BITS, 0) as u16;
        for more in 0..reader.bits(COUNT_BITS, 0) as u16 {
            show(first + more, ChannelKind::Constant(0).code(&mut reader));
        }
        reader.ends_with(identity)
    };
    go(&mut |_, _| {}) && go(&mut show)
}

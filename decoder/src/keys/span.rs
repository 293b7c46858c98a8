//! The part of a span that a channel plays: its start p, v, w and slope k, exact at its first frame.

use super::channels::Keys;
use super::layout::{PART_FRAMES, interpolation};
use super::numbers::{Scale, divide};
use super::spline::{rise, slope};
use super::words;
use crate::channel::ChannelState;

/// A span between two keys.
struct Span {
    /// The raw value of its first key, not wrapped, and the way to that of its last.
    p: i64,
    rise: i64,
    /// Second differences at its ends.
    w: [i32; 2],
    frames: u32,
}

/// Sets a channel to the start of the part in which `frame` is, and returns how many frames before that is. `p` is the channel's value.
#[inline(never)]
pub(super) fn start(state: &mut ChannelState, p: &mut i32, words: &[ChannelState], frame: u32, looped: bool) -> i32 {
    let keys = Keys::of(words, state);
    let key = keys.grid.key_at(words, frame);
    let scale = Scale(state.mode);
    let from = scale.raw(keys.value(words, key));
    if key == keys.grid.last() {
        (state.v, state.w, state.k, state.due) = (0, 0, 0, frame as u8);
        *p = from as i32;
        return 0;
    }
    let span = Span {
        p: from,
        rise: rise(words, &keys, scale, key),
        w: seconds(words, &keys, scale, key, looped),
        frames: keys.grid.length(words, key),
    };
    let passed = frame - keys.grid.time(words, key);
    let begin = passed & !(PART_FRAMES - 1);
    let into = passed - begin;
    let frames = (span.frames - begin).min(PART_FRAMES);
    let (from, w) = span.at(begin);
    let (to, w_to) = span.at(begin + frames);
    let k = divide(w_to - w, frames);
    let w = w + k;
    // C(n, 2) is at most 2016 and C(n, 3) 41664. Three times an odd number's inverse is 1: this divides by 3.
    let c2 = (frames * (frames - 1)) >> 1;
    let c3 = (c2 * frames.wrapping_sub(2)).wrapping_mul(0xaaaa_aaab);
    state.v = divide(to - from - i64::from(c2) * w - i64::from(c3) * k, frames) as i32;
    (state.w, state.k) = (w as i32, k as i32);
    *p = from as i32;
    state.due = (frame - into + frames) as u8;
    into as i32
}

impl Span {
    /// Value and second difference at a frame, which is counted from the first key.
    #[inline(never)]
    fn at(&self, frames: u32) -> (i64, i64) {
        let (n, all, [w, end]) = (frames as i32, self.frames as i32, self.w);
        // What the formulas below give at the keys, without their divisions: most parts are whole spans.
        if n == 0 {
            return (self.p, w.into());
        }
        if n == all {
            return (self.p + self.rise, end.into());
        }
        // Below 2^46.
        let bent = i64::from(2 * all - n) * i64::from(w) + i64::from(all + n) * i64::from(end);
        let bent = bent.wrapping_mul(i64::from(n * (all - n)));
        let p = self.p + divide(i64::from(n) * self.rise, self.frames) - divide(bent, 6 * self.frames);
        (p, i64::from(w) + divide(i64::from(n) * (i64::from(end) - i64::from(w)), self.frames))
    }
}

/// Second differences at the ends of a span.
#[inline(never)]
fn seconds(words: &[ChannelState], keys: &Keys, scale: Scale, key: usize, looped: bool) -> [i32; 2] {
    match keys.grid.interpolation() {
        interpolation::LINEAR => [0; 2],
        interpolation::CATMULL_ROM => {
            let chord = 6 * slope(words, keys, scale, key);
            let [from, to] = [key, key + 1].map(|key| tangent(words, keys, scale, key, looped));
            let by = keys.grid.length(words, key) << 8;
            [divide(chord - 4 * from - 2 * to, by) as i32, divide(2 * from + 4 * to - chord, by) as i32]
        }
        _ => [0, 2].map(|end| words::get(words, keys.at + 1 + 2 * key + end)),
    }
}

/// The slope at a key of a curve with Catmull-Rom tangents, in raw units a frame, in 2^-8: that of the chord from the key before to the key after.
#[inline(never)]
fn tangent(words: &[ChannelState], keys: &Keys, scale: Scale, key: usize, looped: bool) -> i64 {
    let last = keys.grid.last();
    let at_end = key == 0 || key == last;
    let (before, after) = if !at_end {
        (key - 1, key)
    } else if looped {
        (last - 1, 0)
    } else {
        return slope(words, keys, scale, if key == 0 { 0 } else { last - 1 });
    };
    let rise = rise(words, keys, scale, before) + rise(words, keys, scale, after);
    divide(rise << 8, keys.grid.length(words, before) + keys.grid.length(words, after))
}

//! The keys of an open key clip, as an editor wants them.

use super::channels::Keys;
use super::layout::interpolation;
use crate::channel::ChannelState;

/// How a channel of a key clip runs between its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubics whose slope at a key is that of the chord from the key before to the key after.
    CatmullRom,
    /// The natural cubic spline.
    Natural,
    /// The spline whose second difference over the frames is piecewise linear.
    Discrete,
}

/// The keys of one channel of a key clip: [`crate::Player::channel_keys`].
#[derive(Clone, Copy, Debug)]
pub struct ChannelKeys<'p> {
    words: &'p [ChannelState],
    keys: Keys,
}

impl<'p> ChannelKeys<'p> {
    pub(crate) fn new(words: &'p [ChannelState], state: &ChannelState) -> ChannelKeys<'p> {
        ChannelKeys { words, keys: Keys::of(words, state) }
    }

    /// How the channel runs between its keys.
    pub fn interpolation(&self) -> Interpolation {
        match self.keys.grid.interpolation() {
            interpolation::LINEAR => Interpolation::Linear,
            interpolation::CATMULL_ROM => Interpolation::CatmullRom,
            interpolation::NATURAL => Interpolation::Natural,
            _ => Interpolation::Discrete,
        }
    }

    /// Frame and value of every key, at least two. Values are in thousandths: of a degree, of the source's unit of length, or of 1. The last key
    /// of a loop is at the number of frames, where the first one comes again.
    pub fn iter(&self) -> impl Iterator<Item = (u32, i32)> + use<'p> {
        let ChannelKeys { words, keys } = *self;
        (0..=keys.grid.last()).map(move |key| (keys.grid.time(words, key), keys.value(words, key)))
    }
}

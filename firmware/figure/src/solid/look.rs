//! A character: how thick its parts are, what they are made of, and what is attached to them.
//!
//! # Bytes
//!
//! A character is at most [`MOST_BYTES`] bytes, which stay where they are, for example in flash. `look_text.rs` compiles them from text.
//!
//! | bytes | contents |
//! |---|---|
//! | 1 | [`VERSION`] |
//! | 1 | the figure's height divided by the width of outlines |
//! | 14, 14 | radii in thousandths of the height, by [`Radius`]: of figures of 80 pixels and more, and of smaller ones |
//! | 4 each | tints by [`Material`]: red, green, blue, and grey in the higher half of a byte above the [`Pattern`] |
//! | 3 | how far attachments reach from head, chest, and hips or thighs in any direction, in 4 thousandths of the height |
//! | 1 | number of attachments |
//! | for each | one byte with the [`Anchor`] in the higher half and the number of circles less one below it, a tint, and 4 bytes each circle |
//!
//! A circle is left, up and ahead of its anchor, as signed bytes, and a radius, all in [`STEP`] thousandths of the height.

use super::tint::{Pattern, Tint};

/// Circles that parts are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are those of the body")]
pub enum Radius {
    Hip,
    Knee,
    Ankle,
    Shoulder,
    Elbow,
    Wrist,
    Hand,
    Heel,
    Toe,
    Chest,
    Waist,
    Pelvis,
    Neck,
    Skull,
}

/// Number of radii.
pub const RADII: usize = 14;

/// Materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    /// Chest.
    Shirt,
    /// Pelvis, thighs and shins.
    Trousers,
    /// Neck and forearms.
    Skin,
    /// Head without the face.
    Hair,
    /// Face.
    Face,
    /// Nose.
    Nose,
    /// Eyes.
    Eye,
    /// What is the left side's: on displays of hues upper arm, hand and foot, on others the whole arm and the leg.
    Left,
    /// What is the right side's.
    Right,
    /// Hand and foot of the right side, on displays of greys.
    RightEnd,
    /// Outlines.
    Edge,
    /// The disc on which the figure stands, on displays of hues.
    Stage,
    /// Lines or dots of the floor.
    Floor,
    /// The figure's shadow.
    Shadow,
}

/// Number of materials.
pub const MATERIALS: usize = 14;

/// Most bytes of a character.
pub const MOST_BYTES: usize = 200;
/// The first byte of a character.
pub const VERSION: u8 = 1;
/// Thousandths of the height that places and radii of attachments are multiples of.
pub const STEP: i32 = 2;
/// Anchors for which a character has how far attachments reach: [`Anchor::Hips`] and [`Anchor::Thighs`] share the last one.
pub const REACHES: usize = 3;
/// Thousandths of the height that these are multiples of.
pub const REACH_STEP: i32 = 4;
/// Most circles of an attachment.
pub const MOST_CIRCLES: usize = 4;
/// Most attachments.
pub const MOST_ATTACHMENTS: usize = 12;

const RADII_AT: usize = 2;
const TINTS_AT: usize = RADII_AT + 2 * RADII;
const REACH_AT: usize = TINTS_AT + 4 * MATERIALS;
const COUNT_AT: usize = REACH_AT + REACHES;
/// Bytes before the attachments.
const FIXED: usize = COUNT_AT + 1;

/// What an attachment hangs on: the origin of its places, and their directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The middle of the skull, in the head's own directions.
    Head,
    /// The middle between the shoulders; left is towards the left shoulder, up along the spine.
    Chest,
    /// The middle between the hip joints; left is towards the left one, up along the spine.
    Hips,
    /// The hip joint of the side on which a place is. Up goes from the knee to the hip, so that a skirt follows both thighs.
    Thighs,
}

impl Anchor {
    /// All of them, by number.
    pub const ALL: [Anchor; 4] = [Anchor::Head, Anchor::Chest, Anchor::Hips, Anchor::Thighs];
}

/// A hull of one to four circles that moves with a part of a person: a hat, hair, a skirt, a tail.
#[derive(Clone, Copy, Debug)]
pub struct Attachment<'a> {
    /// What it hangs on.
    pub anchor: Anchor,
    /// What it is made of.
    pub tint: Tint,
    circles: &'a [[u8; 4]],
}

impl<'a> Attachment<'a> {
    /// Left, up, ahead and radius of each circle in thousandths of the figure's height.
    #[inline(always)]
    pub fn circles(&self) -> impl ExactSizeIterator<Item = [i32; 4]> + use<'a> {
        let signed = |byte: u8| i32::from(byte as i8) * STEP;
        self.circles
            .iter()
            .map(move |[left, up, ahead, radius]| [signed(*left), signed(*up), signed(*ahead), i32::from(*radius) * STEP])
    }
}

/// A character, as its bytes: see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    bytes: &'static [u8],
}

/// Bytes are no character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LookError {
    /// The first byte is another one than [`VERSION`].
    Version,
    /// There are fewer bytes than they say, or more, or more than [`MOST_BYTES`].
    Length,
    /// The byte at this place has a value without a meaning.
    Value(usize),
}

impl core::fmt::Display for LookError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            LookError::Version => write!(f, "these bytes are no character, or one of another version"),
            LookError::Length => write!(f, "a character has as many bytes as it says, at most {MOST_BYTES}"),
            LookError::Value(at) => write!(f, "byte {at} of the character has a value without a meaning"),
        }
    }
}

impl core::error::Error for LookError {}

const fn tint(rgb: [u8; 3], grey: u8, pattern: Pattern) -> Tint {
    Tint { rgb, grey, pattern }
}

impl Look {
    /// A person in a pale shirt and blue trousers.
    pub const DEFAULT: Look = Look { bytes: &DEFAULT_BYTES };

    /// [`Look::DEFAULT`]'s radii in thousandths of the figure's height, by [`Radius`]: of figures of 80 pixels and more, and of smaller ones.
    pub const DEFAULT_RADII: [[u8; RADII]; 2] =
        [[56, 36, 25, 40, 29, 21, 26, 26, 19, 50, 70, 58, 28, 78], [58, 39, 29, 43, 33, 26, 31, 28, 23, 51, 70, 59, 29, 88]];

    /// [`Look::DEFAULT`]'s tints, by [`Material`].
    pub const DEFAULT_TINTS: [Tint; MATERIALS] = [
        tint([235, 235, 225], 10, Pattern::Bright),
        tint([70, 92, 150], 10, Pattern::Bright),
        tint([240, 190, 150], 10, Pattern::Bright),
        tint([96, 60, 44], 5, Pattern::Dark),
        tint([255, 214, 176], 15, Pattern::Bright),
        tint([255, 200, 160], 15, Pattern::Bright),
        tint([20, 16, 20], 0, Pattern::Dark),
        tint([255, 160, 60], 15, Pattern::Bright),
        tint([80, 190, 255], 5, Pattern::Checkered),
        tint([80, 190, 255], 10, Pattern::Checkered),
        tint([6, 8, 14], 0, Pattern::Dark),
        tint([36, 44, 64], 0, Pattern::Dark),
        tint([56, 68, 92], 5, Pattern::Bright),
        tint([14, 18, 28], 5, Pattern::Checkered),
    ];

    /// A character of bytes that `look_text.rs` compiled, or the like. A constant is checked while a program is built.
    ///
    /// # Errors
    /// [`LookError`] says what is wrong with the bytes.
    pub const fn new(bytes: &'static [u8]) -> Result<Look, LookError> {
        if bytes.len() < FIXED || bytes.len() > MOST_BYTES {
            return Err(LookError::Length);
        }
        if bytes[0] != VERSION {
            return Err(LookError::Version);
        }
        let mut at = 1;
        while at < TINTS_AT {
            if bytes[at] == 0 {
                return Err(LookError::Value(at));
            }
            at += 1;
        }
        while at < REACH_AT {
            if bytes[at + 3] & 15 > Pattern::Checkered as u8 {
                return Err(LookError::Value(at + 3));
            }
            at += 4;
        }
        at = COUNT_AT;
        let mut left = bytes[at];
        if left as usize > MOST_ATTACHMENTS {
            return Err(LookError::Value(at));
        }
        at += 1;
        while left > 0 {
            if bytes.len() < at + 5 {
                return Err(LookError::Length);
            }
            let (anchor, circles) = (bytes[at] >> 4, (bytes[at] & 15) as usize + 1);
            if anchor as usize >= Anchor::ALL.len() || circles > MOST_CIRCLES {
                return Err(LookError::Value(at));
            }
            if bytes[at + 4] & 15 > Pattern::Checkered as u8 {
                return Err(LookError::Value(at + 4));
            }
            at += 5 + 4 * circles;
            left -= 1;
        }
        if at == bytes.len() { Ok(Look { bytes }) } else { Err(LookError::Length) }
    }

    /// The bytes.
    pub fn bytes(&self) -> &'static [u8] {
        self.bytes
    }

    #[inline(always)]
    fn byte(&self, at: usize) -> u8 {
        self.bytes.get(at).copied().unwrap_or(1)
    }

    /// A radius in thousandths of the figure's height, of figures of 80 pixels and more or of smaller ones.
    #[inline(always)]
    pub fn radius(&self, radius: Radius, small: bool) -> u8 {
        self.byte(RADII_AT + if small { RADII } else { 0 } + radius as usize)
    }

    /// All of them, by [`Radius`].
    #[inline(always)]
    pub(super) fn radii(&self, small: bool) -> &[u8] {
        let from = RADII_AT + if small { RADII } else { 0 };
        self.bytes.get(from..from + RADII).unwrap_or_default()
    }

    /// Outlines are one pixel wide, or the figure's height divided by this where that is more.
    pub fn outline(&self) -> u8 {
        self.byte(1)
    }

    /// What a part is made of.
    #[inline(never)]
    pub fn tint(&self, material: Material) -> Tint {
        self.tint_at(TINTS_AT + 4 * material as usize)
    }

    /// All tints, by [`Material`], and those of the attachments.
    pub fn tints(&self) -> impl Iterator<Item = Tint> {
        (0..MATERIALS).map(|index| self.tint_at(TINTS_AT + 4 * index)).chain(self.attachments().map(|attachment| attachment.tint))
    }

    #[inline(always)]
    fn tint_at(&self, at: usize) -> Tint {
        match self.bytes.get(at..at + 4) {
            Some(&[red, green, blue, last]) => Tint { rgb: [red, green, blue], grey: last >> 4, pattern: Pattern::of(last & 15) },
            _ => tint([0; 3], 0, Pattern::Dark),
        }
    }

    /// The material of a limb: on displays of hues it is `of`, on others that of the side.
    #[inline(always)]
    pub(super) fn limb(&self, of: Material, side: Material) -> Tint {
        Tint { rgb: self.tint(of).rgb, ..self.tint(side) }
    }

    /// What is attached.
    pub fn attachments(&self) -> impl Iterator<Item = Attachment<'static>> {
        let (look, mut at) = (*self, FIXED);
        (0..self.count()).map_while(move |_| {
            let head = look.bytes.get(at)?;
            let anchor = Anchor::ALL.get(usize::from(head >> 4)).copied()?;
            let (tint, first) = (look.tint_at(at + 1), at + 5);
            at = first + 4 * (usize::from(head & 15) + 1);
            Some(Attachment { anchor, tint, circles: look.bytes.get(first..at)?.as_chunks().0 })
        })
    }

    /// How many attachments there are.
    #[inline(always)]
    pub(super) fn count(&self) -> u8 {
        self.byte(COUNT_AT)
    }

    /// How far attachments reach from head, chest and hips in any direction, in thousandths of the figure's height; 0 if there are none.
    pub(super) fn reaches(&self) -> [i32; REACHES] {
        core::array::from_fn(|anchor| i32::from(self.byte(REACH_AT + anchor)) * REACH_STEP)
    }
}

static DEFAULT_BYTES: [u8; FIXED] = {
    let mut bytes = [0; FIXED];
    (bytes[0], bytes[1]) = (VERSION, 110);
    let mut index = 0;
    while index < 2 * RADII {
        bytes[RADII_AT + index] = Look::DEFAULT_RADII[index / RADII][index % RADII];
        index += 1;
    }
    index = 0;
    while index < MATERIALS {
        let Tint { rgb: [red, green, blue], grey, pattern } = Look::DEFAULT_TINTS[index];
        let at = TINTS_AT + 4 * index;
        (bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]) = (red, green, blue, grey << 4 | pattern as u8);
        index += 1;
    }
    bytes
};

impl Default for Look {
    fn default() -> Look {
        Look::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_characters_bytes_are_its_tables() {
        assert_eq!(Look::new(&DEFAULT_BYTES), Ok(Look::DEFAULT));
        assert!(Look::DEFAULT.tints().eq(Look::DEFAULT_TINTS));
        for (small, radii) in Look::DEFAULT_RADII.iter().enumerate() {
            assert_eq!(Look::DEFAULT.radii(small == 1), radii);
        }
        assert_eq!(Look::DEFAULT.radius(Radius::Skull, true), 88);
        assert_eq!(Look::DEFAULT.attachments().count(), 0);
    }

    #[test]
    fn damaged_bytes_are_refused_or_drawn_without_a_failure() {
        let mut random = fastrand::Rng::with_seed(11);
        let mut bytes = DEFAULT_BYTES.to_vec();
        bytes[COUNT_AT] = 2;
        bytes.extend([0x11, 1, 2, 3, 0x42, 10, 246, 5, 20, 1, 1, 1, 1, 0x30, 9, 9, 9, 0x51, 100, 100, 100, 100]);
        assert!(Look::new(bytes.clone().leak()).is_ok());
        for length in 0..bytes.len() {
            assert_eq!(Look::new(bytes[..length].to_vec().leak()), Err(LookError::Length));
        }
        for _ in 0..2000 {
            let mut bytes = bytes.clone();
            let at = random.usize(..bytes.len());
            bytes[at] = random.u8(..);
            if let Ok(look) = Look::new(bytes.leak()) {
                assert!(look.attachments().all(|attachment| (1..=MOST_CIRCLES).contains(&attachment.circles().len())));
                assert_eq!(look.attachments().count(), usize::from(look.bytes[COUNT_AT]));
            }
        }
        assert_eq!(Look::new(&[0; 90]), Err(LookError::Version));
    }
}

//! A character: how thick its parts are and what they are made of.

use super::tint::{Pattern, Tint};

/// Circles that parts are made of, as indices of [`Look::radii`].
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

/// Materials, as indices of [`Look::tints`].
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

/// A character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Radii in thousandths of the figure's height, by [`Radius`], for figures of 80 pixels and more, and for smaller ones.
    pub radii: [[u8; RADII]; 2],
    /// Outlines are one pixel, or the figure's height divided by this where that is more.
    pub outline: u8,
    /// By [`Material`].
    pub tints: [Tint; MATERIALS],
}

const fn tint(rgb: [u8; 3], grey: u8, pattern: Pattern) -> Tint {
    Tint { rgb, grey, pattern }
}

impl Look {
    /// A person in a pale shirt and blue trousers.
    pub const DEFAULT: Look = Look {
        radii: [
            [56, 36, 25, 40, 29, 21, 26, 26, 19, 50, 70, 58, 28, 78],
            [58, 39, 29, 43, 33, 26, 31, 28, 23, 51, 70, 59, 29, 88],
        ],
        outline: 110,
        tints: [
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
        ],
    };

    /// What a part is made of.
    #[inline(always)]
    pub fn tint(&self, material: Material) -> &Tint {
        self.tints.get(material as usize).unwrap_or(&Look::NOTHING)
    }

    const NOTHING: Tint = tint([0; 3], 0, Pattern::Dark);

    /// The material of a limb: on displays of hues it is `of`, on others that of the side.
    #[inline(always)]
    pub(super) fn limb(&self, of: Material, side: Material) -> Tint {
        Tint { rgb: self.tint(of).rgb, ..*self.tint(side) }
    }
}

impl Default for Look {
    fn default() -> Look {
        Look::DEFAULT
    }
}

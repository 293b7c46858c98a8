//! What a channel drives: the kinds of the format.

/// What one channel drives. A joint applies its rotations in the order of its list, as BVH does.
///
/// A rig's kinds are those of the source. Where a clip codes three Euler angles as an exponential map, its poses hold the
/// map's x, y and z in their place: [`Clip::kinds`](crate::Clip::kinds) returns the kinds as coded, and
/// [`Pose::turn`](crate::Pose::turn) takes care of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Kind {
    /// Replaces the x of the joint's offset.
    Xposition,
    /// Replaces the y of the joint's offset.
    Yposition,
    /// Replaces the z of the joint's offset.
    Zposition,
    /// An Euler angle about the joint's x axis, unless the clip's form says exponential map.
    Xrotation,
    /// An Euler angle about y, as [`Kind::Xrotation`].
    Yrotation,
    /// An Euler angle about z, as [`Kind::Xrotation`].
    Zrotation,
    /// Component w (the real part) of a rotation given as a quaternion, which the figure normalizes.
    Wquaternion,
    /// Component x of a quaternion.
    Xquaternion,
    /// Component y of a quaternion.
    Yquaternion,
    /// Component z of a quaternion.
    Zquaternion,
    /// Component x of a rotation given as an exponential map (axis times angle).
    Xexponential,
    /// Component y of an exponential map.
    Yexponential,
    /// Component z of an exponential map.
    Zexponential,
    /// A number that moves no joint: a morph weight, a servo, a light.
    Scalar,
}

impl Kind {
    /// Every kind, at the index that stands for it in a rig's bytes.
    pub const ALL: [Kind; 14] = [
        Kind::Xposition,
        Kind::Yposition,
        Kind::Zposition,
        Kind::Xrotation,
        Kind::Yrotation,
        Kind::Zrotation,
        Kind::Wquaternion,
        Kind::Xquaternion,
        Kind::Yquaternion,
        Kind::Zquaternion,
        Kind::Xexponential,
        Kind::Yexponential,
        Kind::Zexponential,
        Kind::Scalar,
    ];

    /// A translation along an axis of the parent.
    pub const fn is_position(self) -> bool {
        matches!(self, Kind::Xposition | Kind::Yposition | Kind::Zposition)
    }

    /// An Euler angle about one axis.
    pub const fn is_rotation(self) -> bool {
        matches!(self, Kind::Xrotation | Kind::Yrotation | Kind::Zrotation)
    }

    /// A component of a quaternion.
    pub const fn is_quaternion(self) -> bool {
        matches!(self, Kind::Wquaternion | Kind::Xquaternion | Kind::Yquaternion | Kind::Zquaternion)
    }

    /// A component of an exponential map.
    pub const fn is_exponential(self) -> bool {
        matches!(self, Kind::Xexponential | Kind::Yexponential | Kind::Zexponential)
    }

    /// The axis of a position, rotation, exponential map or of a quaternion's imaginary part: 0, 1, 2 for x, y, z.
    pub const fn axis(self) -> Option<usize> {
        match self {
            Kind::Xposition | Kind::Xrotation | Kind::Xquaternion | Kind::Xexponential => Some(0),
            Kind::Yposition | Kind::Yrotation | Kind::Yquaternion | Kind::Yexponential => Some(1),
            Kind::Zposition | Kind::Zrotation | Kind::Zquaternion | Kind::Zexponential => Some(2),
            Kind::Wquaternion | Kind::Scalar => None,
        }
    }

    /// How it turns a joint: one of [`ANGLE`], [`MAP`] and [`QUATERNION`], or 0; and the axis of an angle, or which component of a map or a
    /// quaternion it is.
    #[inline(always)]
    pub(crate) fn turning(self) -> (u8, usize) {
        const A: u8 = ANGLE << 2;
        const M: u8 = MAP << 2;
        const Q: u8 = QUATERNION << 2;
        static TURNING: [u8; 14] = [0, 0, 0, A, A + 1, A + 2, Q, Q + 1, Q + 2, Q + 3, M, M + 1, M + 2, 0];
        let own = TURNING.get(self as usize).copied().unwrap_or(0);
        (own >> 2, usize::from(own & 3))
    }

    fn from_code(code: u8) -> Option<Kind> {
        Kind::ALL.get(usize::from(code)).copied()
    }
}

/// An Euler angle.
pub(crate) const ANGLE: u8 = 1;
/// A component of an exponential map.
pub(crate) const MAP: u8 = 2;
/// A component of a quaternion.
pub(crate) const QUATERNION: u8 = 4;

/// Iterates over the kinds of one joint's channels, in the order in which they apply.
#[derive(Clone, Copy, Debug)]
pub struct Kinds<'a> {
    /// Two to a byte, low half first.
    halves: &'a [u8],
    next: u8,
    len: u8,
}

impl<'a> Kinds<'a> {
    pub(crate) const NONE: Kinds<'static> = Kinds { halves: &[], next: 0, len: 0 };

    pub(crate) fn new(halves: &'a [u8], len: u8) -> Kinds<'a> {
        Kinds { halves, next: 0, len }
    }
}

impl Kinds<'_> {
    /// Whether all of them can be a joint's.
    pub(crate) fn are_of_joint(&mut self) -> bool {
        // A code that is no kind ends the walk early, the last one too.
        let mut known = 0;
        for kind in self.by_ref() {
            if kind == Kind::Scalar {
                return false;
            }
            known += 1;
        }
        known == self.len
    }
}

impl Iterator for Kinds<'_> {
    type Item = Kind;

    fn next(&mut self) -> Option<Kind> {
        if self.next >= self.len {
            return None;
        }
        let byte = *self.halves.get(usize::from(self.next / 2))?;
        let code = if self.next.is_multiple_of(2) { byte & 0xf } else { byte >> 4 };
        self.next += 1;
        Kind::from_code(code)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::from(self.len - self.next);
        (left, Some(left))
    }
}

impl ExactSizeIterator for Kinds<'_> {}

//! What the raw values of a pose mean.

use crate::joint::has_choice;
use crate::kind::Kind;
use crate::layout::MAX_CHANNELS;
use crate::rig::Rig;

/// What the raw values of a pose mean: which rig's they are, the unit of positions, and which joints are coded as exponential maps.
///
/// An encoder chooses the unit and the maps clip by clip, so that two clips of one rig can differ in form. Values of one form mean
/// nothing in another: what draws or mixes poses compares forms first ([`Form::check`]). `pantin convert --same-form` gives a set of
/// clips one form. A [`crate::Pose`] refers to its form by a [`FormRef`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// [`Rig::id`].
    rig_id: u32,
    length_exponent: i8,
    /// Number of bytes up to the last that is not 0.
    len: u8,
    /// Bit i % 8 of byte i / 8: whether the i-th joint that [`has_choice`] is coded as an exponential map.
    exponentials: [u8; Form::EXPONENTIAL_BYTES],
}

impl Form {
    /// The form of no rig: what stands in memory before a clip is set up.
    pub const NONE: Form = Form { rig_id: 0, length_exponent: 0, len: 0, exponentials: [0; Form::EXPONENTIAL_BYTES] };

    /// Bytes that hold a bit for each joint with a choice, in any rig: such a joint has three channels at least.
    pub const EXPONENTIAL_BYTES: usize = (MAX_CHANNELS / 3).div_ceil(32) * 4;

    /// The form of a rig's id, the exponent of its positions' unit, and the exponential bits of FORMAT.md 4, byte by byte; bytes
    /// past [`Form::EXPONENTIAL_BYTES`] are ignored.
    pub fn new(rig_id: u32, length_exponent: i8, exponentials: impl IntoIterator<Item = u8>) -> Form {
        let mut form = Form { rig_id, length_exponent, ..Form::NONE };
        for (index, (own, byte)) in (1..).zip(form.exponentials.iter_mut().zip(exponentials)) {
            *own = byte;
            if byte != 0 {
                form.len = index;
            }
        }
        form
    }

    /// The id of the rig: [`Rig::id`].
    pub fn rig_id(&self) -> u32 {
        self.rig_id
    }

    /// The raw value of a position channel times 2^`length_exponent` is in units of the source: -63 to 31.
    pub fn length_exponent(&self) -> i8 {
        self.length_exponent
    }

    /// The exponential bits of FORMAT.md 4, byte by byte.
    pub fn exponentials(&self) -> impl Iterator<Item = u8> + '_ {
        self.exponentials.iter().copied()
    }

    /// Whether the three rotation channels of this joint of the form's rig hold the x, y and z of an exponential map.
    pub fn is_exponential(&self, rig: &Rig<'_>, joint: usize) -> bool {
        FormRef::from(self).is_exponential(rig, joint)
    }

    /// Compares two forms; the error names the first difference.
    #[inline]
    pub fn check<'f>(&self, other: impl Into<FormRef<'f>>) -> Result<(), WrongForm> {
        FormRef::from(self).check(other.into())
    }
}

impl Default for Form {
    fn default() -> Self {
        Form::NONE
    }
}

/// A [`Form`] whose bits stand in a clip, or in a form: 16 bytes on a 32-bit machine instead of 52.
#[derive(Clone, Copy, Debug)]
pub struct FormRef<'f> {
    pub(crate) rig_id: u32,
    pub(crate) length_exponent: i8,
    /// As in a form; what is not there is 0.
    pub(crate) exponentials: &'f [u8],
}

impl FormRef<'_> {
    /// The id of the rig: [`Rig::id`].
    pub fn rig_id(&self) -> u32 {
        self.rig_id
    }

    /// The raw value of a position channel times 2^`length_exponent` is in units of the source: -63 to 31.
    pub fn length_exponent(&self) -> i8 {
        self.length_exponent
    }

    /// A form of its own, which outlives the clip.
    pub fn to_form(&self) -> Form {
        Form::new(self.rig_id, self.length_exponent, self.exponentials.iter().copied())
    }

    /// Whether a joint is coded as an exponential map that has three rotation channels, as `choice` joints before it have. For a walk over all joints:
    /// [`FormRef::is_exponential`] counts them again for each joint.
    pub fn is_exponential_choice(&self, choice: usize) -> bool {
        self.exponentials.get(choice / 8).is_some_and(|byte| byte >> (choice % 8) & 1 != 0)
    }

    /// Whether the three rotation channels of this joint of the form's rig hold the x, y and z of an exponential map.
    pub fn is_exponential(&self, rig: &Rig<'_>, joint: usize) -> bool {
        rig.joint(joint).is_some_and(|joint| has_choice(&joint))
            && self.is_exponential_choice(rig.joints().take(joint).filter(has_choice).count())
    }

    /// Compares two forms; the error names the first difference.
    #[inline(never)]
    pub fn check(&self, other: FormRef<'_>) -> Result<(), WrongForm> {
        if self.rig_id != other.rig_id {
            return Err(WrongForm::Rig);
        }
        if self.length_exponent != other.length_exponent {
            return Err(WrongForm::LengthExponent);
        }
        // Of one clip, as mostly.
        if core::ptr::eq(self.exponentials, other.exponentials) {
            return Ok(());
        }
        let (mut own, mut its) = (self.exponentials.iter(), other.exponentials.iter());
        loop {
            match (own.next(), its.next()) {
                (None, None) => return Ok(()),
                (a, b) if a.unwrap_or(&0) == b.unwrap_or(&0) => {}
                _ => return Err(WrongForm::Exponentials),
            }
        }
    }
}

impl PartialEq for FormRef<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.check(*other).is_ok()
    }
}

impl Eq for FormRef<'_> {}

impl<'f> From<&'f Form> for FormRef<'f> {
    fn from(form: &'f Form) -> FormRef<'f> {
        let bits = form.exponentials.get(..usize::from(form.len)).unwrap_or(&form.exponentials);
        FormRef { rig_id: form.rig_id, length_exponent: form.length_exponent, exponentials: bits }
    }
}

/// Why a pose cannot be used here: it has another form than the clip for which this was set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WrongForm {
    /// The pose is of another rig.
    Rig,
    /// Positions are in another unit.
    LengthExponent,
    /// Other joints are coded as exponential maps.
    Exponentials,
}

impl core::fmt::Display for WrongForm {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            WrongForm::Rig => "the pose is of another rig",
            WrongForm::LengthExponent => "the pose has positions in another unit: convert the clips with --same-form",
            WrongForm::Exponentials => "the pose codes other joints as exponential maps: convert the clips with --same-form",
        })
    }
}

impl core::error::Error for WrongForm {}

/// The kinds of a joint's channels as a clip codes them.
#[derive(Clone, Debug)]
pub struct CodedKinds<'a> {
    pub(crate) kinds: crate::Kinds<'a>,
    pub(crate) exponential: bool,
    /// Rotations so far.
    pub(crate) turned: usize,
}

impl Iterator for CodedKinds<'_> {
    type Item = Kind;

    fn next(&mut self) -> Option<Kind> {
        let kind = self.kinds.next()?;
        if !self.exponential || !kind.is_rotation() {
            return Some(kind);
        }
        let coded = [Kind::Xexponential, Kind::Yexponential, Kind::Zexponential].get(self.turned).copied();
        self.turned += 1;
        coded.or(Some(kind))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.kinds.size_hint()
    }
}

impl ExactSizeIterator for CodedKinds<'_> {}

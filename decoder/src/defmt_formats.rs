//! `defmt::Format` of the types that are no plain errors: what a log of a program needs to know, without the library's formatting.

use crate::*;

/// Implements the trait by a text and its values.
macro_rules! format {
    ($($type:ty: $own:ident => $text:literal $(, $value:expr)*;)*) => {$(
        impl defmt::Format for $type {
            fn format(&self, f: defmt::Formatter) {
                let $own = self;
                defmt::write!(f, $text $(, $value)*);
            }
        }
    )*};
}

format! {
    Angle: own => "{=i32} cdeg", own.centidegrees();
    Matrix: own => "Matrix {}", own.rows.map(|row| row.map(|element| element.to_bits()));
    Bank<'_>: own => "Bank {{ clips: {=usize} }}", own.len();
    BankEntry<'_>: own => "BankEntry {{ name: {=str}, bytes: {=usize} }}", own.name(), own.bytes().len();
    Clip<'_>: own => "Clip {{ frames: {=u32}, moving: {=usize}, form: {} }}", own.frames(), own.moving(), own.form_ref();
    DetachedPlayer<'_>: own => "DetachedPlayer {{ frame: {=u32}, clip: {} }}", own.frame(), own.clip();
    Player<'_, '_>: own => "Player {{ frame: {=u32}, clip: {} }}", own.frame(), own.clip();
    Clock: own => "Clock {{ frame: {=u32}, ended: {=bool} }}", own.frame(), own.ended();
    Form: own => "{}", FormRef::from(own);
    FormRef<'_>: own => "Form {{ rig_id: {=u32:#x}, length_exponent: {=i8} }}", own.rig_id(), own.length_exponent();
    Pose<'_>: own => "Pose {{ values: {}, form: {} }}", own.values, own.form;
    Rig<'_>: own => "Rig {{ id: {=u32:#x}, joints: {=usize}, channels: {=usize} }}", own.id(), own.joint_count(), own.channels();
    Joint<'_>: own => "Joint {{ name: {=str}, parent: {}, first_channel: {=u16} }}", own.name(), own.parent, own.first_channel;
    JointRef<'_>: own => "JointRef {{ index: {=usize}, first_channel: {=usize} }}", own.index(), own.first_channel();
    Joints<'_>: own => "Joints {{ next_channel: {=u16} }}", own.first_channel;
    Kinds<'_>: own => "Kinds {{ left: {=usize} }}", own.len();
    CodedKinds<'_>: own => "CodedKinds {{ left: {=usize} }}", own.len();
    Scalar<'_>: own => "Scalar {{ name: {=str}, exponent: {=i8} }}", own.name(), own.exponent;
    Scalars<'_>: _own => "Scalars";
    PartialClip<'_>: _own => "PartialClip";
    PausedClip: _own => "PausedClip";
    SeekCache<'_>: _own => "SeekCache";
    RigCollector<'_>: _own => "RigCollector";
    SnapshotPos: _own => "SnapshotPos";
    Undo: _own => "Undo";
    Stream<'_, '_>: _own => "Stream";
}

impl<const MOVING: usize, const CHANNELS: usize> defmt::Format for Room<MOVING, CHANNELS> {
    fn format(&self, f: defmt::Formatter) {
        defmt::write!(f, "Room<{=usize}, {=usize}>", MOVING, CHANNELS);
    }
}

impl defmt::Format for Turn {
    fn format(&self, f: defmt::Formatter) {
        match self {
            Turn::Euler { order, angles } => defmt::write!(f, "{} {}", order, angles),
            Turn::Exponential(map) => defmt::write!(f, "map {}", map),
            Turn::Quaternion(q) => defmt::write!(f, "quaternion {}", q.map(|component| component.to_bits())),
        }
    }
}

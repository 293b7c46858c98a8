//! Options of the encoder as words of the command line.

/// How joints with three Euler angles about three axes are coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Rotations {
    /// Choose for each joint what seems smaller
    ByCost,
    /// Use the file's Euler angles
    Euler,
    /// Use exponential maps where they stay within half a turn
    Exponential,
    /// Use quaternions, four channels a joint; the rig has them instead of the angles
    Quaternion,
}

impl From<Rotations> for pantin_convert::Rotations {
    fn from(rotations: Rotations) -> pantin_convert::Rotations {
        match rotations {
            Rotations::ByCost => pantin_convert::Rotations::ByCost,
            Rotations::Euler => pantin_convert::Rotations::Euler,
            Rotations::Exponential => pantin_convert::Rotations::Exponential,
            Rotations::Quaternion => pantin_convert::Rotations::Quaternion,
        }
    }
}

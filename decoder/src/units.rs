//! What the numbers of a pose mean. A pose holds raw 32-bit integers; the kind of a channel says which of these it is.

use fixed::types::{I0F32, I2F30};

/// An angle in turns, -1/2 to 1/2 (exclusive). It wraps as angles do: adding half a turn twice gives the angle back.
/// Euler angles and the components of an exponential map are angles.
pub type Angle = I0F32;

/// A component of a quaternion, -2 to 2 (exclusive).
pub type Component = I2F30;

/// The angle that a raw value of a pose stands for.
pub const fn angle(raw: i32) -> Angle {
    Angle::from_bits(raw)
}

/// The quaternion component that a raw value of a pose stands for.
pub const fn component(raw: i32) -> Component {
    Component::from_bits(raw)
}

//! A joint's rotation as a clip codes it, and as Euler angles: in integers, to two millionths of a degree.
//!
//! # The steps
//!
//! An implementation in another language that follows these steps computes the same bits. The notation, `high`, `sin_cos`, `atan2` and
//! `inverse_root` are those of `trig.rs`. Two products are signed: `scaled(a, b)` is `(a * b + 2^29) >> 30`, and `dot(a, b)` is the same of
//! the sum of four products, which is exact (it needs 62 bits) and rounded once. A unit quaternion is w, x, y, z, signed, in Q30.
//!
//! **`direction(q)`** gives a unit quaternion and the length of four signed numbers:
//! 1. `largest` is the bitwise or of the |q[i]|. If it is 0, the results are (2^30, 0, 0, 0) and 0.
//! 2. `up` is the number of leading zeros of `largest`, `raised[i] = (|q[i]| << up) >> 1`, `square` the sum of the `high(raised[i], raised[i])`.
//! 3. `twice` is 1 if `square < 2^30`, else 0. Then `square = square << (2 * twice)`.
//! 4. `inverse = inverse_root(square)`. Each component is `high(raised[i] << twice, inverse)`, with the sign of `q[i]`.
//! 5. The length is `high(square, inverse)`, shifted by `3 - up - twice`: to the left, or if that is negative to the right.
//!
//! **A rotation becomes a unit quaternion** by its form:
//! * A quaternion: `direction` of it.
//! * An exponential map x, y, z: `direction` of (0, x, y, z) gives (0, X, Y, Z) and `length`; `sin_cos(length >> 1)` then gives
//!   (`cos`, `scaled(X, sin)`, `scaled(Y, sin)`, `scaled(Z, sin)`).
//! * Euler angles: each alone has w = `cos` and `sin` in the place of its axis, by `sin_cos(angle >> 1)` with the sign kept. The first times
//!   the second, then that times the third: (aw, ax, ay, az) times (w, x, y, z) is dot(a, (w, -x, -y, -z)), dot(a, (x, w, z, -y)),
//!   dot(a, (y, -z, w, x)), dot(a, (z, y, -x, w)).
//! * A joint with several of these, or with Euler angles that are not one to three about different axes: `direction` of their product, in the
//!   order of FORMAT.md 11. Euler angles that the clip codes as an exponential map come before the joint's own quaternion and map.
//!
//! **`angles_of`** gives the Euler angles about the axes i, j, k of a unit quaternion w, x, y, z (Bernardes and Viollet 2022). `a`, `b`, `c` are its
//! components of i, j, k, with `c` negated if the order is odd (XZY, YXZ, ZYX):
//! 1. `sum = atan2(a + c, w + b)`; `sin_cos(sum)` gives `longer = scaled(w + b, cos) + scaled(a + c, sin)`.
//! 2. `difference = atan2(a - c, w - b)`; `sin_cos(difference)` gives `shorter = scaled(w - b, cos) + scaled(a - c, sin)`.
//! 3. The first angle is `sum + difference`, the second `2^30 - 2 * atan2(shorter, longer)`, the third `sum - difference`, negated if the
//!    order is odd. Sums wrap.
//!
//! Angles in the order in which the joint has them are not converted.
//!
//! **The whole angle** is `2 * atan2(length, |w|)`, where `length` is the one that `direction` of (0, x, y, z) gives.

use crate::trig::{atan2, high, inverse_root, sin_cos};
use crate::units::{Angle, Component};

/// An axis of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Axis {
    /// The x axis.
    X,
    /// The y axis.
    Y,
    /// The z axis.
    Z,
}

impl Axis {
    pub(crate) const fn of_index(index: usize) -> Axis {
        match index {
            0 => Axis::X,
            1 => Axis::Y,
            _ => Axis::Z,
        }
    }

    const fn index(self) -> usize {
        self as usize
    }

    /// The axis that is neither.
    const fn third(self, other: Axis) -> Axis {
        Axis::of_index((3 - self.index()).wrapping_sub(other.index()))
    }
}

/// The order of three Euler angles: each turns about the axis as rotated by those before it, as a BVH file lists them.
///
/// `EulerOrder::ZYX` is the rotation matrix Rz Ry Rx; arrays of its angles hold z, y, x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[allow(missing_docs)]
pub enum EulerOrder {
    XYZ,
    XZY,
    YXZ,
    YZX,
    ZXY,
    ZYX,
}

impl EulerOrder {
    /// Every order.
    pub const ALL: [EulerOrder; 6] =
        [EulerOrder::XYZ, EulerOrder::XZY, EulerOrder::YXZ, EulerOrder::YZX, EulerOrder::ZXY, EulerOrder::ZYX];

    /// The order that begins with these two axes; `None` if they are one.
    pub const fn of(first: Axis, second: Axis) -> Option<EulerOrder> {
        match (first, second) {
            (Axis::X, Axis::Y) => Some(EulerOrder::XYZ),
            (Axis::X, Axis::Z) => Some(EulerOrder::XZY),
            (Axis::Y, Axis::X) => Some(EulerOrder::YXZ),
            (Axis::Y, Axis::Z) => Some(EulerOrder::YZX),
            (Axis::Z, Axis::X) => Some(EulerOrder::ZXY),
            (Axis::Z, Axis::Y) => Some(EulerOrder::ZYX),
            _ => None,
        }
    }

    /// Whether the axes are in the order of x, y, z, wherever it begins.
    const fn is_even(self) -> bool {
        matches!(self, EulerOrder::XYZ | EulerOrder::YZX | EulerOrder::ZXY)
    }

    /// The three axes, first to last.
    pub const fn axes(self) -> [Axis; 3] {
        let (first, second) = match self {
            EulerOrder::XYZ => (Axis::X, Axis::Y),
            EulerOrder::XZY => (Axis::X, Axis::Z),
            EulerOrder::YXZ => (Axis::Y, Axis::X),
            EulerOrder::YZX => (Axis::Y, Axis::Z),
            EulerOrder::ZXY => (Axis::Z, Axis::X),
            EulerOrder::ZYX => (Axis::Z, Axis::Y),
        };
        [first, second, first.third(second)]
    }
}

/// The rotation of a joint at one frame, in the form in which the clip codes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Up to three Euler angles about different axes; axes that the joint lacks have the angle 0.
    Euler {
        /// The joint's own order.
        order: EulerOrder,
        /// One angle for each axis of the order.
        angles: [Angle; 3],
    },
    /// An exponential map: x, y and z of the axis times the angle.
    Exponential([Angle; 3]),
    /// A quaternion w, x, y, z of any length but 0, which stands for no rotation.
    Quaternion([Component; 4]),
}

/// A rotation matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Matrix {
    /// Row by row: elements of -1 to 1. The columns are the images of the axes.
    pub rows: [[Component; 3]; 3],
}

impl Matrix {
    /// No rotation.
    pub const IDENTITY: Matrix = {
        let (one, zero) = (Component::from_bits(ONE), Component::from_bits(0));
        Matrix { rows: [[one, zero, zero], [zero, one, zero], [zero, zero, one]] }
    };

    /// The Euler angles in an order, as [`Turn::euler`] gives them.
    pub fn euler(&self, order: EulerOrder) -> [Angle; 3] {
        euler_of(&self.rows, order)
    }

    /// The first of the angles that [`Matrix::euler`] gives, for two thirds of its instructions.
    pub fn first_angle(&self, order: EulerOrder) -> Angle {
        Angle::from_bits(first_of(&self.rows, order, last_of(&self.rows, order)))
    }

    /// The matrix of a rotation that [`Turn::quaternion`] gave.
    pub fn of_quaternion(unit: [Component; 4]) -> Matrix {
        matrix_of(unit.map(Component::to_bits))
    }

    /// The image of a vector in any unit, each component below 2^31 in magnitude.
    pub fn apply(&self, vector: [i32; 3]) -> [i64; 3] {
        let [x, y, z] = vector;
        // Three products below 2^61.
        self.rows.map(|[a, b, c]| (times(a.to_bits(), x) + times(b.to_bits(), y) + times(c.to_bits(), z) + (1 << 29)) >> 30)
    }

    /// This rotation, then `local` about the axes that it has turned: a joint's rotation in the world from its parent's.
    pub fn then(&self, local: &Matrix) -> Matrix {
        let [x, y, z] = &local.rows;
        let element = |[a, b, c]: [Component; 3], (x, y, z): (Component, Component, Component)| {
            // Rows and columns are unit vectors: the sum is at most 2^60.
            let bits = |p: Component, q: Component| times(p.to_bits(), q.to_bits());
            Component::from_bits(narrow(bits(a, x) + bits(b, y) + bits(c, z)))
        };
        Matrix {
            rows: self.rows.map(|row| {
                [element(row, (x[0], y[0], z[0])), element(row, (x[1], y[1], z[1])), element(row, (x[2], y[2], z[2]))]
            }),
        }
    }
}

/// One in Q30.
const ONE: i32 = 1 << 30;

/// The product of a number with one in Q30, rounded to the nearest, halves up. In a function of its own for its size on a Cortex-M0.
#[inline(never)]
fn scaled(a: i32, q30: i32) -> i32 {
    narrow(times(a, q30))
}

/// A unit quaternion w, x, y, z in Q30.
pub(crate) type Unit = [i32; 4];

pub(crate) const NO_ROTATION: Unit = [ONE, 0, 0, 0];

impl Turn {
    /// The Euler angles in the order asked for: the first angle of the array is about the order's first axis. The rotation that they make is
    /// within 2e-6 degrees of this one.
    ///
    /// Ask for the joint's own order, [`crate::JointRef::euler_order`]: if the clip codes the joint as Euler angles, they are the clip's own. Otherwise (another
    /// order, an exponential map, a quaternion) the second angle is within 90 degrees of zero, so that the first and the third can jump by 180 degrees
    /// from one frame to the next; and where the second is near 90 or -90 degrees, only the first plus or minus the third is determined: a small
    /// change of the rotation then changes each of them much.
    ///
    /// The angles of a hinge that lies along no axis are three numbers; [`Turn::angle`] is the one by which it bends.
    ///
    /// The joint's own order costs 21 instructions on a Cortex-M3. Another order costs at most 1,330 from Euler angles, 1,160 from an exponential
    /// map and 990 from a quaternion, and 7,700, 6,100 and 5,300 on a Cortex-M0.
    pub fn euler(self, order: EulerOrder) -> [Angle; 3] {
        match self {
            Turn::Euler { order: own, angles } if own == order => angles,
            _ => angles_of(self.unit(), order),
        }
    }

    /// How far the joint is turned in all, about whatever axis: 0 to 1/2 turn, within 2e-6 degrees, read by [`Angle::degrees`]. Half
    /// a turn itself is -180 degrees, for angles wrap.
    ///
    /// Costs at most 930 instructions on a Cortex-M3, and 5,700 on a Cortex-M0.
    pub fn angle(self) -> Angle {
        let [w, x, y, z] = self.unit();
        let (_, sine) = direction([0, x, y, z]);
        Angle::from_bits(atan2(sine as i32, w.saturating_abs()).wrapping_mul(2))
    }

    /// The rotation as a unit quaternion w, x, y, z, within 1e-7 a component. Of the two that are the same rotation it may be either.
    pub fn quaternion(self) -> [Component; 4] {
        self.unit().map(Component::from_bits)
    }

    /// The rotation matrix; elements are within 4e-7.
    pub fn matrix(self) -> Matrix {
        matrix_of(self.unit())
    }

    pub(crate) fn unit(self) -> Unit {
        match self {
            Turn::Euler { order, angles: [a, b, c] } => {
                let [first, second, third] = order.axes().map(Axis::index);
                product(product(about(first, a), about(second, b)), about(third, c))
            }
            Turn::Exponential(map) => of_exponential(map.map(Angle::to_bits)),
            Turn::Quaternion(q) => normalized(q.map(Component::to_bits)),
        }
    }
}

/// The product of two values in Q30.
fn times(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

/// A value in Q60 as Q30.
fn narrow(q60: i64) -> i32 {
    ((q60 + (1 << 29)) >> 30) as i32
}

/// The rotation by `a`, then by `b` about the axes that `a` has turned.
pub(crate) fn product(a: Unit, [w, x, y, z]: Unit) -> Unit {
    [dot(a, [w, -x, -y, -z]), dot(a, [x, w, z, -y]), dot(a, [y, -z, w, x]), dot(a, [z, y, -x, w])]
}

/// The scalar product of two unit quaternions, rounded once. In a function of its own: four of it in line take 250 bytes more on a Cortex-M0.
#[inline(never)]
fn dot([a, b, c, d]: Unit, [w, x, y, z]: Unit) -> i32 {
    // At most 2^60.
    narrow(times(a, w) + times(b, x) + times(c, y) + times(d, z))
}

/// The rotation about an axis.
pub(crate) fn about(axis: usize, angle: Angle) -> Unit {
    // An arithmetic shift halves the angle of -1/2 to 1/2 turn.
    let (sin, cos) = sin_cos(angle.to_bits() >> 1);
    let mut unit = [cos, 0, 0, 0];
    if let Some(component) = unit.get_mut(axis + 1) {
        *component = sin;
    }
    unit
}

/// The rotation of an exponential map in 2^-32 turns.
pub(crate) fn of_exponential([x, y, z]: [i32; 3]) -> Unit {
    let ([_, x, y, z], length) = direction([0, x, y, z]);
    // Three components of 2^31 at most: the length is below 2^32, half of it below 2^31.
    let (sin, cos) = sin_cos((length >> 1) as i32);
    let [x, y, z] = [x, y, z].map(|x| scaled(x, sin));
    [cos, x, y, z]
}

/// The quaternion of length 1; no rotation for a length of 0.
pub(crate) fn normalized(q: [i32; 4]) -> Unit {
    direction(q).0
}

/// The quaternion of length 1 in the direction of another one, each component within 1e-8, and the length of the other one, below 2^32. For 0 no rotation, and 0.
#[inline(never)]
fn direction(q: [i32; 4]) -> (Unit, u32) {
    let largest = q.iter().fold(0, |largest, x| largest | x.unsigned_abs());
    if largest == 0 {
        return (NO_ROTATION, 0);
    }
    // The largest component goes to 2^30 .. 2^31: the upper halves of four squares sum to 2^28 .. 2^32.
    let up = largest.leading_zeros();
    let raised = |x: i32| (x.unsigned_abs() << up) >> 1;
    let square = q.iter().fold(0, |sum: u32, &x| sum.wrapping_add(high(raised(x), raised(x))));
    let twice = u32::from(square < 1 << 30);
    let square = square << (2 * twice);
    let inverse = inverse_root(square);
    let unit = q.map(|x| {
        let component = high(raised(x) << twice, inverse) as i32;
        if x < 0 { -component } else { component }
    });
    // The root of the square, in Q30, back by the shifts.
    let root = high(square, inverse);
    let down = up + twice;
    (unit, if down < 3 { root << (3 - down) } else { root >> (down - 3) })
}

fn matrix_of([w, x, y, z]: Unit) -> Matrix {
    // Twice the sum of two products of components of a unit quaternion is at most 1: Q60 to Q30 times two.
    let twice = |q60: i64| ((q60 + (1 << 28)) >> 29) as i32;
    let element = |diagonal: i32, q60: i64| Component::from_bits(diagonal.wrapping_add(twice(q60)));
    Matrix {
        rows: [
            [
                element(ONE, -times(y, y) - times(z, z)),
                element(0, times(x, y) - times(w, z)),
                element(0, times(x, z) + times(w, y)),
            ],
            [
                element(0, times(x, y) + times(w, z)),
                element(ONE, -times(x, x) - times(z, z)),
                element(0, times(y, z) - times(w, x)),
            ],
            [
                element(0, times(x, z) - times(w, y)),
                element(0, times(y, z) + times(w, x)),
                element(ONE, -times(x, x) - times(y, y)),
            ],
        ],
    }
}

/// The Euler angles of a unit quaternion.
#[inline(never)]
fn angles_of(q: Unit, order: EulerOrder) -> [Angle; 3] {
    let [own, other, third] = order.axes().map(|axis| q.get(axis.index() + 1).copied().unwrap_or(0));
    let [w, _, _, _] = q;
    let odd = !order.is_even();
    let third = if odd { -third } else { third };
    // Sums of two components of a unit quaternion: at most the root of 2, in Q30.
    let (sum, longer) = polar(own + third, w + other);
    let (difference, shorter) = polar(own - third, w - other);
    let second = (1i32 << 30).wrapping_sub(atan2(shorter, longer).wrapping_mul(2));
    let last = sum.wrapping_sub(difference);
    [sum.wrapping_add(difference), second, if odd { last.wrapping_neg() } else { last }].map(Angle::from_bits)
}

/// The angle and the length of a vector shorter than 2^31.
#[inline(never)]
fn polar(y: i32, x: i32) -> (i32, i32) {
    let angle = atan2(y, x);
    let (sin, cos) = sin_cos(angle);
    (angle, scaled(x, cos) + scaled(y, sin))
}

/// An element of a rotation matrix.
fn at(matrix: &[[Component; 3]; 3], row: Axis, column: Axis) -> i32 {
    matrix.get(row.index()).and_then(|row| row.get(column.index())).map_or(0, |element| element.to_bits())
}

/// 1 where the axes are an even permutation of x, y, z, else -1.
fn sign(order: EulerOrder) -> i32 {
    if order.is_even() { 1 } else { -1 }
}

/// The Euler angles of a rotation matrix: Ri(a) Rj(b) Rk(c).
fn euler_of(matrix: &[[Component; 3]; 3], order: EulerOrder) -> [Angle; 3] {
    let ([i, j, k], sign) = (order.axes(), sign(order));
    let last = last_of(matrix, order);
    let (c, (sin, cos)) = last;
    let cos_b = narrow(times(at(matrix, i, i), cos) - times(sign * at(matrix, i, j), sin));
    let b = atan2(sign * at(matrix, i, k), cos_b);
    [first_of(matrix, order, last), b, c].map(Angle::from_bits)
}

/// The last angle, with its sine and cosine.
fn last_of(matrix: &[[Component; 3]; 3], order: EulerOrder) -> (i32, (i32, i32)) {
    let [i, j, _] = order.axes();
    let c = atan2(-sign(order) * at(matrix, i, j), at(matrix, i, i));
    (c, sin_cos(c))
}

/// The first angle. Without the last one the image of axis j shows it alone, also where the second is a quarter turn.
fn first_of(matrix: &[[Component; 3]; 3], order: EulerOrder, (_, (sin, cos)): (i32, (i32, i32))) -> i32 {
    let ([i, j, k], sign) = (order.axes(), sign(order));
    let image = |row: Axis| narrow(times(sign * at(matrix, row, i), sin) + times(at(matrix, row, j), cos));
    atan2(sign * image(k), image(j))
}

#[cfg(test)]
mod tests {
    use super::*;

    type Matrix = [[f64; 3]; 3];

    fn multiply(a: Matrix, b: Matrix) -> Matrix {
        core::array::from_fn(|row| core::array::from_fn(|column| (0..3).map(|k| a[row][k] * b[k][column]).sum()))
    }

    fn about_axis(axis: Axis, angle: f64) -> Matrix {
        let (sin, cos) = angle.sin_cos();
        match axis {
            Axis::X => [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]],
            Axis::Y => [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]],
            Axis::Z => [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]],
        }
    }

    #[test]
    fn the_first_angle_is_that_of_all_three() {
        let mut random = fastrand::Rng::with_seed(3);
        for order in EulerOrder::ALL {
            for _ in 0..if cfg!(miri) { 3 } else { 1000 } {
                let turn = Turn::Quaternion([(); 4].map(|()| Component::from_bits(random.i32(..))));
                let matrix = super::Matrix::of_quaternion(turn.quaternion());
                assert_eq!(matrix, turn.matrix());
                assert_eq!(matrix.first_angle(order), matrix.euler(order)[0]);
            }
        }
    }

    fn radians(angle: Angle) -> f64 {
        f64::from(angle.to_bits()) / 4_294_967_296.0 * std::f64::consts::TAU
    }

    fn of_angles(order: EulerOrder, angles: [Angle; 3]) -> Matrix {
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        order.axes().into_iter().zip(angles).fold(identity, |m, (axis, angle)| multiply(m, about_axis(axis, radians(angle))))
    }

    /// Rodrigues' formula.
    fn of_map(map: [Angle; 3]) -> Matrix {
        let v = map.map(radians);
        let angle = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if angle == 0.0 {
            return of_angles(EulerOrder::XYZ, [Angle::ZERO; 3]);
        }
        let [x, y, z] = v.map(|x| x / angle);
        let (sin, cos) = angle.sin_cos();
        let t = 1.0 - cos;
        [
            [t * x * x + cos, t * x * y - sin * z, t * x * z + sin * y],
            [t * x * y + sin * z, t * y * y + cos, t * y * z - sin * x],
            [t * x * z - sin * y, t * y * z + sin * x, t * z * z + cos],
        ]
    }

    fn difference(a: Matrix, b: Matrix) -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).fold(0.0, |worst, (a, b)| worst.max((a - b).abs()))
    }

    const ORDERS: [EulerOrder; 6] = EulerOrder::ALL;

    fn random() -> impl FnMut() -> i32 {
        let mut random = fastrand::Rng::with_seed(1);
        move || random.i32(..)
    }

    fn of_fixed(matrix: super::Matrix) -> Matrix {
        matrix.rows.map(|row| row.map(|x| x.to_num::<f64>()))
    }

    /// Miri takes a thousand times as long.
    const ROUNDS: usize = if cfg!(miri) { 60 } else { 20_000 };

    #[test]
    fn any_rotation_in_any_order_is_the_same_rotation() {
        let mut next = random();
        let (mut worst, mut worst_matrix) = (0.0f64, 0.0f64);
        for round in 0..ROUNDS {
            // Small, large and greatest maps and angles.
            let shift = round % 24;
            let angles = [next() >> shift, next() >> shift, next() >> shift].map(Angle::from_bits);
            let own = ORDERS[round % 6];
            for (turn, truth) in
                [(Turn::Euler { order: own, angles }, of_angles(own, angles)), (Turn::Exponential(angles), of_map(angles))]
            {
                worst_matrix = worst_matrix.max(difference(of_fixed(turn.matrix()), truth));
                for order in ORDERS {
                    worst = worst.max(difference(of_angles(order, turn.euler(order)), truth));
                }
                let again = Turn::Quaternion(turn.quaternion());
                worst = worst.max(difference(of_fixed(again.matrix()), truth));
            }
        }
        assert!(worst_matrix < 4e-7, "{worst_matrix}");
        // A rotation by 2e-6 degrees moves no element by more than 3.5e-8.
        assert!(worst < 2e-8, "{worst}");
    }

    #[test]
    fn the_whole_angle_of_a_map_is_its_length() {
        let mut next = random();
        for round in 0..ROUNDS {
            let map = [next(), next(), next()].map(|x| Angle::from_bits(x >> (2 + round % 24)));
            let length = map.map(radians).iter().map(|x| x * x).sum::<f64>().sqrt();
            let folded = if length > std::f64::consts::PI { std::f64::consts::TAU - length } else { length };
            let got = radians(Turn::Exponential(map).angle());
            // 2e-6 degrees are 3.5e-8.
            assert!((got - folded).abs() < 2e-8, "{map:?}: {got} for {folded}");
        }
    }

    #[test]
    fn at_a_quarter_turn_the_other_two_still_make_the_rotation() {
        for quarter in [1 << 30, -(1 << 30), (1 << 30) - 1, (1 << 30) + 40] {
            for (a, c) in [(0, 0), (1 << 28, 3 << 27), (-7 << 26, 1 << 30)] {
                let angles = [a, quarter, c].map(Angle::from_bits);
                for own in ORDERS {
                    let still = Turn::Exponential([Angle::ZERO; 3]).euler(own);
                    assert!(still.iter().all(|angle| angle.to_bits().unsigned_abs() < 16), "{still:?}");
                    let quaternion = Turn::Quaternion(Turn::Euler { order: own, angles }.quaternion());
                    let error = difference(of_angles(own, quaternion.euler(own)), of_angles(own, angles));
                    assert!(error < 2e-6, "{own:?} {angles:?}: {error}");
                }
            }
        }
    }

    #[test]
    fn quaternions_of_any_length_are_normalized() {
        let mut next = random();
        for round in 0..ROUNDS {
            let q = [next(), next(), next(), next()].map(|x| x >> (round % 27));
            let length = q.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
            let unit = normalized(q);
            for (raw, unit) in q.iter().zip(unit) {
                let error = (f64::from(*raw) / length - f64::from(unit) / f64::from(1 << 30)).abs();
                assert!(length < 1.0 || error < 1e-8, "{q:?} {unit:?} {error}");
            }
        }
        assert_eq!(normalized([0; 4]), NO_ROTATION);
        for bits in 0..31 {
            assert_eq!(normalized([1 << bits, 0, 0, 0]), NO_ROTATION);
        }
        assert_eq!(normalized([i32::MIN; 4]), [-(1 << 29); 4]);
    }
}

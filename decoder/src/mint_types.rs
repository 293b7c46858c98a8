//! Rotations as types of the `mint` crate, which other crates of mathematics convert from: with [`Component`]s and [`Angle`]s in them, so that no float is linked.
//! `fixed`'s `to_num::<f32>()` converts a component.

use crate::{Angle, Component, EulerOrder, Matrix, Turn};

impl From<Turn> for mint::Quaternion<Component> {
    /// The unit quaternion: [`Turn::quaternion`].
    fn from(turn: Turn) -> Self {
        let [s, x, y, z] = turn.quaternion();
        mint::Quaternion { v: mint::Vector3 { x, y, z }, s }
    }
}

impl From<mint::Quaternion<Component>> for Turn {
    fn from(q: mint::Quaternion<Component>) -> Self {
        Turn::Quaternion([q.s, q.v.x, q.v.y, q.v.z])
    }
}

impl From<Matrix> for mint::RowMatrix3<Component> {
    fn from(matrix: Matrix) -> Self {
        let [x, y, z] = matrix.rows.map(mint::Vector3::from);
        mint::RowMatrix3 { x, y, z }
    }
}

impl From<Matrix> for mint::ColumnMatrix3<Component> {
    fn from(matrix: Matrix) -> Self {
        mint::RowMatrix3::from(matrix).into()
    }
}

impl From<mint::RowMatrix3<Component>> for Matrix {
    fn from(matrix: mint::RowMatrix3<Component>) -> Self {
        Matrix { rows: [matrix.x.into(), matrix.y.into(), matrix.z.into()] }
    }
}

impl From<mint::ColumnMatrix3<Component>> for Matrix {
    fn from(matrix: mint::ColumnMatrix3<Component>) -> Self {
        mint::RowMatrix3::from(matrix).into()
    }
}

/// Angles in the orders that `mint` has, about axes as turned by those before.
macro_rules! euler {
    ($($order:ident $mint:ident,)*) => {$(
        impl From<Turn> for mint::EulerAngles<Angle, mint::$mint> {
            /// The angles in this order: [`Turn::euler`].
            fn from(turn: Turn) -> Self {
                turn.euler(EulerOrder::$order).into()
            }
        }

        impl From<mint::EulerAngles<Angle, mint::$mint>> for Turn {
            fn from(angles: mint::EulerAngles<Angle, mint::$mint>) -> Self {
                Turn::Euler { order: EulerOrder::$order, angles: angles.into() }
            }
        }
    )*};
}

euler!(XYZ IntraXYZ, ZYX IntraZYX,);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_come_and_go() {
        let angles = [1 << 28, -3 << 27, 12_345_678].map(Angle::from_bits);
        let turn = Turn::Euler { order: EulerOrder::ZYX, angles };
        let other: mint::EulerAngles<Angle, mint::IntraZYX> = turn.into();
        assert_eq!((Turn::from(other), [other.a, other.b, other.c]), (turn, angles));
        let q: mint::Quaternion<Component> = turn.into();
        assert_eq!(Turn::from(q).matrix(), Turn::Quaternion(turn.quaternion()).matrix());
        let matrix = turn.matrix();
        let (rows, columns): (mint::RowMatrix3<Component>, mint::ColumnMatrix3<Component>) = (matrix.into(), matrix.into());
        assert_eq!((rows.x.y, columns.x.y), (matrix.rows[0][1], matrix.rows[1][0]));
        assert_eq!((Matrix::from(rows), Matrix::from(columns)), (matrix, matrix));
    }
}

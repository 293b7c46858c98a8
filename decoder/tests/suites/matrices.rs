//! Rotation matrices: images of vectors and products, to the last bit.

use pantin::{Angle, Axis, EulerOrder, Matrix, Turn};

use super::poses::Noise;

/// A sum of products of components in Q30, rounded to the nearest whole number, halves up.
fn rounded(products: impl Iterator<Item = (i32, i32)>) -> i64 {
    let sum: i128 = products.map(|(a, b)| i128::from(a) * i128::from(b)).sum();
    i64::try_from((2 * sum + (1 << 30)).div_euclid(1 << 31)).unwrap()
}

fn bits(matrix: &Matrix) -> [[i32; 3]; 3] {
    matrix.rows.map(|row| row.map(|element| element.to_bits()))
}

#[test]
fn vectors_and_matrices_are_multiplied_to_the_last_bit() {
    let mut noise = Noise(5);
    let mut before = Matrix::IDENTITY;
    for round in 0..if cfg!(miri) { 4 } else { 300 } {
        let matrix = Turn::Exponential([(); 3].map(|()| Angle::from_bits(noise.next()))).matrix();
        let rows = bits(&matrix);
        let vector = match round % 3 {
            0 => [i32::MIN, i32::MAX, noise.next()],
            _ => [(); 3].map(|()| noise.next()),
        };
        let image = rows.map(|row| rounded(row.into_iter().zip(vector)));
        assert_eq!(matrix.apply(vector), image, "{rows:?} {vector:?}");
        assert_eq!(Matrix::IDENTITY.apply(vector), vector.map(i64::from));
        let (first, both) = (bits(&before), before.then(&matrix));
        let wanted = first.map(|row| [0, 1, 2].map(|column| rounded(row.into_iter().zip(rows.map(|own| own[column])))));
        assert_eq!(bits(&both).map(|row| row.map(i64::from)), wanted, "{first:?} then {rows:?}");
        for order in [EulerOrder::XYZ, EulerOrder::ZXY, EulerOrder::YZX] {
            assert_eq!(matrix.euler(order), Turn::Exponential([Angle::ZERO; 3]).matrix().then(&matrix).euler(order));
        }
        before = matrix;
    }
}

/// The product of two quaternions w, x, y, z in Q30, each component rounded once.
fn product(a: [i32; 4], b: [i32; 4]) -> [i32; 4] {
    // For each component the components of `b` that those of `a` are multiplied by, and the signs.
    let table = [
        [(0, 1), (1, -1), (2, -1), (3, -1)],
        [(1, 1), (0, 1), (3, 1), (2, -1)],
        [(2, 1), (3, -1), (0, 1), (1, 1)],
        [(3, 1), (2, 1), (1, -1), (0, 1)],
    ];
    table.map(|row| {
        let sum: i128 = a.into_iter().zip(row).map(|(a, (of, sign))| i128::from(a) * i128::from(b[of]) * sign).sum();
        i32::try_from((2 * sum + (1 << 30)).div_euclid(1 << 31)).unwrap()
    })
}

#[test]
fn angles_become_quaternions_and_those_matrices_with_one_rounding_each() {
    let (mut noise, one) = (Noise(9), 1 << 30);
    for _ in 0..if cfg!(miri) { 4 } else { 300 } {
        for order in [EulerOrder::XYZ, EulerOrder::YXZ, EulerOrder::ZXY, EulerOrder::ZYX] {
            let angles = [(); 3].map(|()| Angle::from_bits(noise.next()));
            let turn = Turn::Euler { order, angles };
            let about = |(axis, angle): (Axis, Angle)| {
                let (sin, cos) = Angle::from_bits(angle.to_bits() >> 1).sin_cos();
                let mut unit = [cos.to_bits(), 0, 0, 0];
                unit[axis as usize + 1] = sin.to_bits();
                unit
            };
            let unit = order.axes().into_iter().zip(angles).map(about).fold([one, 0, 0, 0], product);
            assert_eq!(turn.quaternion().map(|component| component.to_bits()), unit, "{turn:?}");
            // Twice a product of components, rounded.
            let [w, x, y, z] = unit;
            let twice = |[(a, b), (c, d)]: [(i32, i32); 2], sign: i128| {
                let sum = i128::from(a) * i128::from(b) + sign * i128::from(c) * i128::from(d);
                i32::try_from((2 * sum + (1 << 29)).div_euclid(1 << 30)).unwrap()
            };
            let wanted = [
                [one - less(twice, y, z), twice([(x, y), (w, z)], -1), twice([(x, z), (w, y)], 1)],
                [twice([(x, y), (w, z)], 1), one - less(twice, x, z), twice([(y, z), (w, x)], -1)],
                [twice([(x, z), (w, y)], -1), twice([(y, z), (w, x)], 1), one - less(twice, x, y)],
            ];
            assert_eq!(bits(&turn.matrix()), wanted, "{turn:?}");
        }
    }
}

/// What two squares take from an element of the diagonal: minus the rounded value of their negative.
fn less(twice: impl Fn([(i32, i32); 2], i128) -> i32, a: i32, b: i32) -> i32 {
    -twice([(-a, a), (b, b)], -1)
}

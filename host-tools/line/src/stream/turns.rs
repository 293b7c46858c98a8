//! Rotations as quaternions w, x, y, z of length 1.

/// A rotation.
pub type Turn = [f64; 4];

/// Turns nothing.
pub const IDENTITY: Turn = [1.0, 0.0, 0.0, 0.0];

/// `b`, then `a`.
pub fn product([a, b, c, d]: Turn, [e, f, g, h]: Turn) -> Turn {
    [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e]
}

/// The rotation back.
pub fn inverse([w, x, y, z]: Turn) -> Turn {
    [w, -x, -y, -z]
}

/// A vector after a rotation.
pub fn turned(turn: Turn, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [_, x, y, z] = product(product(turn, [0.0, x, y, z]), inverse(turn));
    [x, y, z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_turn_one_after_the_other() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let (about_x, about_y) = ([half, half, 0.0, 0.0], [half, 0.0, half, 0.0]);
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12);
        assert!(near(turned(about_x, [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]));
        assert!(near(turned(product(about_y, about_x), [0.0, 1.0, 0.0]), [1.0, 0.0, 0.0]));
        assert!(near(turned(product(about_x, inverse(about_x)), [1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]));
    }
}

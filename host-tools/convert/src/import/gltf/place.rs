//! Where nodes stand: translation, rotation and scale of a node, and what the scales above it do to its place.
//!
//! A rig's joints turn and move but do not stretch. Scales go into the places of the joints below: with Q the product of the
//! rotations above a node and A that of all its linear parts, its place in the rig is D t with D = transposed(Q) A, and below
//! the node D becomes transposed(R) D R S. Without scales D is 1; a uniform one commutes with R.

use super::sampler::unit;
use crate::fk::{IDENTITY, Matrix, apply, from_quaternion, product, quaternion};
use crate::import::from_transforms::Affine;
use gltf::json::Node;

/// Scales nearer to each other than this part of them are equal: the steps of f32 are up to 1.2e-7 of a number.
const SAME_SCALE: f64 = 2e-7;

/// What a node says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// In source units.
    pub translation: [f64; 3],
    /// x, y, z, w of length 1.
    pub rotation: [f64; 4],
    /// Along its own axes.
    pub scale: [f64; 3],
}

impl Rest {
    /// Of a node; `None` if it holds a number that is none.
    pub fn of(node: &Node) -> Option<Rest> {
        let wide = |vector: [f32; 3]| vector.map(f64::from);
        let rest = match &node.matrix {
            Some(matrix) => from_matrix(matrix.map(f64::from)),
            None => Rest {
                translation: node.translation.map_or([0.0; 3], wide),
                rotation: node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| unit(rotation.0.map(f64::from))),
                scale: node.scale.map_or([1.0; 3], wide),
            },
        };
        let numbers = rest.translation.iter().chain(&rest.rotation).chain(&rest.scale);
        numbers.into_iter().all(|x| x.abs() <= 1e9).then_some(rest)
    }

    /// Its transform.
    pub fn affine(&self) -> Affine {
        let [x, y, z, w] = self.rotation;
        affine(&from_quaternion([w, x, y, z]), self.scale, self.translation)
    }
}

/// The transform that scales, then turns, then moves.
pub fn affine(turn: &Matrix, scale: [f64; 3], place: [f64; 3]) -> Affine {
    std::array::from_fn(|i| [turn[i][0] * scale[0], turn[i][1] * scale[1], turn[i][2] * scale[2], place[i]])
}

/// A matrix of columns; a mirrored one has a negative first scale, and columns of length 0 turn nothing.
fn from_matrix(m: [f64; 16]) -> Rest {
    let column = |i: usize| [m[4 * i], m[4 * i + 1], m[4 * i + 2]];
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [a, b, c] = [0, 1, 2].map(column);
    let across = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let mirrored = across.iter().zip(c).map(|(x, y)| x * y).sum::<f64>() < 0.0;
    let scale = [length(a) * if mirrored { -1.0 } else { 1.0 }, length(b), length(c)];
    let turn = scale
        .iter()
        .all(|x| x.abs() > 1e-12)
        .then(|| -> Matrix { std::array::from_fn(|row| std::array::from_fn(|i| [a, b, c][i][row] / scale[i])) });
    Rest { translation: [m[12], m[13], m[14]], rotation: turn.map_or([0.0, 0.0, 0.0, 1.0], |turn| quaternion(&turn)), scale }
}

/// D of the module's text.
#[derive(Clone, Debug)]
pub enum Stretch {
    /// 1.
    None,
    /// The same at all frames.
    Still(Matrix),
    /// One a frame.
    Moving(Vec<Matrix>),
}

impl Stretch {
    /// At a frame.
    pub fn at(&self, frame: usize) -> Matrix {
        match self {
            Stretch::None => IDENTITY,
            Stretch::Still(d) => *d,
            Stretch::Moving(d) => d[frame],
        }
    }

    /// Below a node with rotation `turn` (one, or one a frame) and scale `scale` (likewise).
    pub fn below(&self, turn: &[Matrix], scale: &[[f64; 3]], frames: usize) -> Stretch {
        let one = |vector: &[f64; 3]| *vector == [1.0; 3];
        if matches!(self, Stretch::None) && scale.iter().all(one) {
            return Stretch::None;
        }
        let at = |frame: usize| {
            let (turn, scale) = (&turn[frame.min(turn.len() - 1)], scale[frame.min(scale.len() - 1)]);
            let back: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| turn[j][i]));
            let d = self.at(frame);
            let turned = if uniform(&d) { d } else { product(&back, &product(&d, turn)) };
            std::array::from_fn(|row| std::array::from_fn(|i| turned[row][i] * scale[i]))
        };
        let still = match self {
            Stretch::None => scale.len() == 1,
            Stretch::Still(d) => scale.len() == 1 && (turn.len() == 1 || uniform(d)),
            Stretch::Moving(_) => false,
        };
        if still { Stretch::Still(at(0)) } else { Stretch::Moving((0..frames).map(at).collect()) }
    }

    /// Whether places below need no frames of their own.
    pub fn is_still(&self) -> bool {
        !matches!(self, Stretch::Moving(_))
    }
}

/// What a joint stands in: nothing but the stretch of the joint above, or, for the first joint, nodes that are no joints.
#[derive(Clone, Debug)]
pub struct Base {
    /// Where it is.
    pub place: [f64; 3],
    /// How it is turned.
    pub turn: Matrix,
    /// D of the module's text.
    pub stretch: Stretch,
}

impl Base {
    /// A joint above with this stretch.
    pub fn joint(stretch: Stretch) -> Base {
        Base { place: [0.0; 3], turn: IDENTITY, stretch }
    }

    /// Nodes that stand in each other, from the top.
    pub fn nodes(rests: &[Rest]) -> Base {
        rests.iter().fold(Base::joint(Stretch::None), |base, rest| {
            let [x, y, z, w] = rest.rotation;
            let turn = from_quaternion([w, x, y, z]);
            let place = base.at(0, rest.translation);
            Base { place, turn: product(&base.turn, &turn), stretch: base.stretch.below(&[turn], &[rest.scale], 1) }
        })
    }

    /// The linear part of [`Base::at`]; `None` if it changes nothing.
    pub fn linear(&self, frame: usize) -> Option<Matrix> {
        let nothing = matches!(self.stretch, Stretch::None) && self.turn == IDENTITY;
        (!nothing).then(|| product(&self.turn, &self.stretch.at(frame)))
    }

    /// The place of a node with this translation.
    pub fn at(&self, frame: usize, translation: [f64; 3]) -> [f64; 3] {
        let turned = self.linear(frame).map_or(translation, |linear| apply(&linear, translation));
        std::array::from_fn(|axis| self.place[axis] + turned[axis])
    }
}

fn uniform(d: &Matrix) -> bool {
    let s = d[0][0];
    (0..9).all(|n| {
        let expected = if n % 4 == 0 { s } else { 0.0 };
        (d[n / 3][n % 3] - expected).abs() <= SAME_SCALE * s.abs()
    })
}

/// The first of `values` alone, if all are within the tolerance for scales of it.
pub fn settled(mut values: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let first = values[0];
    if values.iter().all(|value| (0..3).all(|i| (value[i] - first[i]).abs() <= SAME_SCALE * first[i].abs())) {
        values.truncate(1);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::about;

    #[test]
    fn a_matrix_comes_apart() {
        for (axis, angle) in [(0, 10f64), (1, 170.0), (2, -95.0), (0, 180.0)] {
            for scale in [[1.0, 1.0, 1.0], [2.0, 0.5, 3.0], [-2.0, 2.0, 2.0]] {
                let turn = product(&about(axis, angle.to_radians()), &about((axis + 1) % 3, 0.3));
                let mut m = [0.0; 16];
                (0..9).for_each(|n| m[4 * (n % 3) + n / 3] = turn[n / 3][n % 3] * scale[n % 3]);
                m[12] = 7.0;
                let rest = from_matrix(m);
                assert!((0..3).all(|i| (rest.scale[i] - scale[i]).abs() < 1e-12), "{:?}", rest.scale);
                let [x, y, z, w] = rest.rotation;
                let back = from_quaternion([w, x, y, z]);
                assert!((0..9).all(|n| (back[n / 3][n % 3] - turn[n / 3][n % 3]).abs() < 1e-12));
                assert_eq!(rest.translation, [7.0, 0.0, 0.0]);
            }
        }
    }
}

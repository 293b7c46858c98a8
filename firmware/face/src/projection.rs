//! Projects vertices: nine multiplications for the position, two for perspective, no division.

use crate::camera::Camera;
use crate::model::Model;
use crate::vertex::Vertex;
use pantin_figure::rotation::{Rotation, Vector};
use pantin_figure::trig::FRACTION_BITS;

/// The camera's projection of vertices in one orientation.
pub(crate) struct Projection {
    /// Directions to the right and down: sums of products with these are sixteenths of a pixel after `shift`.
    across: [Vector; 2],
    /// Added before the shift.
    offset: [i32; 2],
    shift: u32,
    centre: [i32; 2],
    /// Direction towards the camera, Q15.
    towards: Vector,
    nearer: i32,
}

impl Projection {
    /// `offset` is added to vertices after `head` has rotated them.
    pub fn new(camera: &Camera, head: &Rotation, offset: Vector) -> Projection {
        let [right, up, towards] = camera.rows;
        let rows = [right, up.map(|x| -x)];
        // A row of length 1 in Q15 times a scale below 2^15.
        let scaled = |row: Vector| row.map(|x| (x * camera.scale + (1 << 14)) >> 15);
        let moved = |row: Vector| {
            let along = scaled(row).into_iter().zip(offset).fold(0i32, |sum, (a, b)| sum.wrapping_add(a.wrapping_mul(b)));
            along.wrapping_add((1 << camera.shift) >> 1)
        };
        Projection {
            across: rows.map(|row| scaled(row_times(row, head))),
            offset: rows.map(moved),
            shift: camera.shift,
            centre: camera.centre,
            towards: row_times(towards, head),
            nearer: camera.nearer,
        }
    }

    /// Projects all vertices that are drawn.
    #[inline(never)]
    pub fn points(&self, vertices: &[Vertex], facing: &[i8], points: &mut [[i16; 2]]) {
        if let ([[right, 0, 0], [0, down, 0]], [0, 0, towards]) = (self.across, self.towards) {
            return self.straight([right, down, towards], vertices, facing, points);
        }
        for ((point, &vertex), &facing) in points.iter_mut().zip(vertices).zip(facing) {
            if facing != NOT_DRAWN {
                *point = self.point(vertex);
            }
        }
    }

    /// Projects a head that looks into the camera: the same sums without the products with 0.
    #[inline(always)]
    fn straight(&self, [right, down, towards]: Vector, vertices: &[Vertex], facing: &[i8], points: &mut [[i16; 2]]) {
        for ((point, &[x, y, z]), &facing) in points.iter_mut().zip(vertices).zip(facing) {
            if facing == NOT_DRAWN {
                continue;
            }
            let magnification = self.magnification(towards.wrapping_mul(i32::from(z)));
            let (across, along) = (right.wrapping_mul(i32::from(x)), down.wrapping_mul(i32::from(y)));
            *point = [self.onto(across, magnification, 0), self.onto(along, magnification, 1)];
        }
    }

    /// Perspective to the first order: 1 + z / d instead of 1 / (1 - z / d).
    #[inline(always)]
    fn magnification(&self, towards: i32) -> i32 {
        (1 << 12) + (((towards >> FRACTION_BITS) * self.nearer) >> 16)
    }

    /// Rows are at most 2^15 long, positions at most 2^15.8: sums stay below 2^31.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub fn point(&self, vertex: Vertex) -> [i16; 2] {
        let (x, y, z) = (i32::from(vertex[0]), i32::from(vertex[1]), i32::from(vertex[2]));
        let along =
            |row: &Vector| row[0].wrapping_mul(x).wrapping_add(row[1].wrapping_mul(y)).wrapping_add(row[2].wrapping_mul(z));
        let magnification = self.magnification(along(&self.towards));
        let [right, down] = &self.across;
        [self.onto(along(right), magnification, 0), self.onto(along(down), magnification, 1)]
    }

    /// A position on the display: within 2^15 sixteenths, magnified at most twice.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn onto(&self, along: i32, magnification: i32, axis: usize) -> i16 {
        let flat = along.wrapping_add(self.offset[axis]) >> self.shift;
        (flat.wrapping_mul(magnification) >> 12).wrapping_add(self.centre[axis]) as i16
    }
}

/// Marks a vertex that no line needs.
pub(crate) const NOT_DRAWN: i8 = i8::MIN;

/// The head's rotation: about y, then x, then z.
pub(crate) fn head_rotation([x, y, z]: [i32; 3]) -> Rotation {
    let mut head = Rotation::IDENTITY;
    for (axis, angle) in [(1, y), (0, x), (2, z)] {
        head.turn(axis, angle);
    }
    head
}

/// The direction towards the camera, Q15, in the axes of a head with this rotation.
pub(crate) fn towards(camera: &Camera, angles: [i32; 3]) -> Vector {
    row_times(camera.rows[2], &head_rotation(angles))
}

/// The cosine between each vertex's normal and a direction towards the camera (Q15), 127 is 1. Mirror images share two of three products.
#[inline(never)]
pub(crate) fn facing(model: &Model, [a, b, c]: Vector, facing: &mut [i8]) {
    let normals = model.normals.as_chunks::<3>().0;
    // Normals are at most 127 long: a sum is below 2^22, and fits 8 bits after the shift.
    let parts = |normal: &[u8; 3]| {
        let [x, y, z] = *normal;
        (a * i32::from(x as i8), b * i32::from(y as i8) + c * i32::from(z as i8))
    };
    let (middles, pairs) = facing.split_at_mut(model.middles().min(facing.len()));
    for (out, normal) in middles.iter_mut().zip(normals) {
        let (across, along) = parts(normal);
        *out = ((along + across) >> FRACTION_BITS) as i8;
    }
    let (left, right) = pairs.split_at_mut(model.pairs().min(pairs.len()));
    let rest = normals.get(model.middles()..).unwrap_or(&[]);
    for ((left, right), normal) in left.iter_mut().zip(right).zip(rest) {
        let (across, along) = parts(normal);
        *left = ((along + across) >> FRACTION_BITS) as i8;
        *right = ((along - across) >> FRACTION_BITS) as i8;
    }
}

/// A row vector times a rotation.
fn row_times(row: Vector, rotation: &Rotation) -> Vector {
    rotation.0.map(|column| (row[0] * column[0] + row[1] * column[1] + row[2] * column[2] + (1 << 14)) >> 15)
}

//! A face in full precision, as it becomes a model: what moves which points, and by which names.

use super::head::Vector;
use pantin_face::shape::{Interpolation, ShapeKind};
use std::collections::HashSet;

/// A turn about a line parallel to an axis.
#[derive(Clone, Debug)]
pub struct Turn {
    /// 0, 1, 2: x, y, z.
    pub axis: usize,
    /// A point of the line.
    pub centre: Vector,
    /// Degrees at full weight.
    pub degrees: f64,
    /// Points, each with its part of the angle, 0 to 1: in the middle or left.
    pub members: Vec<(usize, f64)>,
}

/// What a weight moves. Its other weight moves the mirror image.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its name; with `_left` and `_right` that of one side.
    pub name: String,
    /// How it goes.
    pub interpolation: Interpolation,
    /// What its weights are.
    pub kind: ShapeKind,
    /// Whether it has a left and a right version.
    pub sided: bool,
    /// Points and the ways that they go at full weight of the stored side.
    pub deltas: Vec<(usize, Vector)>,
    /// What turns.
    pub turns: Vec<Turn>,
}

/// What a name drives: a shape's sides, by so much a unit of the channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Name of the channel.
    pub name: String,
    /// Index of the shape.
    pub shape: usize,
    /// The stored side, the mirrored one.
    pub sides: [bool; 2],
    /// Weight for a value of 1.
    pub gain: f64,
}

/// A curve by its points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// From which size on it is drawn.
    pub detail: u8,
    /// Brightness.
    pub shade: u8,
    /// Whether its mirror image is drawn too.
    pub paired: bool,
    /// Whether it runs back to its first point.
    pub closed: bool,
    /// Whether it keeps its corners at any size.
    pub straight: bool,
    /// Whether the smallest displays alone draw it.
    pub small: bool,
    /// Its points.
    pub points: Vec<usize>,
}

/// An opening, and the shape that lets what is behind over its lower edge by so much.
#[derive(Clone, Debug)]
pub struct Opening {
    /// The edges and members.
    pub opening: super::head::Opening,
    /// Index of the shape, and the drop.
    pub release: Option<(usize, f64)>,
}

/// All that a model holds.
#[derive(Clone, Debug, Default)]
pub struct Blueprint {
    /// Points in the middle.
    pub middles: usize,
    /// Points of the left half.
    pub pairs: usize,
    /// Steps a unit, as a power of two.
    pub fraction_bits: i8,
    /// Points of the middle and of the left half.
    pub points: Vec<Vector>,
    /// Their normals.
    pub normals: Vec<Vector>,
    /// Triangles of the left half.
    pub triangles: Vec<[usize; 3]>,
    /// Number of triangles that make the outline.
    pub outline: usize,
    /// Points that stay when the head turns.
    pub fixed: Vec<usize>,
    /// What is drawn.
    pub curves: Vec<Curve>,
    /// Eyes and mouth.
    pub openings: Vec<Opening>,
    /// What moves.
    pub shapes: Vec<Shape>,
    /// By which names.
    pub names: Vec<Drive>,
}

impl Blueprint {
    /// Number of points of both halves.
    pub fn vertices(&self) -> usize {
        self.middles + 2 * self.pairs
    }

    /// The point that mirrors another.
    pub fn mirror(&self, index: usize) -> usize {
        match index {
            index if index < self.middles => index,
            index if index < self.middles + self.pairs => index + self.pairs,
            _ => index - self.pairs,
        }
    }

    /// Index of the shape called so.
    pub fn shape(&self, name: &str) -> Option<usize> {
        self.shapes.iter().position(|shape| shape.name == name)
    }

    /// The names of the channels that drive shapes, one per line, in the order of their first entries.
    pub fn name_list(&self) -> String {
        let mut listed = HashSet::new();
        let names = self.names.iter().map(|drive| drive.name.as_str());
        names.filter(|name| listed.insert(*name)).map(|name| format!("{name}\n")).collect()
    }

    /// Places of all points at rest.
    pub fn neutral(&self) -> Vec<Vector> {
        let right = self.points[self.middles..].iter().map(|&[x, y, z]| [-x, y, z]);
        self.points.iter().copied().chain(right).collect()
    }
}

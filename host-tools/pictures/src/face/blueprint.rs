//! A face in full precision, from which a model is encoded: points, curves, shapes that move points, and names of channels.

use super::head::Vector;
use anyhow::{Context, Result, bail, ensure};
use pantin_face::shape::{Interpolation, ShapeKind};
use std::collections::HashSet;

/// A rotation about a line parallel to an axis.
#[derive(Clone, Debug)]
pub struct Turn {
    /// 0, 1, 2: x, y, z.
    pub axis: usize,
    /// A point of the line.
    pub centre: Vector,
    /// Degrees at full weight.
    pub degrees: f64,
    /// Points in the middle or on the left, each with its part of the angle, 0 to 1.
    pub members: Vec<(usize, f64)>,
}

/// The centre and the angle about which the spherical interpolation moves deltas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// The centre.
    pub centre: Vector,
    /// The angle in degrees, [`Arc::LEAST`] to [`Arc::MOST`].
    pub degrees: f64,
}

impl Arc {
    /// The least angle in degrees: on the device, the sine of a smaller one has too few steps.
    pub const LEAST: f64 = 2.0;
    /// The largest angle in degrees.
    pub const MOST: f64 = 120.0;
}

/// What a weight moves. Its other weight moves the mirror image.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its name; a suffix `_left` or `_right` selects one side.
    pub name: String,
    /// How its points move.
    pub interpolation: Interpolation,
    /// The range of its weights.
    pub kind: ShapeKind,
    /// Whether it has a left and a right version.
    pub sided: bool,
    /// At least the largest coordinate of a displacement for which deltas are stored: the model keeps 127ths of it. 0 where the deltas themselves
    /// decide.
    pub reach: f64,
    /// Points and their displacements at full weight of the stored side.
    pub deltas: Vec<(usize, Vector)>,
    /// Its rotations.
    pub turns: Vec<Turn>,
    /// About what the spherical interpolation moves its deltas; without it, deltas cannot be spherical.
    pub arc: Option<Arc>,
}

impl Shape {
    /// The displacement of which the model keeps 127ths.
    pub fn longest(&self) -> f64 {
        self.deltas.iter().flat_map(|(_, way)| way).fold(self.reach, |longest, x| longest.max(x.abs()))
    }
}

/// A name, and the sides of a shape that a channel with this name drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Name of the channel.
    pub name: String,
    /// Index of the shape.
    pub shape: usize,
    /// Whether it drives the stored side, and the mirrored side.
    pub sides: [bool; 2],
    /// Weight at a channel value of 1.
    pub gain: f64,
}

/// A curve through points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The lowest detail, 0 to 3, at which it is drawn.
    pub detail: u8,
    /// Brightness, 0 to 255.
    pub shade: u8,
    /// Whether its mirror image is drawn too.
    pub paired: bool,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// Whether it consists of straight lines at every size.
    pub straight: bool,
    /// Whether it is drawn at detail 0 only.
    pub small: bool,
    /// Whether the area inside is filled.
    pub filled: bool,
    /// Its points.
    pub points: Vec<usize>,
}

/// An opening, and the shape that lets its members pass the lower edge.
#[derive(Clone, Debug)]
pub struct Opening {
    /// The edges and members.
    pub opening: super::head::Opening,
    /// Index of the shape, and the distance at full weight, in the model's units of length.
    pub release: Option<(usize, f64)>,
}

/// The content of a model.
#[derive(Clone, Debug, Default)]
pub struct Blueprint {
    /// Number of points in the middle.
    pub middles: usize,
    /// Number of points on the left.
    pub pairs: usize,
    /// Steps per unit of length, as a power of two.
    pub fraction_bits: i8,
    /// Points in the middle and on the left.
    pub points: Vec<Vector>,
    /// Their normals.
    pub normals: Vec<Vector>,
    /// Triangles of the left half of the skin.
    pub triangles: Vec<[usize; 3]>,
    /// Number of the first triangles that make the outline.
    pub outline: usize,
    /// Points that stay fixed when the head rotates.
    pub fixed: Vec<usize>,
    /// Curves in the order in which they are drawn.
    pub curves: Vec<Curve>,
    /// The eyes and the mouth.
    pub openings: Vec<Opening>,
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// The names that drive the shapes.
    pub names: Vec<Drive>,
}

impl Blueprint {
    /// Number of points, including mirror images.
    pub fn vertices(&self) -> usize {
        self.middles + 2 * self.pairs
    }

    /// The index of the point that mirrors another.
    pub fn mirror(&self, index: usize) -> usize {
        match index {
            index if index < self.middles => index,
            index if index < self.middles + self.pairs => index + self.pairs,
            _ => index - self.pairs,
        }
    }

    /// Sets how units move, each once: see [`Blueprint::choose`].
    pub fn choose_all(&mut self, choices: &[String]) -> Result<()> {
        let mut seen = HashSet::new();
        for choice in choices {
            let unit = choice.split('=').next().unwrap_or_default();
            ensure!(seen.insert(unit), "{unit} comes twice");
            self.choose(choice)?;
        }
        Ok(())
    }

    /// Sets how a unit moves, as `--interpolation` says it: `smile=linear`, `smile=spherical:40`. A unit with sides of its own has both set. Fails for units that do
    /// not exist, for unknown kinds, and where a spherical unit has no centre or an angle beyond [`Arc::LEAST`] to [`Arc::MOST`].
    pub fn choose(&mut self, choice: &str) -> Result<()> {
        let (unit, kind) = choice.split_once('=').with_context(|| format!("{choice}: expected unit=kind"))?;
        let (kind, degrees) = kind.split_once(':').map_or((kind, None), |(kind, degrees)| (kind, Some(degrees)));
        let interpolation = match kind {
            "linear" => Interpolation::Linear,
            "improved" => Interpolation::ImprovedLinear,
            "eased" => Interpolation::Eased,
            "spherical" => Interpolation::Spherical,
            _ => bail!("{choice}: expected linear, improved, eased or spherical"),
        };
        let named = |name: &str| name == unit || ["_left", "_right"].iter().any(|side| name.strip_suffix(side) == Some(unit));
        let mut shapes: Vec<&mut Shape> = self.shapes.iter_mut().filter(|shape| named(&shape.name)).collect();
        ensure!(!shapes.is_empty(), "{choice}: no unit of the face is called {unit}");
        for shape in &mut shapes {
            shape.interpolation = interpolation;
            let Some(degrees) = degrees else { continue };
            ensure!(interpolation == Interpolation::Spherical, "{choice}: only spherical interpolation has an angle");
            ensure!(shape.turns.is_empty(), "{choice}: {unit} rotates by an angle of its own");
            let degrees: f64 = degrees.parse().with_context(|| format!("{choice}: {degrees} is no angle"))?;
            ensure!(
                (Arc::LEAST..=Arc::MOST).contains(&degrees),
                "{choice}: expected an angle from {} to {} degrees",
                Arc::LEAST,
                Arc::MOST
            );
            let arc =
                shape.arc.as_mut().with_context(|| format!("{choice}: {unit} has no centre for spherical interpolation"))?;
            arc.degrees = degrees;
        }
        let centred = |shape: &&mut Shape| shape.deltas.is_empty() || shape.arc.is_some();
        ensure!(
            interpolation != Interpolation::Spherical || shapes.iter().all(centred),
            "{choice}: {unit} has no centre for spherical interpolation"
        );
        Ok(())
    }

    /// Index of the shape with this name.
    pub fn shape(&self, name: &str) -> Option<usize> {
        self.shapes.iter().position(|shape| shape.name == name)
    }

    /// The names of the channels that drive shapes, one per line, in the order of their first entries.
    pub fn name_list(&self) -> String {
        let mut listed = HashSet::new();
        let names = self.names.iter().map(|drive| drive.name.as_str());
        names.filter(|name| listed.insert(*name)).map(|name| format!("{name}\n")).collect()
    }

    /// Positions of all points of the neutral face.
    pub fn neutral(&self) -> Vec<Vector> {
        let right = self.points[self.middles..].iter().map(|&[x, y, z]| [-x, y, z]);
        self.points.iter().copied().chain(right).collect()
    }
}

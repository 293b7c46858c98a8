//! The units of a mesh: those of the paper that its feature points allow, and its own shapes.

use super::Missing;
use crate::face::action_units::{Effect, RULES, Rule, arc, effect, missing, shape};
use crate::face::blueprint::{Drive, Shape, Turn};
use crate::face::head::Vector;
use crate::face::names;
use crate::face::outside::of_target;
use crate::face::subject::Subject;
use pantin_convert::import::mesh::Mesh;
use pantin_face::shape::Interpolation;

/// Shapes and the names that drive them.
#[derive(Default)]
pub(super) struct Units {
    pub shapes: Vec<Shape>,
    names: Vec<Drive>,
}

impl Units {
    /// Units 1 to 5 whose feature points are there, and the missing feature points.
    pub fn of(subject: &Subject) -> (Units, Missing) {
        let (mut units, mut lacking) = (Units::default(), Missing::new());
        for rule in &RULES {
            let lacks = missing(subject, rule);
            for point in &lacks {
                lacking.entry(point.to_string()).or_default().push(rule.name);
            }
            if lacks.is_empty() {
                units.add_rule(subject, rule);
            }
        }
        (units, lacking)
    }

    fn add_rule(&mut self, subject: &Subject, rule: &Rule) {
        match effect(subject, rule) {
            Effect::Rotated { centre, degrees, members } => {
                let turns = vec![Turn { axis: 0, centre, degrees, members }];
                let shape = Shape { turns, ..shape(rule.name, Interpolation::Spherical, false) };
                self.add(shape, &[rule.name], [true, true]);
            }
            Effect::Moved(ways) => {
                for (side, suffix) in [(1.0, "left"), (-1.0, "right")] {
                    let name = format!("{}_{suffix}", rule.name);
                    let deltas = of_side(subject, &ways, side);
                    let arc = Some(arc(subject, rule));
                    let shape = Shape { deltas, arc, ..shape(&name, Interpolation::ImprovedLinear, false) };
                    self.add(shape, &[rule.name, &name], [true, false]);
                }
            }
        }
    }

    fn add(&mut self, shape: Shape, names: &[&str], sides: [bool; 2]) {
        let index = self.shapes.len();
        self.names.extend(names.iter().map(|&name| Drive { name: name.into(), shape: index, sides, gain: 1.0 }));
        self.shapes.push(shape);
    }

    /// Adds the mesh's own shapes whose names no unit has, with displacements in the axes of the rules.
    pub fn add_targets(&mut self, mesh: &Mesh, in_axes: impl Fn(&Vector) -> Vector) {
        for (ways, name) in mesh.targets.iter().zip(&mesh.names) {
            if !self.names.iter().any(|drive| drive.name == *name) {
                let ways: Vec<Vector> = ways.iter().map(&in_axes).collect();
                self.shapes.push(of_target(&ways, name));
            }
        }
        for (index, shape) in self.shapes.iter().enumerate() {
            if !self.names.iter().any(|drive| drive.shape == index) {
                self.names.push(Drive { name: shape.name.clone(), shape: index, sides: [true, false], gain: 1.0 });
            }
        }
    }

    /// The shapes in the order in which a model applies them, and their names with those of sums.
    pub fn in_order(self) -> (Vec<Shape>, Vec<Drive>) {
        let Units { shapes, mut names } = self;
        // Rotations apply after all deltas.
        let mut order: Vec<usize> = (0..shapes.len()).collect();
        order.sort_by_key(|&index| !shapes[index].turns.is_empty());
        names.iter_mut().for_each(|drive| drive.shape = order.iter().position(|&index| index == drive.shape).unwrap_or(0));
        names.extend(names::sums(&names));
        (order.iter().map(|&index| shapes[index].clone()).collect(), names)
    }
}

/// The displacements of one side: 1 is left, -1 is right. Points in the middle follow both sides, each by half.
fn of_side(subject: &Subject, ways: &[(usize, Vector)], side: f64) -> Vec<(usize, Vector)> {
    let middle = subject.at("8.3")[0].midpoint(subject.at("8.4")[0]);
    let near = 1e-3 * subject.mouth_width();
    let part = |index: usize| match (subject.points[index][0] - middle) * side {
        x if x > near => 1.0,
        x if x < -near => 0.0,
        _ => 0.5,
    };
    let deltas = ways.iter().map(|&(index, way)| (index, way.map(|x| x * part(index))));
    deltas.filter(|(_, way)| *way != [0.0; 3]).collect()
}

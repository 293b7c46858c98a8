//! Decomposes a pose into units: the weights whose sum is closest to a target, by bounded least squares (docs/METHOD.md 3.2).

use super::action_units::RULES;
use super::blueprint::Blueprint;
use super::exact;
use super::head::{Head, Vector, dot, minus, plus};
use super::names::goes_aside;
use super::onmesh;
use super::points::Points;
use super::pose::Pairs;
use anyhow::{Context, Result, ensure};
use pantin_convert::import::mesh::Mesh;
use pantin_face::shape::{Interpolation, ShapeKind};
use std::f64::consts::PI;
use std::fmt::Write;

/// Number of linearizations; each system is solved by sweeps over the weights.
const ROUNDS: usize = 12;
const SWEEPS: usize = 200;
/// Step of the numeric derivatives.
const STEP: f64 = 1e-4;
/// Regularization in mm^2 per squared weight: it keeps units that are nearly equal from cancelling each other.
const RIDGE: f64 = 1e-3;

/// A fitted pose.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The weights.
    pub pairs: Pairs,
    /// Root mean square distance of a point from the target, in millimetres.
    pub residual: f64,
    /// Root mean square distance with all weights 0, in millimetres.
    pub before: f64,
    /// The largest distance in millimetres, and the index of its point.
    pub worst: (f64, usize),
}

/// One weight that is fitted.
#[derive(Clone, Copy)]
struct Unknown {
    shape: usize,
    sides: [bool; 2],
    least: f64,
}

/// Which units a fit may use, and how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Whether only the paper's units are used.
    pub paper: bool,
    /// The most weights that are not 0.
    pub most: usize,
}

impl Limits {
    /// All units, as many as help.
    pub const NONE: Limits = Limits { paper: false, most: usize::MAX };
}

/// Fits the units of `face` to `target`. Fails if the target has another number of points.
pub fn fit(face: &Blueprint, target: &[Vector]) -> Result<Fit> {
    ensure!(target.len() == face.vertices(), "the target has {} points; Pantin's face has {}", target.len(), face.vertices());
    let rows: Vec<(usize, Vector)> = target.iter().copied().enumerate().collect();
    fit_rows(face, &rows, Limits::NONE)
}

/// A unit is added to a sparse fit if it lowers the mean square by this part of what it is at rest, or more.
const WORTH: f64 = 2e-3;

/// Fits units of `face` to positions of some of its vertices. With a limit, units are chosen one after the other: each time the one that lowers the residual most.
pub fn fit_rows(face: &Blueprint, rows: &[(usize, Vector)], limits: Limits) -> Result<Fit> {
    ensure!(!rows.is_empty(), "no points to fit");
    let all = unknowns(face, limits.paper);
    if limits.most >= all.len() {
        return Ok(solve(face, rows, &all));
    }
    let target: Vec<Vector> = rows.iter().map(|row| row.1).collect();
    let picked = |places: &[Vector]| -> Vec<Vector> { rows.iter().map(|row| places[row.0]).collect() };
    // Both sides of a unit together are one weight, which most faces need instead of two.
    let mut all = all;
    let both = |unknown: &&Unknown| unknown.sides == [true, false] && face.shapes[unknown.shape].sided;
    let pairs_of_sides: Vec<Unknown> =
        all.iter().filter(both).map(|&unknown| Unknown { sides: [true, true], ..unknown }).collect();
    all.extend(pairs_of_sides);
    let (mut chosen, mut left): (Vec<usize>, Vec<usize>) = (Vec::new(), (0..all.len()).collect());
    let mut best = solve(face, rows, &[]);
    let rest = best.residual.powi(2);
    while chosen.len() < limits.most && best.residual.powi(2) > WORTH * rest {
        let at = exact::places(face, &best.pairs);
        let gap = differences(&target, &picked(&at));
        // By how much the best weight of one more unit lowers the sum of squares, if displacements are linear.
        let gain = |index: usize| {
            let mut moved = best.pairs.clone();
            let unknown = &all[index];
            let probe = pairs(face, std::slice::from_ref(unknown), &[PROBE])[unknown.shape];
            for (slot, (driven, weight)) in moved[unknown.shape].iter_mut().zip(unknown.sides.into_iter().zip(probe)) {
                *slot += if driven { weight } else { 0.0 };
            }
            let column = differences(&picked(&exact::places(face, &moved)), &picked(&at));
            let along: f64 = column.iter().zip(&gap).map(|(a, b)| a * b).sum::<f64>() / PROBE;
            let square = column.iter().map(|x| x * x).sum::<f64>() / (PROBE * PROBE) + RIDGE;
            let way = (along / square).clamp(unknown.least, 1.0);
            way * (2.0 * along - way * square)
        };
        let gains = left.iter().map(|&index| (index, gain(index)));
        let Some((next, gain)) = gains.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if gain <= 0.0 {
            break;
        }
        left.retain(|&index| index != next);
        chosen.push(next);
        let some: Vec<Unknown> = chosen.iter().map(|&index| all[index]).collect();
        let tried = solve(face, rows, &some);
        if best.residual.powi(2) - tried.residual.powi(2) < WORTH * rest {
            chosen.pop();
        } else {
            best = tried;
        }
    }
    Ok(best)
}

/// The part of its displacement by which a unit is tried.
const PROBE: f64 = 0.05;

/// The weights of `unknowns` that bring the vertices closest.
fn solve(face: &Blueprint, rows: &[(usize, Vector)], unknowns: &[Unknown]) -> Fit {
    let target: Vec<Vector> = rows.iter().map(|row| row.1).collect();
    let picked = |places: &[Vector]| -> Vec<Vector> { rows.iter().map(|row| places[row.0]).collect() };
    let mut ways = vec![0.0; unknowns.len()];
    for _ in 0..ROUNDS {
        let at = picked(&exact::places(face, &pairs(face, unknowns, &ways)));
        let gap = differences(&target, &at);
        let columns: Vec<Vec<f64>> = (0..unknowns.len())
            .map(|unknown| {
                let mut moved = ways.clone();
                // Beyond a full displacement nothing moves any more.
                let step = if ways[unknown] + STEP > 1.0 { -STEP } else { STEP };
                moved[unknown] += step;
                let places = picked(&exact::places(face, &pairs(face, unknowns, &moved)));
                differences(&places, &at).iter().map(|x| x / step).collect()
            })
            .collect();
        let before = ways.clone();
        descend(&columns, &gap, unknowns, &mut ways);
        if before.iter().zip(&ways).all(|(a, b)| (a - b).abs() < 1e-6) {
            break;
        }
    }
    let mut pairs = pairs(face, unknowns, &ways);
    for (shape, pair) in face.shapes.iter().zip(&mut pairs).filter(|(shape, _)| !shape.sided && goes_aside(&shape.name)) {
        // Its two directions cancel each other.
        let both = if shape.kind == ShapeKind::Unsigned { pair[0].min(pair[1]) } else { 0.0 };
        *pair = pair.map(|weight| weight - both);
    }
    let distances = |places: &[Vector]| -> Vec<f64> {
        places.iter().zip(&target).map(|(&a, &b)| minus(a, b).iter().map(|x| x * x).sum::<f64>()).collect()
    };
    let mean = |squares: &[f64]| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    let squares = distances(&picked(&exact::places(face, &pairs)));
    let worst =
        squares.iter().enumerate().fold((0.0, 0), |worst, (index, &x)| if x > worst.0 { (x, rows[index].0) } else { worst });
    let before = mean(&distances(&picked(&face.neutral())));
    Fit { pairs, residual: mean(&squares), before, worst: (worst.0.sqrt(), worst.1) }
}

/// A point of Pantin's head for each feature point that another mesh has too.
pub struct Matched {
    /// Vertices of Pantin's head and of the mesh, and how many of our millimetres its unit of length is, axis by axis.
    pairs: Vec<(usize, usize)>,
    axes: [(usize, f64); 3],
    scale: f64,
}

impl Matched {
    /// Matches the feature points of a mesh. Fails without the corners of the mouth, whose distance is the scale.
    pub fn new(head: &Head, mesh: &Mesh, points: &Points) -> Result<Matched> {
        let mut pairs: Vec<(usize, usize)> =
            head.features().filter_map(|(name, index)| Some((index, *points.get(name)?))).collect();
        pairs.sort_unstable();
        let corner = |name: &str| {
            points.get(name).map(|&vertex| mesh.points[vertex]).with_context(|| format!("the mesh has no feature point {name}"))
        };
        let width = |a: Vector, b: Vector| dot(minus(a, b), minus(a, b)).sqrt();
        let scale = width(head.at("8.3"), head.at("8.4")) / width(corner("8.3")?, corner("8.4")?);
        Ok(Matched { pairs, axes: onmesh::axes(mesh, points)?, scale })
    }

    /// Where the matched points of Pantin's head are if they move as those of the mesh do.
    pub fn rows(&self, head: &Head, neutral: &[Vector], pose: &[Vector]) -> Result<Vec<(usize, Vector)>> {
        ensure!(neutral.len() == pose.len(), "the pose has {} points, the neutral mesh {}", pose.len(), neutral.len());
        let row = |&(own, other): &(usize, usize)| {
            let way = minus(pose[other], neutral[other]);
            let way = self.axes.map(|(axis, sign)| way[axis] * sign * self.scale);
            (own, plus(head.points[own], way, 1.0))
        };
        Ok(self.pairs.iter().map(row).collect())
    }
}

/// Writes fitted frames as key-frame text: a scalar for each unit and side that has a weight in some frame.
pub fn keys(face: &Blueprint, fits: &[Fit], fps: f64, comment: &str) -> String {
    let mut out = format!("keyframes 1\n# {}\nfps {fps}\nframes {}\n\n", comment.replace('\n', " "), fits.len());
    let tracks: Vec<(String, Vec<f64>)> = (0..face.shapes.len())
        .flat_map(|shape| {
            let side = |side: usize| fits.iter().map(|fit| fit.pairs[shape][side]).collect::<Vec<f64>>();
            let (left, right) = (side(0), side(1));
            let name = &face.shapes[shape].name;
            let apart = face.shapes[shape].sided || goes_aside(name);
            if apart && (left != right || goes_aside(name)) {
                vec![(format!("{name}_left"), left), (format!("{name}_right"), right)]
            } else {
                vec![(name.clone(), left)]
            }
        })
        .filter(|(_, values)| values.iter().any(|value| value.abs() >= LEAST))
        .collect();
    // Writing to a string cannot fail.
    for (name, _) in &tracks {
        let _ = writeln!(out, "scalar {name} scale 1");
    }
    for (name, values) in &tracks {
        let _ = writeln!(out, "\nkeys linear {name}");
        for (frame, value) in values.iter().enumerate() {
            let _ = writeln!(out, "  {frame} {:.4}", value.clamp(-1.0, 1.0));
        }
    }
    out
}

/// Weights below it are left out.
pub const LEAST: f64 = 0.005;

fn differences(a: &[Vector], b: &[Vector]) -> Vec<f64> {
    a.iter().zip(b).flat_map(|(&a, &b)| minus(a, b)).collect()
}

/// Returns an unknown per unit, or per side of units with sides. The head's rotation is not fitted.
fn unknowns(face: &Blueprint, paper: bool) -> Vec<Unknown> {
    let of = |(index, shape): (usize, &super::blueprint::Shape)| {
        let least = if shape.kind == ShapeKind::Unsigned { 0.0 } else { -1.0 };
        let one = |sides| Unknown { shape: index, sides, least };
        let apart = shape.sided || goes_aside(&shape.name);
        match (shape.kind, apart) {
            (ShapeKind::Head, _) => vec![],
            (_, true) => vec![one([true, false]), one([false, true])],
            (_, false) => vec![one([true, true])],
        }
    };
    let wanted = |entry: &(usize, &super::blueprint::Shape)| !paper || RULES.iter().any(|rule| rule.name == entry.1.name);
    face.shapes.iter().enumerate().filter(wanted).flat_map(of).collect()
}

/// Converts parts of displacements to weights: eased units are fitted by their displacement, in which the problem is linear.
fn pairs(face: &Blueprint, unknowns: &[Unknown], ways: &[f64]) -> Pairs {
    let mut pairs = vec![[0.0; 2]; face.shapes.len()];
    for (unknown, &way) in unknowns.iter().zip(ways) {
        for (slot, driven) in pairs[unknown.shape].iter_mut().zip(unknown.sides) {
            *slot += if driven { way } else { 0.0 };
        }
    }
    for (shape, pair) in face.shapes.iter().zip(&mut pairs) {
        *pair = pair.map(|way| match shape.interpolation {
            Interpolation::Eased => way.signum() * (1.0 - 2.0 * way.abs().min(1.0)).acos() / PI,
            Interpolation::ImprovedLinear => way.clamp(-1.0, 1.0).asin() * 2.0 / PI,
            _ => way,
        });
    }
    pairs
}

/// Minimizes |gap - columns * change|^2 within the bounds, one unknown after the other. The products of columns are taken once, for sweeps are
/// many and columns long.
fn descend(columns: &[Vec<f64>], gap: &[f64], unknowns: &[Unknown], ways: &mut [f64]) {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let products: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| product(a, b)).collect()).collect();
    let mut slopes: Vec<f64> = columns.iter().map(|column| product(column, gap)).collect();
    for _ in 0..SWEEPS {
        for (index, unknown) in unknowns.iter().enumerate() {
            let square = products[index][index];
            let slope = slopes[index] - RIDGE * ways[index];
            let next = (ways[index] + slope / (square + RIDGE)).clamp(unknown.least, 1.0);
            let change = next - ways[index];
            ways[index] = next;
            slopes.iter_mut().zip(&products[index]).for_each(|(slope, product)| *slope -= product * change);
        }
    }
}

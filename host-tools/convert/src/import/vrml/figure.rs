//! The tree of what has a place, and where everything is at a time.

use super::interpolator::{InterpolatorKeys, quaternion};
use super::lexer::Words;
use super::world::{World, children, is_joint, is_transform};
use crate::fk::{Matrix, from_quaternion};
use crate::import::from_transforms::{Affine, Role, UNMOVED, chained};
use anyhow::{Result, bail};
use std::collections::HashMap;

/// Nodes in each other, those included that `USE` puts there.
const DEEPEST: usize = 400;
/// Nodes that are visited: `USE` of `USE` makes a small file large.
const MOST_VISITS: usize = 1 << 17;

/// A node with a place, once for every time that it stands in the world.
#[derive(Clone, Copy, Debug)]
pub struct Stand {
    /// The node.
    pub node: usize,
    /// What it stands in.
    pub parent: Option<usize>,
}

/// Everything that has a place: parents before children, in the file's order.
pub fn stands(world: &World, words: &Words) -> Result<Vec<Stand>> {
    let mut walk = Walk { world, words, stands: Vec::new(), path: Vec::new(), visits: 0 };
    world.roots.iter().try_for_each(|&root| walk.visit(root, None))?;
    Ok(walk.stands)
}

struct Walk<'w> {
    world: &'w World,
    words: &'w Words<'w>,
    stands: Vec<Stand>,
    path: Vec<usize>,
    visits: usize,
}

impl Walk<'_> {
    fn visit(&mut self, node: usize, mut above: Option<usize>) -> Result<()> {
        let error = |message: String| self.words.error_at(self.world.nodes[node].line, message);
        self.visits += 1;
        if self.visits > MOST_VISITS {
            bail!(error(format!("USE makes more than {MOST_VISITS} nodes of this world")));
        }
        if self.path.contains(&node) {
            bail!(error(format!("`{}` stands in itself", self.world.name(node))));
        }
        if self.path.len() >= DEEPEST {
            bail!(error(format!("more than {DEEPEST} nodes in each other")));
        }
        let kind = self.world.kind(node);
        if is_transform(kind) {
            self.stands.push(Stand { node, parent: above });
            above = Some(self.stands.len() - 1);
        }
        self.path.push(node);
        let fields = children(kind).iter().filter_map(|field| self.world.field(node, field));
        let below = fields.map(|value| &value.nodes).find(|nodes| !nodes.is_empty());
        below.into_iter().flatten().try_for_each(|&child| self.visit(child, above))?;
        self.path.pop();
        Ok(())
    }
}

/// Fields that make a node's place and rotation, with how many numbers they have.
pub const FIELDS: [(&str, usize); 5] =
    [("translation", 3), ("rotation", 4), ("scale", 3), ("scaleOrientation", 4), ("center", 3)];

/// Index of [`FIELDS`] of the scale.
pub const SCALE: usize = 2;

/// Index of [`FIELDS`] of the center.
const CENTER: usize = 4;

/// The tracks that move nodes, by node and index of [`FIELDS`].
pub type Moves = HashMap<(usize, usize), InterpolatorKeys>;

/// The part that each stand has in the figure; `moved` tells nodes that anything moves.
pub fn roles(world: &World, stands: &[Stand], moved: impl Fn(usize) -> bool) -> Vec<Role> {
    let role = |stand: &Stand| {
        let moves = moved(stand.node);
        Role { parent: stand.parent, joint: moves || is_joint(world.kind(stand.node)), moves, carried: true }
    };
    stands.iter().map(role).collect()
}

/// A node's fields where nothing moves it, in the order of [`FIELDS`]; rotations as quaternions.
type Rest = [[f64; 4]; FIELDS.len()];

/// A stand that is to be evaluated.
pub struct Needed {
    node: usize,
    /// Index among those that are needed.
    parent: Option<usize>,
    /// Whether it is a joint of H-Anim.
    joint: bool,
    rest: Rest,
}

/// The stands of the figure at the end, in the order of `kept`, and before them what they stand in.
pub fn needed(world: &World, stands: &[Stand], kept: &[usize]) -> Vec<Needed> {
    let mut under = Vec::new();
    let mut above = kept.first().and_then(|&first| stands[first].parent);
    while let Some(stand) = above {
        under.push(stand);
        above = stands[stand].parent;
    }
    let order: Vec<usize> = under.into_iter().rev().chain(kept.iter().copied()).collect();
    let mut index_of = vec![None; stands.len()];
    let entry = |(index, &stand): (usize, &usize)| {
        index_of[stand] = Some(index);
        let Stand { node, parent } = stands[stand];
        Needed {
            node,
            parent: parent.and_then(|parent| index_of[parent]),
            joint: is_joint(world.kind(node)),
            rest: rest(world, node),
        }
    };
    order.iter().enumerate().map(entry).collect()
}

fn rest(world: &World, node: usize) -> Rest {
    std::array::from_fn(|index| {
        let (name, width) = FIELDS[index];
        let given = world.field(node, name).map(|value| &value.numbers).filter(|numbers| numbers.len() == width);
        let plain = [[0.0; 4], [0.0, 0.0, 1.0, 0.0], [1.0; 4], [0.0, 0.0, 1.0, 0.0], [0.0; 4]][index];
        let given = given.map_or(plain, |numbers| std::array::from_fn(|i| numbers.get(i).copied().unwrap_or(0.0)));
        if width == 4 { quaternion(given) } else { given }
    })
}

/// World transforms at a time. A joint of H-Anim is where its center is: it turns about it, and its translation is mostly 0.
pub fn evaluate(stands: &[Needed], moves: &Moves, time: f64) -> Vec<Affine> {
    let mut worlds: Vec<Affine> = Vec::with_capacity(stands.len());
    for stand in stands {
        let above = stand.parent.map_or(UNMOVED, |parent| worlds[parent]);
        worlds.push(chained(&above, &local(stand, moves, time)));
    }
    for (world, stand) in worlds.iter_mut().zip(stands).filter(|(_, stand)| stand.joint) {
        let [x, y, z, _] = field(stand, moves, CENTER, time);
        let center = [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]];
        *world = chained(world, &center);
    }
    worlds
}

/// A field of a node at a time.
fn field(stand: &Needed, moves: &Moves, index: usize, time: f64) -> [f64; 4] {
    let Some(track) = moves.get(&(stand.node, index)) else { return stand.rest[index] };
    let value = track.at(time);
    std::array::from_fn(|i| value.get(i).copied().unwrap_or(0.0))
}

/// Translation, center, rotation, scale in its own orientation, and back from the center.
fn local(stand: &Needed, moves: &Moves, time: f64) -> Affine {
    let turn = |[x, y, z, w]: [f64; 4]| from_quaternion([w, x, y, z]);
    let [place, rotation, scale, leaning, center] = [0, 1, 2, 3, CENTER].map(|index| field(stand, moves, index, time));
    let (rotation, leaning) = (turn(rotation), turn(leaning));
    let stretch: Matrix =
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| leaning[i][k] * scale[k] * leaning[j][k]).sum()));
    let linear = crate::fk::product(&rotation, &stretch);
    let from = crate::fk::apply(&linear, [center[0], center[1], center[2]]);
    std::array::from_fn(|i| [linear[i][0], linear[i][1], linear[i][2], place[i] + center[i] - from[i]])
}

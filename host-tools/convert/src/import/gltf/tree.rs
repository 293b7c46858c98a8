//! Which nodes become joints, and in which order.
//!
//! Joints are the scene's nodes that some animation of the file moves or that some skin names, all above them, so that they stand where
//! they stand, and all below them, which they carry. Lights, cameras and meshes that nothing moves are no part of the figure. Nodes
//! above all others that no animation moves, that no skin names and that carry one node each (axes, armatures) only say where the figure stands: they
//! are one joint with the node that they carry. All this is the same for every animation of a file.

use super::file::File;
use anyhow::{Result, bail};
use gltf::json::animation::Property;
use gltf::json::validation::Checked;
use pantin::codec::layout::MAX_JOINTS;
use std::collections::HashSet;

/// The joints: parents before children.
#[derive(Debug, Default)]
pub struct Tree {
    /// The node of each joint; `None` for a root that only joins several.
    pub nodes: Vec<Option<usize>>,
    /// Nodes above the first joint that it stands in, from the top.
    pub under: Vec<usize>,
    /// The joint above each joint.
    pub parents: Vec<Option<usize>>,
    /// Nodes that are moved but stand outside of the scene.
    pub outside: Vec<usize>,
}

/// The joints of the default scene, or of the first, or of all nodes if there is no scene.
pub fn tree(file: &File) -> Result<Tree> {
    let above = parents(file)?;
    let roots = roots(file, &above)?;
    let order = depth_first(file, &roots);
    let moved = moved(file);
    let used = used(file, &moved);
    let mut kept = used.clone();
    // Upwards and downwards are the same walk: in this order parents come first.
    for &node in order.iter().rev() {
        if let (true, Some(parent)) = (kept[node], above[node]) {
            kept[parent] = true;
        }
    }
    let mut carried = used.clone();
    for &node in &order {
        carried[node] |= above[node].is_some_and(|parent| carried[parent]);
        kept[node] |= carried[node];
    }
    let mut tree = Tree::default();
    let order: Vec<usize> = order.into_iter().filter(|&node| kept[node]).collect();
    let mut children = vec![0; above.len()];
    order.iter().filter_map(|&node| above[node]).for_each(|parent| children[parent] += 1);
    if order.iter().filter(|&&node| above[node].is_none()).count() > 1 {
        tree.nodes.push(None);
        tree.parents.push(None);
    } else {
        let mut line = order.iter().copied().take_while(|&node| !used[node] && children[node] == 1).peekable();
        while let Some(node) = line.next_if(|node| tree.under.last().copied() == above[*node]) {
            tree.under.push(node);
        }
    }
    let mut joint_of = vec![None; above.len()];
    for &node in &order[tree.under.len()..] {
        let joined = (!tree.nodes.is_empty()).then_some(0);
        tree.parents.push(above[node].and_then(|parent| joint_of[parent]).or(joined));
        joint_of[node] = Some(tree.nodes.len());
        tree.nodes.push(Some(node));
    }
    if tree.nodes.len() > MAX_JOINTS {
        bail!(file.error("nodes", format!("{} of them make the figure; a rig holds at most {MAX_JOINTS}", tree.nodes.len())));
    }
    tree.outside = (0..used.len()).filter(|&node| used[node] && !kept[node]).collect();
    Ok(tree)
}

/// The node above each node.
fn parents(file: &File) -> Result<Vec<Option<usize>>> {
    let mut above = vec![None; file.root.nodes.len()];
    for (index, node) in file.root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let Some(slot) = above.get_mut(child.value()) else { bail!(file.error("nodes", "no such child")) };
            if let Some(other) = slot.replace(index) {
                let at = format!("nodes[{index}].children");
                bail!(file.error(&at, format!("node {child} is a child of node {other} already; expected a tree")));
            }
        }
    }
    let roots: Vec<usize> = (0..above.len()).filter(|&node| above[node].is_none()).collect();
    let mut reached = vec![false; above.len()];
    depth_first(file, &roots).into_iter().for_each(|node| reached[node] = true);
    if let Some(node) = reached.iter().position(|reached| !reached) {
        bail!(file.error(&format!("nodes[{node}]"), "the node stands below itself; expected a tree"));
    }
    Ok(above)
}

fn roots(file: &File, above: &[Option<usize>]) -> Result<Vec<usize>> {
    let scene = file.root.scene.map_or(0, |scene| scene.value());
    let Some(scene_nodes) = file.root.scenes.get(scene).map(|scene| &scene.nodes) else {
        return Ok((0..above.len()).filter(|&node| above[node].is_none()).collect());
    };
    let mut seen = HashSet::new();
    let mut roots = Vec::new();
    for node in scene_nodes.iter().map(|node| node.value()) {
        match above.get(node) {
            Some(None) => roots.extend(seen.insert(node).then_some(node)),
            _ => bail!(file.error(&format!("scenes[{scene}].nodes"), format!("node {node} is not the root of a tree"))),
        }
    }
    Ok(roots)
}

fn depth_first(file: &File, roots: &[usize]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut left: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(node) = left.pop() {
        order.push(node);
        left.extend(file.root.nodes[node].children.iter().flatten().rev().map(|child| child.value()));
    }
    order
}

/// Nodes that an animation moves.
fn moved(file: &File) -> Vec<bool> {
    let moves = |path: &Checked<Property>| !matches!(path, Checked::Valid(Property::MorphTargetWeights) | Checked::Invalid);
    let channels = file.root.animations.iter().flat_map(|animation| &animation.channels);
    let mut moved = vec![false; file.root.nodes.len()];
    for channel in channels.filter(|channel| moves(&channel.target.path)) {
        moved[channel.target.node.value()] = true;
    }
    moved
}

/// Those, and what a skin names.
fn used(file: &File, moved: &[bool]) -> Vec<bool> {
    let mut used = moved.to_vec();
    file.root.skins.iter().flat_map(|skin| &skin.joints).for_each(|joint| used[joint.value()] = true);
    used
}

//! Which nodes of a scene are the figure, and what moves them.
//!
//! Joints are the skeleton's bones and the nodes that a curve of any stack moves. Meshes that nothing moves are no part of the figure unless
//! they carry a joint; cameras, lights and handles are part of it only where there is no body. This is the same for every stack of a file.

use super::layers;
use crate::import::from_transforms::Role;
use crate::import::one_line;
use crate::note::{Note, NoteKind};
use ufbx::{AnimCurve, AnimLayer, AnimProp, AnimStack, ElementType, Scene};

/// What a stack moves.
#[derive(Debug, Default)]
pub struct Moves {
    /// Nodes whose place, rotation or scale changes.
    pub nodes: Vec<bool>,
    /// Nodes whose place changes.
    pub shifted: Vec<bool>,
    /// Blend channels whose weight changes.
    pub weights: Vec<bool>,
    /// How many curves do that.
    pub curves: usize,
    /// Nodes whose scale changes.
    pub scaled: Vec<bool>,
}

impl Moves {
    /// Of one stack.
    pub fn of(scene: &Scene, stack: &AnimStack) -> Moves {
        let mut moves = Moves::nothing(scene);
        moves.add(stack);
        moves
    }

    /// Of all stacks together.
    pub fn of_any(scene: &Scene) -> Moves {
        let mut moves = Moves::nothing(scene);
        scene.anim_stacks.iter().for_each(|stack| moves.add(stack));
        moves
    }

    fn nothing(scene: &Scene) -> Moves {
        Moves {
            nodes: vec![false; scene.nodes.len()],
            shifted: vec![false; scene.nodes.len()],
            scaled: vec![false; scene.nodes.len()],
            weights: vec![false; scene.blend_channels.len()],
            curves: 0,
        }
    }

    fn add<'s>(&mut self, stack: &'s AnimStack) {
        let of_layer = |layer: &'s AnimLayer| layer.anim_props.iter().map(|property| (layer.weight_is_animated, property));
        for (weighed, property) in layers::played(stack).into_iter().flat_map(of_layer) {
            // In a layer that comes and goes, a constant moves something too.
            let count = curves(property).filter(|curve| varies(curve) || (weighed && !curve.keyframes.is_empty())).count();
            if count == 0 {
                continue;
            }
            let index = property.element.typed_id as usize;
            let slot = match (property.element.type_, &*property.prop_name) {
                (ElementType::Node, "Lcl Translation" | "Lcl Rotation" | "Lcl Scaling") => self.nodes.get_mut(index),
                (ElementType::BlendChannel, "DeformPercent") => self.weights.get_mut(index),
                _ => None,
            };
            if let Some(slot) = slot {
                *slot = true;
                self.curves += count;
                match &*property.prop_name {
                    "Lcl Translation" => self.shifted[index] = true,
                    "Lcl Scaling" => self.scaled[index] = true,
                    _ => {}
                }
            }
        }
    }

    /// Whether that is nothing.
    pub fn none(&self) -> bool {
        self.curves == 0
    }
}

fn properties(stack: &AnimStack) -> impl Iterator<Item = &AnimProp> {
    layers::played(stack).into_iter().flat_map(|layer| layer.anim_props.iter())
}

fn curves(property: &AnimProp) -> impl Iterator<Item = &AnimCurve> {
    property.anim_value.curves.iter().flatten().map(|curve| &**curve)
}

/// Keys of one value with flat tangents, as exporters write for what stands still, move nothing; nor does the rounding of f32.
fn varies(curve: &AnimCurve) -> bool {
    const ROUNDING: f64 = 1e-5;
    let keys = &curve.keyframes;
    let far = |a: f64, b: f64| (a - b).abs() > ROUNDING * b.abs().max(1.0);
    let sloped = |dy: f32| keys.len() > 1 && f64::from(dy).abs() > ROUNDING;
    keys.iter().any(|key| far(key.value, keys[0].value) || sloped(key.left.dy) || sloped(key.right.dy))
}

/// From a stack's first key to its last, in seconds.
pub fn span(stack: &AnimStack) -> (f64, f64) {
    let times = properties(stack).flat_map(curves).flat_map(|curve| curve.keyframes.iter()).map(|key| key.time);
    let (first, last) = times.fold((f64::MAX, f64::MIN), |(first, last), time| (first.min(time), last.max(time)));
    if first <= last { (first, last) } else { (0.0, 0.0) }
}

/// Indices of all nodes, each after the one above it and before that one's next child.
pub fn depth_first(scene: &Scene) -> Vec<usize> {
    let mut order = Vec::with_capacity(scene.nodes.len());
    let mut left = vec![scene.root_node.element.typed_id as usize];
    while let Some(node) = left.pop() {
        order.push(node);
        left.extend(scene.nodes[node].children.iter().rev().map(|child| child.element.typed_id as usize));
    }
    order
}

/// The part in the figure of each node of `order`.
pub fn roles(scene: &Scene, order: &[usize]) -> Vec<Role> {
    let Moves { nodes: moved, shifted, .. } = Moves::of_any(scene);
    let bones = bones(scene);
    let aside = aside(scene, order, &bones, &moved, &shifted);
    let mut role_of = vec![None; scene.nodes.len()];
    let role = |(index, &node): (usize, &usize)| {
        role_of[node] = Some(index);
        let entry = &scene.nodes[node];
        let parent = entry.parent.as_ref().and_then(|parent| role_of[parent.element.typed_id as usize]);
        let plain = matches!(entry.attrib_type, ElementType::Unknown | ElementType::Empty | ElementType::Bone);
        let joint = (moved[node] || bones[node]) && !aside[node];
        Role { parent, joint, moves: moved[node], carried: plain && !aside[node] }
    };
    order.iter().enumerate().map(role).collect()
}

/// The skeleton's nodes.
fn bones(scene: &Scene) -> Vec<bool> {
    let mut bones: Vec<bool> = scene.nodes.iter().map(|node| node.bone.is_some()).collect();
    let skinned = scene.skin_clusters.iter().filter_map(|cluster| cluster.bone_node.as_ref());
    skinned.for_each(|node| bones[node.element.typed_id as usize] = true);
    bones
}

/// Nodes that move but are no part of a body: cameras and lights, and, beside a skeleton, empty nodes that change their place and carry no
/// bone (targets, footsteps).
fn aside(scene: &Scene, order: &[usize], bones: &[bool], moved: &[bool], shifted: &[bool]) -> Vec<bool> {
    let mut carries = bones.to_vec();
    for &node in order.iter().rev() {
        if let (true, Some(parent)) = (carries[node], &scene.nodes[node].parent) {
            carries[parent.element.typed_id as usize] = true;
        }
    }
    let watches = |node: usize| matches!(scene.nodes[node].attrib_type, ElementType::Camera | ElementType::Light);
    let skeleton = bones.contains(&true);
    let body = skeleton || (0..moved.len()).any(|node| moved[node] && !watches(node));
    let empty = |node: usize| matches!(scene.nodes[node].attrib_type, ElementType::Unknown | ElementType::Empty);
    (0..moved.len()).map(|node| (body && watches(node)) || (skeleton && shifted[node] && empty(node) && !carries[node])).collect()
}

/// The blend channels that a curve of any stack changes.
pub fn weights(scene: &Scene) -> Vec<usize> {
    let moved = Moves::of_any(scene).weights;
    (0..moved.len()).filter(|&channel| moved[channel]).collect()
}

/// What a person would call a node.
pub fn name(scene: &Scene, node: usize) -> String {
    let name = one_line(&scene.nodes[node].element.name);
    if name.trim().is_empty() { format!("node{node}") } else { name }
}

/// One sentence about what motion does not need.
pub fn unused(scene: &Scene, left_out: usize) -> Option<Note> {
    let counts = [
        (left_out, "nodes that carry no joint"),
        (scene.meshes.len(), "meshes"),
        (scene.cameras.len(), "cameras"),
        (scene.lights.len(), "lights"),
        (scene.materials.len(), "materials"),
        (scene.blend_channels.len() - weights(scene).len(), "weights that nothing changes"),
        (scene.constraints.len(), "constraints"),
        (scene.cache_deformers.len(), "geometry caches"),
    ];
    let present = counts.iter().filter(|(count, _)| *count > 0);
    let words: Vec<String> = present.map(|(count, what)| format!("{count} {what}")).collect();
    (!words.is_empty()).then(|| Note::info(NoteKind::Unread, format!("not used: {}", words.join(", "))))
}

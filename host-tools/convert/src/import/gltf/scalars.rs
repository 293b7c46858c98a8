//! Channels that move no joint: morph weights, and scales that change.

use super::file::{File, one_line};
use super::sampler::SamplerKeys;
use super::{Target, Tracks, Values, joints};
use crate::import::grid::Grid;
use crate::keys::sample_pieces;
use crate::motion::{Keys, Scalar};
use anyhow::Result;
use std::collections::HashMap;

/// A scalar and its channel.
pub struct Weight {
    scalar: Scalar,
    node: String,
    values: Values,
}

impl Weight {
    /// Component `component` of a track of the node called `node`; its full scale is at least `least`.
    pub fn new(name: String, node: &str, track: &SamplerKeys, component: usize, least: f64, grid: &Grid) -> Weight {
        let pieces = track.pieces(component, grid.first, grid.frame_time);
        let values = sample_pieces(&pieces, grid.frames);
        let largest = values.iter().fold(least, |largest, value| largest.max(value.abs()));
        let full_scale = if largest > 0.0 { largest } else { 1.0 };
        let values = Values { values, keys: Some(Keys::Pieces(pieces)) };
        Weight { scalar: Scalar { name, full_scale }, node: node.into(), values }
    }

    /// The scalar and its channel.
    pub fn split(self) -> (Scalar, Values) {
        (self.scalar, self.values)
    }
}

/// Scalars for all weights that `tracks` move; full scale is 1, or more for weights that go beyond.
pub fn weights(file: &File, tracks: &Tracks, grid: &Grid) -> Result<Vec<Weight>> {
    let mut weights = Vec::new();
    for (target, track) in tracks {
        let Target::Weights(node) = *target else { continue };
        let owner = joints::name(file, node);
        let mesh = file.root.nodes[node].mesh.and_then(|mesh| file.root.meshes.get(mesh.value()));
        let Some(mesh) = mesh else {
            return Err(file.error(&format!("nodes[{node}]"), "weights move, but the node has no mesh"));
        };
        let names = target_names(mesh);
        let prefix = mesh.name.as_deref().map_or_else(|| owner.clone(), one_line);
        for component in 0..track.components {
            let name = names.get(component).cloned().unwrap_or_else(|| format!("{prefix}.weights[{component}]"));
            weights.push(Weight::new(name, &owner, track, component, 1.0, grid));
        }
    }
    Ok(weights)
}

/// The names that most exporters put beside a mesh.
pub(super) fn target_names(mesh: &gltf::json::Mesh) -> Vec<String> {
    let extras = mesh.extras.as_ref().and_then(|extras| serde_json::from_str::<serde_json::Value>(extras.get()).ok());
    let names = extras.as_ref().and_then(|extras| extras["targetNames"].as_array()).into_iter().flatten();
    names.map(|name| one_line(name.as_str().unwrap_or_default())).collect()
}

/// Scalars of one name (jawOpen of head and teeth) get their node's name before it.
pub fn tell_apart(weights: &mut [Weight]) {
    let mut counts: HashMap<String, usize> = HashMap::new();
    for weight in weights.iter() {
        *counts.entry(weight.scalar.name.clone()).or_default() += 1;
    }
    for weight in weights.iter_mut().filter(|weight| counts[&weight.scalar.name] > 1) {
        weight.scalar.name = format!("{}.{}", weight.node, weight.scalar.name);
    }
}

//! Layers of a stack that its author muted, or that are not among those that play alone: ufbx evaluates them like the others.

use crate::import::one_line;
use anyhow::{Result, anyhow};
use ufbx::{AnimLayer, AnimOpts, AnimRoot, AnimStack, ListOpt, Scene};

fn is_set(layer: &AnimLayer, property: &str) -> bool {
    ufbx::find_prop(&layer.element.props, property).is_some_and(|property| property.value_int != 0)
}

/// The layers that play, in their order: those marked `Solo` if any are, and of these the ones without `Mute`.
pub fn played(stack: &AnimStack) -> Vec<&AnimLayer> {
    let alone = stack.layers.iter().any(|layer| is_set(layer, "Solo"));
    let plays = |layer: &&AnimLayer| !is_set(layer, "Mute") && (!alone || is_set(layer, "Solo"));
    stack.layers.iter().map(|layer| &**layer).filter(plays).collect()
}

/// An animation of the layers that play, if these are not all.
pub fn animation(scene: &Scene, stack: &AnimStack) -> Result<Option<AnimRoot>> {
    let played = played(stack);
    if played.len() == stack.layers.len() {
        return Ok(None);
    }
    let ids = played.iter().map(|layer| layer.element.typed_id).collect();
    let options = AnimOpts { layer_ids: ListOpt::Owned(ids), ..Default::default() };
    ufbx::create_anim(scene, options).map(Some).map_err(|error| anyhow!("layers: {}", one_line(&error.description)))
}

/// A sentence that names the layers which do not play.
pub fn left_out(stack: &AnimStack) -> Option<String> {
    let played: Vec<u32> = played(stack).iter().map(|layer| layer.element.typed_id).collect();
    let left_out = stack.layers.iter().filter(|layer| !played.contains(&layer.element.typed_id));
    let names: Vec<String> = left_out.map(|layer| format!("`{}`", one_line(&layer.element.name))).collect();
    (!names.is_empty())
        .then(|| format!("layers that are muted, or not among those that play alone, are left out: {}", names.join(", ")))
}

//! Which layers of a stack play, and what ufbx is told so that it evaluates them and nothing else.
//!
//! ufbx evaluates layers that their author muted, or that are not among those that play alone. And a property that no curve of a layer moves takes the
//! first curve of the layer's next element, if that is of the same name: it must be told the property's own value.

use crate::import::one_line;
use crate::note::{Note, NoteKind};
use anyhow::{Result, anyhow, ensure};
use std::collections::{HashMap, HashSet};
use ufbx::{AnimLayer, AnimOpts, AnimRoot, AnimStack, ListOpt, PropOverrideDesc, Scene, StringOpt};

fn is_set(layer: &AnimLayer, property: &str) -> bool {
    ufbx::find_prop(&layer.element.props, property).is_some_and(|property| property.value_int != 0)
}

/// The layers that play, in their order: those marked `Solo` if any are, and of these the ones without `Mute`.
pub fn played(stack: &AnimStack) -> Vec<&AnimLayer> {
    let alone = stack.layers.iter().any(|layer| is_set(layer, "Solo"));
    let plays = |layer: &&AnimLayer| !is_set(layer, "Mute") && (!alone || is_set(layer, "Solo"));
    stack.layers.iter().map(|layer| &**layer).filter(plays).collect()
}

/// Elements, each with the names of its properties that curves of a layer move, in the layer's order.
fn moved(layer: &AnimLayer) -> Vec<(u32, Vec<&str>)> {
    let mut elements: Vec<(u32, Vec<&str>)> = Vec::new();
    for property in layer.anim_props.iter() {
        let (id, name) = (property.element.element_id, &*property.prop_name);
        match elements.last_mut().filter(|(last, _)| *last == id) {
            Some((_, names)) => names.push(name),
            None => elements.push((id, vec![name])),
        }
    }
    elements
}

/// The animation of what plays, where ufbx's own of the stack is another one.
pub fn animation<'s>(scene: &'s Scene, stack: &'s AnimStack) -> Result<Option<AnimRoot>> {
    let played = played(stack);
    let all = played.len() == stack.layers.len();
    // The first layer's values stand for themselves whatever its properties say; the others' may lie over those of layers below.
    let lowest = stack.layers.first().map(|layer| layer.element.typed_id);
    if let Some(first) = played.first().filter(|first| Some(first.element.typed_id) != lowest) {
        let lies_on = first.blended && (first.additive || first.weight < 1.0 || first.weight_is_animated);
        let name = one_line(&first.element.name);
        ensure!(!lies_on, "layer `{name}` adds to a layer below it that does not play: mute both or none");
    }
    // What curves of any layer of the file move, and of the layers that play.
    let of_file: Vec<_> = scene.anim_layers.iter().map(|layer| moved(layer)).collect();
    let mut ever: HashMap<u32, HashSet<&str>> = HashMap::new();
    for (id, names) in of_file.iter().flatten() {
        ever.entry(*id).or_default().extend(names);
    }
    let here: Vec<_> = played.iter().map(|layer| moved(layer)).collect();
    let moves = |id: u32, name: &str| here.iter().flatten().any(|(own, names)| *own == id && names.contains(&name));
    let mut held: HashSet<(u32, &'s str)> = HashSet::new();
    for elements in &here {
        for pair in elements.windows(2) {
            let [(id, names), (_, next)] = pair else { continue };
            let Some(&name) = next.first() else { continue };
            if names.contains(&name) || !ever.get(id).is_some_and(|names| names.contains(name)) {
                continue;
            }
            let element = || one_line(&scene.elements[*id as usize].name);
            ensure!(
                !moves(*id, name),
                "`{}`: its {} is moved in one layer and not in another, which cannot be read: merge the layers",
                element(),
                one_line(name)
            );
            held.insert((*id, name));
        }
    }
    if all && held.is_empty() {
        return Ok(None);
    }
    let mut held: Vec<(u32, &'s str)> = held.into_iter().collect();
    held.sort_unstable();
    let own = |(id, name): (u32, &'s str)| -> Option<PropOverrideDesc<'s>> {
        let property = ufbx::find_prop(&scene.elements[id as usize].props, name)?;
        let (value, value_int) = (property.value_vec4, property.value_int);
        Some(PropOverrideDesc {
            element_id: id,
            prop_name: StringOpt::Ref(name),
            value_str: StringOpt::Ref(""),
            value,
            value_int,
        })
    };
    let options = AnimOpts {
        layer_ids: ListOpt::Owned(played.iter().map(|layer| layer.element.typed_id).collect()),
        prop_overrides: ListOpt::Owned(held.into_iter().filter_map(own).collect()),
        ..Default::default()
    };
    ufbx::create_anim(scene, options).map(Some).map_err(|error| anyhow!("layers: {}", one_line(&error.description)))
}

/// A warning that names the layers which do not play.
pub fn left_out(stack: &AnimStack) -> Option<Note> {
    let played: Vec<u32> = played(stack).iter().map(|layer| layer.element.typed_id).collect();
    let left_out = stack.layers.iter().filter(|layer| !played.contains(&layer.element.typed_id));
    let names: Vec<String> = left_out.map(|layer| format!("`{}`", one_line(&layer.element.name))).collect();
    let text = || format!("layers that are muted, or not among those that play alone, are left out: {}", names.join(", "));
    (!names.is_empty()).then(|| Note::warning(NoteKind::Unread, text()))
}

//! By which joints the clips of a bank travel.

use crate::expand::expand_within;
use crate::memory::Memory;
use crate::motion::{Motion, Rig};
use crate::note::{Note, NoteKind, Remedy, first_of};
use anyhow::Result;
use pantin::Bank;

/// Horizontal cm from its place at rest that a joint is at most while the figure stays where it is: hips sway, and come down far behind the feet to sit.
const ON_THE_SPOT_CM: f64 = 60.0;
/// Names of clips that are listed for a joint.
const LISTED: usize = 4;

/// A warning if some clips of a bank carry the figure by one joint, and others by another one above or below it: a player moves the figure by one joint for all clips, and
/// it then jumps at changes between them.
pub fn travel(bank: &Bank<'_>, memory: Memory) -> Result<Option<Note>> {
    let mut by: Vec<(String, Vec<String>)> = Vec::new();
    for entry in bank.entries() {
        let clip = bank.open(&entry)?;
        let rig = super::rig::decode(&clip.rig());
        let joints = carriers(&rig);
        if joints.len() < 2 {
            return Ok(None);
        }
        let motion = expand_within(&clip, memory)?;
        let far = joints.iter().map(|&joint| (reach_cm(&motion, joint), joint));
        let Some((_, joint)) = far.filter(|(cm, _)| *cm > ON_THE_SPOT_CM).max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let (joint, clip) = (rig.joint_name(joint), entry.name().to_owned());
        match by.iter_mut().find(|(name, _)| *name == joint) {
            Some((_, clips)) => clips.push(clip),
            None => by.push((joint, vec![clip])),
        }
    }
    if by.len() < 2 {
        return Ok(None);
    }
    let of = |(joint, clips): &(String, Vec<String>)| {
        let clips: Vec<String> = clips.iter().map(|clip| format!("`{clip}`")).collect();
        format!("{} by `{joint}`", first_of(&clips, LISTED))
    };
    let text = format!(
        "the clips travel by different joints, so that the figure jumps at changes between them: {}",
        by.iter().map(of).collect::<Vec<_>>().join("; ")
    );
    Ok(Some(Note::warning(NoteKind::Travel, text).remedy(Remedy::ShareBody)))
}

/// The joints that can carry the figure: those with positions on which most of its joints hang.
fn carriers(rig: &Rig) -> Vec<usize> {
    let mut carried = vec![1; rig.joints.len()];
    for (index, joint) in rig.joints.iter().enumerate().rev() {
        if let Some(parent) = joint.parent {
            carried[parent] += carried[index];
        }
    }
    let up = rig.up.axis();
    let placed = |index: &usize| {
        let mut kinds = rig.joints[*index].kinds.iter();
        kinds.any(|kind| kind.is_position() && kind.axis() != Some(up))
    };
    (0..rig.joints.len()).filter(|&index| 2 * carried[index] > rig.joints.len()).filter(placed).collect()
}

/// The farthest horizontal cm that a joint is in its parent from where it stands at rest.
fn reach_cm(motion: &Motion, joint: usize) -> f64 {
    let (rig, first) = (&motion.rig, motion.rig.first_channels()[joint]);
    let joint = &rig.joints[joint];
    let level = |kind: &pantin::Kind| kind.is_position() && kind.axis() != Some(rig.up.axis());
    let far = |frame: usize| {
        let slots = joint.kinds.iter().enumerate().filter(|(_, kind)| level(kind));
        let parts = slots.map(|(slot, kind)| motion.values[first + slot][frame] - joint.offset[kind.axis().unwrap_or(0)]);
        parts.map(|part| part * part).sum::<f64>().sqrt()
    };
    (0..motion.frames).map(far).fold(0.0, f64::max) * rig.cm_per_unit
}

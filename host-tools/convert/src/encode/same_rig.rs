//! Tells whether two motions share a rig, and if not, where the rigs differ.

use super::rig;
use crate::motion::{Kind, Rig};
use crate::note::first_of;
use anyhow::Result;

/// The first difference between two rigs as clips hold them, as a clause about `other`; `None` if clips of both have the
/// same rig.
pub fn difference(one: &Rig, other: &Rig) -> Result<Option<String>> {
    let bytes = [rig::encode(one)?, rig::encode(other)?];
    if bytes[0] == bytes[1] {
        return Ok(None);
    }
    // What clips hold, not what the files say: offsets are rounded, and those of a root do not count.
    let [held, other_held] =
        [rig::decode(&pantin::Rig::new_checked(&bytes[0])?), rig::decode(&pantin::Rig::new_checked(&bytes[1])?)];
    Ok(Some(
        in_joints(&held, &other_held)
            .or_else(|| in_scalars(&held, &other_held))
            .or_else(|| {
                let text = crate::import::up::text;
                (held.up != other_held.up).then(|| format!("{} is up instead of {}", text(other_held.up), text(held.up)))
            })
            .unwrap_or_else(|| format!("its unit is {} cm instead of {} cm", other_held.cm_per_unit, held.cm_per_unit)),
    ))
}

fn in_joints(one: &Rig, other: &Rig) -> Option<String> {
    for (index, (a, b)) in one.joints.iter().zip(&other.joints).enumerate() {
        let [name, other_name] = [one, other].map(|rig| rig.joint_name(index));
        if name != other_name {
            return Some(format!("joint {} is `{other_name}` instead of `{name}`", index + 1));
        }
        let [parent, other_parent] = [(one, a), (other, b)].map(|(rig, joint)| match joint.parent {
            Some(parent) => rig.joint_name(parent),
            None => "nothing".into(),
        });
        if parent != other_parent {
            return Some(format!("joint `{name}` is below {other_parent} instead of {parent}"));
        }
        if a.kinds != b.kinds {
            return Some(format!("joint `{name}` has the channels {} instead of {}", kinds(&b.kinds), kinds(&a.kinds)));
        }
        if a.helper != b.helper {
            return Some(format!("joint `{name}` is {} helper", if b.helper { "a" } else { "no" }));
        }
        if a.offset != b.offset {
            return Some(format!("joint `{name}` has the offset {} instead of {}", offset(b.offset), offset(a.offset)));
        }
    }
    let (count, other_count) = (one.joints.len(), other.joints.len());
    match count.cmp(&other_count) {
        std::cmp::Ordering::Less => Some(format!("joint `{}` is one too many", other.joint_name(count))),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(format!("joint `{}` is missing", one.joint_name(other_count))),
    }
}

fn in_scalars(one: &Rig, other: &Rig) -> Option<String> {
    let different = one.scalars.iter().zip(&other.scalars).find(|(a, b)| a != b);
    if let Some((a, b)) = different {
        return Some(if a.name == b.name {
            format!("channel `{}` has another full scale", a.name)
        } else {
            format!("channel `{}` stands where `{}` is expected", b.name, a.name)
        });
    }
    let (count, other_count) = (one.scalars.len(), other.scalars.len());
    let more = if other_count > count { &other.scalars[count..] } else { &one.scalars[other_count..] };
    let named: Vec<String> = more.iter().map(|scalar| format!("`{}`", scalar.name)).collect();
    let which = if other_count > count { "also has" } else { "lacks" };
    let noun = if more.len() == 1 { "channel that moves no joint" } else { "channels that move no joint" };
    (!more.is_empty()).then(|| format!("it {which} {} {noun}: {}", more.len(), first_of(&named, LISTED)))
}

/// Channels that are named at most.
const LISTED: usize = 4;

fn kinds(kinds: &[Kind]) -> String {
    if kinds.is_empty() { "(none)".into() } else { kinds.iter().map(|kind| format!("{kind:?}")).collect::<Vec<_>>().join(" ") }
}

fn offset([x, y, z]: [f64; 3]) -> String {
    format!("({x:.4}, {y:.4}, {z:.4})")
}

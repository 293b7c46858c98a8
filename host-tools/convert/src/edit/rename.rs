//! Other names for joints and scalars.

use crate::error::{Error, Setting, require};
use crate::motion::Motion;
use anyhow::Result;
use std::collections::HashSet;

/// Gives joints and scalars other names: pairs of the old and the new one. One `*` in both stands for the same letters, as in `mixamorig:*` and `*`.
pub fn rename(motion: &mut Motion, pairs: &[(String, String)]) -> Result<()> {
    let before = distinct(motion);
    for (old, new) in pairs {
        let wrong = |text: &str| Error::value(Setting::Rename, format!("{old}={new}"), text);
        require!(!new.is_empty(), wrong("the new name is empty"));
        let stars = (old.matches('*').count(), new.matches('*').count());
        require!(matches!(stars, (0, 0) | (1, 1)), wrong("a `*` stands once in both names, or in none"));
        let joints = motion.rig.joints.iter_mut().filter(|joint| !joint.end_site).map(|joint| &mut joint.name);
        let names = joints.chain(motion.rig.scalars.iter_mut().map(|scalar| &mut scalar.name));
        let mut found = false;
        for name in names {
            if let Some(other) = renamed(name, old, new) {
                *name = other;
                found = true;
            }
        }
        require!(found, wrong("no joint and no scalar has this name"));
    }
    require!(distinct(motion) == before, Error::setting(Setting::Rename, "two joints would have one name"));
    Ok(())
}

/// How many names the joints have.
fn distinct(motion: &Motion) -> usize {
    motion.rig.joints.iter().filter(|joint| !joint.end_site).map(|joint| joint.name.as_str()).collect::<HashSet<_>>().len()
}

fn renamed(name: &str, old: &str, new: &str) -> Option<String> {
    let Some((head, tail)) = old.split_once('*') else { return (name == old).then(|| new.to_owned()) };
    let rest = name.strip_prefix(head)?.strip_suffix(tail)?;
    Some(new.replacen('*', rest, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_the_same_letters() {
        assert_eq!(renamed("mixamorig:Hips", "mixamorig:*", "*").as_deref(), Some("Hips"));
        assert_eq!(renamed("Arm_L", "*_L", "Left*").as_deref(), Some("LeftArm"));
        assert_eq!(renamed("Hips", "Hip", "a"), None);
    }
}

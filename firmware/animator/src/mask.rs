//! Which joints and scalars a layer moves: one bit each.

use crate::error::{Error, Name};
use crate::groups::Group;
use pantin::Rig;

/// Joints of which [`Mask::set`] notes that they match, on its stack; those of larger rigs are looked up again.
const NOTED: usize = 256;

/// A bit for each joint of a rig, End Sites included, and then for each scalar, in memory of the caller's.
#[derive(Debug)]
pub struct Mask<'m> {
    words: &'m mut [u32],
}

impl<'m> Mask<'m> {
    /// A mask of nothing. `words` needs an element for each 32 joints and scalars: [`Mask::words`].
    pub fn new(rig: &Rig<'_>, words: &'m mut [u32]) -> Result<Mask<'m>, Error> {
        let (needed, given) = (Mask::words(rig), words.len());
        let words = words.get_mut(..needed).ok_or(Error::TooSmall { what: "words of a mask", needed, given })?;
        words.fill(0);
        Ok(Mask { words })
    }

    /// A mask without memory.
    pub(crate) fn empty() -> Mask<'static> {
        Mask { words: &mut [] }
    }

    /// A mask of a rig that these words hold.
    pub(crate) fn of_words(rig: &Rig<'_>, words: &'m mut [u32]) -> Option<Mask<'m>> {
        Some(Mask { words: words.get_mut(..Mask::words(rig))? })
    }

    /// The elements that a mask of a rig needs.
    pub fn words(rig: &Rig<'_>) -> usize {
        (rig.joint_count() + rig.channels().saturating_sub(rig.joint_channels())).div_ceil(32)
    }

    /// Adds (or, with `on` false, removes) the joints and scalars whose name matches a pattern: `*` stands for any characters, `?` for one,
    /// everything else for itself. The pattern is followed by ` +` if joints below those that match are meant too.
    /// [`Error::NothingMatches`] if no name does; the mask is then as it was.
    pub fn set(&mut self, rig: &Rig<'_>, pattern: &str, on: bool) -> Result<(), Error> {
        let asked = pattern;
        let (pattern, below) = match pattern.strip_suffix(" +") {
            Some(pattern) => (pattern, true),
            None => (pattern, false),
        };
        let mut found = false;
        // Joints that match or hang on one that does: a parent comes before its children.
        let mut hanging = [0; NOTED / 32];
        let mut noted = Mask { words: &mut hanging };
        for (joint, index) in rig.joints().zip(0usize..) {
            let own = !joint.end_site && matches(pattern.as_bytes(), joint.name_bytes());
            let parent = joint.parent.filter(|_| below);
            let below_one = |parent: u16| {
                let at = usize::from(parent);
                if at < NOTED { noted.contains(at) } else { hangs(rig, parent, pattern) }
            };
            if own || parent.is_some_and(below_one) {
                self.put(index, on);
                noted.put(index, true);
                found |= own;
            }
        }
        for (scalar, index) in rig.scalars().zip(rig.joint_count()..) {
            if matches(pattern.as_bytes(), scalar.name().as_bytes()) {
                self.put(index, on);
                found = true;
            }
        }
        if found { Ok(()) } else { Err(Error::NothingMatches(Name::new(asked))) }
    }

    /// Turns every bit over: what this mask leaves to others.
    pub fn invert(&mut self) {
        for word in self.words.iter_mut() {
            *word = !*word;
        }
    }

    /// Whether a joint (or, counted after the joints, a scalar) is in the mask.
    #[inline(always)]
    pub fn contains(&self, index: usize) -> bool {
        self.words.get(index / 32).is_some_and(|word| word >> (index % 32) & 1 != 0)
    }

    /// Whether a group is in the mask, for one after the other: each word is read once.
    #[inline(always)]
    pub(crate) fn picks(&self) -> impl FnMut(&&Group) -> bool + '_ {
        let (mut at, mut word) = (u16::MAX, 0);
        move |group| {
            let bit = group.bit;
            if at != bit / 32 {
                at = bit / 32;
                word = self.words.get(usize::from(at)).copied().unwrap_or(0);
            }
            word >> (bit % 32) & 1 != 0
        }
    }

    /// Adds or removes a joint, or, counted after the joints, a scalar.
    pub fn put(&mut self, index: usize, on: bool) {
        if let Some(word) = self.words.get_mut(index / 32) {
            let bit = 1 << (index % 32);
            *word = if on { *word | bit } else { *word & !bit };
        }
    }
}

/// Whether a joint or one above it matches, by a walk through the rig for each of them.
fn hangs(rig: &Rig<'_>, joint: u16, pattern: &str) -> bool {
    let mut next = Some(joint);
    while let Some(joint) = next.and_then(|index| rig.joint(index.into())) {
        if !joint.end_site && matches(pattern.as_bytes(), joint.name_bytes()) {
            return true;
        }
        next = joint.parent;
    }
    false
}

/// Whether a name matches a pattern of `*` and `?`. Takes at most as many steps as the product of the lengths.
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    let (mut at, mut from) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while at < name.len() {
        match pattern.get(from) {
            Some(b'*') => {
                star = Some((from + 1, at));
                from += 1;
            }
            Some(&byte) if byte == b'?' || Some(&byte) == name.get(at) => (at, from) = (at + 1, from + 1),
            _ => {
                let Some((behind, taken)) = star else { return false };
                (from, at) = (behind, taken + 1);
                star = Some((behind, taken + 1));
            }
        }
    }
    pattern.get(from..).is_some_and(|rest| rest.iter().all(|&byte| byte == b'*'))
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns_match_as_globs_do() {
        for (pattern, name, expected) in [
            ("", "", true),
            ("", "a", false),
            ("*", "", true),
            ("*", "abc", true),
            ("a*c", "abbc", true),
            ("a*c", "abcb", false),
            ("*arm*", "left-forearm", true),
            ("?rm", "arm", true),
            ("?rm", "rm", false),
            ("a*b*c", "aXbXbXc", true),
            ("a*b*c", "aXcXb", false),
            ("a**", "a", true),
        ] {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), expected, "{pattern} {name}");
        }
    }
}

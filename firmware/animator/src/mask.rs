//! Which joints and scalars a layer moves: one bit each.

use crate::error::{Error, Name};
use crate::groups::{Group, Shape};
use pantin::Rig;

/// Joints of which [`Mask::set`] notes that they match, on its stack; those of larger rigs are looked up again.
const NOTED: usize = 256;

/// A bit for each joint of a rig, End Sites included, and then for each scalar, in memory of the caller's.
#[derive(Debug)]
pub struct Mask<'m> {
    words: &'m mut [u32],
    /// Where [`Mask::prepare`] puts runs: the first `runs` are in use, for a clip with `groups` groups.
    spare: &'m mut [u32],
    runs: u16,
    groups: u16,
}

/// Channels one after the other that belong to groups of one shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    first: u16,
    len: u8,
    pub(crate) shape: Shape,
}

impl Run {
    #[inline(always)]
    pub(crate) fn of_group(group: &Group) -> Run {
        Run { first: group.first, len: group.len, shape: group.shape }
    }

    fn to_word(self) -> u32 {
        u32::from(self.first) | u32::from(self.len) << 16 | (self.shape as u32) << 24
    }

    #[inline(always)]
    fn of_word(word: u32) -> Run {
        let shape = match word >> 24 {
            0 => Shape::Free,
            1 => Shape::Euler,
            2 => Shape::Map,
            _ => Shape::Quaternion,
        };
        Run { first: word as u16, len: (word >> 16) as u8, shape }
    }

    #[inline(always)]
    pub(crate) fn range(self) -> core::ops::Range<usize> {
        usize::from(self.first)..usize::from(self.first) + usize::from(self.len)
    }
}

impl<'m> Mask<'m> {
    /// A mask of nothing. `words` needs an element for each 32 joints and scalars: [`Mask::words`]. More of them serve [`Mask::prepare`].
    pub fn new(rig: &Rig<'_>, words: &'m mut [u32]) -> Result<Mask<'m>, Error> {
        let (needed, given) = (Mask::words(rig), words.len());
        let mask = Mask::of_words(rig, words).ok_or(Error::TooSmall { what: "words of a mask", needed, given })?;
        mask.words.fill(0);
        Ok(mask)
    }

    /// A mask without memory.
    pub(crate) fn empty() -> Mask<'static> {
        Mask { words: &mut [], spare: &mut [], runs: 0, groups: 0 }
    }

    /// A mask of a rig that these words hold.
    pub(crate) fn of_words(rig: &Rig<'_>, words: &'m mut [u32]) -> Option<Mask<'m>> {
        let (words, spare) = words.split_at_mut_checked(Mask::words(rig))?;
        Some(Mask { words, spare, runs: 0, groups: 0 })
    }

    /// Notes the channels that the mask picks of groups, in what [`Mask::new`] was lent beyond its needs: an element for each group is enough. A layer with
    /// these groups is then mixed in fewer instructions, until the mask changes; call it again for groups of another form. Without room it stays as it is.
    pub fn prepare(&mut self, groups: &[Group]) {
        (self.runs, self.groups) = (0, 0);
        let mut used = 0;
        let mut last: Option<Run> = None;
        for group in groups.iter().filter(|group| contains(self.words, group.bit.into())) {
            let own = Run::of_group(group);
            let joined = last.filter(|last| last.shape == own.shape && last.range().end == usize::from(own.first));
            let run = match joined.and_then(|last| Some(Run { len: last.len.checked_add(own.len)?, ..last })) {
                Some(run) => run,
                None => {
                    used += 1;
                    own
                }
            };
            let Some(place) = self.spare.get_mut(used - 1) else { return };
            (*place, last) = (run.to_word(), Some(run));
        }
        // A rig has fewer groups than channels.
        (self.runs, self.groups) = (used as u16, groups.len() as u16);
    }

    /// The runs of these groups; `None` if they were not prepared.
    #[inline(always)]
    pub(crate) fn runs(&self, groups: &[Group]) -> Option<impl Iterator<Item = Run> + '_> {
        let runs = self.spare.get(..self.runs.into()).filter(|_| self.groups > 0 && usize::from(self.groups) == groups.len());
        Some(runs?.iter().map(|word| Run::of_word(*word)))
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
        let mut noted = Mask { words: &mut hanging, ..Mask::empty() };
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
        self.groups = 0;
        for word in self.words.iter_mut() {
            *word = !*word;
        }
    }

    /// Whether a joint (or, counted after the joints, a scalar) is in the mask.
    #[inline(always)]
    pub fn contains(&self, index: usize) -> bool {
        contains(self.words, index)
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
        self.groups = 0;
        if let Some(word) = self.words.get_mut(index / 32) {
            let bit = 1 << (index % 32);
            *word = if on { *word | bit } else { *word & !bit };
        }
    }
}

#[inline(always)]
fn contains(words: &[u32], index: usize) -> bool {
    words.get(index / 32).is_some_and(|word| word >> (index % 32) & 1 != 0)
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

//! Which names are of the left side, which of the right, and which are each other's counterparts.
//!
//! Told are the words left and right anywhere in a name (`LeftArm`, `mouthSmile_Left`), the letters l and r as a word of their own
//! (`UpperArm_L`, `l_shoulder`, `Bip01 L Thigh`), and as a name's first letter where a counterpart with the other letter
//! is there too (`lfemur` and `rfemur`, `LHipJoint`). What stands in front of a colon, Rigify's `DEF-` of bones that deform, and what all names
//! begin with, say nothing.

use std::collections::HashMap;

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The figure's own left.
    Left,
    /// The figure's own right.
    Right,
}

impl Side {
    /// The other one.
    pub fn other(self) -> Side {
        if self == Side::Left { Side::Right } else { Side::Left }
    }
}

/// A name as its side and the rest: small letters and digits alone.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Part {
    /// `None` in the middle.
    pub side: Option<Side>,
    /// `LeftUpLeg` is `upleg`.
    pub rest: String,
}

/// Every name's side and rest; empty names stay empty.
pub fn parts(names: &[String]) -> Vec<Part> {
    let bare: Vec<&str> = without_common(names);
    let marked: Vec<Option<Part>> = bare.iter().map(|name| by_word(name)).collect();
    let plain: Vec<String> = bare.iter().map(|name| letters(name)).collect();
    let first = |name: &str| match name.as_bytes().first() {
        Some(b'l') => Some((Side::Left, format!("r{}", &name[1..]))),
        Some(b'r') => Some((Side::Right, format!("l{}", &name[1..]))),
        _ => None,
    };
    let by_letter = |name: &String| {
        let (side, counterpart) = first(name)?;
        plain.contains(&counterpart).then(|| Part { side: Some(side), rest: name[1..].to_string() })
    };
    let part = |(marked, name): (Option<Part>, &String)| {
        marked.or_else(|| by_letter(name)).unwrap_or_else(|| Part { side: None, rest: name.clone() })
    };
    marked.into_iter().zip(&plain).map(part).collect()
}

/// The counterpart of each name, its own index in the middle, `None` for a side's without one.
///
/// Of several alike but for the numbers at their ends (`b_LeftArm_09`, `b_RightArm_06`), the first is the first one's.
pub fn counterparts(parts: &[Part]) -> Vec<Option<usize>> {
    let trimmed = |part: &Part| part.rest.trim_end_matches(|letter: char| letter.is_ascii_digit()).to_string();
    let mut exact: HashMap<&Part, Vec<usize>> = HashMap::new();
    let mut alike: HashMap<(Option<Side>, String), Vec<usize>> = HashMap::new();
    for (index, part) in parts.iter().enumerate() {
        exact.entry(part).or_default().push(index);
        alike.entry((part.side, trimmed(part))).or_default().push(index);
    }
    let of = |(index, part): (usize, &Part)| {
        let Some(side) = part.side else { return Some(index) };
        let other = Part { side: Some(side.other()), rest: part.rest.clone() };
        if let Some(&[found]) = exact.get(&other).map(Vec::as_slice) {
            return Some(found);
        }
        let own = alike.get(&(part.side, trimmed(part)))?;
        let others = alike.get(&(other.side, trimmed(part)))?;
        let place = own.iter().position(|&own| own == index)?;
        if own.len() == others.len() { others.get(place).copied() } else { None }
    };
    parts.iter().enumerate().map(of).collect()
}

fn letters(name: &str) -> String {
    name.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The names without what stands in front of a colon, without `DEF-`, and without what is common to all of them up to a mark that is no letter.
fn without_common(names: &[String]) -> Vec<&str> {
    let after_colon = names.iter().map(|name| name.rsplit(':').next().unwrap_or_default());
    let after_colon = after_colon.map(|name| name.strip_prefix("DEF-").unwrap_or(name));
    let names: Vec<&str> = after_colon.collect();
    let mut named = names.iter().filter(|name| !name.is_empty());
    let first = named.next().copied().unwrap_or_default();
    let common = named.clone().fold(first, |common, name| {
        let same = common.char_indices().zip(name.chars()).take_while(|((_, a), b)| a == b).last();
        same.map_or("", |((at, letter), _)| &common[..at + letter.len_utf8()])
    });
    let mark = common.rfind(|letter: char| !letter.is_alphanumeric()).filter(|_| named.next().is_some());
    let length = mark.map_or(0, |at| at + 1);
    names.into_iter().map(|name| name.get(length..).unwrap_or_default()).collect()
}

/// Finds a side that a whole word or letter names.
fn by_word(name: &str) -> Option<Part> {
    let lower = name.to_lowercase();
    for (word, side) in [("left", Side::Left), ("right", Side::Right)] {
        if let Some(at) = lower.find(word) {
            let rest = format!("{}{}", &lower[..at], &lower[at + word.len()..]);
            return Some(Part { side: Some(side), rest: letters(&rest) });
        }
    }
    let words: Vec<&str> = lower.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let at = words.iter().position(|&word| word == "l" || word == "r").filter(|_| words.len() > 1)?;
    let side = if words[at] == "l" { Side::Left } else { Side::Right };
    Some(Part { side: Some(side), rest: [&words[..at], &words[at + 1..]].concat().concat() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(names: &[&str]) -> Vec<Option<usize>> {
        let names: Vec<String> = names.iter().map(|name| name.to_string()).collect();
        counterparts(&parts(&names))
    }

    #[test]
    fn counterparts_are_found_in_every_convention() {
        for names in [
            ["Hips", "LeftUpLeg", "RightUpLeg"],
            ["Beta:Hips", "Beta:LeftArm", "Beta:RightArm"],
            ["mixamorig:Hips", "mixamorig:LeftArm", "mixamorig:RightArm"],
            ["joint_Root", "UpperArm_L", "UpperArm_R"],
            ["lowerback", "lfemur", "rfemur"],
            ["root", "LHipJoint", "RHipJoint"],
            ["HumanoidRoot", "l_shoulder", "r_shoulder"],
            ["Bip01", "Bip01 L Thigh", "Bip01 R Thigh"],
            ["hip", "lShldr", "rShldr"],
            ["b_Hip_01", "b_LeftForeArm_010", "b_RightForeArm_07"],
            ["browInnerUp", "eyeBlinkLeft", "eyeBlinkRight"],
        ] {
            assert_eq!(pairs(&names), [Some(0), Some(2), Some(1)], "{names:?}");
        }
    }

    #[test]
    fn the_middle_is_its_own_and_a_side_alone_has_none() {
        assert_eq!(pairs(&["Hips", "LeftHand", "lowerback", "rib"]), [Some(0), None, Some(2), Some(3)]);
    }
}

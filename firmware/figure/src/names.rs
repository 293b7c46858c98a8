//! What the names of joints tell.

/// Whether `name` contains `word`, in any case.
pub(crate) fn contains(name: &[u8], word: &[u8]) -> bool {
    name.windows(word.len().max(1)).any(|part| part.eq_ignore_ascii_case(word))
}

/// For two names that differ in "left" and "right" or "l" and "r" alone, in any case: whether `a` is the left one.
pub(crate) fn is_left_of(a: &[u8], b: &[u8]) -> Option<bool> {
    let same = a.iter().zip(b).take_while(|(a, b)| a.eq_ignore_ascii_case(b)).count();
    let (is_left, a) = side(a.get(same..)?)?;
    let (other_is_left, b) = side(b.get(same..)?)?;
    (is_left != other_is_left && a.eq_ignore_ascii_case(b)).then_some(is_left)
}

/// Whether a name begins with the left side's word or the right one's, and what follows it.
fn side(name: &[u8]) -> Option<(bool, &[u8])> {
    [("left", true), ("right", false), ("l", true), ("r", false)].into_iter().find_map(|(word, is_left)| {
        let (begin, rest) = name.split_at_checked(word.len())?;
        begin.eq_ignore_ascii_case(word.as_bytes()).then_some((is_left, rest))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counterparts_are_told_by_one_word_or_letter() {
        assert_eq!(is_left_of(b"LeftUpLeg", b"RightUpLeg"), Some(true));
        assert_eq!(is_left_of(b"Beta:RightArm", b"Beta:LeftArm"), Some(false));
        assert_eq!(is_left_of(b"UpperLeg_L", b"UpperLeg_R"), Some(true));
        assert_eq!(is_left_of(b"rfemur", b"lfemur"), Some(false));
        assert_eq!(is_left_of(b"LeftUpLeg", b"RightLeg"), None);
        assert_eq!(is_left_of(b"Spine", b"Spine"), None);
        assert_eq!(is_left_of(b"LowerBack", b"Root"), None);
    }
}

//! Names that rigs share, so that none has to hold them: only programs that ask for a scalar's name link them.

/// The 52 weights and 9 angles of Live Link Face (ARKit's blend shapes, head and eyes) in the order of its files, which is that of
/// [`crate::layout::LISTED`].
pub const LIVE_LINK: &str = "EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft EyeBlinkRight \
    EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight EyeWideRight JawForward JawRight JawLeft \
    JawOpen MouthClose MouthFunnel MouthPucker MouthRight MouthLeft MouthSmileLeft MouthSmileRight MouthFrownLeft \
    MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft MouthStretchRight MouthRollLower MouthRollUpper \
    MouthShrugLower MouthShrugUpper MouthPressLeft MouthPressRight MouthLowerDownLeft MouthLowerDownRight MouthUpperUpLeft \
    MouthUpperUpRight BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft BrowOuterUpRight CheekPuff CheekSquintLeft \
    CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut HeadYaw HeadPitch HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll \
    RightEyeYaw RightEyePitch RightEyeRoll";

/// Name `index` of a list; as bytes, among which a space takes less code to find than in text.
pub(crate) fn nth(list: &str, index: u8) -> &[u8] {
    list.as_bytes().split(|&byte| byte == b' ').nth(usize::from(index)).unwrap_or(&[])
}

/// FNV-1a, 32 bits.
pub const fn hash(name: &[u8]) -> u32 {
    let (mut hash, mut at) = (HASH_OF_NOTHING, 0);
    while at < name.len() {
        hash = hash_on(hash, name[at]);
        at += 1;
    }
    hash
}

pub(crate) const HASH_OF_NOTHING: u32 = 0x811c_9dc5;

/// A byte more.
pub(crate) const fn hash_on(hash: u32, byte: u8) -> u32 {
    (hash ^ byte as u32).wrapping_mul(0x0100_0193)
}

/// Hashes of the names in [`LIVE_LINK`]: who only compares names need not have these.
pub(crate) static HASHES: [u32; 61] = {
    let (names, mut hashes) = (LIVE_LINK.as_bytes(), [HASH_OF_NOTHING; 61]);
    let (mut index, mut at) = (0, 0);
    while at < names.len() {
        if names[at] == b' ' {
            index += 1;
        } else {
            hashes[index] = hash_on(hashes[index], names[at]);
        }
        at += 1;
    }
    hashes
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_as_the_format_says() {
        assert_eq!(LIVE_LINK.split(' ').count(), 61);
        assert!(LIVE_LINK.split(' ').map(|name| hash(name.as_bytes())).eq(HASHES));
        assert_eq!([0, 60, 61].map(|index| nth(LIVE_LINK, index)), [&b"EyeBlinkLeft"[..], b"RightEyeRoll", b""]);
    }
}

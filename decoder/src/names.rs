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

/// Name `index` of a list.
pub(crate) fn nth(list: &str, index: u8) -> &str {
    list.split(' ').nth(usize::from(index)).unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_as_the_format_says() {
        assert_eq!(LIVE_LINK.split(' ').count(), 61);
        assert_eq!((nth(LIVE_LINK, 0), nth(LIVE_LINK, 60), nth(LIVE_LINK, 61)), ("EyeBlinkLeft", "RightEyeRoll", ""));
    }
}

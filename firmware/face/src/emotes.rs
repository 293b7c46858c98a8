//! The emotes of voice-assistant devices, as clips.

/// The 23 emotes that voice-assistant devices name, each a clip (`.ptn`) that loops in 1.2 to 2 s and drives [`MODEL`](crate::MODEL) and
/// [`CARTOON`](crate::CARTOON): the motions in `motions/emotes`, in the order of their names. They take 1,932 bytes together.
///
/// ```
/// let (_, happy) = pantin_face::EMOTES.iter().find(|(name, _)| *name == "happy").ok_or("no such emote")?;
/// let clip = pantin::Clip::new_checked(happy)?;
/// assert!(clip.looped());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub static EMOTES: [(&str, &[u8]); 23] = [
    ("angry", include_bytes!("../emotes/angry.ptn")),
    ("confident", include_bytes!("../emotes/confident.ptn")),
    ("confused", include_bytes!("../emotes/confused.ptn")),
    ("cool", include_bytes!("../emotes/cool.ptn")),
    ("crying", include_bytes!("../emotes/crying.ptn")),
    ("curious", include_bytes!("../emotes/curious.ptn")),
    ("delicious", include_bytes!("../emotes/delicious.ptn")),
    ("embarrassed", include_bytes!("../emotes/embarrassed.ptn")),
    ("funny", include_bytes!("../emotes/funny.ptn")),
    ("happy", include_bytes!("../emotes/happy.ptn")),
    ("kissy", include_bytes!("../emotes/kissy.ptn")),
    ("laughing", include_bytes!("../emotes/laughing.ptn")),
    ("listening", include_bytes!("../emotes/listening.ptn")),
    ("loving", include_bytes!("../emotes/loving.ptn")),
    ("neutral", include_bytes!("../emotes/neutral.ptn")),
    ("relaxed", include_bytes!("../emotes/relaxed.ptn")),
    ("sad", include_bytes!("../emotes/sad.ptn")),
    ("shocked", include_bytes!("../emotes/shocked.ptn")),
    ("silly", include_bytes!("../emotes/silly.ptn")),
    ("sleepy", include_bytes!("../emotes/sleepy.ptn")),
    ("surprised", include_bytes!("../emotes/surprised.ptn")),
    ("thinking", include_bytes!("../emotes/thinking.ptn")),
    ("winking", include_bytes!("../emotes/winking.ptn")),
];

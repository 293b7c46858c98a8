//! The program's options, parsed from the words of a command line.

/// When the next frame is shown, and when the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Frames follow at the clip's rate, without end. A board that is too slow skips frames.
    Play,
    /// Frames follow at the clip's rate, or later on a board that is too slow. The program ends after this number of pictures.
    Frames(u32),
    /// The host asks for each frame over the serial line with [`NEXT`](crate::NEXT), and ends the program with [`QUIT`](crate::QUIT).
    Sync,
}

/// In [`Mode::Sync`]: asks for the next picture. Letters of commands may come before it.
pub const NEXT: u8 = b'\n';
/// In [`Mode::Sync`]: ends the program.
pub const QUIT: u8 = b'q';
/// In [`Mode::Sync`]: reports that a picture is on the display. The number of its frame follows in 4 bytes, the least significant first.
pub const SHOWN: u8 = b'F';

/// How the program runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// When the next frame is shown, and when the program ends.
    pub mode: Mode,
    /// The camera's orbit about the figure in degrees, instead of the default view's.
    pub orbit: Option<i16>,
    /// Whether lines have smooth edges at first.
    pub smooth: bool,
    /// Whether figures have volume at first.
    #[cfg(feature = "solid")]
    pub solid: bool,
    /// The character of figures that have volume.
    #[cfg(feature = "solid")]
    pub look: pantin_figure::solid::Look,
    /// The character of the character that another one meets.
    #[cfg(all(feature = "meet", feature = "solid"))]
    pub other_look: pantin_figure::solid::Look,
    /// Whether the face of a clip with a body and a face is on the neck of a body with volume.
    #[cfg(feature = "neck")]
    pub neck: bool,
    /// Whether name, frame and speed are shown at first.
    pub hud: bool,
    /// Whether the display stays lit when nobody gives a command for ten minutes.
    pub awake: bool,
    /// Number of figures side by side.
    pub figures: usize,
    /// Whether a steered character holds its feet, if its bank has a table of them. A console of 16 MHz has no time for that.
    #[cfg(feature = "steer")]
    pub feet: bool,
    /// Whether poses arrive over the serial line.
    #[cfg(feature = "link")]
    pub link: bool,
    /// Whether the link's packets have parity.
    #[cfg(feature = "link")]
    pub fec: bool,
    /// The key of the link's packets.
    #[cfg(feature = "key")]
    pub key: Key,
}

/// Which packets of the link are taken.
#[cfg(feature = "key")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// All that are intact.
    None,
    /// Those with a tag of this key.
    Tag(pantin_link::packet::TagKey),
    /// None: the option is not 32 hexadecimal digits, and the program ends.
    Invalid,
}

impl Options {
    /// Parses the words `frames=N`, `sync`, `view=DEGREES`, `smooth`, `info`, `awake` and `figures=N`, with the feature `solid` also `solid`, with the feature `neck` also `neck`, with the feature `link` also `link` and
    /// `fec`, with the feature `key` also `key=HEX`. Other words are ignored: an emulator without arguments passes the program's path.
    pub fn parse<'a>(words: impl IntoIterator<Item = &'a str>) -> Options {
        let mut options = Options {
            mode: Mode::Play,
            orbit: None,
            smooth: false,
            #[cfg(feature = "solid")]
            solid: false,
            #[cfg(feature = "solid")]
            look: pantin_figure::solid::Look::DEFAULT,
            #[cfg(all(feature = "meet", feature = "solid"))]
            other_look: pantin_figure::solid::Look::DEFAULT,
            #[cfg(feature = "neck")]
            neck: false,
            hud: false,
            awake: false,
            figures: 1,
            #[cfg(feature = "steer")]
            feet: true,
            #[cfg(feature = "link")]
            link: false,
            #[cfg(feature = "link")]
            fec: false,
            #[cfg(feature = "key")]
            key: Key::None,
        };
        for word in words {
            match word.split_once('=') {
                None if word == "sync" => options.mode = Mode::Sync,
                #[cfg(feature = "solid")]
                None if word == "solid" => options.solid = true,
                #[cfg(feature = "neck")]
                None if word == "neck" => options.neck = true,
                None if word == "smooth" => options.smooth = true,
                #[cfg(feature = "link")]
                None if word == "link" => options.link = true,
                #[cfg(feature = "link")]
                None if word == "fec" => options.fec = true,
                None if word == "info" => options.hud = true,
                None if word == "awake" => options.awake = true,
                #[cfg(feature = "key")]
                Some(("key", digits)) => {
                    options.key = pantin_link::packet::TagKey::from_hex(digits).map_or(Key::Invalid, Key::Tag);
                }
                Some(("frames", count)) => options.mode = count.parse().map_or(options.mode, Mode::Frames),
                Some(("figures", count)) => options.figures = count.parse().unwrap_or(1),
                Some(("view", degrees)) => options.orbit = degrees.parse().ok().or(options.orbit),
                _ => {}
            }
        }
        options
    }
}

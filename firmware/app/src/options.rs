//! What the program is asked to do, as words of a command line.

/// When it goes on to the next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// At the clip's own rate, for ever.
    Play,
    /// At the clip's own rate, for so many pictures.
    Frames(u32),
    /// When the other end of the line says so.
    Sync,
}

/// How the program runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// When it goes on.
    pub mode: Mode,
    /// Degrees of the camera about the figure, instead of the usual view.
    pub orbit: Option<i16>,
    /// Lines with smooth edges from the start.
    pub smooth: bool,
    /// Name, frame and speed on the display from the start.
    pub hud: bool,
    /// Figures side by side.
    pub figures: usize,
    /// What is played comes over the line.
    #[cfg(feature = "link")]
    pub link: bool,
    /// Its packets have parity.
    #[cfg(feature = "link")]
    pub fec: bool,
}

impl Options {
    /// Reads the words `frames=N`, `sync`, `view=DEGREES`, `smooth`, `info` and `figures=N`, and with the feature `link` that word and `fec`. Others are passed over: an emulator without arguments
    /// gives the program's own path.
    pub fn parse<'a>(words: impl IntoIterator<Item = &'a str>) -> Options {
        let mut options = Options {
            mode: Mode::Play,
            orbit: None,
            smooth: false,
            hud: false,
            figures: 1,
            #[cfg(feature = "link")]
            link: false,
            #[cfg(feature = "link")]
            fec: false,
        };
        for word in words {
            match word.split_once('=') {
                None if word == "sync" => options.mode = Mode::Sync,
                None if word == "smooth" => options.smooth = true,
                #[cfg(feature = "link")]
                None if word == "link" => options.link = true,
                #[cfg(feature = "link")]
                None if word == "fec" => options.fec = true,
                None if word == "info" => options.hud = true,
                Some(("frames", count)) => options.mode = count.parse().map_or(options.mode, Mode::Frames),
                Some(("figures", count)) => options.figures = count.parse().unwrap_or(1),
                Some(("view", degrees)) => options.orbit = degrees.parse().ok().or(options.orbit),
                _ => {}
            }
        }
        options
    }
}

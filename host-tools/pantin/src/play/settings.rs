//! What is shown, and how: kept from clip to clip.

use super::cells::Dots;
use super::colours::Colours;
use super::keys::Action;
use anyhow::Result;
use pantin_figure::solid::Look;
use pantin_figure::{CameraTarget, View};
use pantin_images::palette::Palette;

/// Rows of cells from which on half blocks show enough of a figure. Below, braille has twice the pixels.
const ROWS_FOR_HALF: usize = 48;

/// The palette's name, unless another is asked for.
pub const PALETTE: &str = "phone";

/// All of it.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Where the camera stands.
    pub view: View,
    /// Whether the ground shows.
    pub ground: bool,
    /// Whether the body has volume.
    pub solid: bool,
    /// The character of a body with volume.
    pub look: Look,
    /// How pixels become letters; none for what the terminal's size asks for.
    pub dots: Option<Dots>,
    /// The terminal's colours.
    pub colours: Colours,
    /// The picture's.
    pub palette: Palette,
    /// Whether the keys are listed.
    pub help: bool,
}

impl Settings {
    /// What suits the terminal by its environment.
    pub fn of_environment() -> Result<Settings> {
        let variable = |name: &str| std::env::var(name).ok();
        Ok(Settings {
            view: View::default(),
            ground: true,
            solid: false,
            look: Look::DEFAULT,
            // The letters of Linux' own console have no braille.
            dots: (variable("TERM").as_deref() == Some("linux")).then_some(Dots::Half),
            colours: Colours::of_environment(variable),
            palette: PALETTE.parse()?,
            help: false,
        })
    }

    /// How pixels become letters in a picture with this number of rows.
    pub fn dots(&self, rows: usize) -> Dots {
        self.dots.unwrap_or(if rows < ROWS_FOR_HALF { Dots::Braille } else { Dots::Half })
    }

    /// Whether the picture has colours.
    pub fn coloured(&self) -> bool {
        self.colours != Colours::None
    }

    /// Whether it is drawn as on a display of two colours.
    pub fn in_bits(&self) -> bool {
        !self.coloured() || self.palette.is_mono()
    }

    /// Does what a key asks for, if it is about the picture; whether it was.
    pub fn apply(&mut self, action: Action, rows: usize) -> bool {
        match action {
            Action::Orbit(degrees) => self.view.orbit = (self.view.orbit + degrees + 180).rem_euclid(360) - 180,
            Action::Tilt(degrees) => self.view.tilt = (self.view.tilt + degrees).clamp(-30, 85),
            Action::View => {
                self.view.orbit = self.view.next_orbit();
            }
            Action::Follow => {
                self.view.track =
                    if self.view.track == CameraTarget::Follow { CameraTarget::Fixed } else { CameraTarget::Follow };
            }
            Action::Style => self.solid = !self.solid,
            Action::Ground => self.ground = !self.ground,
            Action::Dots => self.dots = Some(if self.dots(rows) == Dots::Half { Dots::Braille } else { Dots::Half }),
            Action::Help => self.help = !self.help,
            _ => return false,
        }
        true
    }

    /// In a few words.
    pub fn view_words(&self) -> String {
        let track = if self.view.track == CameraTarget::Follow { "follow" } else { "fixed" };
        format!("orbit {} tilt {} {track}", self.view.orbit, self.view.tilt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_goes_round_and_stays_out_of_the_poles() {
        let mut settings = Settings {
            view: View::default(),
            ground: true,
            solid: false,
            look: Look::DEFAULT,
            dots: None,
            colours: Colours::All,
            palette: Palette::default(),
            help: false,
        };
        (0..24).for_each(|_| assert!(settings.apply(Action::Orbit(15), 24)));
        assert_eq!(settings.view, View::default());
        (0..99).for_each(|_| assert!(settings.apply(Action::Tilt(5), 24)));
        settings.apply(Action::Follow, 24);
        settings.apply(Action::Dots, 24);
        assert_eq!((settings.view_words().as_str(), settings.dots), ("orbit -50 tilt 85 fixed", Some(Dots::Half)));
        assert!(!settings.apply(Action::Pause, 24));
    }
}

//! What animations have in common: which frames they show, and for how long.

use crate::image::Image;
use anyhow::Result;

/// An animation that is being written, and repeats for ever.
pub trait Animation {
    /// Adds a picture.
    fn push(&mut self, image: &Image) -> Result<()>;
}

/// Times of pictures in whole ticks that never drift from the clip's own time.
pub struct Beat {
    seconds: f64,
    ticks_a_second: f64,
    pictures: f64,
}

impl Beat {
    /// Pictures are `seconds` apart.
    pub fn new(seconds: f64, ticks_a_second: f64) -> Beat {
        Beat { seconds, ticks_a_second, pictures: 0.0 }
    }

    /// The time of the next picture.
    pub fn ticks(&mut self) -> u32 {
        let at = |pictures: f64| (pictures * self.seconds * self.ticks_a_second).round();
        let ticks = at(self.pictures + 1.0) - at(self.pictures);
        self.pictures += 1.0;
        ticks as u32
    }
}

/// How many of a clip's frames go to one picture, so that there are no more than `most` a second.
pub fn stride(frame_time: f64, most: f64) -> u32 {
    (1.0 / most / frame_time.max(1e-6) - 1e-6).ceil().max(1.0) as u32
}

/// Frames of an animation, and the seconds that each is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// In the order in which they are shown.
    pub frames: Vec<u32>,
    /// Each one's.
    pub seconds: f64,
}

impl Timing {
    /// The frames `from..to` of a clip: all of them, or every second, third ... if they are more than `most` a second.
    pub fn of_clip(from: u32, to: u32, frame_time: f64, most: f64) -> Timing {
        let stride = stride(frame_time, most);
        Timing { frames: (from..to).step_by(stride as usize).collect(), seconds: frame_time * f64::from(stride) }
    }

    /// The same at `fps` pictures a second, each the frame that is due.
    pub fn at_rate(from: u32, to: u32, frame_time: f64, fps: f64) -> Timing {
        let frames = to - from;
        let pictures = (f64::from(frames) * frame_time * fps).round().max(1.0) as u32;
        let due = |picture: u32| from + ((f64::from(picture) / fps / frame_time + 1e-6) as u32).min(frames - 1);
        Timing { frames: (0..pictures).map(due).collect(), seconds: 1.0 / fps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_ticks_do_not_drift() {
        let mut beat = Beat::new(1.0 / 30.0, 100.0);
        let ticks: Vec<u32> = (0..300).map(|_| beat.ticks()).collect();
        assert_eq!(ticks[..4], [3, 4, 3, 3]);
        assert_eq!(ticks.iter().sum::<u32>(), 1000);
    }

    #[test]
    fn an_animation_lasts_as_long_as_its_clip() {
        let frame_time = 1.0 / 120.0;
        let own = Timing::of_clip(0, 240, frame_time, 50.0);
        assert_eq!((own.frames.len(), &own.frames[..3], own.seconds), (80, &[0, 3, 6][..], frame_time * 3.0));
        let asked = Timing::at_rate(60, 120, frame_time, 24.0);
        assert_eq!((asked.frames.len(), asked.frames[0], asked.frames[11]), (12, 60, 115));
        // A rate beyond the clip's own shows frames twice and none outside.
        let fast = Timing::at_rate(0, 3, 0.1, 25.0);
        assert_eq!(fast.frames, [0, 0, 0, 1, 1, 2, 2, 2]);
        assert_eq!(Timing::at_rate(7, 8, 0.01, 10.0).frames, [7]);
    }
}

//! Animated GIFs of the display.

use super::screen::{HEIGHT, Picture, WIDTH};
use anyhow::Result;
use gif::{Encoder, Frame, Repeat};
use std::borrow::Cow;
use std::io::Write;

/// Display pixels are squares of this many pixels.
const SCALE: usize = 4;
/// GIF times are hundredths of a second, and viewers slow down what is shorter than two.
const SHORTEST: f64 = 0.02;

/// How many of a clip's frames go to one picture, so that it is shown no shorter than viewers allow.
pub fn stride(frame_time: f64) -> u32 {
    (SHORTEST / frame_time.max(1e-6) - 1e-6).ceil().max(1.0) as u32
}

/// Writes `pictures`, `seconds` apart, as an animation that repeats for ever.
pub fn write(out: impl Write, pictures: &[Picture], seconds: f64) -> Result<()> {
    let greys: Vec<u8> = (0..16u8).flat_map(|grey| [grey * 17; 3]).collect();
    let mut encoder = Encoder::new(out, (WIDTH * SCALE) as u16, (HEIGHT * SCALE) as u16, &greys)?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut shown = 0.0;
    for picture in pictures {
        // Whole hundredths that never drift from the clip's own time.
        let delay = ((shown + seconds) * 100.0).round() - (shown * 100.0f64).round();
        shown += seconds;
        let pixels: Vec<u8> = picture.enlarged(SCALE).iter().map(|grey| grey / 17).collect();
        let frame = Frame {
            width: (WIDTH * SCALE) as u16,
            height: (HEIGHT * SCALE) as u16,
            delay: delay as u16,
            buffer: Cow::Owned(pixels),
            ..Frame::default()
        };
        encoder.write_frame(&frame)?;
    }
    Ok(())
}

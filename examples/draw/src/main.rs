//! Draws a figure into a display driver of one's own, here a terminal: `cargo run --release` in `examples/draw`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::BinaryColor;
use panic_semihosting as _;
use pantin::{Clip, Room};
use pantin_figure::{Canvas, FigureRenderer, View};

/// A display of 64 columns and 48 rows: a bit for each pixel.
struct Display([u64; 48]);

impl OriginDimensions for Display {
    fn size(&self) -> Size {
        Size::new(64, 48)
    }
}

impl DrawTarget for Display {
    type Color = BinaryColor;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(at, color) in pixels {
            if let Some(row) = self.0.get_mut(at.y as usize).filter(|_| (0..64).contains(&at.x)) {
                *row = *row & !(1 << at.x) | u64::from(color.is_on()) << at.x;
            }
        }
        Ok(())
    }
}

#[entry]
fn main() -> ! {
    let clip = Clip::new_checked(include_bytes!("../../../motions/walk.ptn")).unwrap();
    let (mut room, mut display) = (Room::<96, 144>::new(), Display([0; 48]));
    let mut player = room.player(clip).unwrap();
    let canvas = Canvas { width: 64, height: 48 };
    let mut figure = FigureRenderer::<36>::of_clip(&mut player, canvas, View::default()).unwrap();
    figure.draw(player.pose(), &mut display).unwrap();
    for row in display.0 {
        hprintln!("{:064b}", row);
    }
    debug::exit(debug::EXIT_SUCCESS);
    loop {}
}

//! Reduces a picture of 128x64 pixels to 5x5 LEDs: the figure in it, without the ground.
//!
//! A standing figure is about 20 pixels wide and 60 high. One LED therefore stands for 6 pixels across and 12 down. The middle column of LEDs
//! is placed at the mean column of the lit pixels in the upper half of the picture, where there is no ground.

use crate::Mono128x64;
use pantin_figure::surface::{Framebuffer, Layout};

/// The number of LEDs in a row, and of rows.
pub const SIDE: usize = 5;
/// The brightness of each LED from 0 (off) to 3, row by row from the top.
pub type Leds = [[u8; SIDE]; SIDE];

/// Pixels across and down of one LED, and rows of pixels above the first LED.
const CELL: [usize; 2] = [6, 12];
const ABOVE: usize = 2;
/// The number of lit pixels from which an LED has brightness 1, 2 and 3: more than dots of the ground, one line across, several lines.
const STEPS: [usize; 3] = [4, 8, 14];

/// Returns the brightness of each LED for a picture.
pub fn reduce(frame: &Framebuffer<Mono128x64>) -> Leds {
    let left = middle(frame).saturating_sub(SIDE * CELL[0] / 2).min(Mono128x64::WIDTH - SIDE * CELL[0]);
    let mut leds = Leds::default();
    for (row, line) in leds.iter_mut().enumerate() {
        for (column, led) in line.iter_mut().enumerate() {
            let lit = count(frame, left + column * CELL[0], ABOVE + row * CELL[1]);
            *led = STEPS.iter().filter(|step| lit >= **step).count() as u8;
        }
    }
    leds
}

/// Counts the lit pixels of an LED by its upper left pixel.
fn count(frame: &Framebuffer<Mono128x64>, left: usize, top: usize) -> usize {
    (top..top + CELL[1]).map(|y| (left..left + CELL[0]).filter(|x| frame.pixel(*x, y).is_on()).count()).sum()
}

/// Returns the mean column of the lit pixels in the upper half, or the middle of the picture if none is lit.
fn middle(frame: &Framebuffer<Mono128x64>) -> usize {
    let (mut sum, mut lit) = (0, 0);
    for (x, y) in (0..Mono128x64::HEIGHT / 2).flat_map(|y| (0..Mono128x64::WIDTH).map(move |x| (x, y))) {
        if frame.pixel(x, y).is_on() {
            (sum, lit) = (sum + x, lit + 1);
        }
    }
    usize::checked_div(sum, lit).unwrap_or(Mono128x64::WIDTH / 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::Drawable;
    use embedded_graphics::geometry::Point;
    use embedded_graphics::pixelcolor::BinaryColor;
    use embedded_graphics::primitives::{Circle, Line, Primitive, PrimitiveStyle};

    const THIN: PrimitiveStyle<BinaryColor> = PrimitiveStyle::with_stroke(BinaryColor::On, 1);

    fn line(frame: &mut Framebuffer<Mono128x64>, from: [i32; 2], to: [i32; 2]) {
        let [from, to] = [from, to].map(|[x, y]| Point::new(x, y));
        Line::new(from, to).into_styled(THIN).draw(frame).unwrap();
    }

    /// A standing figure on a dotted ground: head, trunk and two legs, `right` pixels from the middle.
    fn stands(right: i32) -> Framebuffer<Mono128x64> {
        let (mut frame, middle) = (Framebuffer::new(), 63 + right);
        for (x, row) in (0..30).map(|dot| (dot % 10 * 13, dot / 10)) {
            line(&mut frame, [x + row, 52 + row * 4], [x + row, 52 + row * 4]);
        }
        Circle::with_center(Point::new(middle, 7), 9).into_styled(THIN).draw(&mut frame).unwrap();
        line(&mut frame, [middle, 12], [middle, 38]);
        line(&mut frame, [middle, 38], [middle - 12, 61]);
        line(&mut frame, [middle, 38], [middle + 12, 61]);
        frame
    }

    #[test]
    fn a_figure_stands_on_two_legs_wherever_it_is() {
        for right in [-40, 0, 17, 40] {
            let lit = reduce(&stands(right)).map(|row| row.map(|led| if led > 0 { '#' } else { '.' }).iter().collect::<String>());
            assert_eq!(lit[0].chars().nth(2), Some('#'), "the head");
            assert_eq!(&lit[1..], ["..#..", "..#..", ".###.", "##.##"], "{right} to the right");
        }
    }

    #[test]
    fn leds_are_brighter_where_more_pixels_are_lit() {
        let mut frame = Framebuffer::new();
        assert_eq!(reduce(&frame), Leds::default(), "nothing is lit");
        for (rows, led) in [(1, 1), (2, 2), (3, 3), (12, 3)] {
            line(&mut frame, [61, 1 + rows], [66, 1 + rows]);
            for row in 2..1 + rows {
                line(&mut frame, [61, row], [66, row]);
            }
            let leds = reduce(&frame);
            assert_eq!((leds[0][2], leds[1]), (led, [0; SIDE]));
        }
    }

    #[test]
    fn a_figure_at_the_edge_stays_inside() {
        for right in [-60, 60] {
            assert_ne!(reduce(&stands(right)), Leds::default());
        }
    }
}

//! A picture of 128x64 pixels on 5x5 lights: the figure in it, without the ground.
//!
//! A figure on its feet is twenty pixels wide and sixty high. So a light stands for 6 pixels across and 12 down, and the middle
//! column for where the picture's upper half, in which there is no ground, has most lit pixels.

use crate::ssd1306::Pages;
use pantin_figure::surface::{Framebuffer, Layout};

/// Lights in a row, and rows.
pub const SIDE: usize = 5;
/// The lights, row by row from above, each in one of 4 brightnesses: 0 to 3.
pub type Lights = [[u8; SIDE]; SIDE];

/// Pixels across and down for a light, and those above the first.
const CELL: [usize; 2] = [6, 12];
const ABOVE: usize = 2;
/// Lit pixels from which a light has the next brightness: more than the ground's dots, a line across, several lines.
const STEPS: [usize; 3] = [4, 8, 14];

/// The lights of a picture.
pub fn tiny(frame: &Framebuffer<Pages>) -> Lights {
    let left = middle(frame).saturating_sub(SIDE * CELL[0] / 2).min(Pages::WIDTH - SIDE * CELL[0]);
    let mut lights = Lights::default();
    for (row, line) in lights.iter_mut().enumerate() {
        for (column, light) in line.iter_mut().enumerate() {
            let lit = count(frame, left + column * CELL[0], ABOVE + row * CELL[1]);
            *light = STEPS.iter().filter(|step| lit >= **step).count() as u8;
        }
    }
    lights
}

/// Lit pixels of a light, from its upper left one.
fn count(frame: &Framebuffer<Pages>, left: usize, top: usize) -> usize {
    (top..top + CELL[1]).map(|y| (left..left + CELL[0]).filter(|x| frame.pixel(*x, y).is_on()).count()).sum()
}

/// The mean column of what is lit in the upper half, or that of the picture where nothing is.
fn middle(frame: &Framebuffer<Pages>) -> usize {
    let (mut sum, mut lit) = (0, 0);
    for (x, y) in (0..Pages::HEIGHT / 2).flat_map(|y| (0..Pages::WIDTH).map(move |x| (x, y))) {
        if frame.pixel(x, y).is_on() {
            (sum, lit) = (sum + x, lit + 1);
        }
    }
    usize::checked_div(sum, lit).unwrap_or(Pages::WIDTH / 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::Drawable;
    use embedded_graphics::geometry::Point;
    use embedded_graphics::pixelcolor::BinaryColor;
    use embedded_graphics::primitives::{Circle, Line, Primitive, PrimitiveStyle};

    const THIN: PrimitiveStyle<BinaryColor> = PrimitiveStyle::with_stroke(BinaryColor::On, 1);

    fn line(frame: &mut Framebuffer<Pages>, from: [i32; 2], to: [i32; 2]) {
        let [from, to] = [from, to].map(|[x, y]| Point::new(x, y));
        Line::new(from, to).into_styled(THIN).draw(frame).unwrap();
    }

    /// Head, trunk and two legs apart, so far to the right of the middle, on a dotted ground.
    fn stands(right: i32) -> Framebuffer<Pages> {
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
            let lit =
                tiny(&stands(right)).map(|row| row.map(|light| if light > 0 { '#' } else { '.' }).iter().collect::<String>());
            assert_eq!(lit[0].chars().nth(2), Some('#'), "the head");
            assert_eq!(&lit[1..], ["..#..", "..#..", ".###.", "##.##"], "{right} to the right");
        }
    }

    #[test]
    fn lights_are_brighter_where_more_is_lit() {
        let mut frame = Framebuffer::new();
        assert_eq!(tiny(&frame), Lights::default(), "nothing is lit");
        for (rows, light) in [(1, 1), (2, 2), (3, 3), (12, 3)] {
            line(&mut frame, [61, 1 + rows], [66, 1 + rows]);
            for row in 2..1 + rows {
                line(&mut frame, [61, row], [66, row]);
            }
            let lights = tiny(&frame);
            assert_eq!((lights[0][2], lights[1]), (light, [0; SIDE]));
        }
    }

    #[test]
    fn a_figure_at_the_edge_stays_inside() {
        for right in [-60, 60] {
            assert_ne!(tiny(&stands(right)), Lights::default());
        }
    }
}

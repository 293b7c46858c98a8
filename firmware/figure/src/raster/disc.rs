//! Filled discs with an outline.

use crate::surface::{Cursor, Surface};

/// Draws a disc about a pixel: what lies within `radius` (at most 128) of it, its edge in `ink`, the inside in `fill`.
#[inline(never)]
pub fn disc<S: Surface>(surface: &mut S, centre: [i32; 2], radius: i32, ink: S::Ink, fill: S::Ink) {
    let radius = radius.clamp(0, 128);
    let [width, height] = surface.size();
    let (least, most) = ([centre[0] - radius, centre[1] - radius], [centre[0] + radius, centre[1] + radius]);
    if most[0] < 0 || most[1] < 0 || least[0] >= width || least[1] >= height {
        return;
    }
    surface.mark([least[0].max(0), least[1].max(0)], [most[0].min(width - 1), most[1].min(height - 1)]);
    // Half the width of a row: the greatest x with x^2 + y^2 <= r^2 + r, a circle of radius r + 1/2.
    let edge = radius * radius + radius;
    let (mut below, mut width) = (-1, half_width(edge, radius, 0));
    for row in (0..=radius).rev() {
        // From the outermost row inwards rows widen.
        width = half_width(edge, row, width);
        // The outline fills the row up to where the one outside ends.
        let inside = (width - 1).min(below);
        for y in [centre[1] - row, centre[1] + row] {
            // The edge on both sides of what is inside: nothing is, in the outermost row.
            span(surface, [centre[0] - width, centre[0] - inside - 1], y, ink);
            span(surface, [centre[0] - inside, centre[0] + inside], y, fill);
            span(surface, [centre[0] + inside + 1, centre[0] + width], y, ink);
        }
        below = width;
    }
}

fn half_width(edge: i32, row: i32, from: i32) -> i32 {
    let mut width = from;
    while (width + 1) * (width + 1) + row * row <= edge {
        width += 1;
    }
    width
}

/// A stretch of a row.
#[inline(always)]
fn span<S: Surface>(surface: &mut S, columns: [i32; 2], y: i32, ink: S::Ink) {
    let [width, height] = surface.size();
    let [from, to] = [columns[0].max(0), columns[1].min(width - 1)];
    if from > to || !(0..height).contains(&y) {
        return;
    }
    let mut cursor = surface.cursor(from, y);
    for _ in from..=to {
        surface.put(cursor, ink);
        cursor.across(true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Framebuffer, Gray4Rows};
    use embedded_graphics::pixelcolor::{Gray4, GrayColor};

    fn picture(centre: [i32; 2], radius: i32) -> String {
        let mut frame = Framebuffer::<Gray4Rows<16, 9, 18>>::new();
        disc(&mut frame, centre, radius, Gray4::new(15), Gray4::new(1));
        let letter = |x, y| [".", "o", "#"][usize::from(frame.pixel(x, y).luma()).min(2)];
        (0..9).map(|y| (0..16).map(|x| letter(x, y)).collect::<String>() + "\n").collect()
    }

    #[test]
    fn discs_are_round_and_closed_and_cut_off_at_the_edge() {
        let expected = "\
.....#####......
....#ooooo#.....
...#ooooooo#....
...#ooooooo#....
...#ooooooo#....
...#ooooooo#....
...#ooooooo#....
....#ooooo#.....
.....#####......
";
        assert_eq!(picture([7, 4], 4), expected, "{}", picture([7, 4], 4));
        assert_eq!(picture([3, 2], 0).matches('#').count(), 1);
        picture([-3, 20], 9);
        assert!(picture([0, 0], 3).starts_with("ooo#"), "{}", picture([0, 0], 3));
        assert_eq!(picture([300, 4], 40), "................\n".repeat(9));
    }
}

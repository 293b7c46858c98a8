//! Anti-aliased lines: Wu's, two pixels a step that share the line's brightness by how near they are to it.

use crate::surface::Surface;

/// Fraction bits of a place while a line is walked.
const BITS: u32 = 16;

/// Draws a line between places in sixteenths of a pixel, a pixel's middle at 8. On a display that only knows light and dark it is
/// the pixel wide line, nearly.
#[inline(never)]
pub fn smooth<S: Surface>(surface: &mut S, from: [i32; 2], to: [i32; 2], ink: S::Ink) {
    // From here on a pixel's middle is at 0.
    let [from, to] = [from, to].map(|end| end.map(|x| (x - 8).clamp(-(1 << 15), 1 << 15)));
    let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
    let turned = |[x, y]: [i32; 2]| if steep { [y, x] } else { [x, y] };
    let (from, to, size) = (turned(from), turned(to), turned(surface.size()));
    let (from, to) = if from[0] <= to[0] { (from, to) } else { (to, from) };
    // Below 1: across a pixel along, Q16. Differences are below 2^17, so only 14 bits may be added before the division.
    let slope = (((to[1] - from[1]) << 14).checked_div(to[0] - from[0]).unwrap_or(0)) << 2;
    let whole = |x: i32| (x + 8) >> 4;
    let (first, last) = (whole(from[0]).max(0), whole(to[0]).min(size[0] - 1));
    if first > last {
        return;
    }
    // Below 2^27, and below 2^28 with what lies before the surface.
    let mut across = (from[1] << (BITS - 4)) + (slope >> 4) * (first * 16 - from[0]);
    let rows = [across, across + slope * (last - first)].map(|across| across >> BITS);
    let (least, most) = (rows[0].min(rows[1]).max(0), (rows[0].max(rows[1]) + 1).min(size[1] - 1));
    if least > most {
        return;
    }
    let place = |along: i32, across: i32| if steep { [across, along] } else { [along, across] };
    surface.mark(place(first, least), place(last, most));
    for along in first..=last {
        let row = across >> BITS;
        let cover = ((across >> (BITS - 4)) & 15) as u32;
        for (row, cover) in [(row, 16 - cover), (row + 1, cover)] {
            if cover > 0 && (0..size[1]).contains(&row) {
                let [x, y] = place(along, row);
                let cursor = surface.cursor(x, y);
                surface.blend(cursor, ink, cover);
            }
        }
        across += slope;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Framebuffer, Gray4Rows};
    use embedded_graphics::pixelcolor::{Gray4, GrayColor};

    type Small = Framebuffer<Gray4Rows<16, 8, 16>>;

    fn picture(frame: &Small) -> String {
        let row = |y: usize| (0..16).map(|x| char::from_digit(frame.pixel(x, y).luma().into(), 16).unwrap()).collect::<String>();
        (0..8).map(row).map(|row| row.replace('0', ".") + "\n").collect()
    }

    #[test]
    fn a_line_between_two_rows_shares_its_brightness() {
        let mut frame = Small::new();
        smooth(&mut frame, [16 + 8, 16 + 8], [8 * 16 + 8, 16 + 8], Gray4::new(15));
        smooth(&mut frame, [16 + 8, 4 * 16], [8 * 16 + 8, 4 * 16], Gray4::new(14));
        smooth(&mut frame, [12 * 16 + 8, -100], [12 * 16 + 8, 3 * 16 + 8], Gray4::new(9));
        let expected = "\
............9...
.ffffffff...9...
............9...
.77777777...9...
.77777777.......
................
................
................
";
        assert_eq!(picture(&frame), expected, "{}", picture(&frame));
    }

    #[test]
    fn every_column_of_a_flat_line_holds_all_of_its_brightness() {
        let mut frame = Small::new();
        smooth(&mut frame, [8, 8], [15 * 16 + 8, 6 * 16 + 3], Gray4::new(15));
        for x in 0..16 {
            let sum: u32 = (0..8).map(|y| u32::from(frame.pixel(x, y).luma())).sum();
            assert!((14..=16).contains(&sum), "{sum}\n{}", picture(&frame));
        }
    }
}

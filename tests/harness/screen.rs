//! A display's pixels, read back from QEMU's window, and the difference between two pictures.

use std::fmt;

use anyhow::{Context, Result, bail, ensure};

use crate::display::{Depth, Display, Picture};

/// Reads QEMU's window (a binary portable pixmap) back into the display's pixels, each of which is a square of `scale`. Refuses a
/// picture that is not made of whole squares in the display's own colours: then it is not the display.
pub fn from_window(pixmap: &[u8], display: Display, scale: usize) -> Result<Picture> {
    let (columns, rows, window) = parse_pixmap(pixmap)?;
    let Display { width, height, depth, .. } = display;
    ensure!(
        (columns, rows) == (scale * width, scale * height),
        "a window of {columns}x{rows}, not {width}x{height} squares of {scale}"
    );
    let mut picture = Picture::dark(display);
    for (index, rgb) in window.chunks_exact(3).enumerate() {
        let (x, y) = (index % columns, index / columns);
        let corner = &window[3 * ((y - y % scale) * columns + x - x % scale)..][..3];
        ensure!(rgb == corner, "the window's pixel ({x}, {y}) is {rgb:?}, the first of its square {corner:?}");
        let value = value(depth, [rgb[0], rgb[1], rgb[2]]);
        let value = value.with_context(|| format!("the window's pixel ({x}, {y}) is {rgb:?}, none of the display's colours"))?;
        picture.pixels[y / scale * width + x / scale] = value;
    }
    Ok(picture)
}

/// The value that QEMU shows as a colour: the grey `v` of 0..=15 as `17 v` thrice; of five and six bits of a colour, the highest.
fn value(depth: Depth, rgb: [u8; 3]) -> Option<u16> {
    let [red, green, blue] = rgb.map(u16::from);
    let (value, shown) = match depth {
        Depth::Mono => (u16::from(red > 0), [255 * u16::from(red > 0); 3]),
        Depth::Gray4 => (red / 17, [red / 17 * 17; 3]),
        Depth::Bgr555 => (red >> 3 | green >> 3 << 5 | blue >> 3 << 10, [red & 0xf8, green & 0xf8, blue & 0xf8]),
        Depth::Rgb565 => (red >> 3 << 11 | green >> 2 << 5 | blue >> 3, [red & 0xf8, green & 0xfc, blue & 0xf8]),
    };
    (shown == [red, green, blue]).then_some(value)
}

/// Returns how a picture differs from the expected one; `None` if all pixels are equal.
pub fn difference(seen: &Picture, expected: &Picture) -> Option<Difference> {
    let size = |picture: &Picture| (picture.display.width, picture.display.height, picture.display.depth);
    assert_eq!(size(seen), size(expected), "pictures of displays that cannot be compared");
    let pairs = || seen.pixels.iter().zip(&expected.pixels);
    let first = pairs().position(|(is, should)| is != should)?;
    let count = pairs().filter(|(is, should)| is != should).count();
    let width = seen.display.width;
    Some(Difference { count, first: (first % width, first / width), seen: seen.clone(), expected: expected.clone() })
}

/// How a picture differs from the expected one.
#[derive(Debug)]
pub struct Difference {
    /// Number of unequal pixels.
    pub count: usize,
    /// Column and row of the first.
    pub first: (usize, usize),
    seen: Picture,
    expected: Picture,
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let (seen, expected) = (&self.seen.pixels, &self.expected.pixels);
        let Display { width, depth, .. } = self.seen.display;
        let (x, y) = self.first;
        let at = y * width + x;
        let (is, should) = (seen[at], expected[at]);
        writeln!(formatter, "{} pixels differ, first ({x}, {y}): {is:#x}, expected {should:#x}", self.count)?;
        writeln!(formatter, "(+ too bright, - too dark, ~ another colour, else as expected)")?;
        let rows = seen.chunks(width).zip(expected.chunks(width));
        for (row, (seen, expected)) in rows.enumerate().filter(|(_, (seen, expected))| seen != expected) {
            let line: String = seen.iter().zip(expected).map(|(&is, &should)| mark(depth, is, should)).collect();
            writeln!(formatter, "{row:4} {}", line.trim_end())?;
        }
        Ok(())
    }
}

fn mark(depth: Depth, is: u16, should: u16) -> char {
    match depth.brightness(is).cmp(&depth.brightness(should)) {
        std::cmp::Ordering::Greater => '+',
        std::cmp::Ordering::Less => '-',
        std::cmp::Ordering::Equal if is != should => '~',
        std::cmp::Ordering::Equal => shade(depth.brightness(is)),
    }
}

fn shade(brightness: u8) -> char {
    match brightness {
        0 => ' ',
        1..=90 => '.',
        91..=175 => 'o',
        _ => '#',
    }
}

/// Columns, rows and the pixels (three bytes each) of a binary portable pixmap.
fn parse_pixmap(pixmap: &[u8]) -> Result<(usize, usize, &[u8])> {
    let mut rest = pixmap.strip_prefix(b"P6").context("not a binary portable pixmap (P6)")?;
    let mut numbers = [0_usize; 3];
    for number in &mut numbers {
        rest = rest.trim_ascii_start();
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        *number = std::str::from_utf8(&rest[..digits])?.parse().context("a damaged pixmap header")?;
        rest = &rest[digits..];
    }
    let [columns, rows, maximum] = numbers;
    ensure!(maximum == 255, "a pixmap with values up to {maximum}, expected 255");
    let Some((_blank, pixels)) = rest.split_first() else { bail!("a pixmap without pixels") };
    ensure!(Some(pixels.len()) == columns.checked_mul(rows).and_then(|count| count.checked_mul(3)), "a pixmap cut short");
    Ok((columns, rows, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::{LCD, OLED};

    const SCALE: usize = 4;

    fn gradient() -> Picture {
        Picture { display: OLED, pixels: (0..OLED.width * OLED.height).map(|index| index as u16 % 16).collect() }
    }

    fn window(picture: &Picture) -> Vec<u8> {
        let (columns, rows) = (SCALE * OLED.width, SCALE * OLED.height);
        let mut pixmap = format!("P6\n{columns} {rows}\n255\n").into_bytes();
        for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            pixmap.extend([picture.pixels[y / SCALE * OLED.width + x / SCALE] as u8 * 17; 3]);
        }
        pixmap
    }

    fn read(pixmap: &[u8]) -> Result<Picture> {
        from_window(pixmap, OLED, SCALE)
    }

    #[test]
    fn a_window_is_read_back_into_its_greys() {
        assert_eq!(read(&window(&gradient())).unwrap(), gradient());
    }

    #[test]
    fn a_window_is_read_back_into_its_colours_or_refused() {
        let mut pixmap = format!("P6\n{} {}\n255\n", LCD.width, LCD.height).into_bytes();
        let start = pixmap.len();
        for value in 0..(LCD.width * LCD.height) as u16 {
            pixmap.extend([value >> 11 << 3, value >> 5 << 2 & 0xff, value << 3 & 0xff].map(|part| part as u8));
        }
        let picture = from_window(&pixmap, LCD, 1).unwrap();
        assert!(picture.pixels.iter().enumerate().all(|(index, &value)| index == usize::from(value)));
        pixmap[start + 1] = 2;
        let error = from_window(&pixmap, LCD, 1).unwrap_err().to_string();
        assert!(error.contains("pixel (0, 0) is [0, 2, 0], none of the display's colours"), "{error}");
    }

    #[test]
    fn a_pixel_unlike_its_square_is_refused_by_place() {
        let mut pixmap = window(&gradient());
        *pixmap.last_mut().unwrap() ^= 1;
        let error = read(&pixmap).unwrap_err().to_string();
        assert!(error.contains("pixel (511, 255)"), "{error}");
    }

    #[test]
    fn a_colour_between_the_greys_is_refused() {
        let mut pixmap = window(&gradient());
        let pixels = pixmap.len() - 3 * 512 * 256;
        pixmap[pixels..].fill(52);
        let error = read(&pixmap).unwrap_err().to_string();
        assert!(error.contains("none of the display's colours"), "{error}");
    }

    #[test]
    fn a_cut_or_foreign_pixmap_is_refused() {
        let pixmap = window(&gradient());
        for length in (0..40).chain([pixmap.len() - 1]) {
            assert!(read(&pixmap[..length]).is_err(), "{length} bytes");
        }
        let error = read(b"P6 4 4 255\n0123456789ab0123456789ab0123456789ab0123456789ab").unwrap_err().to_string();
        assert!(error.contains("a window of 4x4"), "{error}");
        assert!(read(b"\x89PNG").is_err());
    }

    #[test]
    fn a_difference_names_count_place_and_greys() {
        let (mut seen, mut expected) = (Picture::dark(OLED), Picture::dark(OLED));
        assert!(difference(&seen, &expected).is_none());
        seen.pixels[OLED.width..OLED.width + 3].copy_from_slice(&[15, 7, 0]);
        expected.pixels[OLED.width..OLED.width + 3].copy_from_slice(&[15, 0, 9]);
        let difference = difference(&seen, &expected).unwrap();
        assert_eq!((difference.count, difference.first), (2, (1, 1)));
        let text = difference.to_string();
        assert!(text.starts_with("2 pixels differ, first (1, 1): 0x7, expected 0x0\n"), "{text}");
        assert!(text.ends_with("   1 #+-\n"), "{text}");
    }
}

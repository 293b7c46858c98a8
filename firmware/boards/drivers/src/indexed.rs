//! Displays whose pixels are bytes that index a palette, in rows from the top.

use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::pixelcolor::raw::RawU8;
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::surface::{Cell, Cursor, Layout};

/// A palette index: the body part in the upper two bits, its brightness in the lower six. Brightness 0 of every part is the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Indexed(pub u8);

/// Bits of the brightness.
const SHADE_BITS: u32 = 6;
const MAX_SHADE: u8 = (1 << SHADE_BITS) - 1;

impl Indexed {
    /// Returns red, green and blue of this index, 0 to 255: from the background to the part's own colour.
    pub const fn rgb(self) -> [u8; 3] {
        let full = match self.0 >> SHADE_BITS {
            // The ground, whose lines are dim.
            0 => [170, 255, 230],
            1 => [255, 240, 214],
            2 => [255, 158, 56],
            _ => [84, 190, 255],
        };
        let shade = (self.0 & MAX_SHADE) as i32;
        let mut rgb = [0; 3];
        let mut channel = 0;
        while channel < 3 {
            let from = BACKGROUND[channel];
            rgb[channel] = (from + (full[channel] - from) * shade / MAX_SHADE as i32) as u8;
            channel += 1;
        }
        rgb
    }

    /// Returns the brightness, 0 to 63.
    const fn shade(self) -> u8 {
        self.0 & MAX_SHADE
    }
}

/// The background, a dark blue.
const BACKGROUND: [i32; 3] = [10, 14, 30];

impl PixelColor for Indexed {
    type Raw = RawU8;
}

impl Ink for Indexed {
    const DARK: Self = Indexed(0);

    #[inline]
    fn of(body_part: BodyPart, shade: u8) -> Self {
        let part = match body_part {
            BodyPart::Ground => 0,
            BodyPart::Middle => 1,
            BodyPart::Left => 2,
            BodyPart::Right => 3,
        };
        Indexed(part << SHADE_BITS | shade >> (8 - SHADE_BITS))
    }
}

/// Two pixels, the left one in the lower byte: a display's memory may take no single bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Pair(pub u16);

impl Cell for Pair {
    type Wire = [u8; 2];
    const DARK: Pair = Pair(0);

    fn wire(self) -> [u8; 2] {
        self.0.to_le_bytes()
    }
}

/// A pair in rows of `WIDTH` pixels, and the bits of the pixel in it.
#[derive(Clone, Copy, Debug)]
pub struct Half<const WIDTH: usize> {
    pair: usize,
    mask: u16,
}

const LEFT: u16 = 0x00ff;
const RIGHT: u16 = 0xff00;

impl<const WIDTH: usize> Cursor for Half<WIDTH> {
    #[inline(always)]
    fn across(&mut self, right: bool) {
        self.mask = !self.mask;
        if right && self.mask == LEFT {
            self.pair = self.pair.wrapping_add(1);
        }
        if !right && self.mask == RIGHT {
            self.pair = self.pair.wrapping_sub(1);
        }
    }

    #[inline(always)]
    fn along(&mut self, down: bool) {
        self.pair = if down { self.pair.wrapping_add(WIDTH / 2) } else { self.pair.wrapping_sub(WIDTH / 2) };
    }
}

/// The layout of a display of `WIDTH` x `HEIGHT`; `PAIRS` is half of their product.
#[derive(Clone, Copy, Debug)]
pub struct IndexedRows<const WIDTH: usize, const HEIGHT: usize, const PAIRS: usize>;

impl<const WIDTH: usize, const HEIGHT: usize, const PAIRS: usize> Layout for IndexedRows<WIDTH, HEIGHT, PAIRS> {
    type Cell = Pair;
    type Cells = [Pair; PAIRS];
    type Ink = Indexed;
    type Cursor = Half<WIDTH>;
    const WIDTH: usize = WIDTH;
    const HEIGHT: usize = HEIGHT;
    const CELL: [usize; 2] = [2, 1];
    const DARK: [Pair; PAIRS] = {
        assert!(PAIRS * 2 == WIDTH * HEIGHT && WIDTH.is_multiple_of(2));
        [Pair::DARK; PAIRS]
    };

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> Half<WIDTH> {
        Half { pair: (y * WIDTH + x) >> 1, mask: LEFT << (x % 2 * 8) }
    }

    #[inline(always)]
    fn put(cells: &mut [Pair], cursor: Half<WIDTH>, ink: Indexed) {
        if let Some(Pair(pair)) = cells.get_mut(cursor.pair) {
            *pair ^= (*pair ^ (u16::from(ink.0) * 0x0101)) & cursor.mask;
        }
    }

    /// Of two colours the brighter one stays.
    #[inline(always)]
    fn blend(cells: &mut [Pair], cursor: Half<WIDTH>, ink: Indexed, cover: u32) {
        let shade = ((u32::from(ink.shade()) * cover + 8) >> 4) as u8;
        if shade > Self::get(cells, cursor).shade() {
            Self::put(cells, cursor, Indexed(ink.0 & !MAX_SHADE | shade));
        }
    }

    #[inline(always)]
    fn get(cells: &[Pair], cursor: Half<WIDTH>) -> Indexed {
        let [left, right] = cells.get(cursor.pair).map_or([0; 2], |pair| pair.wire());
        Indexed(if cursor.mask == LEFT { left } else { right })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_figure::surface::Framebuffer;

    type Small = IndexedRows<16, 8, 64>;

    #[test]
    fn pixels_lie_in_memory_as_bytes_from_left_to_right() {
        let mut cells = Small::DARK;
        for index in 0..128 {
            Small::put(&mut cells, Small::cursor(index % 16, index / 16), Indexed(index as u8));
        }
        let bytes: Vec<u8> = cells.iter().flat_map(|cell| cell.wire()).collect();
        assert_eq!(bytes, (0..128).collect::<Vec<u8>>());
        assert!((0..128).all(|index| Small::get(&cells, Small::cursor(index % 16, index / 16)) == Indexed(index as u8)));
        assert_eq!(Framebuffer::<Small>::new().pixel(15, 7), Indexed::DARK);
    }

    #[test]
    fn a_blended_pixel_gets_brighter_and_never_darker() {
        let (mut cells, at) = (Small::DARK, Small::cursor(5, 1));
        let (left, right) = (Indexed::of(BodyPart::Left, 200), Indexed::of(BodyPart::Right, 255));
        Small::blend(&mut cells, at, left, 0);
        assert_eq!(Small::get(&cells, at), Indexed::DARK);
        Small::blend(&mut cells, at, left, 16);
        assert_eq!(Small::get(&cells, at), left);
        Small::blend(&mut cells, at, right, 8);
        assert_eq!(Small::get(&cells, at), left);
        Small::blend(&mut cells, at, right, 16);
        assert_eq!(Small::get(&cells, at), right);
    }

    #[test]
    fn every_part_begins_at_the_background_and_gets_brighter() {
        for part in 0..4_u8 {
            assert_eq!(Indexed(part << SHADE_BITS).rgb(), Indexed::DARK.rgb());
            for shade in 0..MAX_SHADE {
                let [darker, brighter] = [shade, shade + 1].map(|shade| Indexed(part << SHADE_BITS | shade).rgb());
                assert!((0..3).all(|channel| darker[channel] <= brighter[channel]), "{part} {shade}");
            }
        }
    }
}

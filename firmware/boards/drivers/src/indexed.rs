//! Displays whose pixels are bytes that index a palette, in rows from the top.

use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::pixelcolor::raw::RawU8;
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::solid::{Light, Look, Tint};
use pantin_figure::surface::{Cell, Cursor, Layout};

/// A palette index. Of the lower half, which lines take: the body part in two bits above five of brightness; brightness 0 of every part is the
/// background. Of the upper half, which solid figures take: [`Look::DEFAULT`]'s materials, each in [`LIGHTS`] brightnesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Indexed(pub u8);

/// Bits of the brightness.
const SHADE_BITS: u32 = 5;
const MAX_SHADE: u8 = (1 << SHADE_BITS) - 1;
/// The first index of solid figures.
const SOLID: u8 = 128;
/// Brightnesses of a material, [`LIGHT_STEP`] apart; the last one is its own colour.
const LIGHTS: u8 = 9;
const LIGHT_STEP: u16 = 20;

impl Indexed {
    /// Returns red, green and blue of this index, 0 to 255: from the background to the part's own colour.
    pub const fn rgb(self) -> [u8; 3] {
        if self.0 >= SOLID {
            return self.material_rgb();
        }
        let full = match self.0 >> SHADE_BITS & 3 {
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

    /// Returns the colour of a material in a brightness.
    const fn material_rgb(self) -> [u8; 3] {
        let (material, step) = ((self.0 - SOLID) / LIGHTS, (self.0 - SOLID) % LIGHTS);
        // The last two indices are of no material.
        if material as usize >= Look::DEFAULT_TINTS.len() {
            return [0; 3];
        }
        let light = 256 - (LIGHTS - 1 - step) as u16 * LIGHT_STEP;
        let mut rgb = Look::DEFAULT_TINTS[material as usize].rgb;
        let mut channel = 0;
        while channel < 3 {
            rgb[channel] = ((rgb[channel] as u16 * light) >> 8) as u8;
            channel += 1;
        }
        rgb
    }

    /// Returns the brightness, 0 to 31; of a solid figure's colour the greatest.
    const fn shade(self) -> u8 {
        if self.0 >= SOLID { MAX_SHADE } else { self.0 & MAX_SHADE }
    }
}

/// The background, a dark blue.
const BACKGROUND: [i32; 3] = [10, 14, 30];

impl PixelColor for Indexed {
    type Raw = RawU8;
}

impl Ink for Indexed {
    const DARK: Self = Indexed(0);
    const HUES: bool = true;

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

    /// The colour of the default character's material that is nearest; the brightness below.
    #[inline(never)]
    fn tint(tint: &Tint, light: Light) -> Self {
        // The default character's own colours, without a search for the nearest one: a figure asks for fifty a picture.
        let [red, green, blue] = tint.rgb;
        let wanted = u32::from_le_bytes([red, green, blue, 0]);
        let exact = COLOURS.iter().position(|colour| *colour == wanted);
        let material = exact.unwrap_or_else(|| nearest(tint)) as u8;
        let darker = (256 - light.min(256)).div_ceil(LIGHT_STEP).min(u16::from(LIGHTS) - 1) as u8;
        Indexed(SOLID + material * LIGHTS + LIGHTS - 1 - darker)
    }
}

/// Red, green and blue of the default character's materials, from the lowest byte on.
static COLOURS: [u32; Look::DEFAULT_TINTS.len()] = {
    let mut colours = [0; Look::DEFAULT_TINTS.len()];
    let mut index = 0;
    while index < colours.len() {
        let [red, green, blue] = Look::DEFAULT_TINTS[index].rgb;
        colours[index] = u32::from_le_bytes([red, green, blue, 0]);
        index += 1;
    }
    colours
};

/// The default character's material whose colour is nearest.
#[inline(never)]
fn nearest(tint: &Tint) -> usize {
    let apart = |own: &Tint| own.rgb.iter().zip(tint.rgb).map(|(own, other)| u32::from(own.abs_diff(other))).sum::<u32>();
    let nearest = Look::DEFAULT_TINTS.iter().enumerate().min_by_key(|(_, own)| apart(own));
    nearest.map_or(0, |(index, _)| index)
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

    /// Whole pairs, and halves of the first and the last one.
    #[inline(always)]
    fn span(cells: &mut [Pair], y: usize, [from, to]: [usize; 2], ink: Indexed) {
        let (first, last) = ((y * WIDTH + from) / 2, (y * WIDTH + to) / 2);
        let head = if from % 2 == 0 { !0 } else { RIGHT };
        let tail = if to % 2 == 0 { LEFT } else { !0 };
        let both = u16::from(ink.0) * 0x0101;
        match cells.get_mut(first..last.wrapping_add(1)).unwrap_or_default() {
            [] => {}
            [Pair(only)] => *only ^= (*only ^ both) & head & tail,
            [Pair(left), middle @ .., Pair(right)] => {
                *left ^= (*left ^ both) & head;
                middle.iter_mut().for_each(|pair| *pair = Pair(both));
                *right ^= (*right ^ both) & tail;
            }
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
    fn a_span_is_its_pixels() {
        for (from, to) in (0..16).flat_map(|from| (from..16).map(move |to| (from, to))) {
            let (mut spans, mut pixels) = (Small::DARK, Small::DARK);
            Small::span(&mut spans, 3, [from, to], Indexed(77));
            (from..=to).for_each(|x| Small::put(&mut pixels, Small::cursor(x, 3), Indexed(77)));
            assert_eq!(spans, pixels, "{from} {to}");
        }
    }

    #[test]
    fn every_material_of_a_solid_figure_has_its_colour() {
        for tint in &Look::DEFAULT_TINTS {
            assert_eq!(Indexed::tint(tint, 256).rgb(), tint.rgb);
            for light in 96..=256 {
                let [found, exact] =
                    [Indexed::tint(tint, light).rgb(), tint.rgb.map(|part| ((u16::from(part) * light) >> 8) as u8)];
                assert!((0..3).all(|channel| found[channel].abs_diff(exact[channel]) <= 20), "{tint:?} {light}: {found:?}");
            }
        }
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

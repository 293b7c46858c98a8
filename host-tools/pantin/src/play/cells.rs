//! What a terminal shows: cells of one letter in two colours, and pixels as such letters.

use crate::output::is_hostile;
use pantin_figure::ink::BodyPart;
use pantin_images::palette::{Palette, Rgb};
use pantin_images::shades::{Mark, Shades};

/// How pixels become letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Dots {
    /// A cell is two pixels, one above the other, each in its colour.
    Half,
    /// A cell is two pixels wide and four high, all in the colour of the brightest.
    Braille,
}

impl Dots {
    /// Pixels of a cell: columns and rows.
    pub fn pixels(self) -> [usize; 2] {
        match self {
            Dots::Half => [1, 2],
            Dots::Braille => [2, 4],
        }
    }
}

/// One letter's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The letter.
    pub letter: char,
    /// Its colour.
    pub ink: Rgb,
    /// The colour behind it.
    pub paper: Rgb,
}

/// All cells, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Cells in a row.
    pub columns: usize,
    /// All of them.
    pub cells: Vec<Cell>,
}

impl Grid {
    /// Blank cells.
    pub fn new(columns: usize, rows: usize, palette: &Palette) -> Grid {
        let blank = Cell { letter: ' ', ink: palette.letters(), paper: palette.paper() };
        Grid { columns, cells: vec![blank; columns * rows] }
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.cells.len().checked_div(self.columns).unwrap_or(0)
    }

    /// Writes letters into a row from a column on; what has no room is left out.
    pub fn write_text(&mut self, column: usize, row: usize, text: &str, ink: Rgb, paper: Rgb) {
        let room = self.columns.saturating_sub(column);
        let start = row * self.columns + column;
        for (offset, letter) in text.chars().take(room).enumerate() {
            if let Some(cell) = self.cells.get_mut(start + offset) {
                let letter = if is_hostile(letter) { char::REPLACEMENT_CHARACTER } else { letter };
                *cell = Cell { letter, ink, paper };
            }
        }
    }

    /// Shows pixels from the upper left corner on, in as many rows as they have.
    pub fn show(&mut self, shades: &Shades, rows: usize, dots: Dots, palette: &Palette, coloured: bool) {
        let columns = self.columns;
        for (index, cell) in self.cells.iter_mut().take(columns * rows).enumerate() {
            let (column, row) = (index % columns, index / columns);
            *cell = match dots {
                Dots::Half => half(shades, column, row, palette, coloured),
                Dots::Braille => braille(shades, column, row, palette),
            };
        }
    }

    /// The letters without colours; rows end where there are only blanks.
    pub fn text(&self) -> String {
        let rows = self.cells.chunks(self.columns.max(1));
        rows.map(|row| row.iter().map(|cell| cell.letter).collect::<String>().trim_end().to_string() + "\n").collect()
    }
}

fn half(shades: &Shades, column: usize, row: usize, palette: &Palette, coloured: bool) -> Cell {
    let marks = [0, 1].map(|below| shades.at(column, 2 * row + below));
    let letter = match marks.map(|mark| mark.shade > 0) {
        [false, false] => ' ',
        [true, false] => '▀',
        [false, true] if !coloured => '▄',
        [true, true] if !coloured => '█',
        [_, true] => '▀',
    };
    let [ink, paper] = marks.map(|mark| palette.mark(&mark));
    match coloured && letter != ' ' {
        true => Cell { letter, ink, paper },
        false => Cell { letter, ink: palette.letters(), paper: palette.paper() },
    }
}

/// Braille's dots by column and row: the first six of a letter stand in two columns of three, the last two below them.
const BRAILLE: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];
/// The letter without dots.
const NO_DOTS: u32 = 0x2800;

fn braille(shades: &Shades, column: usize, row: usize, palette: &Palette) -> Cell {
    let dots = || (0..2).flat_map(|x| (0..4).map(move |y| (BRAILLE[x][y], shades.at(2 * column + x, 4 * row + y))));
    let brightness = |mark: &Mark| (mark.shade > 0 && mark.body_part != BodyPart::Ground, mark.shade);
    let brightest = dots().map(|(_, mark)| mark).max_by_key(brightness).unwrap_or(shades.at(usize::MAX, 0));
    // Where the figure is, it hides the ground's dots: they would have its colour.
    let shows = |mark: Mark| mark.shade > 0 && (mark.body_part == BodyPart::Ground) <= (brightest.body_part == BodyPart::Ground);
    let bits: u32 = dots().filter(|&(_, mark)| shows(mark)).map(|(bit, _)| bit).sum();
    let letter = if bits == 0 { ' ' } else { char::from_u32(NO_DOTS + bits).unwrap_or(' ') };
    let ink = if bits == 0 { palette.letters() } else { palette.mark(&brightest) };
    Cell { letter, ink, paper: palette.paper() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::Pixel;
    use embedded_graphics::draw_target::DrawTarget;
    use embedded_graphics::geometry::Point;

    const FIGURE: BodyPart = BodyPart::Left;
    const GROUND: BodyPart = BodyPart::Ground;

    fn shades(width: usize, height: usize, lit: &[(i32, i32, BodyPart, u8)]) -> Shades {
        let mut shades = Shades::new(width, height);
        let pixels = lit.iter().map(|&(x, y, body_part, shade)| Pixel(Point::new(x, y), Mark { body_part, shade, rgb: None }));
        let Ok(()) = shades.draw_iter(pixels);
        shades
    }

    fn grid(dots: Dots, shades: &Shades, coloured: bool) -> Grid {
        let mut grid = Grid::new(1, 1, &Palette::default());
        grid.show(shades, 1, dots, &Palette::default(), coloured);
        grid
    }

    #[test]
    fn braille_dots_stand_where_the_pixels_are() {
        // By the Unicode names: dots 1 to 3 and 7 from the top on the left, 4 to 6 and 8 on the right.
        let dots = [['⠁', '⠂', '⠄', '⡀'], ['⠈', '⠐', '⠠', '⢀']];
        for (x, column) in dots.iter().enumerate() {
            for (y, &letter) in column.iter().enumerate() {
                let one = shades(2, 4, &[(x as i32, y as i32, FIGURE, 255)]);
                assert_eq!(grid(Dots::Braille, &one, true).cells[0].letter, letter);
            }
        }
        let all: Vec<_> = (0..8).map(|i| (i % 2, i / 2, FIGURE, 255)).collect();
        assert_eq!(grid(Dots::Braille, &shades(2, 4, &all), true).text(), "⣿\n");
        assert_eq!(grid(Dots::Braille, &shades(2, 4, &[]), true).text(), "\n");
    }

    #[test]
    fn the_figure_hides_the_grounds_dots_and_gives_the_colour() {
        let both = shades(2, 4, &[(0, 0, FIGURE, 160), (1, 3, GROUND, 200), (1, 1, FIGURE, 96)]);
        let cell = grid(Dots::Braille, &both, true).cells[0];
        assert_eq!((cell.letter, cell.ink), ('⠑', [170; 3]));
        let ground = grid(Dots::Braille, &shades(2, 4, &[(1, 3, GROUND, 40)]), true).cells[0];
        assert_eq!((ground.letter, ground.ink), ('⢀', [34; 3]));
    }

    #[test]
    fn half_blocks_are_two_colours_or_two_bits() {
        let cell = |lit: &[_], coloured| grid(Dots::Half, &shades(1, 2, lit), coloured).cells[0];
        let (above, below) = ((0, 0, FIGURE, 255), (0, 1, FIGURE, 128));
        let upper = cell(&[above], true);
        assert_eq!((upper.letter, upper.ink, upper.paper), ('▀', [255; 3], [0; 3]));
        let lower = cell(&[below], true);
        assert_eq!((lower.letter, lower.ink, lower.paper), ('▀', [0; 3], [136; 3]));
        let letters = [&[][..], &[above], &[below], &[above, below]];
        assert_eq!(letters.map(|lit| cell(lit, false).letter), [' ', '▀', '▄', '█']);
    }

    #[test]
    fn text_beyond_the_row_is_left_out() {
        let mut grid = Grid::new(4, 2, &Palette::default());
        grid.write_text(2, 0, "abc", [1; 3], [2; 3]);
        grid.write_text(9, 1, "abc", [1; 3], [2; 3]);
        assert_eq!(grid.text(), "  ab\n\n");
    }
}

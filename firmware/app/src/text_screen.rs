//! Text on the whole display: why a clip does not play, or where the program panicked.

use core::fmt;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, ascii::FONT_4X6, ascii::FONT_6X10};
use embedded_graphics::text::{Baseline, Text};
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::surface::{Framebuffer, Layout};

/// Displays with fewer rows take the smaller font: a message of a panic has about 60 letters.
const LARGE_ROWS: usize = 64;

/// A screen of text, written with [`write!`]. Long lines wrap; text below the display is lost.
pub struct TextScreen<'a, L: Layout> {
    framebuffer: &'a mut Framebuffer<L>,
    at: Point,
}

impl<'a, L: Layout> TextScreen<'a, L> {
    /// Clears a framebuffer to write on it.
    pub fn new(framebuffer: &'a mut Framebuffer<L>) -> Self {
        framebuffer.clear();
        TextScreen { framebuffer, at: Point::zero() }
    }

    const FONT: &'static MonoFont<'static> = if L::HEIGHT < LARGE_ROWS { &FONT_4X6 } else { &FONT_6X10 };

    fn new_line(&mut self) {
        self.at = Point::new(0, self.at.y + Self::FONT.character_size.height as i32);
    }
}

impl<L: Layout> fmt::Write for TextScreen<'_, L> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let style = MonoTextStyle::new(Self::FONT, L::Ink::of(BodyPart::Middle, u8::MAX));
        for letter in text.chars() {
            if letter == '\n' {
                self.new_line();
                continue;
            }
            if self.at.x + Self::FONT.character_size.width as i32 > L::WIDTH as i32 {
                self.new_line();
            }
            let text = Text::with_baseline(letter.encode_utf8(&mut [0; 4]), self.at, style, Baseline::Top).draw(self.framebuffer);
            self.at = text.unwrap_or(self.at);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::fmt::Write;
    use pantin_figure::surface::MonoPages;

    type Pages = MonoPages<128, 64, 1024>;

    /// Returns the rows and columns of letters in which a pixel is lit.
    fn written(frame: &Framebuffer<Pages>) -> Vec<(usize, usize)> {
        let lit = |&(row, column): &(usize, usize)| (0..60).any(|at| frame.pixel(column * 6 + at % 6, row * 10 + at / 6).is_on());
        (0..6).flat_map(|row| (0..21).map(move |column| (row, column))).filter(lit).collect()
    }

    #[test]
    fn long_lines_wrap_and_the_rest_is_lost() {
        let mut frame = Framebuffer::<Pages>::new();
        write!(TextScreen::new(&mut frame), "{}\n\n{}", "a".repeat(22), 7).unwrap();
        let first = (0..21).map(|column| (0, column));
        assert_eq!(written(&frame), first.chain([(1, 0), (3, 0)]).collect::<Vec<_>>());
        write!(TextScreen::new(&mut frame), "{}b\u{e9}", "\n".repeat(5)).unwrap();
        assert_eq!(written(&frame), [(5, 0), (5, 1)]);
        write!(TextScreen::new(&mut frame), "{}b", "\n".repeat(9)).unwrap();
        assert_eq!(written(&frame), []);
    }
}

//! The display: 240x160 pixels, which index a palette.
//!
//! The video memory has two such pages. The program draws on one while the other is shown; in the vertical blank they change places. The
//! display's sprites show text over the picture.
#![allow(unsafe_code)]

use crate::registers::{dma3, interrupts, lcd, set_colour};
use crate::sprites::Text;
use crate::start::{blanks, sleep};
use board_drivers::Display;
use board_drivers::indexed::{Half, Indexed, IndexedRows, Pair};
use core::ptr::{self, with_exposed_provenance_mut};
use core::slice;
use pantin_figure::surface::{Framebuffer, Layout};
use portable_atomic::AtomicU32;

/// The layout of a page.
type Rows = IndexedRows<240, 160, PAIRS>;

const PAIRS: usize = 240 * 160 / 2;

/// [`Rows`], whose memory is the page that is drawn on.
#[derive(Clone, Copy, Debug)]
pub struct Lcd;

/// The page that is drawn on: its address.
#[derive(Clone, Debug)]
pub struct DrawnPage(usize);

impl DrawnPage {
    /// Whether it is the second page.
    fn is_second(&self) -> bool {
        self.0 == lcd::PAGES[1]
    }
}

impl AsRef<[Pair]> for DrawnPage {
    #[inline(always)]
    fn as_ref(&self) -> &[Pair] {
        // Safety: the page is memory of this size and alignment, and no other value lies there. The program has one framebuffer of this
        // layout, which lends it.
        unsafe { slice::from_raw_parts(ptr::with_exposed_provenance(self.0), PAIRS) }
    }
}

impl AsMut<[Pair]> for DrawnPage {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut [Pair] {
        // Safety: as above.
        unsafe { slice::from_raw_parts_mut(with_exposed_provenance_mut(self.0), PAIRS) }
    }
}

impl Layout for Lcd {
    type Cell = Pair;
    type Cells = DrawnPage;
    type Ink = Indexed;
    type Cursor = Half<240>;
    const WIDTH: usize = Rows::WIDTH;
    const HEIGHT: usize = Rows::HEIGHT;
    const CELL: [usize; 2] = Rows::CELL;
    /// The display darkens both pages when it starts.
    const DARK: DrawnPage = DrawnPage(lcd::PAGES[1]);
    const STARTS_DARK: bool = true;

    #[inline(always)]
    fn cursor(x: usize, y: usize) -> Half<240> {
        Rows::cursor(x, y)
    }

    #[inline(always)]
    fn put(cells: &mut [Pair], cursor: Half<240>, ink: Indexed) {
        Rows::put(cells, cursor, ink);
    }

    /// Pairs, and halves of the first and the last one. Most spans are short: it takes half the instructions of the safe way.
    #[inline(always)]
    fn span(cells: &mut [Pair], y: usize, [from, to]: [usize; 2], ink: Indexed) {
        if cells.len() != PAIRS || y >= Self::HEIGHT || to >= Self::WIDTH || from > to {
            return;
        }
        let ink = u16::from(ink.0);
        let both = ink << 8 | ink;
        // Safety: the columns and the row are inside, so that all pairs are. Volatile, because the compiler would write a half as a byte, which
        // this memory takes for both halves.
        unsafe {
            let row = cells.as_mut_ptr().cast::<u16>().add(y * (Self::WIDTH / 2));
            let (mut at, end) = (row.add(from / 2), row.add(to.div_ceil(2)));
            if from % 2 == 1 {
                ptr::write_volatile(at, ptr::read_volatile(at) & LEFT_PIXEL | ink << 8);
                at = at.add(1);
            }
            while at < end {
                ptr::write_volatile(at, both);
                at = at.add(1);
            }
            if to % 2 == 0 {
                ptr::write_volatile(end, ptr::read_volatile(end) & !LEFT_PIXEL | ink);
            }
        }
    }

    #[inline(always)]
    fn blend(cells: &mut [Pair], cursor: Half<240>, ink: Indexed, cover: u32) {
        Rows::blend(cells, cursor, ink, cover);
    }

    #[inline(always)]
    fn get(cells: &[Pair], cursor: Half<240>) -> Indexed {
        Rows::get(cells, cursor)
    }
}

/// The bits of a pair's left pixel.
const LEFT_PIXEL: u16 = 0xff;

/// Mode 4, which takes pixels from a page in the background 2; sprites.
const MODE_4: u16 = 4 | 1 << 10 | 1 << 12 | 1 << 6;
const SECOND_PAGE: u16 = 1 << 4;
/// An interrupt at each vertical blank.
const BLANK_INTERRUPT: u16 = 1 << 3;

/// At once, words, all from the same address.
const FILL_WORDS: u32 = 1 << 31 | 1 << 26 | 2 << 23;
/// Four dark pixels, in the fast RAM.
static DARK: AtomicU32 = AtomicU32::new(0);

/// The display.
#[derive(Debug)]
pub struct Screen {
    text: Text,
}

impl Screen {
    /// Clears both pages and sets palette, mode, sprites and interrupt up.
    pub fn start() -> Self {
        for page in lcd::PAGES {
            fill(page, PAIRS / 2);
        }
        for index in 0..=u8::MAX {
            set_colour(lcd::PALETTE, index, Indexed(index).rgb());
        }
        let screen = Screen { text: Text::start() };
        lcd::CONTROL.write(MODE_4);
        lcd::STATUS.write(BLANK_INTERRUPT);
        interrupts::ENABLED.write(1);
        interrupts::MASTER.write(1);
        screen
    }
}

/// Darkens words of the video memory. Inlined where the display's frames need it: that is in the fast RAM.
#[inline(always)]
fn fill(start: usize, words: usize) {
    dma3::SOURCE.write((&raw const DARK).expose_provenance());
    dma3::DESTINATION.write(start);
    dma3::CONTROL.write(FILL_WORDS | words as u32);
}

impl Display<Lcd> for Screen {
    /// Waits for the next vertical blank and shows the page that was drawn on. The other one is cleared where the last two pictures were
    /// drawn: it shows the former of them.
    fn present(&mut self, framebuffer: &mut Framebuffer<Lcd>) {
        let before = blanks();
        // The time that the program waits is not part of the frame.
        markers::stop();
        while blanks() == before {
            sleep();
        }
        markers::start();
        let page = framebuffer.memory();
        lcd::CONTROL.write(if page.is_second() { MODE_4 | SECOND_PAGE } else { MODE_4 });
        let [first, second] = lcd::PAGES;
        page.0 = if page.is_second() { first } else { second };
        let page = page.0;
        self.text.show();
        for window in framebuffer.send() {
            // Whole words.
            let (from, to) = (window.columns[0] / 4, window.columns[1] / 4);
            for row in window.rows[0]..=window.rows[1] {
                fill(page + row * Lcd::WIDTH + 4 * from, to + 1 - from);
            }
        }
    }

    fn overlay(&mut self, lines: [&str; 2]) -> bool {
        self.text.set(lines);
        true
    }
}

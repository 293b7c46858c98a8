//! The phone's display: 176x220 pixels of 16 bits, which a DMA channel copies from memory to the controller.
#![allow(unsafe_code)]

use crate::board::Lcd;
use crate::registers::{lcd, lcd_dma};
use core::ptr;
use pantin_figure::surface::{Framebuffer, Layout, Pair};

/// The palette's first entry: no palette, 12 or 16 bits a pixel.
const NO_PALETTE: u16 = 0x4000;

const ENABLE: u32 = 1 << 0;
/// RGB565.
const TFT: u32 = 1 << 7;
/// Load only the palette, or only the pixels.
const PALETTE_ONLY: u32 = 1 << 20;
const PIXELS_ONLY: u32 = 2 << 20;

/// Bytes of the palette.
const PALETTE: usize = 512;

// Safety: the memory map places them; no Rust value lies there.
unsafe extern "C" {
    static mut _palette: u16;
    static mut _pixels: Pair;
    static mut _pixels_end: Pair;
}

/// Sets up controller and channel, first for the palette, then for the pixels.
pub fn start() {
    // Safety: the memory map reserves this place for the palette.
    unsafe { ptr::write_volatile(&raw mut _palette, NO_PALETTE) };
    lcd::CONTROL.write(0);
    lcd::TIMING_0.write(Lcd::WIDTH as u32 - 1);
    lcd::TIMING_1.write(Lcd::HEIGHT as u32 - 1);
    lcd::TIMING_2.write(0);
    lcd_dma::CONTROL.write(0);
    let palette = (&raw mut _palette).expose_provenance();
    transfer(palette, palette + PALETTE);
    lcd::CONTROL.write(ENABLE | TFT | PALETTE_ONLY);
    lcd::CONTROL.write(0);
    transfer((&raw mut _pixels).expose_provenance(), (&raw mut _pixels_end).expose_provenance());
    lcd::CONTROL.write(ENABLE | TFT | PIXELS_ONLY);
}

/// Makes the channel copy the memory from `start` to `end`.
fn transfer(start: usize, end: usize) {
    let last = end - 2;
    lcd_dma::TOP_LOW.write(start as u16);
    lcd_dma::TOP_HIGH.write((start >> 16) as u16);
    lcd_dma::BOTTOM_LOW.write(last as u16);
    lcd_dma::BOTTOM_HIGH.write((last >> 16) as u16);
}

/// Copies what changed since the last call to the memory that the channel reads.
pub fn show(frame: &mut Framebuffer<Lcd>) {
    for window in frame.send() {
        let cells = window.cells::<Lcd>();
        for (row, stretch) in (cells.rows[0]..).zip(frame.stretches(window)) {
            let at = row * (Lcd::WIDTH / Lcd::CELL[0]) + cells.columns[0];
            // Safety: a window lies inside the picture. The memory map reserves this place for a whole picture, and no Rust value lies
            // there.
            unsafe { copy(stretch, (&raw mut _pixels).add(at)) };
        }
    }
}

/// Copies eight pairs at a time: the library's way takes seven instructions a word.
///
/// # Safety
/// `to` is memory for as many pairs as `from` has, and no Rust value lies there.
unsafe fn copy(from: &[Pair], mut to: *mut Pair) {
    let (blocks, rest) = from.as_chunks::<8>();
    for block in blocks {
        // Safety: the caller's.
        unsafe {
            to.cast::<[Pair; 8]>().write(*block);
            to = to.add(8);
        }
    }
    for pair in rest {
        // Safety: the caller's.
        unsafe {
            to.write(*pair);
            to = to.add(1);
        }
    }
}

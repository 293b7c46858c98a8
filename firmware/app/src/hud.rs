//! Two lines of text over the picture: the clip's name, and the state of its source.

use crate::board::Board;
use crate::session::Entry;
use crate::source::{Status, TextLine};
use crate::view_state::ViewState;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, ascii::FONT_4X6, ascii::FONT_6X10};
use embedded_graphics::text::{Baseline, Text};
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::surface::{Framebuffer, Layout};

/// Displays with this many rows or more take the larger font.
const LARGE_ROWS: usize = 160;
/// Brightness of the letters.
pub(crate) const SHADE: u8 = 200;

/// Shows the name at the top, and at the bottom frame and speed of a clip, packets and exact channels of a link, or the state of a state
/// machine: on the board's overlay, or drawn on the framebuffer.
#[inline(never)]
pub(crate) fn show<B: Board>(
    view_state: &ViewState,
    name: &str,
    status: &Status,
    target: &mut Framebuffer<B::Layout>,
    board: &mut B,
) {
    let (mut top, mut bottom) = (TextLine::new(), TextLine::new());
    let name = name.get(..24).unwrap_or(name);
    match status {
        Status::Clip { frame, frames } => {
            let _ = top.push_str(name);
            clip(&mut bottom, view_state, *frame, *frames);
        }
        #[cfg(feature = "steer")]
        Status::State(name) => return lines(["", name], target, board),
        #[cfg(feature = "link")]
        Status::Link(status) => link(&mut top, &mut bottom, name, status),
    }
    lines([&top, &bottom], target, board);
}

/// Shows the name at the top, and the size at the bottom.
#[inline(never)]
pub(crate) fn caption<B: Board>(entry: &Entry, target: &mut Framebuffer<B::Layout>, board: &mut B) {
    let mut size = TextLine::new();
    number(&mut size, entry.bytes.len() as u32);
    let _ = size.push_str(" bytes");
    lines([entry.name.get(..24).unwrap_or(entry.name), &size], target, board);
}

/// Shows a line at the top and one at the bottom. Not inlined, so that the drawing of text, which is, stands once in the image.
#[inline(never)]
pub(crate) fn lines<B: Board>(lines: [&str; 2], target: &mut Framebuffer<B::Layout>, board: &mut B) {
    if !board.overlay(lines) {
        draw(lines, target);
    }
}

/// The font of a display.
const fn font<L: Layout>() -> &'static MonoFont<'static> {
    if L::HEIGHT >= LARGE_ROWS { &FONT_6X10 } else { &FONT_4X6 }
}

/// Letters in a line of a display.
pub(crate) const fn columns<L: Layout>() -> usize {
    L::WIDTH / font::<L>().character_size.width as usize
}

/// Draws a line at the top and one at the bottom.
#[inline(always)]
fn draw<L: Layout>([top, bottom]: [&str; 2], target: &mut Framebuffer<L>) {
    let font = const { font::<L>() };
    let mut style = MonoTextStyle::new(font, L::Ink::of(BodyPart::Middle, SHADE));
    // On a small display the text is over the figure: its ground is dark.
    if const { L::HEIGHT < LARGE_ROWS } {
        style.background_color = Some(L::Ink::DARK);
    }
    let last_row = L::HEIGHT as i32 - font.character_size.height as i32;
    for (line, y) in [(top, 0), (bottom, last_row)] {
        // Drawing on a framebuffer cannot fail.
        let _ = Text::with_baseline(line, Point::new(0, y), style, Baseline::Top).draw(target);
    }
}

/// Writes the frame, counted from 1, the speed and the direction.
fn clip(line: &mut TextLine, view_state: &ViewState, frame: u32, frames: u32) {
    number(line, frame + 1);
    let _ = line.push('/');
    number(line, frames);
    let _ = line.push(' ');
    if view_state.paused {
        let _ = line.push_str("paused");
    } else {
        let _ = line.push_str(if view_state.rate_log2 < 0 { "x1/" } else { "x" });
        number(line, 1 << view_state.rate_log2.unsigned_abs());
    }
    if view_state.backwards {
        let _ = line.push_str(" back");
    }
}

/// Writes the name, or why the clip cannot be played; then packets, those lost or damaged, and how many channels are exact.
#[cfg(feature = "link")]
fn link(top: &mut TextLine, bottom: &mut TextLine, name: &str, status: &crate::source::LinkStatus) {
    let _ = top.push_str(match status.refusal {
        Some(pantin_link::ClipMismatch::Rig) => "another rig",
        Some(pantin_link::ClipMismatch::Form) => "another coding",
        Some(pantin_link::ClipMismatch::Channels) => "too many channels",
        Some(_) => "another clip",
        None => name,
    });
    let lost = status.counts.missing.wrapping_add(status.damaged);
    for (count, words) in [(status.counts.packets, " packets "), (lost, " lost "), (status.exact.into(), "/")] {
        number(bottom, count);
        let _ = bottom.push_str(words);
    }
    number(bottom, status.channels.into());
}

/// Writes a number's digits. The formatting of the standard library is larger than all of this file.
fn number(line: &mut TextLine, value: u32) {
    if value >= 10 {
        number(line, value / 10);
    }
    let _ = line.push(char::from(b'0' + (value % 10) as u8));
}

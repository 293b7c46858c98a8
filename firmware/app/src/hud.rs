//! Name, frame and speed in a corner of the display, by `embedded-graphics`.

use crate::view_state::{Entry, ViewState};
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, ascii::FONT_4X6, ascii::FONT_6X10};
use embedded_graphics::text::{Baseline, Text};
use heapless::String;
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::surface::{Framebuffer, Layout};

/// Rows from which a display takes the larger letters.
const LARGE: usize = 160;
/// Brightness of the letters.
const SHADE: u8 = 200;

/// Draws it.
#[inline(never)]
pub(crate) fn draw<L: Layout>(view_state: &ViewState, entry: &Entry, frame: [u32; 2], target: &mut Framebuffer<L>) {
    let font: &MonoFont = const { if L::HEIGHT >= LARGE { &FONT_6X10 } else { &FONT_4X6 } };
    let style = MonoTextStyle::new(font, L::Ink::of(BodyPart::Middle, SHADE));
    let mut first: String<32> = String::new();
    let mut second: String<32> = String::new();
    // What does not fit the line is left out.
    let _ = first.push_str(entry.name.get(..24).unwrap_or(entry.name));
    number(&mut second, frame[0] + 1);
    let _ = second.push('/');
    number(&mut second, frame[1]);
    let _ = second.push(' ');
    match (view_state.paused, view_state.pace) {
        (true, _) => {
            let _ = second.push_str("paused");
        }
        (false, pace) => {
            let _ = second.push_str(if pace < 0 { "x1/" } else { "x" });
            number(&mut second, 1 << pace.unsigned_abs());
        }
    }
    if view_state.backwards {
        let _ = second.push_str(" back");
    }
    let bottom = L::HEIGHT as i32 - font.character_size.height as i32;
    for (line, y) in [(&first, 0), (&second, bottom)] {
        // A display that fails shows no letters; the figure's drawing tells of it.
        let _ = Text::with_baseline(line, Point::new(0, y), style, Baseline::Top).draw(target);
    }
}

/// Draws what came over a line: packets, those that did not arrive or not whole, and how many channels are exact.
#[cfg(feature = "link")]
#[inline(never)]
pub(crate) fn draw_line<L: Layout>(entry: &Entry, status: &crate::link::LinkStatus, target: &mut Framebuffer<L>) {
    let font: &MonoFont = const { if L::HEIGHT >= LARGE { &FONT_6X10 } else { &FONT_4X6 } };
    let style = MonoTextStyle::new(font, L::Ink::of(BodyPart::Middle, SHADE));
    let (mut first, mut second): (String<32>, String<32>) = (String::new(), String::new());
    let words = match status.refusal {
        Some(pantin_link::ClipMismatch::Rig) => "another rig",
        Some(pantin_link::ClipMismatch::Form) => "another coding",
        Some(pantin_link::ClipMismatch::Channels) => "too many channels",
        None => entry.name.get(..24).unwrap_or(entry.name),
    };
    let _ = first.push_str(words);
    let lost = status.counts.missing.wrapping_add(status.damaged);
    for (number_of, words) in [(status.counts.packets, " packets "), (lost, " lost "), (status.exact[0].into(), "/")] {
        number(&mut second, number_of);
        let _ = second.push_str(words);
    }
    number(&mut second, status.exact[1].into());
    let bottom = L::HEIGHT as i32 - font.character_size.height as i32;
    for (line, y) in [(&first, 0), (&second, bottom)] {
        let _ = Text::with_baseline(line, Point::new(0, y), style, Baseline::Top).draw(target);
    }
}

/// The digits of a number: without the library's formatting, which is larger than all of this.
fn number(line: &mut String<32>, value: u32) {
    if value >= 10 {
        number(line, value / 10);
    }
    let _ = line.push(char::from(b'0' + (value % 10) as u8));
}

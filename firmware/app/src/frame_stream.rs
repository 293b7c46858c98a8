//! Sends pictures over a serial line, for boards whose display an emulator does not show: the changed windows, cell by cell.
//!
//! A window is the letter `W`, then its first column, last column, first row and last row in cells of the layout, a byte each, then its
//! cells row by row, the most significant byte of a cell first.

use pantin_figure::surface::{Cell, Framebuffer, Layout};

/// The byte that begins a window.
pub const WINDOW: u8 = b'W';

/// Sends the windows of a framebuffer that have changed.
pub fn send<L: Layout>(framebuffer: &mut Framebuffer<L>, mut send: impl FnMut(&[u8])) {
    for window in framebuffer.send() {
        let cells = window.cells::<L>();
        let [columns, rows] = [cells.columns, cells.rows].map(|ends| ends.map(|end| end as u8));
        send(&[WINDOW, columns[0], columns[1], rows[0], rows[1]]);
        for stretch in framebuffer.stretches(window) {
            for cell in stretch {
                send(cell.wire().as_ref());
            }
        }
    }
}

//! Pictures over a serial line, for boards without a display that an emulator shows: the changed windows, cell by cell.
//!
//! A window is the letter `W`, the first and last column and the first and last row in the layout's cells (a byte each),
//! then its cells row by row, the high byte of a cell first.

use pantin_figure::surface::{Cell, Framebuffer, Layout};

/// Begins a window.
pub const WINDOW: u8 = b'W';

/// Sends what changed of a picture.
pub fn send<L: Layout>(frame: &mut Framebuffer<L>, mut send: impl FnMut(&[u8])) {
    for window in frame.send() {
        let cells = window.cells::<L>();
        let [columns, rows] = [cells.columns, cells.rows].map(|ends| ends.map(|end| end as u8));
        send(&[WINDOW, columns[0], columns[1], rows[0], rows[1]]);
        for stretch in frame.stretches(window) {
            for cell in stretch {
                send(cell.wire().as_ref());
            }
        }
    }
}

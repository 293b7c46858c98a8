//! A frame in both forms that the page draws: strokes for its canvas, or the greys of a display.

use crate::actor::Actor;
use crate::grey::{PIXELS, draw};
use pantin_web_module::Stroke;

/// Maximum number of strokes of a frame: a face takes 900.
pub const STROKES: usize = 4096;

/// A frame in both forms.
pub struct Picture {
    pub strokes: [Stroke; STROKES],
    count: usize,
    grey: [u8; PIXELS],
}

impl Picture {
    /// Collects the strokes of the last pose and returns their number.
    pub fn gather(&mut self, actor: &mut Actor, pose: &[i32]) -> usize {
        self.count = 0;
        actor.each(pose, self);
        self.count
    }

    /// Adds a stroke.
    #[inline(never)]
    pub fn add(&mut self, stroke: Stroke) {
        if let Some(place) = self.strokes.get_mut(self.count) {
            *place = stroke;
            self.count += 1;
        }
    }

    /// Draws the first `count` strokes as the firmware does.
    pub fn draw(&mut self, count: usize) -> &[u8] {
        self.grey.fill(0);
        for stroke in self.strokes.iter().take(count) {
            draw(stroke, &mut self.grey);
        }
        &self.grey
    }
}

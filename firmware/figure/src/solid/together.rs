//! Several figures in one picture: the parts of all are drawn from far to near.

use super::paint::Painter;
use super::{Kind, MOST_PARTS, SolidFigure};
use crate::DrawStyle;
use crate::rotation::RotationBackend;
use crate::surface::Surface;

/// Most figures that [`draw_together`] sorts among each other.
pub const MOST_FIGURES: usize = 8;

/// Draws figures in the poses that they took last on a clear surface: the floor of the first one, if it is wanted, the shadows of the others, and
/// then the parts of all figures from far to near, so that figures can reach around each other. Each figure's own parts keep their order.
///
/// Depths are those before the figures' cameras. Figures in one world need one camera: [`SolidFigure::share_camera`]. Only the first
/// [`MOST_FIGURES`] are drawn; a figure of [`Build::Lines`](super::Build::Lines) is drawn as lines before the others. It takes 900 bytes of stack.
#[inline(never)]
pub fn draw_together<const N: usize, R: RotationBackend, S: Surface>(
    figures: &mut [&mut SolidFigure<N, R>],
    surface: &mut S,
    floor: bool,
) {
    let mut keys = [[0i16; MOST_PARTS]; MOST_FIGURES];
    for (index, (figure, keys)) in figures.iter_mut().zip(&mut keys).enumerate() {
        if let Kind::Lines = figure.kind {
            figure.figure.draw_on(surface, DrawStyle { ground: floor && index == 0, smooth: false });
            continue;
        }
        figure.sort();
        let depths = figure.keys();
        for (key, part) in keys.iter_mut().zip(&figure.order) {
            *key = depths.of(&figure.figure, *part).clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        }
    }
    let mut painter = Painter::on(surface);
    for (index, figure) in figures.iter().take(MOST_FIGURES).enumerate().filter(|_| floor) {
        // A figure of lines was drawn with its ground.
        if !matches!(figure.kind, Kind::Lines) {
            figure.body().draw_floor(&mut painter, index == 0);
        }
    }
    // The next part of each figure, and the joints of those before it.
    let mut next = [(0usize, 0u64); MOST_FIGURES];
    loop {
        let waiting = figures.iter().zip(&keys).zip(&mut next).filter_map(|((figure, keys), next)| {
            let part = figure.order.get(next.0).filter(|_| !matches!(figure.kind, Kind::Lines))?;
            Some((keys.get(next.0)?, figure, *part, next))
        });
        // Of equally far parts that of the first figure comes first.
        let farthest = waiting.reduce(|best, other| if other.0 > best.0 { other } else { best });
        let Some((_, figure, part, (place, drawn))) = farthest else { break };
        figure.body().draw(&mut painter, part, drawn);
        *place += 1;
    }
}

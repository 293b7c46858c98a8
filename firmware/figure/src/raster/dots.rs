//! Single pixels.

use crate::surface::Surface;

/// Sets the pixels that are on the surface.
#[inline(always)]
pub fn dots<S: Surface>(surface: &mut S, dots: impl IntoIterator<Item = ([i32; 2], S::Ink)>) {
    let [width, height] = surface.size();
    let (mut least, mut most) = ([width, height], [-1; 2]);
    for ([x, y], ink) in dots {
        if (0..width).contains(&x) && (0..height).contains(&y) {
            least = [least[0].min(x), least[1].min(y)];
            most = [most[0].max(x), most[1].max(y)];
            let cursor = surface.cursor(x, y);
            surface.put(cursor, ink);
        }
    }
    if most[0] >= 0 {
        surface.mark(least, most);
    }
}

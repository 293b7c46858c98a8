//! Openings between two lids: what is behind them is drawn no farther than their edges, an iris, a row of teeth, a tongue.

use crate::bytes::Bytes;
use crate::model::{Error, Model, NO_SHAPE};
use crate::morph::{Place, Weights};
use heapless::Vec;

struct Aperture<'a> {
    mirrored: bool,
    /// A shape that lets the members over the lower edge, by so many steps at full weight.
    release: u8,
    drop: i16,
    upper: &'a [u8],
    lower: &'a [u8],
    members: &'a [u8],
}

impl<'a> Aperture<'a> {
    fn parse(bytes: &mut Bytes<'a>, wide: bool) -> Result<Self, Error> {
        let [flags, release] = bytes.array()?;
        let drop = bytes.number()?;
        let counts: [u8; 3] = bytes.array()?;
        let [upper, lower, members] = counts.map(|count| bytes.take(usize::from(count) << u32::from(wide)));
        if flags > 1 || counts[0] < 2 || counts[1] < 2 {
            return Err(Error::Malformed);
        }
        Ok(Aperture { mirrored: flags != 0, release, drop, upper: upper?, lower: lower?, members: members? })
    }
}

pub(crate) fn check(bytes: &mut Bytes, count: u8, model: &Model) -> Result<(), Error> {
    for _ in 0..count {
        let aperture = Aperture::parse(bytes, model.wide)?;
        if aperture.release != NO_SHAPE && usize::from(aperture.release) >= model.shape_count() {
            return Err(Error::Malformed);
        }
        let mut members = Bytes(aperture.members);
        while !members.0.is_empty() {
            model.check_run(members.index(model.wide)?, 1)?;
        }
        for indices in [aperture.upper, aperture.lower] {
            let mut indices = Bytes(indices);
            while !indices.0.is_empty() {
                model.check_index(indices.index(model.wide)?)?;
            }
        }
    }
    Ok(())
}

/// Brings members between the edges.
#[inline(never)]
pub(crate) fn close(model: &Model, places: &mut [Place], weights: &Weights) {
    let mut bytes = Bytes(model.apertures);
    while let Ok(aperture) = Aperture::parse(&mut bytes, model.wide) {
        let released = weights.of(usize::from(aperture.release))[0].max(0);
        let drop = (i32::from(aperture.drop) * released) >> 15;
        for mirrored in [false, true] {
            if mirrored && !aperture.mirrored {
                break;
            }
            let image = |index| usize::from(if mirrored { model.mirror(index) } else { index });
            let edge = |indices| Edge::new(each(indices, model.wide).map(image), places);
            let (upper, lower) = (edge(aperture.upper), edge(aperture.lower));
            for index in each(aperture.members, model.wide).map(image) {
                let Some(place) = places.get_mut(index) else { continue };
                let x = place[0].clamp(upper.least, upper.most.max(upper.least));
                let mut y = i32::from(place[1]);
                // Below all of the upper edge, or above all of the lower one, there is nothing to look up.
                if y > i32::from(upper.lowest) {
                    y = y.min(i32::from(upper.height(x)));
                }
                if y < i32::from(lower.highest) {
                    y = y.max(i32::from(lower.height(x)) - drop);
                }
                *place = [x, y as i16, place[2]];
            }
        }
    }
}

fn each(indices: &[u8], wide: bool) -> impl Iterator<Item = u16> {
    let mut bytes = Bytes(indices);
    core::iter::from_fn(move || bytes.index(wide).ok())
}

/// Most vertices of an edge; further ones are left out.
const EDGE: usize = 16;

/// A row of vertices from one corner to the other.
struct Edge {
    vertices: Vec<[i16; 2], EDGE>,
    least: i16,
    most: i16,
    lowest: i16,
    highest: i16,
}

impl Edge {
    fn new(indices: impl Iterator<Item = usize>, places: &[Place]) -> Edge {
        let (least, most, lowest, highest) = (i16::MAX, i16::MIN, i16::MAX, i16::MIN);
        let mut edge = Edge { vertices: Vec::new(), least, most, lowest, highest };
        for &[x, y, _] in indices.filter_map(|index| places.get(index)) {
            let _ = edge.vertices.push([x, y]);
            edge.least = edge.least.min(x);
            edge.most = edge.most.max(x);
            edge.lowest = edge.lowest.min(y);
            edge.highest = edge.highest.max(y);
        }
        edge
    }

    /// The height of the edge at `x`, which is inside.
    fn height(&self, x: i16) -> i16 {
        for pair in self.vertices.windows(2) {
            let &[from, to] = pair else { continue };
            if from[0].min(to[0]) <= x && x <= from[0].max(to[0]) {
                return between(from, to, x);
            }
        }
        self.vertices.last().map_or(0, |last| last[1])
    }
}

/// Height at `x` between two vertices, by halving: within 1/32 of the way from one to the other.
#[inline(always)]
fn between(from: [i16; 2], to: [i16; 2], x: i16) -> i16 {
    let x = i32::from(x);
    let (from, to) = if from[0] <= to[0] { (from, to) } else { (to, from) };
    let (from, to) = ([i32::from(from[0]), i32::from(from[1])], [i32::from(to[0]), i32::from(to[1])]);
    let [[_, a], [_, b]] = halved(halved(halved(halved([from, to], x), x), x), x);
    ((a + b) >> 1) as i16
}

/// The half in which `x` lies.
#[inline(always)]
fn halved([from, to]: [[i32; 2]; 2], x: i32) -> [[i32; 2]; 2] {
    let middle = [(from[0] + to[0]) >> 1, (from[1] + to[1]) >> 1];
    if x <= middle[0] { [from, middle] } else { [middle, to] }
}

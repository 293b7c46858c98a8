//! Openings between two lids: what is behind them is drawn no farther than their edges, an iris, a row of teeth, a tongue.

use crate::bytes::{Bytes, indices};
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
            let (mut upper, mut lower) = (Edge::EMPTY, Edge::EMPTY);
            indices(aperture.upper, model.wide).for_each(|index| upper.add(places, image(index)));
            indices(aperture.lower, model.wide).for_each(|index| lower.add(places, image(index)));
            let (above, below) = (upper.inner(), lower.inner());
            indices(aperture.members, model.wide).for_each(|index| {
                let Some(place) = places.get_mut(image(index)) else { return };
                let (x, mut y) = (i32::from(place[0]).max(upper.least).min(upper.most), i32::from(place[1]));
                if !above.holds(x) || y > above.lowest {
                    y = y.min(upper.height(x));
                }
                if !below.holds(x) || y < below.highest {
                    y = y.max(lower.height(x) - drop);
                }
                *place = [x as i16, y as i16, place[2]];
            });
        }
    }
}

/// Most vertices of an edge; further ones are left out.
const EDGE: usize = 10;

/// A row of vertices from one corner to the other.
struct Edge {
    vertices: Vec<[i16; 2], EDGE>,
    least: i32,
    most: i32,
}

impl Edge {
    const EMPTY: Edge = Edge { vertices: Vec::new(), least: i32::MAX, most: i32::MIN };

    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn add(&mut self, places: &[Place], index: usize) {
        let Some(&[x, y, _]) = places.get(index) else { return };
        let _ = self.vertices.push([x, y]);
        (self.least, self.most) = (self.least.min(x.into()), self.most.max(x.into()));
    }

    /// Its vertices but the corners.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    fn inner(&self) -> Inner {
        let mut inner = Inner { least: i32::MAX, most: i32::MIN, lowest: i32::MAX, highest: i32::MIN };
        let corners = self.vertices.len().saturating_sub(1);
        for &[x, y] in self.vertices.get(1..corners).unwrap_or(&[]) {
            let (x, y) = (i32::from(x), i32::from(y));
            inner = Inner {
                least: inner.least.min(x),
                most: inner.most.max(x),
                lowest: inner.lowest.min(y),
                highest: inner.highest.max(y),
            };
        }
        inner
    }

    /// The height of the edge at `x`, which is inside.
    fn height(&self, x: i32) -> i32 {
        for pair in self.vertices.windows(2) {
            let &[from, to] = pair else { continue };
            if i32::from(from[0].min(to[0])) <= x && x <= i32::from(from[0].max(to[0])) {
                return between(from, to, x);
            }
        }
        self.vertices.last().map_or(0, |last| last[1].into())
    }
}

/// What an edge's vertices between its corners span: a member there, and on the near side of all of them, need not look up its height.
struct Inner {
    least: i32,
    most: i32,
    lowest: i32,
    highest: i32,
}

impl Inner {
    #[inline(always)]
    fn holds(&self, x: i32) -> bool {
        self.least <= x && x <= self.most
    }
}

/// Height at `x` between two vertices, by halving: within 1/32 of the way from one to the other.
#[inline(always)]
fn between(from: [i16; 2], to: [i16; 2], x: i32) -> i32 {
    let (from, to) = if from[0] <= to[0] { (from, to) } else { (to, from) };
    let (from, to) = ([i32::from(from[0]), i32::from(from[1])], [i32::from(to[0]), i32::from(to[1])]);
    let [[_, a], [_, b]] = halved(halved(halved(halved([from, to], x), x), x), x);
    (a + b) >> 1
}

/// The half in which `x` lies.
#[inline(always)]
fn halved([from, to]: [[i32; 2]; 2], x: i32) -> [[i32; 2]; 2] {
    let middle = [(from[0] + to[0]) >> 1, (from[1] + to[1]) >> 1];
    if x <= middle[0] { [from, middle] } else { [middle, to] }
}

//! Openings between two lids: what is behind them is drawn no farther than their edges, an iris, a row of teeth, a tongue.

use crate::bytes::Bytes;
use crate::model::{Error, Model, NO_SHAPE};
use crate::morph::{Place, Weights};

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
        for indices in [aperture.upper, aperture.lower, aperture.members] {
            let mut indices = Bytes(indices);
            while !indices.0.is_empty() {
                model.check_index(indices.index(model.wide)?)?;
            }
        }
    }
    Ok(())
}

/// Brings members between the edges.
pub(crate) fn close(model: &Model, places: &mut [Place], weights: &Weights) {
    let mut bytes = Bytes(model.apertures);
    while let Ok(aperture) = Aperture::parse(&mut bytes, model.wide) {
        let released = weights.of(usize::from(aperture.release))[0].max(0);
        let drop = (i32::from(aperture.drop) * released) >> 15;
        for mirrored in [false, true] {
            if mirrored && !aperture.mirrored {
                break;
            }
            let edge = |indices| Edge { indices, wide: model.wide, mirror: mirrored.then_some(*model) };
            let (upper, lower) = (edge(aperture.upper), edge(aperture.lower));
            for index in edge(aperture.members).indices() {
                let Some(&[x, y, z]) = places.get(index) else { continue };
                let x = upper.within(places, x);
                let lowest = i32::from(lower.height(places, x)) - drop;
                let y = i32::from(y).min(i32::from(upper.height(places, x))).max(lowest) as i16;
                if let Some(place) = places.get_mut(index) {
                    *place = [x, y, z];
                }
            }
        }
    }
}

/// A row of vertices from one corner to the other, or its mirror image.
struct Edge<'a> {
    indices: &'a [u8],
    wide: bool,
    mirror: Option<Model<'a>>,
}

impl Edge<'_> {
    fn indices(&self) -> impl Iterator<Item = usize> + '_ {
        let mut bytes = Bytes(self.indices);
        core::iter::from_fn(move || {
            let index = bytes.index(self.wide).ok()?;
            Some(usize::from(self.mirror.map_or(index, |model| model.mirror(index))))
        })
    }

    fn vertices<'p>(&'p self, places: &'p [Place]) -> impl Iterator<Item = Place> + 'p {
        self.indices().map(|index| places.get(index).copied().unwrap_or_default())
    }

    /// `x`, or the nearer corner's.
    fn within(&self, places: &[Place], x: i16) -> i16 {
        let xs = || self.vertices(places).map(|place| place[0]);
        x.min(xs().max().unwrap_or(x)).max(xs().min().unwrap_or(x))
    }

    /// The height of the edge at `x`, which is inside.
    fn height(&self, places: &[Place], x: i16) -> i16 {
        let mut vertices = self.vertices(places);
        let Some(mut from) = vertices.next() else { return 0 };
        for to in vertices {
            if from[0].min(to[0]) <= x && x <= from[0].max(to[0]) {
                return between(from, to, x);
            }
            from = to;
        }
        from[1]
    }
}

/// Height at `x` between two vertices, by halving: within 1/64 of the way from one to the other.
fn between(from: Place, to: Place, x: i16) -> i16 {
    let ([mut a, mut b], x) = ([from, to].map(|place| [i32::from(place[0]), i32::from(place[1])]), i32::from(x));
    let ascending = a[0] <= b[0];
    for _ in 0..6 {
        let middle = [(a[0] + b[0]) >> 1, (a[1] + b[1]) >> 1];
        if (x <= middle[0]) == ascending { b = middle } else { a = middle }
    }
    ((a[1] + b[1]) >> 1) as i16
}

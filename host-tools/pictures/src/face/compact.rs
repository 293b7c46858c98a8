//! Encodes a blueprint as a model (firmware/face/MODEL.md).

use super::blueprint::{Arc, Blueprint, Shape, Turn};
use anyhow::{Context, Result, ensure};
use pantin_face::model::{self, NO_SHAPE, VERSION, WIDE};
use pantin_face::shape::{Interpolation, ShapeKind};

/// Deltas smaller than this many steps are omitted.
const LEAST: f64 = 0.5;

/// Returns the model's bytes. Fails if a number exceeds the format's limits.
pub fn encode(blueprint: &Blueprint) -> Result<Vec<u8>> {
    let vertices = blueprint.vertices();
    ensure!(vertices <= 1 << 15, "{vertices} vertices; a model holds at most {}", 1 << 15);
    ensure!(
        blueprint.shapes.len() <= pantin_face::SHAPES,
        "{} shapes; a model holds at most {}",
        blueprint.shapes.len(),
        pantin_face::SHAPES
    );
    let wide = vertices > 256;
    let mut out = Writer { bytes: vec![VERSION, if wide { WIDE } else { 0 }, (-blueprint.fraction_bits) as u8], wide };
    let moving = moving(blueprint);
    for count in [
        blueprint.middles,
        blueprint.pairs,
        moving[0],
        moving[1],
        blueprint.triangles.len(),
        blueprint.outline,
        blueprint.names.len(),
    ] {
        out.short(count);
    }
    for count in [blueprint.fixed.len(), blueprint.curves.len(), blueprint.openings.len(), blueprint.shapes.len()] {
        ensure!(count <= 255, "{count} curves, openings or fixed points; a model holds at most 255");
        out.bytes.push(count as u8);
    }
    let step = f64::from(blueprint.fraction_bits).exp2();
    for point in &blueprint.points {
        out.place(point.map(|x| x * step))?;
    }
    for normal in &blueprint.normals {
        out.bytes.extend(normal.map(|x| (x * 127.0).round() as i8 as u8));
    }
    blueprint.triangles.iter().flatten().chain(&blueprint.fixed).for_each(|&index| out.index(index));
    for curve in &blueprint.curves {
        let flags = u8::from(curve.closed) | u8::from(curve.paired) << 1 | curve.detail << 2;
        let flags = flags | u8::from(curve.straight) << 4 | u8::from(curve.small) << 5 | u8::from(curve.filled) << 6;
        ensure!(curve.points.len() <= 255, "a curve of {} points; a model's have at most 255", curve.points.len());
        out.bytes.extend([flags, curve.shade, curve.points.len() as u8]);
        curve.points.iter().for_each(|&index| out.index(index));
    }
    for entry in &blueprint.openings {
        let opening = &entry.opening;
        let (release, drop) = entry.release.map_or((NO_SHAPE, 0.0), |(shape, drop)| (shape as u8, drop * step));
        out.bytes.extend([u8::from(opening.paired), release]);
        out.number(drop)?;
        let parts = [&opening.upper, &opening.lower, &opening.members];
        out.bytes.extend(parts.map(|part| part.len() as u8));
        parts.into_iter().flatten().for_each(|&index| out.index(index));
    }
    for shape in &blueprint.shapes {
        out.shape(blueprint, shape, step)?;
    }
    for drive in &blueprint.names {
        out.bytes.extend(model::hash(drive.name.as_bytes()).to_le_bytes());
        let [stored, mirrored] = drive.sides.map(u8::from);
        let (mantissa, exponent) = short_float(drive.gain);
        out.bytes.extend([drive.shape as u8 | stored << 6 | mirrored << 7, mantissa as u8, exponent as u8]);
    }
    Ok(out.bytes)
}

/// Numbers of the first points in the middle and of the first pairs that include every point that moves or is a member of an opening.
fn moving(blueprint: &Blueprint) -> [usize; 2] {
    let step = f64::from(blueprint.fraction_bits).exp2();
    let shapes = blueprint.shapes.iter();
    let moved = shapes.flat_map(|shape| deltas(shape, step).into_iter().map(|entry| entry.0).chain(members(shape)));
    let behind = blueprint.openings.iter().flat_map(|entry| entry.opening.members.iter().copied());
    let (middles, left) = (blueprint.middles, blueprint.middles + blueprint.pairs);
    moved.chain(behind).fold([0, 0], |[middle, pair], index| match index {
        index if index < middles => [middle.max(index + 1), pair],
        index if index < left => [middle, pair.max(index + 1 - middles)],
        index => [middle, pair.max(index + 1 - left)],
    })
}

fn members(shape: &Shape) -> impl Iterator<Item = usize> {
    shape.turns.iter().flat_map(|turn| turn.members.iter().map(|member| member.0))
}

/// A shape's deltas in units of its scale, without those that round to zero.
fn deltas(shape: &Shape, step: f64) -> Vec<(usize, [i8; 3])> {
    let unit = scale(shape, step) / 256.0;
    let far = shape.deltas.iter().filter(|(_, way)| way.iter().any(|x| (x * step).abs() >= LEAST));
    let whole = far.map(|&(index, way)| (index, way.map(|x| (x * step / unit).round() as i8)));
    let mut deltas: Vec<_> = whole.filter(|(_, way)| *way != [0; 3]).collect();
    deltas.sort_by_key(|entry| entry.0);
    deltas
}

/// Returns the closest mantissa * 2^exponent, with a mantissa of 7 bits and a sign.
pub fn short_float(value: f64) -> (i8, i8) {
    if value == 0.0 {
        return (0, 0);
    }
    let mut exponent = value.abs().log2().floor() as i32 - 6;
    if (value / f64::from(exponent).exp2()).round().abs() > 127.0 {
        exponent += 1;
    }
    ((value / f64::from(exponent).exp2()).round() as i8, exponent as i8)
}

struct Writer {
    bytes: Vec<u8>,
    wide: bool,
}

impl Writer {
    fn short(&mut self, value: usize) {
        self.bytes.extend((value as u16).to_le_bytes());
    }

    fn number(&mut self, value: f64) -> Result<()> {
        let rounded = value.round();
        ensure!((f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&rounded), "a place of {value} steps does not fit 16 bits");
        self.bytes.extend((rounded as i16).to_le_bytes());
        Ok(())
    }

    fn place(&mut self, place: [f64; 3]) -> Result<()> {
        place.into_iter().try_for_each(|x| self.number(x))
    }

    fn index(&mut self, index: usize) {
        if self.wide { self.short(index) } else { self.bytes.push(index as u8) }
    }

    fn shape(&mut self, blueprint: &Blueprint, shape: &Shape, step: f64) -> Result<()> {
        let interpolation = match shape.interpolation {
            Interpolation::Linear => 0,
            Interpolation::Eased => 1,
            Interpolation::Spherical => 2,
            Interpolation::ImprovedLinear => 3,
        };
        let kind = match shape.kind {
            ShapeKind::Unsigned => 0,
            ShapeKind::Signed => 4,
            ShapeKind::Head => 8,
        };
        let scale = scale(shape, step);
        ensure!(
            scale <= f64::from(u16::MAX),
            "the unit {} moves points too far for a model of {step} steps a unit of length",
            shape.name
        );
        let mut moved = Writer { bytes: Vec::new(), wide: self.wide };
        let deltas = deltas(shape, step);
        if shape.interpolation == Interpolation::Spherical && !deltas.is_empty() {
            let arc = shape.arc.with_context(|| {
                format!(
                    "the unit {} moves points without an axis: spherical interpolation needs a centre and an angle",
                    shape.name
                )
            })?;
            ensure!(
                (Arc::LEAST..=Arc::MOST).contains(&arc.degrees),
                "the unit {}: expected an angle from {} to {} degrees, not {}",
                shape.name,
                Arc::LEAST,
                Arc::MOST,
                arc.degrees
            );
            moved.place(arc.centre.map(|x| x * step))?;
            moved.number((arc.degrees / 360.0 * 65536.0).floor())?;
        }
        moved.runs(blueprint, &deltas);
        let mut turns = Writer { bytes: Vec::new(), wide: self.wide };
        for turn in &shape.turns {
            turns.turn(blueprint, turn, step)?;
        }
        ensure!(moved.bytes.len() <= usize::from(u16::MAX), "the shape {} moves too many points", shape.name);
        self.bytes.push(interpolation | kind);
        self.short(scale as usize);
        self.short(moved.bytes.len());
        self.short(turns.bytes.len());
        self.bytes.extend(moved.bytes);
        self.bytes.extend(turns.bytes);
        Ok(())
    }

    fn runs(&mut self, blueprint: &Blueprint, deltas: &[(usize, [i8; 3])]) {
        for run in runs(blueprint, deltas) {
            self.index(run[0].0);
            self.bytes.push(run.len() as u8);
            self.bytes.extend(run.iter().flat_map(|(_, way)| way.map(|x| x as u8)));
        }
    }

    fn turn(&mut self, blueprint: &Blueprint, turn: &Turn, step: f64) -> Result<()> {
        let mut members: Vec<(usize, u8)> =
            turn.members.iter().map(|&(index, part)| (index, (part * 255.0).round() as u8)).collect();
        members.sort_by_key(|entry| entry.0);
        let mut parts = Vec::new();
        for run in runs(blueprint, &members) {
            parts.extend(run.chunk_by(|a, b| a.1 == b.1).map(|same| (same[0].0, same.len(), same[0].1)));
        }
        ensure!(parts.len() <= 255, "too many members of a turn");
        self.bytes.extend([turn.axis as u8, parts.len() as u8]);
        self.place(turn.centre.map(|x| x * step))?;
        self.number(turn.degrees / 360.0 * 65536.0)?;
        for (first, count, part) in parts {
            self.index(first);
            self.bytes.extend([count as u8, part]);
        }
        Ok(())
    }
}

/// Steps of a delta of 1, Q8, rounded up to a whole number so that the largest displacement is at most 127.
fn scale(shape: &Shape, step: f64) -> f64 {
    (shape.longest() * step / 127.0 * 256.0).ceil()
}

/// Runs of entries of consecutive points, at most 255 each, which do not cross the borders between middle, left and right.
fn runs<'e, T>(blueprint: &Blueprint, entries: &'e [(usize, T)]) -> Vec<&'e [(usize, T)]> {
    let borders = [blueprint.middles, blueprint.middles + blueprint.pairs];
    let runs = entries.chunk_by(move |a, b| b.0 == a.0 + 1 && !borders.contains(&b.0));
    runs.flat_map(|run| run.chunks(255)).collect()
}

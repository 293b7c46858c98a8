//! The text of a cartoon face, one statement a line.

use super::zoom::{Part, Zoom};
use crate::face::blueprint::{Blueprint, Curve};
use crate::face::head::Head;
use anyhow::{Context, Result, bail, ensure};
use pantin_face::shape::ShapeKind;
use std::collections::BTreeSet;

/// A filled shape on both sides whose corners all lie in one place, so that it is invisible until a unit opens it.
pub(super) struct Hidden {
    /// Brightness, 0 to 255.
    pub shade: u8,
    /// The place of all corners on the left, in mm: aside, up.
    pub place: [f64; 2],
    /// Number of corners, 3 to 32.
    pub corners: usize,
}

/// A filled shape with corners of its own.
pub(super) struct Block {
    /// Brightness, 0 to 255.
    pub shade: u8,
    /// Whether it has a mirror image. Otherwise the places are its left half, which the mirror image completes.
    pub paired: bool,
    /// Whether it is drawn with straight edges at every size.
    pub straight: bool,
    /// The place of each corner on the left or in the middle, in mm: aside, up.
    pub places: Vec<[f64; 2]>,
}

/// How far a unit of the face moves the corners of a block.
pub(super) struct Move {
    /// Index of the unit among the face's shapes.
    pub unit: usize,
    /// Index of the block.
    pub block: usize,
    /// The way of each corner at full weight, in mm: aside, up.
    pub ways: Vec<[f64; 2]>,
}

/// A unit that moves the corners of a hidden shape to places on the left: one of its own, or one of the face. Several may open one shape.
pub(super) struct Prop {
    /// The unit's name.
    pub name: String,
    /// Index of the hidden shape.
    pub hidden: usize,
    /// The place of each corner, in mm: aside, up.
    pub places: Vec<[f64; 2]>,
}

/// The content of the text.
#[derive(Default)]
pub(super) struct Table {
    /// Statements that have been read and may stand once.
    read: BTreeSet<&'static str>,
    /// Half the width, the top and the bottom of the picture, in mm.
    pub view: [f64; 3],
    /// The part of the jaw's angle, 0 to 1.
    pub jaw: f64,
    /// The enlarged parts, each once.
    pub zooms: Vec<Zoom>,
    /// Units of the face, as indices of its shapes, that move points of the head farther or less far, and by what factor.
    pub gains: Vec<(usize, f64)>,
    /// Areas and lines, through points of the head.
    pub curves: Vec<Curve>,
    /// Shapes with corners of their own, and how units move these.
    pub blocks: Vec<Block>,
    /// Each unit moves a block once.
    pub moves: Vec<Move>,
    /// The hidden shapes, each opened by a prop.
    pub hidden: Vec<Hidden>,
    /// What opens hidden shapes.
    pub props: Vec<Prop>,
}

impl Table {
    /// Reads the text. Points are found in `head`; units of `face` cannot be props. Errors name the line.
    pub fn read(text: &str, head: &Head, face: &Blueprint) -> Result<Table> {
        let mut table = Table { jaw: 1.0, ..Table::default() };
        for (number, line) in text.lines().enumerate() {
            let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
            table.statement(&words, head, face).with_context(|| format!("line {}", number + 1))?;
        }
        table.complete()
    }

    /// Reads the words of one line.
    fn statement(&mut self, words: &[&str], head: &Head, face: &Blueprint) -> Result<()> {
        match *words {
            [] => Ok(()),
            ["view", width, top, bottom] => self.view([width, top, bottom]),
            ["jaw", part] => self.jaw(part),
            ["gain", name, factor] => self.gain(name, factor, face),
            ["zoom", name, factor, aside, up] => self.zoom(name, [factor, aside, up]),
            ["block", shade, options, ref places @ ..] => self.block(shade, options, places),
            ["move", name, number, ref ways @ ..] => self.moved(name, number, ways, face),
            ["hidden", shade, place, corners] => self.hidden(shade, place, corners),
            ["prop", name, number, ref places @ ..] => self.prop(name, number, places, face),
            ["fill", shade, options, ref points @ ..] => self.curve(true, shade, options, points, head),
            ["line", shade, options, ref points @ ..] => self.curve(false, shade, options, points, head),
            _ => bail!("expected view, jaw, zoom, gain, fill, line, block, move, hidden or prop"),
        }
    }

    fn view(&mut self, words: [&str; 3]) -> Result<()> {
        ensure!(self.read.insert("view"), "a second view");
        self.view = numbers(words)?;
        Ok(())
    }

    fn jaw(&mut self, part: &str) -> Result<()> {
        ensure!(self.read.insert("jaw"), "a second jaw");
        [self.jaw] = numbers([part])?;
        ensure!((0.0..=1.0).contains(&self.jaw), "expected a part from 0 to 1");
        Ok(())
    }

    fn zoom(&mut self, name: &str, words: [&str; 3]) -> Result<()> {
        let part = match name {
            "eye" => Part::Eye,
            "brow" => Part::Brow,
            "mouth" => Part::Mouth,
            _ => bail!("expected eye, brow or mouth, not {name}"),
        };
        ensure!(self.zooms.iter().all(|zoom| zoom.part != part), "a second zoom {name}");
        let [factor, aside, up] = numbers(words)?;
        ensure!((0.1..=10.0).contains(&factor), "expected a factor from 0.1 to 10");
        self.zooms.push(Zoom { part, factor, to: [aside, up] });
        Ok(())
    }

    fn gain(&mut self, name: &str, factor: &str, face: &Blueprint) -> Result<()> {
        let unit = unit(name, face)?;
        ensure!(self.gains.iter().all(|gain| gain.0 != unit), "a second gain {name}");
        let [factor] = numbers([factor])?;
        ensure!((0.0..=3.0).contains(&factor), "expected a factor from 0 to 3");
        self.gains.push((unit, factor));
        Ok(())
    }

    fn block(&mut self, shade: &str, options: &str, places: &[&str]) -> Result<()> {
        let (options, straight) = options.strip_suffix(",straight").map_or((options, false), |options| (options, true));
        let paired = is_paired(options)?;
        ensure!((if paired { 3 } else { 2 }..=32).contains(&places.len()), "expected 3 to 32 corners");
        let places = places.iter().map(|word| pair(word)).collect::<Result<Vec<_>>>()?;
        ensure!(
            places.iter().all(|place| place[0] >= 0.0),
            "a block lies on the left, or its left half does: aside is 0 or more"
        );
        self.blocks.push(Block { shade: shade.parse()?, paired, straight, places });
        Ok(())
    }

    fn moved(&mut self, name: &str, number: &str, ways: &[&str], face: &Blueprint) -> Result<()> {
        let number: usize = number.parse()?;
        let block = number.checked_sub(1).filter(|&index| index < self.blocks.len());
        let block = block.with_context(|| format!("no block {number} before it"))?;
        let corners = self.blocks[block].places.len();
        ensure!(ways.len() == corners, "block {number} has {corners} corners, not {}", ways.len());
        let unit = unit(name, face)?;
        ensure!(self.moves.iter().all(|other| (other.unit, other.block) != (unit, block)), "{name} moves block {number} already");
        let ways = ways.iter().map(|word| if *word == "." { Ok([0.0; 2]) } else { pair(word) }).collect::<Result<_>>()?;
        self.moves.push(Move { unit, block, ways });
        Ok(())
    }

    fn hidden(&mut self, shade: &str, place: &str, corners: &str) -> Result<()> {
        let (shade, corners) = (shade.parse()?, corners.parse()?);
        ensure!((3..=32).contains(&corners), "expected 3 to 32 corners");
        self.hidden.push(Hidden { shade, place: pair(place)?, corners });
        Ok(())
    }

    fn prop(&mut self, name: &str, number: &str, places: &[&str], face: &Blueprint) -> Result<()> {
        let number: usize = number.parse()?;
        let shape = number.checked_sub(1).and_then(|index| self.hidden.get(index));
        let corners = shape.with_context(|| format!("no hidden shape {number} before it"))?.corners;
        ensure!(places.len() == corners, "hidden shape {number} has {corners} corners, not {}", places.len());
        let is_unit = face.shapes.iter().any(|shape| shape.name == name && !shape.deltas.is_empty());
        ensure!(
            is_unit || face.names.iter().all(|drive| drive.name != name),
            "{name} is a name of the face, but no unit that moves points"
        );
        let places = places.iter().map(|word| pair(word)).collect::<Result<_>>()?;
        self.props.push(Prop { name: name.into(), hidden: number - 1, places });
        Ok(())
    }

    /// An area if it is `filled`, or a line.
    fn curve(&mut self, filled: bool, shade: &str, options: &str, points: &[&str], head: &Head) -> Result<()> {
        let paired = is_paired(options)?;
        let points = points.iter().map(|name| head.find(name)).collect::<Result<Vec<_>>>()?;
        ensure!(points.len() >= if filled { 3 } else { 2 }, "too few points");
        let shade = shade.parse()?;
        self.curves.push(Curve { detail: 0, shade, paired, closed: filled, straight: false, small: false, filled, points });
        Ok(())
    }

    /// The table after its last line. Fails without a view, without curves, and for hidden shapes without a prop.
    fn complete(self) -> Result<Table> {
        ensure!(self.read.contains("view"), "no line `view`");
        let [width, top, bottom] = self.view;
        ensure!(width > 0.0 && top > bottom, "view: expected a width above 0, and a top above the bottom");
        ensure!(!(self.curves.is_empty() && self.blocks.is_empty()), "nothing is drawn");
        let unopened = (0..self.hidden.len()).find(|index| self.props.iter().all(|prop| prop.hidden != *index));
        ensure!(unopened.is_none(), "no prop opens hidden shape {}", unopened.unwrap_or_default() + 1);
        Ok(self)
    }
}

/// The index of a unit that moves points.
fn unit(name: &str, face: &Blueprint) -> Result<usize> {
    let unit = face.shapes.iter().position(|shape| shape.name == name && shape.kind != ShapeKind::Head);
    unit.with_context(|| format!("the face has no unit {name} that moves points"))
}

fn is_paired(options: &str) -> Result<bool> {
    ensure!(["-", "paired"].contains(&options), "expected paired or -, found {options}");
    Ok(options == "paired")
}

/// A place in the picture: `aside,up`.
fn pair(word: &str) -> Result<[f64; 2]> {
    let (aside, up) = word.split_once(',').with_context(|| format!("{word}: expected aside,up"))?;
    numbers([aside, up])
}

fn numbers<const N: usize>(words: [&str; N]) -> Result<[f64; N]> {
    let mut out = [0.0; N];
    for (slot, word) in out.iter_mut().zip(words) {
        let number: f64 = word.parse().with_context(|| format!("{word} is no number"))?;
        ensure!(number.is_finite() && number.abs() < 200.0, "{word} is beyond 200 mm");
        *slot = number;
    }
    Ok(out)
}

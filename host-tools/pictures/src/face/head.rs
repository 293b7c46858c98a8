//! The neutral head, parsed from `head.txt`: named points, curves through them, openings.

use super::skin::{self, Triangle};
use anyhow::{Context, Result, bail, ensure};
use std::collections::HashMap;

/// The table of the head.
pub const TABLE: &str = include_str!("head.txt");

/// A position or a displacement in millimetres.
pub type Vector = [f64; 3];

/// A curve through points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// The lowest detail, 0 to 3, at which it is drawn.
    pub detail: u8,
    /// Brightness, 0 to 255.
    pub shade: u8,
    /// Whether its mirror image is drawn too.
    pub paired: bool,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// Whether it is drawn at detail 0 only.
    pub small: bool,
    /// Its points.
    pub points: Vec<usize>,
}

/// An opening, an eye or the mouth: its edges, and the points behind it.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Whether it has a mirror image.
    pub paired: bool,
    /// Points of the upper edge, from one corner to the other.
    pub upper: Vec<usize>,
    /// Points of the lower edge, between the same corners.
    pub lower: Vec<usize>,
    /// Points that the edges clip.
    pub members: Vec<usize>,
}

impl Opening {
    /// Returns whether a point is on its edges.
    pub fn edges(&self, point: usize) -> bool {
        self.upper.contains(&point) || self.lower.contains(&point)
    }
}

/// The neutral head. Points in the middle come first, then the left ones, then their mirror images.
#[derive(Clone, Debug)]
pub struct Head {
    /// Number of points in the middle.
    pub middles: usize,
    /// Number of points on the left.
    pub pairs: usize,
    /// Positions of all points.
    pub points: Vec<Vector>,
    /// Unit normals, pointing outwards.
    pub normals: Vec<Vector>,
    /// Triangles of the left half of the skin, anticlockwise seen from outside.
    pub triangles: Vec<Triangle>,
    /// Points that stay fixed when the head rotates.
    pub fixed: Vec<usize>,
    /// Curves in the order in which they are drawn.
    pub curves: Vec<Curve>,
    /// The eyes and the mouth.
    pub openings: Vec<Opening>,
    names: HashMap<String, usize>,
    labels: Vec<String>,
    /// Whether a stored point is skin, by index.
    skin: Vec<bool>,
}

/// A row of the table's points.
struct Row {
    name: String,
    features: [String; 2],
    place: Vector,
    normal: Option<Vector>,
    fixed: bool,
    skin: bool,
}

impl Head {
    /// Returns Pantin's own head.
    pub fn new() -> Head {
        // The table is part of the program, and tested.
        Head::parse(TABLE).expect("head.txt")
    }

    /// Parses a table.
    pub fn parse(table: &str) -> Result<Head> {
        let mut sections: HashMap<&str, Vec<(usize, &str)>> = HashMap::new();
        let mut section = "";
        for (number, line) in table.lines().enumerate() {
            let line = line.split('#').next().unwrap_or("").trim();
            if matches!(line, "skin" | "loose" | "skull" | "ears" | "curves" | "openings") {
                section = line;
            } else if !line.is_empty() {
                sections.entry(section).or_default().push((number + 1, line));
            }
        }
        let mut rows = Vec::new();
        for (name, skin) in [("skin", true), ("loose", false), ("skull", true), ("ears", false)] {
            for (number, line) in sections.remove(name).unwrap_or_default() {
                rows.push(Row::parse(line, skin).with_context(|| format!("line {number}"))?);
            }
        }
        // A stable sort: the table's order otherwise.
        rows.sort_by_key(|row| row.place[0] > 0.0);
        let mut head = Head::of_rows(&rows)?;
        for (number, line) in sections.remove("curves").unwrap_or_default() {
            let curve = head.parse_curve(line).with_context(|| format!("line {number}"))?;
            head.curves.push(curve);
        }
        for (number, line) in sections.remove("openings").unwrap_or_default() {
            let opening = head.parse_opening(line).with_context(|| format!("line {number}"))?;
            head.openings.push(opening);
        }
        head.dress(&rows);
        Ok(head)
    }

    fn of_rows(rows: &[Row]) -> Result<Head> {
        let middles = rows.iter().filter(|row| row.place[0] == 0.0).count();
        let pairs = rows.len() - middles;
        let right = rows[middles..].iter().map(|row| mirror(row.place));
        let points = rows.iter().map(|row| row.place).chain(right).collect();
        let (mut names, mut labels) = (HashMap::new(), Vec::new());
        for (index, row) in rows.iter().enumerate() {
            labels.push(row.name.clone());
            let image = if index < middles { index } else { index + pairs };
            let mut name = |name: &str, index: usize| -> Result<()> {
                if name == "-" || (image == index && name == row.name && index >= middles) {
                    return Ok(());
                }
                ensure!(names.insert(name.to_string(), index).is_none_or(|old| old == index), "two points are called {name}");
                Ok(())
            };
            name(&row.name, index)?;
            name(&row.features[0], index)?;
            name(&row.features[1], image)?;
            if image != index {
                name(&format!("-{}", row.name), image)?;
            }
        }
        labels.extend(rows[middles..].iter().map(|row| format!("-{}", row.name)));
        let fixed = rows.iter().enumerate().filter(|(_, row)| row.fixed).flat_map(|(index, _)| {
            let image = if index < middles { None } else { Some(index + pairs) };
            [Some(index), image].into_iter().flatten()
        });
        let fixed = fixed.collect();
        let skin = rows.iter().map(|row| row.skin).collect();
        let (normals, triangles, curves, openings) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Ok(Head { middles, pairs, points, normals, triangles, fixed, curves, openings, names, labels, skin })
    }

    /// Adds the skin's triangles, without those that close an opening, and all normals.
    fn dress(&mut self, rows: &[Row]) {
        let stored: Vec<usize> = (0..rows.len()).filter(|&index| self.skin[index]).collect();
        let mut triangles = skin::triangles(&self.points, &stored, self.middles);
        let closes = |triangle: &Triangle| {
            self.openings.iter().any(|opening| triangle.iter().all(|corner| opening.edges(*corner)))
                || triangle.iter().all(|corner| self.fixed.contains(corner))
        };
        triangles.retain(|triangle| !closes(triangle));
        self.triangles = triangles;
        self.normals = skin::normals(self);
        for (index, row) in rows.iter().enumerate() {
            let normal = match row.normal {
                Some(normal) => unit(normal),
                None if row.skin => continue,
                None => skin::normal_near(self, &stored, self.points[index]),
            };
            self.normals[index] = normal;
            let image = self.mirror(index);
            if image != index {
                self.normals[image] = mirror(normal);
            }
        }
    }

    /// Returns whether a point is part of the skin.
    pub fn is_skin(&self, index: usize) -> bool {
        self.skin[self.stored(index)]
    }

    /// The index of the stored point for a point or its mirror image.
    pub fn stored(&self, index: usize) -> usize {
        if index >= self.middles + self.pairs { index - self.pairs } else { index }
    }

    /// The index of the point that mirrors another.
    pub fn mirror(&self, index: usize) -> usize {
        match index {
            index if index < self.middles => index,
            index if index < self.middles + self.pairs => index + self.pairs,
            _ => index - self.pairs,
        }
    }

    /// Finds a point by its name or its MPEG-4 number; `-name` is the mirror image. Fails if there is none.
    pub fn find(&self, name: &str) -> Result<usize> {
        self.names.get(name).copied().with_context(|| format!("no point is called {name}"))
    }

    /// The feature points: MPEG-4 number and index.
    pub fn features(&self) -> impl Iterator<Item = (&str, usize)> {
        let numbered = |name: &str| {
            name.split_once('.').is_some_and(|(group, number)| [group, number].iter().all(|part| part.parse::<u8>().is_ok()))
        };
        self.names.iter().filter(move |(name, _)| numbered(name)).map(|(name, &index)| (name.as_str(), index))
    }

    /// The position of a point by name. Panics if there is none.
    pub fn at(&self, name: &str) -> Vector {
        self.points[self.find(name).expect("a point of head.txt")]
    }

    /// The name of a point.
    pub fn label(&self, index: usize) -> &str {
        &self.labels[index]
    }

    /// Parses a list of points; `|` appends the mirror images in reverse order.
    fn path(&self, words: &[&str]) -> Result<Vec<usize>> {
        let mut path = Vec::new();
        for word in words {
            if *word == "|" {
                let back: Vec<usize> =
                    path.iter().rev().map(|&index| self.mirror(index)).filter(|index| !path.contains(index)).collect();
                path.extend(back);
            } else {
                path.push(self.find(word)?);
            }
        }
        Ok(path)
    }

    fn parse_curve(&self, line: &str) -> Result<Curve> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, detail, shade, options, points @ ..] = &words[..] else {
            bail!("expected name, detail, brightness, options, points")
        };
        Ok(Curve {
            name: name.to_string(),
            detail: detail.parse()?,
            shade: shade.parse()?,
            paired: options.contains("paired"),
            closed: options.contains("closed"),
            small: options.contains("small"),
            points: self.path(points)?,
        })
    }

    fn parse_opening(&self, line: &str) -> Result<Opening> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, options, rest @ ..] = &words[..] else { bail!("expected name, options, points") };
        let parts: Vec<Vec<usize>> = rest.split(|word| *word == "/").map(|part| self.path(part)).collect::<Result<_>>()?;
        let [upper, lower, members] = <[Vec<usize>; 3]>::try_from(parts).ok().context("expected upper / lower / members")?;
        Ok(Opening { paired: options.contains("paired"), upper, lower, members })
    }
}

impl Default for Head {
    fn default() -> Self {
        Head::new()
    }
}

impl Row {
    fn parse(line: &str, skin: bool) -> Result<Row> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, features, x, y, z, rest @ ..] = &words[..] else { bail!("expected name, feature points, x, y, z") };
        let features = features.split_once('/').unwrap_or((features, "-"));
        let normal = match rest {
            ["normal", x, y, z] => Some([x.parse()?, y.parse()?, z.parse()?]),
            _ => None,
        };
        let place = [x.parse()?, y.parse()?, z.parse()?];
        let features = [features.0.to_string(), features.1.to_string()];
        let skin = skin && !rest.contains(&"loose");
        Ok(Row { name: name.to_string(), features, place, normal, fixed: rest.contains(&"fixed"), skin })
    }
}

/// The mirror image of a position or displacement.
pub fn mirror([x, y, z]: Vector) -> Vector {
    [-x, y, z]
}

/// Scales a vector to length 1.
pub fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt().max(1e-12);
    v.map(|x| x / length)
}

/// The dot product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a - b`.
pub fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + part * b`.
pub fn plus(a: Vector, b: Vector, part: f64) -> Vector {
    [a[0] + b[0] * part, a[1] + b[1] * part, a[2] + b[2] * part]
}

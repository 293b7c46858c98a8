//! Meshes of other programs: points of an .obj, and a glTF's morph targets as a model.

use super::action_units::shape;
use super::blueprint::{Blueprint, Drive, Shape};
use super::head::{Vector, cross, minus, plus, unit};
use anyhow::{Context, Error, Result, anyhow, bail, ensure};
use pantin_convert::import::mesh::{self, Mesh};
use pantin_convert::import::text::{number_in, quoted};
use pantin_convert::import::{self, Disk, Files};
use pantin_face::shape::Interpolation;
use std::fmt::Display;
use std::path::Path;

/// Maximum coordinate of a vertex of the device, in steps.
const MOST_STEPS: f64 = i16::MAX as f64;

/// The content of a text file with lines, and errors that name both.
struct Text<'a> {
    path: &'a Path,
    content: &'a str,
}

/// A line's number from 1, and its words.
type NumberedWords<'a> = (usize, Vec<&'a str>);

impl<'a> Text<'a> {
    fn new(path: &'a Path, content: &'a str) -> Result<Text<'a>> {
        let content = content.strip_prefix('\u{feff}').unwrap_or(content);
        let text = Text { path, content };
        let zero = (1..).zip(content.lines()).find(|(_, line)| line.contains('\0'));
        zero.map_or(Ok(text), |(line, _)| Err(Text { path, content }.error(line, "a NUL byte; expected text")))
    }

    /// `file:line: message`.
    fn error(&self, line: usize, message: impl Display) -> Error {
        anyhow!("{}:{line}: {message}", self.path.display())
    }

    /// The lines that have words; `#` begins a comment.
    fn lines(&self) -> impl Iterator<Item = NumberedWords<'a>> {
        let words = |line: &'a str| line.split('#').next().unwrap_or("").split_whitespace().collect::<Vec<_>>();
        (1..).zip(self.content.lines().map(words)).filter(|(_, words)| !words.is_empty())
    }

    /// The first three of `words`, which are the x, y and z of a point.
    fn point(&self, line: usize, words: &[&str]) -> Result<Vector> {
        let [x, y, z, ..] = words else { return Err(self.error(line, "expected x, y and z")) };
        let number = |word: &str| number_in(word.as_bytes()).map_err(|message| self.error(line, message));
        Ok([number(x)?, number(y)?, number(z)?])
    }
}

/// Reads the points of an .obj; errors name `path` and the line.
pub fn obj_points(path: &Path, text: &str) -> Result<Vec<Vector>> {
    let text = Text::new(path, text)?;
    let points = text.lines().filter(|(_, words)| words[0] == "v");
    points.map(|(line, words)| text.point(line, &words[1..])).collect()
}

/// Reads a mesh: an .obj, a .wfm (Candide), or the first mesh of a glTF.
pub fn mesh(path: &Path, files: &dyn Files) -> Result<Mesh> {
    let place = || path.display().to_string();
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    let read = match extension.as_deref() {
        Some("glb" | "gltf") => return mesh::read(path, files),
        Some("obj") => obj as fn(&Path, &str) -> Result<Mesh>,
        Some("wfm") => wfm,
        _ => bail!("{}: expected a mesh: .obj, .glb, .gltf or .wfm", place()),
    };
    // Comments of old files are in Latin-1.
    let mesh = read(path, &String::from_utf8_lossy(&import::read_from(files, path)?))?;
    ensure!(!mesh.points.is_empty() && !mesh.triangles.is_empty(), "{}: no triangles", place());
    Ok(mesh)
}

/// Reads points and faces of an .obj; faces of more than three corners become fans. Errors name `path` and the line.
pub fn obj(path: &Path, text: &str) -> Result<Mesh> {
    let points = obj_points(path, text)?;
    let text = Text::new(path, text)?;
    let mut triangles = Vec::new();
    for (line, words) in text.lines().filter(|(_, words)| words[0] == "f") {
        let corner = |word: &&str| -> Result<usize> {
            let index = word.split('/').next().and_then(|index| index.parse::<i64>().ok());
            let index =
                index.ok_or_else(|| text.error(line, format!("expected the number of a vertex, found {}", quoted(word))))?;
            // Numbers from 1; negative ones count from the end.
            let place = if index < 0 { (points.len() as i64).checked_add(index) } else { index.checked_sub(1) };
            let place = place.and_then(|place| usize::try_from(place).ok()).filter(|&place| place < points.len());
            place.ok_or_else(|| text.error(line, format!("no vertex {index}; there are {}", points.len())))
        };
        let corners = words[1..].iter().map(corner).collect::<Result<Vec<_>>>()?;
        if corners.len() < 3 {
            return Err(text.error(line, format!("a face of {} corners; expected 3 or more", corners.len())));
        }
        triangles.extend(corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]));
    }
    Ok(Mesh { points, triangles, ..Mesh::default() })
}

/// Reads the vertices and the faces of a Candide model. Errors name `path` and the line.
pub fn wfm(path: &Path, text: &str) -> Result<Mesh> {
    let text = Text::new(path, text)?;
    // Titles stand in comments: the number of the title's line, that of the count's, and the rows.
    let rows = |title: &str| -> Result<Vec<NumberedWords>> {
        let at = text.content.lines().position(|line| line.contains(title));
        let at = at.with_context(|| format!("{}: no `{title}`", path.display()))? + 1;
        let mut lines = text.lines().filter(|(line, _)| *line > at);
        let wrong = |line| text.error(line, format!("expected the number of rows of `{title}`"));
        let (line, count) = lines.next().ok_or_else(|| wrong(at))?;
        let count: usize = count[0].parse().map_err(|_| wrong(line))?;
        let rows: Vec<NumberedWords> = lines.take(count).collect();
        if rows.len() < count {
            return Err(text.error(line, format!("`{title}` has {} rows; its number says {count}", rows.len())));
        }
        Ok(rows)
    };
    let points = rows("VERTEX LIST:")?.iter().map(|(line, words)| text.point(*line, words)).collect::<Result<Vec<_>>>()?;
    let triangle = |(line, words): &NumberedWords| {
        let corner = |word: &str| {
            let place = word.parse().ok().filter(|&place: &usize| place < points.len());
            let wrong = || format!("expected a vertex of 0 to {}, found {}", points.len() - 1, quoted(word));
            place.ok_or_else(|| text.error(*line, wrong()))
        };
        let [a, b, c] = words[..] else { return Err(text.error(*line, "expected a face of three vertices")) };
        Ok([corner(a)?, corner(b)?, corner(c)?])
    };
    let triangles = match points.is_empty() {
        true => Vec::new(),
        false => rows("FACE LIST:")?.iter().map(triangle).collect::<Result<_>>()?,
    };
    Ok(Mesh { points, triangles, ..Mesh::default() })
}

/// Reads the points of a .glb that `pantin face export` wrote, in millimetres.
pub fn glb_points(path: &Path) -> Result<Vec<Vector>> {
    Ok(mesh::read(path, &Disk::default())?.points.iter().map(|place| place.map(|x| x * 1000.0)).collect())
}

/// Returns the first mesh of a glTF among `files` that has morph targets, one shape per target. All its points are stored, none is a mirror image.
pub fn model(path: &Path, files: &dyn Files) -> Result<Blueprint> {
    let mesh = mesh::read(path, files)?;
    ensure!(!mesh.targets.is_empty(), "{}: no mesh with morph targets", path.display());
    let shapes: Vec<Shape> = mesh.targets.iter().zip(&mesh.names).map(|(ways, name)| of_target(ways, name)).collect();
    let drive = |(index, name): (usize, &String)| Drive { name: name.clone(), shape: index, sides: [true, false], gain: 1.0 };
    let names = mesh.names.iter().enumerate().map(drive).collect();
    Ok(Blueprint {
        middles: mesh.points.len(),
        pairs: 0,
        fraction_bits: fraction_bits(&mesh),
        normals: normals(&mesh),
        outline: mesh.triangles.len(),
        triangles: mesh.triangles,
        points: mesh.points,
        shapes,
        names,
        ..Blueprint::default()
    })
}

/// A morph target as a shape.
pub fn of_target(ways: &[Vector], name: &str) -> Shape {
    Shape {
        deltas: ways.iter().copied().enumerate().filter(|(_, way)| *way != [0.0; 3]).collect(),
        ..shape(name, Interpolation::Linear, false)
    }
}

/// The finest step with which the sum of all targets fits 16 bits.
pub fn fraction_bits(mesh: &Mesh) -> i8 {
    let farthest = (0..mesh.points.len()).flat_map(|index| {
        let reach =
            |axis: usize| mesh.points[index][axis].abs() + mesh.targets.iter().map(|ways| ways[index][axis].abs()).sum::<f64>();
        [reach(0), reach(1), reach(2)]
    });
    let farthest = farthest.fold(1e-6, f64::max);
    (MOST_STEPS / farthest).log2().floor().clamp(-24.0, 24.0) as i8
}

/// Unit normals of the points of a mesh, means of the triangles around them weighted by area.
pub fn normals(mesh: &Mesh) -> Vec<Vector> {
    let mut sums = vec![[0.0; 3]; mesh.points.len()];
    for &corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.points[corner]);
        let normal = cross(minus(b, a), minus(c, a));
        corners.into_iter().for_each(|corner| sums[corner] = plus(sums[corner], normal, 1.0));
    }
    sums.into_iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_order_mark_hides_no_point() {
        let points = obj_points(Path::new("a.obj"), "\u{feff}v 1 2 3\nv 4 5 6\n").unwrap();
        assert_eq!(points, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    }
}

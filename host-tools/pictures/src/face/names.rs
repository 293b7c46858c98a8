//! Names of channels that drive the units: the units' own names, those of `names.txt`, and MPEG-4's parameters.

use super::blueprint::{Drive, Shape};
use anyhow::{Context, Result, ensure};

/// The table of names.
pub const TABLE: &str = include_str!("names.txt");

/// Returns the drives of `shapes`: each unit by its name and by its sides, and those of the table.
pub fn drives(shapes: &[Shape]) -> Result<Vec<Drive>> {
    let mut drives: Vec<Drive> = shapes.iter().enumerate().flat_map(|(index, shape)| own(index, shape)).collect();
    let units = drives.clone();
    for (number, line) in TABLE.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        if !line.is_empty() {
            drives.extend(parse(line, &units).with_context(|| format!("names.txt, line {}", number + 1))?);
        }
    }
    Ok(drives)
}

/// Returns the drives of those sums of the table whose units are all among `units`.
pub fn sums(units: &[Drive]) -> Vec<Drive> {
    let mut sums = Vec::new();
    for line in TABLE.lines() {
        let Some((name, sum)) = line.split('#').next().unwrap_or("").split_once('=') else { continue };
        let words: Vec<&str> = sum.split_whitespace().collect();
        let terms = words.chunks_exact(2).map(|pair| {
            let driven: Vec<&Drive> = units.iter().filter(|drive| drive.name == pair[0]).collect();
            let gain: f64 = pair[1].parse().ok()?;
            (!driven.is_empty()).then_some((driven, gain))
        });
        let Some(terms) = terms.collect::<Option<Vec<_>>>() else { continue };
        for (driven, gain) in terms {
            sums.extend(driven.into_iter().map(|drive| Drive { name: name.trim().into(), gain, ..drive.clone() }));
        }
    }
    sums
}

fn own(shape: usize, entry: &Shape) -> Vec<Drive> {
    let drive = |suffix: &str, sides| Drive { name: format!("{}{suffix}", entry.name), shape, sides, gain: 1.0 };
    match (entry.sided, goes_aside(&entry.name)) {
        (true, _) => vec![drive("", [true, true]), drive("_left", [true, false]), drive("_right", [false, true])],
        (false, true) => vec![drive("_left", [true, false]), drive("_right", [false, true])],
        // A head rotates once: by the weight of the stored side.
        (false, false) if entry.name.starts_with("head_") => vec![drive("", [true, false])],
        (false, false) => vec![drive("", [true, true])],
    }
}

/// Returns whether a unit moves to one side as a whole: its mirror image is the opposite movement.
pub fn goes_aside(name: &str) -> bool {
    matches!(name, "mouth_side" | "jaw_side")
}

/// `name = unit weight unit weight ...`
fn parse(line: &str, units: &[Drive]) -> Result<Vec<Drive>> {
    let (name, sum) = line.split_once('=').context("expected name = unit weight ...")?;
    let words: Vec<&str> = sum.split_whitespace().collect();
    ensure!(words.len().is_multiple_of(2), "expected a weight after each unit");
    let driven = words.chunks_exact(2).map(|pair| {
        let unit = units.iter().find(|drive| drive.name == pair[0]).with_context(|| format!("no unit is called {}", pair[0]))?;
        Ok(Drive { name: name.trim().into(), gain: pair[1].parse()?, ..unit.clone() })
    });
    driven.collect()
}

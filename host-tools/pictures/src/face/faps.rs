//! MPEG-4's facial animation parameters as weights of our units: the displacement of a feature point by the parameter, divided by that of the
//! full unit.

use super::blueprint::{Blueprint, Drive};
use super::exact;
use super::head::Head;
use anyhow::{Context, Result, bail};

const TABLE: &str = include_str!("faps.txt");
/// Parameter values per unit of length.
const PARTS: f64 = 1024.0;
/// Radians per unit of an angle parameter.
const ANGLE: f64 = 1e-5;

/// Returns the drives of all parameters, given a face with units and their names.
pub fn drives(head: &Head, face: &Blueprint) -> Result<Vec<Drive>> {
    let mut drives = Vec::new();
    for (number, line) in TABLE.lines().enumerate() {
        let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
        if let [name, unit, point, axis, part, driven] = words[..] {
            let part: f64 = part.parse()?;
            let driven =
                face.names.iter().find(|drive| drive.name == driven).with_context(|| format!("faps.txt, line {}", number + 1))?;
            let gain = part
                * if unit == "AU" {
                    angle(point, axis)?
                } else {
                    length(head, unit)? / PARTS / way(head, face, driven, point, axis)?
                };
            drives.push(Drive { name: name.into(), gain, ..driven.clone() });
            if name.contains("_l_") && unit != "AU" {
                let [stored, mirrored] = driven.sides;
                drives.push(Drive { name: name.replace("_l_", "_r_"), gain, sides: [mirrored, stored], shape: driven.shape });
            }
        } else if !words.is_empty() {
            bail!("faps.txt, line {}: expected six words", number + 1);
        }
    }
    Ok(drives)
}

fn angle(degrees: &str, sign: &str) -> Result<f64> {
    let whole = degrees.parse::<f64>()?.to_radians();
    Ok(if sign == "-" { -ANGLE / whole } else { ANGLE / whole })
}

/// MPEG-4's units of length on our neutral face, in millimetres.
fn length(head: &Head, unit: &str) -> Result<f64> {
    let eyes = [32.0, 0.6];
    Ok(match unit {
        "MNS" => head.at("9.15")[1] - head.at("2.2")[1],
        "MW" => 2.0 * head.at("8.3")[0],
        "ES" => 2.0 * eyes[0],
        "ENS" => eyes[1] - head.at("9.15")[1],
        "IRISD" => head.at("3.1")[1] - head.at("3.3")[1],
        _ => bail!("{unit} is no unit of length"),
    })
}

/// Displacement of a feature point along an axis (`+x`) at full weight of a unit, in mm.
fn way(head: &Head, face: &Blueprint, drive: &Drive, point: &str, axis: &str) -> Result<f64> {
    let mut weights = vec![[0.0; 2]; face.shapes.len()];
    weights[drive.shape] = drive.sides.map(|driven| f64::from(u8::from(driven)));
    let (index, (sign, axis)) = (head.find(point)?, axis.split_at(1));
    let along = match axis {
        "x" => 0,
        "y" => 1,
        _ => 2,
    };
    let moved = exact::places(face, &weights)[index][along] - head.points[index][along];
    Ok(if sign == "-" { -moved } else { moved })
}

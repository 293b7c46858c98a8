//! `pantin face compare`

use super::face_picture;
use crate::face::compare::{ACTIONS, Jaw, METHODS, deviation, jaw, write};
use crate::face::{Face, paper};
use crate::output::{check, is_json, outln, report, write_whole};
use anyhow::Result;
use serde_json::json;
use std::path::PathBuf;

/// Draw each of the paper's actions at 20, 50 and 80 % under the three interpolations, and measure how they differ.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  pantin face compare -o compare.png")]
pub struct Arguments {
    /// The picture to write (PNG); without it only the numbers are printed
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if let Some(output) = &arguments.output {
        face_picture(output, "face compare")?;
        check(&[], &[output])?;
    }
    let face = Face::new()?;
    let jaws = METHODS.iter().map(|&(method, name)| Ok((name, jaw(&face, method)?))).collect::<Result<Vec<_>>>()?;
    let of_action = |&(label, action)| {
        let pairs = [[0, 1], [0, 2], [1, 2]].map(|pair| pair.map(|index| METHODS[index].0));
        let cells = pairs.into_iter().map(|pair| deviation(&face, action, pair)).collect::<Result<Vec<_>>>()?;
        Ok((label, cells))
    };
    let actions = ACTIONS.iter().map(of_action).collect::<Result<Vec<_>>>()?;
    let angle = paper::opening_angle(&face.head);
    if is_json() {
        let jaw = |(name, jaw): &(_, Jaw)| json!({"method": name, "shortest": jaw.shortest, "longest": jaw.longest});
        let action = |(label, cells): &(_, Vec<(f64, f64)>)| {
            let cell = |cell: usize| json!({"mm": cells[cell].0, "weight": cells[cell].1});
            json!({"action": label, "linear_cosine": cell(0), "linear_spherical": cell(1), "cosine_spherical": cell(2)})
        };
        report(json!({
            "mouth_degrees": angle,
            "jaw_lengths": jaws.iter().map(jaw).collect::<Vec<_>>(),
            "distances": actions.iter().map(action).collect::<Vec<_>>(),
        }));
    } else {
        outln!("the mouth opens by {angle:.1} degrees; length of the jaw on the way, of that at rest:")?;
        for (name, jaw) in &jaws {
            outln!("  {name:10} {:6.2} to {:6.2} %", jaw.shortest * 100.0, jaw.longest * 100.0)?;
        }
        outln!("greatest distance of a point between two interpolations, mm (at the weight):")?;
        outln!("  {:10} {:>18} {:>18} {:>18}", "action", "linear-cosine", "linear-spherical", "cosine-spherical")?;
        for (label, cells) in &actions {
            let cells: Vec<String> = cells.iter().map(|(most, weight)| format!("{most:11.2} ({weight:.2})")).collect();
            outln!("  {label:10} {}", cells.join(" "))?;
        }
    }
    let Some(output) = &arguments.output else { return Ok(()) };
    let mut out = Vec::new();
    write(&mut out, &face)?;
    write_whole(output, &out)
}

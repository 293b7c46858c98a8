//! `pantin face compare`

use super::face_picture;
use crate::output::{check, is_json, outln, report, write_whole};
use anyhow::{Context, Result};
use pantin_pictures::face::compare::{Compared, Jaw, METHODS, TABLES, jaw, pictures, write};
use pantin_pictures::face::subject::Subject;
use pantin_pictures::face::{Face, action_units};
use serde_json::json;
use std::path::PathBuf;

/// Draw the paper's tables 3 and 4: each action at 20, 50 and 80 % under linear, improved linear and spherical interpolation, with the start, the end, and how far
/// the pictures differ from linear.
///
/// The numbers are those of the vertices that are drawn.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  pantin face compare -o compare.png")]
pub struct Arguments {
    /// The picture to write (PNG); without it only the numbers are printed
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The angle of a unit's spherical interpolation in degrees, 2 to 120, instead of that between its start and its end; may be given several times
    #[arg(long, value_name = "UNIT=DEGREES")]
    angle: Vec<String>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if let Some(output) = &arguments.output {
        face_picture(output, "face compare")?;
        check(&[], &[output])?;
    }
    let mut face = Face::new()?;
    let choice = |angle: &String| {
        let (unit, degrees) = angle.split_once('=').with_context(|| format!("{angle}: expected unit=degrees"))?;
        Ok(format!("{unit}=spherical:{degrees}"))
    };
    face.blueprint.choose_all(&arguments.angle.iter().map(choice).collect::<Result<Vec<_>>>()?)?;
    let jaws = METHODS.iter().map(|&(method, name)| Ok((name, jaw(&face, method)?))).collect::<Result<Vec<_>>>()?;
    let rows = TABLES.iter().flat_map(|table| table.actions.iter().map(move |action| (table, action)));
    let rows = rows.map(|(table, action)| Ok((table, action, pictures(&face, action)?.cells))).collect::<Result<Vec<_>>>()?;
    let angle = action_units::opening_angle(&Subject::of_head(&face.head));
    if is_json() {
        let jaw = |(name, jaw): &(_, Jaw)| json!({"method": name, "shortest": jaw.shortest, "longest": jaw.longest});
        let cell = |cell: &Compared| {
            let method = METHODS[cell.method].1;
            json!({"weight": cell.weight, "method": method, "mm": cell.deviation.mm, "pixels": cell.deviation.pixels})
        };
        let row = |(table, action, cells): &(
            &pantin_pictures::face::compare::Table,
            &pantin_pictures::face::compare::Action,
            Vec<Compared>,
        )| json!({"table": table.title, "action": action.label, "from_linear": cells.iter().map(cell).collect::<Vec<_>>()});
        report(json!({
            "mouth_degrees": angle,
            "jaw_lengths": jaws.iter().map(jaw).collect::<Vec<_>>(),
            "rows": rows.iter().map(row).collect::<Vec<_>>(),
        }));
    } else {
        outln!("the mouth opens by {angle:.1} degrees; length of the jaw while it opens, of that at rest:")?;
        for (name, jaw) in &jaws {
            outln!("  {name:15} {:6.2} to {:6.2} %", jaw.shortest * 100.0, jaw.longest * 100.0)?;
        }
        outln!("largest distance of a drawn vertex from linear interpolation, mm (pixels of the picture):")?;
        outln!("  {:7}  {:16} {:>4}  {:>15} {:>15}", "", "action", "%", METHODS[1].1, METHODS[2].1)?;
        for (table, action, cells) in &rows {
            for three in cells.chunks(METHODS.len()) {
                let number = |cell: &Compared| format!("{:.2} ({:.1})", cell.deviation.mm, cell.deviation.pixels);
                let [improved, spherical] = [&three[1], &three[2]].map(number);
                let percent = three[0].weight * 100.0;
                outln!("  {:7}  {:16} {percent:4.0}  {improved:>15} {spherical:>15}", table.title, action.label)?;
            }
        }
    }
    let Some(output) = &arguments.output else { return Ok(()) };
    let mut out = Vec::new();
    write(&mut out, &face)?;
    write_whole(output, &out)
}

//! `pantin face fit`

use crate::cmd::Files;
use crate::cmd::render::Moment;
use crate::face::{Face, fit, outside};
use crate::input;
use crate::output::{is_json, outln, report};
use anyhow::{Context, Result, bail, ensure};
use pantin::{ChannelState, Player};
use pantin_face::{Binding, Morph, VERTICES, Weights};
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// Weights below it are left out of what is printed.
const LEAST: f64 = 0.005;

/// Find the units whose sum is closest to a face, and print the residual.
///
/// The face is a pose of Pantin's own mesh (an edited .obj or .glb of `pantin face export`) or a frame of a clip.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face fit joy.obj
  pantin face fit talk.ptn --frame 120")]
pub struct Arguments {
    /// The face: .obj, .glb or a clip
    target: PathBuf,
    /// The frame of a clip: a number, or seconds as in 1.5s [default: 0]
    #[arg(long, value_name = "MOMENT")]
    frame: Option<Moment>,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let face = Face::new()?;
    let path = &arguments.target;
    let place = || path.display().to_string();
    let extension = path.extension().and_then(|extension| extension.to_str());
    let of_clips = arguments.frame.map(|_| "--frame").or(arguments.rig.as_ref().map(|_| "--rig"));
    if let Some(option) = of_clips.filter(|_| extension != Some("ptn")) {
        bail!("{}: {option} is for clips (.ptn)", place());
    }
    let target = match extension {
        Some("obj") => outside::obj_points(&String::from_utf8(input::read(path)?).with_context(place)?).with_context(place)?,
        Some("glb" | "gltf") => outside::glb_points(path)?,
        Some("ptn") => frame(arguments, &face)?,
        _ => bail!("{}: expected an .obj, a .glb or a clip (.ptn)", place()),
    };
    let fit = fit::fit(&face.blueprint, &target).with_context(place)?;
    if is_json() {
        let units: Map<String, Value> =
            face.blueprint.shapes.iter().zip(&fit.pairs).map(|(shape, pair)| (shape.name.to_string(), json!(pair))).collect();
        report(json!({
            "units": units,
            "residual_mm": fit.residual,
            "neutral_residual_mm": fit.before,
            "worst_mm": fit.worst.0,
            "worst_vertex": face.head.label(fit.worst.1).to_string(),
        }));
        return Ok(());
    }
    for (shape, pair) in face.blueprint.shapes.iter().zip(&fit.pairs) {
        match *pair {
            [left, right] if left == right && left.abs() >= LEAST => outln!("{:24} {left:6.3}", shape.name)?,
            _ => {
                for (side, weight) in ["left", "right"].iter().zip(pair).filter(|(_, weight)| weight.abs() >= LEAST) {
                    outln!("{:24} {weight:6.3}", format!("{}_{side}", shape.name))?;
                }
            }
        }
    }
    outln!("residual {:.3} mm (root mean square; {:.3} mm from the neutral face)", fit.residual, fit.before)?;
    outln!("worst {:.3} mm at {}", fit.worst.0, face.head.label(fit.worst.1))?;
    Ok(())
}

/// The face at a clip's frame, as the device has it.
fn frame(arguments: &Arguments, face: &Face) -> Result<Vec<[f64; 3]>> {
    let place = || arguments.target.display().to_string();
    let files = Files::read(&arguments.target, arguments.rig.as_deref())?;
    let clip = files.open_alone().with_context(place)?;
    let frame = arguments
        .frame
        .unwrap_or(Moment::Frame(0))
        .frame(clip.frames(), f64::from(clip.frame_time_ns()) * 1e-9)
        .with_context(place)?;
    let model = face.model()?;
    let binding = Binding::new(&clip.rig(), &model);
    ensure!(binding.driving() > 0, "{}: no channel bears a name that the face knows; docs/FACE.md lists them", place());
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    player.seek(frame);
    let mut weights = Weights::new();
    binding.read(player.pose().values, &mut weights);
    let mut morph = Morph::<VERTICES>::new(&model)?;
    morph.apply_unclipped(&model, &weights);
    let step = f64::from(model.step_exponent()).exp2();
    Ok(morph.vertices().iter().map(|place| place.map(|x| f64::from(x) * step)).collect())
}

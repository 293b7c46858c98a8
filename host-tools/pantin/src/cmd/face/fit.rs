//! `pantin face fit`

use crate::cmd::Files;
use crate::cmd::render::Moment;
use crate::memory;
use crate::output::{Wanted, check, is_json, outln, progress, refuse_foreign, report, write_whole};
use anyhow::{Context, Result, bail, ensure};
use pantin::{ChannelState, Player};
use pantin_convert::expand::expand_within;
use pantin_convert::import;
use pantin_convert::motion::Motion;
use pantin_face::{Binding, Morph, VERTICES, Weights};
use pantin_pictures::face::fit::{Fit, LEAST};
use pantin_pictures::face::head::{Vector, plus};
use pantin_pictures::face::{Face, exact, fit, outside, points, pose};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// Find the few units whose sum is closest to a face, or to each frame of a moving face, and print the residuals.
///
/// A face is a pose of Pantin's own mesh (an edited .obj or .glb of `pantin face export`), a frame of a clip, or with --points a pose of any mesh. A moving face is
/// a folder of .obj files, a clip, any motion that drives the face (Live Link Face, MPEG-4 FAP, .keys), or with --points a glTF whose animation weights morph targets.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face fit joy.obj
  pantin face fit talk.ptn --frame 120
  pantin face fit recording.fap -o recording.keys --units paper
  pantin face fit smile.obj --neutral robot.obj --points robot.points
  pantin face fit poses/ -o poses.keys --most 5 --fps 25")]
pub struct Arguments {
    /// The face: .obj, .glb, a clip, a motion, or a folder of .obj
    target: PathBuf,
    /// The frame of a clip: a number, or seconds as in 1.5s [default: 0]
    #[arg(long, value_name = "MOMENT", conflicts_with = "output")]
    frame: Option<Moment>,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
    /// Fit every frame and write their weights as key-frame text (.keys)
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// The units that may be used
    #[arg(long, value_enum, default_value = "all")]
    units: Units,
    /// The most weights; sides that move alike have one
    #[arg(long, default_value_t = 8)]
    most: usize,
    /// Feature points of another mesh: lines of an MPEG-4 number and a vertex, or an .fdp of xface
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// The other mesh in its neutral pose; without it the first .obj of a folder, or the glTF itself
    #[arg(long, value_name = "MESH", requires = "points")]
    neutral: Option<PathBuf>,
    /// Frames a second of a folder of .obj files
    /// [default: 30]
    #[arg(long)]
    fps: Option<f64>,
}

/// Frames a second of a folder.
const FPS: f64 = 30.0;

/// Units that a fit may use.
#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Units {
    /// Units 1 to 5 of the paper, and its wider smile
    Paper,
    /// Those of Pantin too
    All,
}

/// Poses of some of the face's vertices, frame by frame.
struct Poses {
    rows: Vec<Vec<(usize, Vector)>>,
    fps: f64,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let face = Face::new()?;
    let path = &arguments.target;
    let place = || path.display().to_string();
    if let Some(output) = &arguments.output {
        refuse_foreign(output, Wanted::Keys)?;
        check(&[path], &[output])?;
    }
    let extension = extension(path);
    let of_clips = arguments.frame.map(|_| "--frame").or(arguments.rig.as_ref().map(|_| "--rig"));
    if let Some(option) = of_clips.filter(|_| extension.as_deref() != Some("ptn")) {
        bail!("{}: {option} is for clips (.ptn)", place());
    }
    ensure!(arguments.most >= 1, "--most: expected 1 or more");
    ensure!(arguments.fps.is_none_or(|fps| fps.is_finite() && fps > 0.0), "--fps: expected a rate above 0");
    ensure!(arguments.fps.is_none() || path.is_dir(), "{}: --fps is for a folder of .obj files", place());
    let limits = fit::Limits { paper: arguments.units == Units::Paper, most: arguments.most };
    let poses = poses(arguments, &face, extension.as_deref())?;
    ensure!(
        poses.rows.len() == 1 || arguments.output.is_some(),
        "{}: {} frames; give -o FILE.keys for their weights",
        place(),
        poses.rows.len()
    );
    let bar = progress(poses.rows.len() as u64, "fitting {wide_bar} {percent} % {eta} left")?;
    let fit = |rows: &Vec<_>| fit::fit_rows(&face.blueprint, rows, limits).inspect(|_| bar.inc(1));
    let fits = poses.rows.par_iter().map(fit).collect::<Result<Vec<_>>>();
    bar.finish_and_clear();
    let fits = fits.with_context(place)?;
    let Some(output) = &arguments.output else { return print(&face, &fits[0]) };
    // Sides that move alike have one weight.
    let of_shape = |pair: &[f64; 2]| match pair.iter().filter(|weight| weight.abs() >= LEAST).count() {
        2 if (pair[0] - pair[1]).abs() < LEAST => 1,
        sides => sides,
    };
    let used = |fit: &Fit| fit.pairs.iter().map(of_shape).sum::<usize>();
    let frames = || fits.iter().enumerate();
    if is_json() {
        let frame = |(frame, fit): (usize, &Fit)| json!({"frame": frame, "weights": used(fit), "residual_mm": fit.residual, "neutral_residual_mm": fit.before, "worst_mm": fit.worst.0});
        report(json!({"frames": frames().map(frame).collect::<Vec<_>>()}));
    } else {
        outln!("frame  weights  residual  neutral    worst (mm)")?;
        for (frame, fit) in frames() {
            let worst = face.head.label(fit.worst.1);
            outln!("{frame:5}  {:7}  {:8.3} {:8.3} {:8.3} at {worst}", used(fit), fit.residual, fit.before, fit.worst.0)?;
        }
    }
    write_whole(output, fit::keys(&face.blueprint, &fits, poses.fps, &format!("Weights fitted to {}.", place())).as_bytes())
}

fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase)
}

fn obj(path: &Path) -> Result<Vec<Vector>> {
    let text = String::from_utf8(memory::read(path)?).with_context(|| path.display().to_string())?;
    outside::obj_points(path, &text)
}

/// The .obj files of a folder by name.
fn objs(folder: &Path) -> Result<Vec<PathBuf>> {
    let place = || folder.display().to_string();
    let mut paths = std::fs::read_dir(folder).with_context(place)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    // A pipe or a device in a folder was not asked for, and may never end.
    paths.retain(|path| extension(path).as_deref() == Some("obj") && path.is_file());
    paths.sort();
    ensure!(!paths.is_empty(), "{}: no .obj files", place());
    Ok(paths)
}

/// What is fitted.
fn poses(arguments: &Arguments, face: &Face, extension: Option<&str>) -> Result<Poses> {
    let path = &arguments.target;
    let place = || path.display().to_string();
    let own = |places: Vec<Vector>| -> Result<Vec<(usize, Vector)>> {
        let (found, wanted) = (places.len(), face.blueprint.vertices());
        ensure!(found == wanted, "{}: {found} points; Pantin's face has {wanted}; other meshes need --points", place());
        Ok(places.into_iter().enumerate().collect())
    };
    if let Some(points) = &arguments.points {
        return of_others(arguments, face, extension, points);
    }
    let fps = arguments.fps.unwrap_or(FPS);
    let rows = match extension {
        _ if path.is_dir() => objs(path)?.iter().map(|path| own(obj(path)?)).collect::<Result<_>>()?,
        Some("obj") => vec![own(obj(path)?)?],
        Some("glb" | "gltf") => vec![own(outside::glb_points(path)?)?],
        Some("ptn") if arguments.output.is_none() => vec![own(frame(arguments, face)?)?],
        _ => return of_motion(arguments, face),
    };
    Ok(Poses { rows, fps })
}

/// Poses of Pantin's face that the scalars of a motion or a clip drive.
fn of_motion(arguments: &Arguments, face: &Face) -> Result<Poses> {
    let path = &arguments.target;
    let motion = match extension(path).as_deref() {
        Some("ptn") => {
            let files = Files::read(path, arguments.rig.as_deref())?;
            expand_within(&files.open_alone().with_context(|| path.display().to_string())?, memory::limit())?
        }
        _ => import::import(&memory::disk(), path, &import::ImportOptions::new().memory(memory::limit()))?.motion,
    };
    let scalars = motion.values.len() - motion.rig.scalars.len();
    let known = |name: &str| face.blueprint.names.iter().any(|drive| drive.name == name);
    let driving: Vec<(usize, &str)> =
        (scalars..).zip(motion.rig.scalars.iter().map(|scalar| scalar.name.as_str())).filter(|entry| known(entry.1)).collect();
    ensure!(!driving.is_empty(), "{}: no channel has a name that the face knows; docs/FACE.md lists them", path.display());
    let pose = |frame: usize| {
        let mut pairs = pose::parse(&face.blueprint, "")?;
        for &(channel, name) in &driving {
            pose::add(&face.blueprint, name, motion.values[channel][frame], &mut pairs)?;
        }
        pairs.iter_mut().for_each(|pair| *pair = pair.map(|weight| weight.clamp(-1.0, 1.0)));
        Ok(exact::places(&face.blueprint, &pairs).into_iter().enumerate().collect())
    };
    let rows = (0..motion.frames).map(pose).collect::<Result<_>>()?;
    Ok(Poses { rows, fps: rate(&motion) })
}

/// Frames a second, without the last digits that the file's rounded frame time leaves.
fn rate(motion: &Motion) -> f64 {
    (1e6 / motion.frame_time).round() / 1e6
}

/// Poses of another mesh, by its feature points.
fn of_others(arguments: &Arguments, face: &Face, extension: Option<&str>, points: &Path) -> Result<Poses> {
    let path = &arguments.target;
    let text = memory::read(points)?;
    let points = points::parse(&String::from_utf8_lossy(&text)).with_context(|| points.display().to_string())?;
    let paths = if path.is_dir() { objs(path)? } else { vec![path.clone()] };
    let files = memory::disk();
    let neutral = outside::mesh(arguments.neutral.as_ref().unwrap_or(&paths[0]), &files)?;
    for (name, &vertex) in &points {
        let count = neutral.points.len();
        ensure!(vertex < count, "feature point {name}: the mesh has {count} vertices, and no vertex {vertex}");
    }
    let matched = fit::Matched::new(&face.head, &neutral, &points)?;
    let rows = |pose: &[Vector]| matched.rows(&face.head, &neutral.points, pose);
    if !path.is_dir() && matches!(extension, Some("glb" | "gltf")) && !neutral.targets.is_empty() {
        let motion = import::import(&memory::disk(), path, &import::ImportOptions::new().memory(memory::limit()))?.motion;
        let first = motion.values.len() - motion.rig.scalars.len();
        // A scalar is called as its target, or ends with it.
        let target = |name: &str| neutral.names.iter().position(|target| name == target || name.ends_with(&format!(".{target}")));
        let driven: Vec<(usize, usize)> = motion
            .rig
            .scalars
            .iter()
            .enumerate()
            .filter_map(|(index, scalar)| Some((first + index, target(&scalar.name)?)))
            .collect();
        let pose = |frame: usize| {
            let mut places = neutral.points.clone();
            for &(channel, target) in &driven {
                for (place, way) in places.iter_mut().zip(&neutral.targets[target]) {
                    *place = plus(*place, *way, motion.values[channel][frame]);
                }
            }
            rows(&places)
        };
        let rows = (0..motion.frames).map(pose).collect::<Result<_>>()?;
        return Ok(Poses { rows, fps: rate(&motion) });
    }
    let rows = paths.iter().map(|path| rows(&outside::mesh(path, &files)?.points)).collect::<Result<_>>()?;
    Ok(Poses { rows, fps: arguments.fps.unwrap_or(FPS) })
}

/// Prints the weights of one face.
fn print(face: &Face, fit: &Fit) -> Result<()> {
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

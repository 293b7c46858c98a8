//! `pantin face export`

use crate::cmd::render::Size;
use crate::output::{check, write_whole};
use anyhow::{Result, bail, ensure};
use pantin_face::FaceView;
use pantin_images::image::Image;
use pantin_pictures::face::draw::picture;
use pantin_pictures::face::{Face, export, pose};
use pantin_pictures::render::figure::MOST_PIXELS;
use std::path::PathBuf;

/// Write the face: its mesh as .glb with one morph target per unit or as .obj, or a picture of it as .png.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face export -o face.glb
  pantin face export -o joy.obj --pose joy=0.7,wink_left
  pantin face export -o joy.png --pose joy --scale 4")]
pub struct Arguments {
    /// The file to write: .glb, .obj or .png
    #[arg(short, long)]
    output: PathBuf,
    /// Units and their weights instead of the neutral pose
    #[arg(long, default_value = "", value_name = "UNIT=WEIGHT,...")]
    pose: String,
    /// Columns and rows of a picture
    /// [default: 128x64]
    #[arg(long, value_name = "COLUMNSxROWS")]
    size: Option<Size>,
    /// Magnify each pixel of a picture N times
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64))]
    scale: Option<u16>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    check(&[], &[&arguments.output])?;
    let face = Face::new()?;
    let pairs = pose::parse(&face.blueprint, &arguments.pose)?;
    let extension = arguments.output.extension().and_then(|extension| extension.to_str());
    let of_pictures = arguments.size.as_ref().map(|_| "--size").or(arguments.scale.map(|_| "--scale"));
    if let (Some(option), Some("glb" | "obj")) = (of_pictures, extension) {
        bail!("{}: {option} is for pictures (.png)", arguments.output.display());
    }
    let bytes = match extension {
        Some("glb") => export::glb(&face, &pairs)?,
        Some("obj") => export::obj(&face, &pairs)?.into_bytes(),
        Some("png") => png(arguments, &face, &pairs)?,
        _ => bail!("{}: expected a name that ends in .glb, .obj or .png", arguments.output.display()),
    };
    write_whole(&arguments.output, &bytes)
}

/// The face as a display of this size shows it.
fn png(arguments: &Arguments, face: &Face, pairs: &pose::Pairs) -> Result<Vec<u8>> {
    let [width, height] = arguments.size.as_ref().map_or([128, 64], |size| size.0);
    ensure!(width.max(height) <= MOST_PIXELS, "--size {width}x{height}: displays of pixels have at most {MOST_PIXELS} a side");
    let canvas = pantin_figure::Canvas { width: width as u16, height: height as u16 };
    let greys = picture(&face.model()?, &pose::weights(pairs), canvas, FaceView::default());
    let mut out = Vec::new();
    let image = Image::of(width, greys.into_iter().map(|grey| [grey; 3]).collect());
    image.enlarged(usize::from(arguments.scale.unwrap_or(1))).write_png(&mut out)?;
    Ok(out)
}

//! `cargo xtask gallery`: every captured clip converted, expanded, compared and drawn on one sheet.
//!
//! Bodies keep 1 cm, or 0.5 % of their height where that is no person's and their unit means nothing; scalars keep 2 %.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use harness::{build, paths};
use pantin_convert::expand::expand;
use pantin_convert::import::{self, units};
use pantin_convert::verify::{compare, shell_radius_cm};
use pantin_pictures::render::gallery::{self, Cell};
use pantin_tools::output::write_whole;

use xtask::steps::say;

/// What a file's name begins with, and the axis that its format has upwards.
const KINDS: [&str; 7] = ["bvh_", "amc_", "gltf_", "fbx_", "vrml_", "face_", "fap_"];
/// Endings of what lies beside motions: skeletons.
const BESIDE: [&str; 1] = ["asf"];
/// A figure of another height is no person in a known unit, in cm.
const PERSONS_CM: std::ops::Range<f64> = 60.0..400.0;
const SCALAR_PERCENT: f64 = 2.0;

/// Converts every captured clip and draws one contact sheet of all clips.
#[derive(Args)]
pub struct Gallery {
    /// The folder for the sheet and the clips
    #[arg(long, default_value = "target/gallery")]
    out: PathBuf,
    /// Only files whose names contain this
    #[arg(long)]
    only: Option<String>,
}

/// A line of the table.
struct Row {
    frames: usize,
    channels: usize,
    bytes: usize,
    error: String,
    cell: Cell,
}

impl Gallery {
    /// Converts, compares, draws; fails if a file did.
    pub fn run(self) -> Result<()> {
        let Some(data) = paths::data() else {
            bail!(
                "no motion clips: set PANTIN_DATA to the folder that holds the bvh_, amc_, gltf_, fbx_, vrml_, face_ and fap_ files"
            );
        };
        let files = self.files(&data)?;
        ensure!(!files.is_empty(), "{}: no file to show", data.display());
        let out = paths::root().join(&self.out);
        fs::create_dir_all(&out).with_context(|| format!("cannot make {}", out.display()))?;
        let tool = build::host_tool()?;
        let wide = files.iter().map(|path| name(path).len()).max().unwrap_or(0);
        println!("{:wide$} {:>7} {:>8} {:>8}  {:44} ok", "file", "frames", "channels", "bytes", "greatest error");
        let mut cells = Vec::new();
        let mut failed = 0;
        for path in &files {
            let file = name(path);
            let made = if import::is_motion(path) { one(&tool, path, &out) } else { Err(anyhow::anyhow!("no importer for it")) };
            match made {
                Ok(row) => {
                    println!("{file:wide$} {:7} {:8} {:8}  {:44} yes", row.frames, row.channels, row.bytes, row.error);
                    cells.push(row.cell);
                }
                Err(error) => {
                    failed += 1;
                    println!("{file:wide$} NO: {error:#}");
                    cells.push(Cell::without(format!("{file}: not converted")));
                }
            }
        }
        let mut sheet = Vec::new();
        gallery::write(&mut sheet, &cells)?;
        write_whole(&out.join("gallery.png"), &sheet)?;
        say(&format!("wrote {}", out.join("gallery.png").display()));
        ensure!(failed == 0, "{failed} of {} files failed", files.len());
        Ok(())
    }

    fn files(&self, data: &Path) -> Result<Vec<PathBuf>> {
        let mut paths: Vec<PathBuf> = fs::read_dir(data)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
        paths.sort();
        paths.retain(|path| !BESIDE.iter().any(|ending| path.extension().is_some_and(|extension| extension == *ending)));
        let wanted = |path: &PathBuf| self.only.as_ref().is_none_or(|part| name(path).contains(part));
        let known = |path: &PathBuf| KINDS.iter().any(|begin| name(path).starts_with(begin));
        Ok(paths.into_iter().filter(wanted).filter(known).collect())
    }
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Converts by the program, expands by the library, and compares with what the importer reads.
fn one(tool: &Path, path: &Path, out: &Path) -> Result<Row> {
    let motion = import::load(path, &import::ImportOptions::new())?.motion;
    let height = units::figure_height_cm(&motion);
    let (bound, text) = match height {
        Some(height) if !PERSONS_CM.contains(&height) => (0.005 * height, "0.5%"),
        _ => (1.0, "1cm"),
    };
    let clip = out.join(name(path)).with_extension("ptn");
    let done = Command::new(tool)
        .arg("convert")
        .arg(path)
        .arg("-o")
        .arg(&clip)
        .args(["--quiet", "--segments", "--max-error", text])
        .output()?;
    ensure!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr).trim());
    let bytes = fs::read(&clip)?;
    let opened = pantin::Clip::new_checked(&bytes)?;
    let report = compare(&motion, &expand(&opened)?, shell_radius_cm(&motion))?;
    let percent =
        height.map_or(String::new(), |height| format!(" ({:.2} % of the height)", 100.0 * report.shell_cm.error / height));
    let mut errors = Vec::new();
    if !motion.rig.joints.is_empty() {
        errors.push(format!("{:.3} cm{percent}", report.shell_cm.error));
    }
    if !motion.rig.scalars.is_empty() {
        errors.push(format!("{:.2} % of scale", 100.0 * report.max_scalar));
    }
    let error = errors.join(", ");
    ensure!(report.shell_cm.error <= bound && 100.0 * report.max_scalar <= SCALAR_PERCENT, "expanded, it is off by {error}");
    let label = format!("{}  {} frames, {} bytes, {error}", name(path), motion.frames, bytes.len());
    let cell = Cell::of(&opened, label)?;
    Ok(Row { frames: motion.frames, channels: motion.rig.channels(), bytes: bytes.len(), error, cell })
}

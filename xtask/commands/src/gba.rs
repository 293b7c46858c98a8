//! `cargo xtask gba [--clip FILE]... [--solid] [--meet] [-o OUT]`: a cartridge image for the Game Boy Advance.
//!
//! ```text
//! $ cargo xtask gba
//! pantin.gba: 118,640 bytes, 58 clips. Emulators play it as it is; for a console put the missing logo into its header: gbafix pantin.gba
//! ```

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::clips::Drawn;
use harness::{clips, gba};
use pantin_tools::output::write_whole;

/// Makes a cartridge image for the Game Boy Advance, with all our motions
#[derive(Args)]
pub struct Gba {
    /// A clip or a bank to build in instead of our motions; may be given several times
    #[arg(long, value_name = "FILE")]
    clip: Vec<PathBuf>,
    /// Draw bodies with volume, with 30 pictures per second
    #[arg(long)]
    solid: bool,
    /// Let the steered character meet another one, which reacts to it, with 20 pictures per second
    #[arg(long)]
    meet: bool,
    /// The file
    #[arg(short, value_name = "OUT", default_value = "pantin.gba")]
    out: PathBuf,
}

impl Gba {
    /// Builds the program and writes the file.
    pub fn run(self) -> Result<()> {
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let (features, drawn) = if self.solid { (gba::SOLID, Drawn::Solid) } else { (gba::LINES, Drawn::Lines) };
        let clips = if self.clip.is_empty() { clips::own(folder.path(), drawn)? } else { self.clip };
        let features = if self.meet { format!("{features},meet") } else { features.into() };
        let image = gba::image(&features, &clips.iter().map(PathBuf::as_path).collect::<Vec<&Path>>())?;
        let most = if self.solid { gba::MOST_SOLID } else { gba::MOST };
        ensure!(image.len() <= most, "{} bytes; there is room for {most}", image.len());
        write_whole(&self.out, &image)?;
        let out = self.out.display();
        let advice = "Emulators play it as it is; a console also needs the logo in its header, which gbafix adds";
        println!("{out}: {} bytes. {advice}: gbafix {out}", image.len());
        Ok(())
    }
}

//! `cargo xtask images [BOARD]... [-o FOLDER]`: ready images of every board and display, with their sums and a page.
//!
//! ```text
//! $ cargo xtask images pico
//! pantin-pico-ssd1306.uf2: 96,204 bytes of flash
//! ...
//! target/images/index.html shows which file is for which wires
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use harness::download::{self, BOARDS, SETS};
use harness::{clips, paths};
use pantin_tools::output::write_whole;

use xtask::steps::say;

/// Makes a folder of images to flash, for every board and display, with SHA256SUMS and a page that shows the wires
#[derive(Args)]
pub struct Images {
    /// Boards to make images for [default: all]
    board: Vec<String>,
    /// The folder
    #[arg(short, value_name = "FOLDER", default_value = "target/images")]
    out: PathBuf,
}

impl Images {
    /// Builds the images and writes the folder.
    pub fn run(self) -> Result<()> {
        let all = || BOARDS.iter().chain(&SETS);
        if let Some(name) = self.board.iter().find(|name| all().all(|board| board.name != **name)) {
            let there = all().map(|board| board.name).collect::<Vec<_>>().join(", ");
            bail!("there are no images for {name}, but for {there}");
        }
        let out = if self.out.is_absolute() { self.out } else { paths::root().join(self.out) };
        std::fs::create_dir_all(&out).with_context(|| format!("cannot make {}", out.display()))?;
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let clips = clips::own(folder.path(), clips::Drawn::Lines)?;
        let mut files = vec![];
        for board in all().filter(|board| self.board.is_empty() || self.board.iter().any(|name| name == board.name)) {
            for image in board.images() {
                let file = image.build(&clips)?;
                write_whole(&out.join(&file.name), &file.bytes)?;
                say(&format!("{}: {} bytes of flash", file.name, file.flash));
                files.push(file);
            }
        }
        write_whole(&out.join("SHA256SUMS"), download::sums(&files).as_bytes())?;
        let page = out.join("index.html");
        write_whole(&page, download::page(&files).as_bytes())?;
        say(&format!("{} shows which file is for which wires", page.display()));
        Ok(())
    }
}

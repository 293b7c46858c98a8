//! `cargo xtask web [-o target/web] [--inline CLIP] [--npm]`: the static site, ready for any server, and for `pantin serve`; and the npm packages.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use harness::paths;
use harness::web::{self, Size, npm};

use xtask::steps::say;

/// Builds the web page with its player and our clips, as static files for any web server or `pantin serve`.
#[derive(Args)]
pub struct Web {
    /// The output folder
    #[arg(short, long, default_value = "target/web")]
    out: PathBuf,
    /// Also writes CLIP's page in one file, NAME.html, with the player, its modules and the clip in it
    #[arg(long, value_name = "CLIP")]
    inline: Vec<PathBuf>,
    /// Also packs the npm packages into target/npm, and uses them in a project of their own
    #[arg(long)]
    npm: bool,
}

impl Web {
    /// Builds it and prints its sizes.
    pub fn run(self) -> Result<()> {
        web::build(&self.out, &self.inline)?;
        for names in [&web::PLAYER[..], &web::EXPORT, &web::FACE, &web::CHARACTER, &web::CONVERTER] {
            let sizes = web::sizes(&self.out, names);
            sizes.iter().for_each(|Size { name, bytes }| say(&format!("{name:<24} {bytes:>9} bytes")));
        }
        let out = self.out.display();
        say(&format!("wrote {out}; `cargo pantin serve --site {out}` shows it"));
        if self.npm { packages(&self.out) } else { Ok(()) }
    }
}

/// Packs the packages and uses them.
fn packages(site: &Path) -> Result<()> {
    let folder = paths::root().join("target/npm");
    let packed = npm::pack(site, &folder)?;
    for npm::Packed { name, file, sizes: [packed, whole] } in &packed {
        say(&format!("{name:<24} {packed:>9} bytes packed, {whole} bytes in {}", file.display()));
    }
    let npm::Checked { measured, places } = npm::check(&packed, site, &folder.join("check"))?;
    let [characters, joints] = ["characters", "joints"].map(|field| measured[field].as_u64().unwrap_or_default());
    let ms = measured["ms"].as_f64().unwrap_or_default();
    say(&format!("{characters} characters of {joints} joints are decoded and posed in {ms:.2} ms a frame"));
    say(&format!("the packages work in Node, with strict types, and in {}", places.join(", ")));
    if !places.iter().any(|place| place.contains("Firefox")) {
        say("not tried in Firefox, which is not installed");
    }
    Ok(())
}

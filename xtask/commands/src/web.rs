//! `cargo xtask web [-o target/web]`: the static site, ready for any server, and for `pantin serve`.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use harness::web::{self, Size};

use xtask::steps::say;

/// Builds the web page with its player and our clips, as static files for any web server or `pantin serve`.
#[derive(Args)]
pub struct Web {
    /// The output folder
    #[arg(short, long, default_value = "target/web")]
    out: PathBuf,
}

impl Web {
    /// Builds it and prints its sizes.
    pub fn run(self) -> Result<()> {
        web::build(&self.out)?;
        for names in [&web::PLAYER[..], &web::FACE, &web::CONVERTER] {
            let sizes = web::sizes(&self.out, names);
            sizes.iter().for_each(|Size { name, bytes }| say(&format!("{name:<24} {bytes:>9} bytes")));
        }
        let out = self.out.display();
        say(&format!("wrote {out}; `cargo pantin serve --site {out}` shows it"));
        Ok(())
    }
}

//! `cargo xtask web [-o target/web] [--no-docs] [--inline CLIP] [--npm] [--examples]`: the static site, ready for any server, and for `pantin serve`; and the npm packages.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};
use clap::Parser;
use pantin_tools::output::write_whole;
use pantin_tools::serve::Site;
use xtask::build::{self, Build};
use xtask::paths;
use xtask::steps::say;
use xtask_web::browsers::{self, Tried};
use xtask_web::npm;
use xtask_web::site::{self, Size};

/// Builds the web page with its player and our clips, as static files for any web server or `pantin serve`.
#[derive(Parser)]
#[command(name = "cargo xtask web", bin_name = "cargo xtask web")]
struct Web {
    /// The output folder
    #[arg(short, long, default_value = "target/web")]
    out: PathBuf,
    /// Leaves out the documentation, which is written to docs in the output folder
    #[arg(long)]
    no_docs: bool,
    /// Also writes CLIP's page in one file, NAME.html, with the player, its modules and the clip in it
    #[arg(long, value_name = "CLIP")]
    inline: Vec<PathBuf>,
    /// Also packs the site into target/site.pack, and builds target/site/release/pantin with it inside: `pantin serve` then needs no folder
    #[arg(long)]
    program: bool,
    /// Also packs the npm packages into target/npm, and uses them in a project of their own, and the page in Chromium, and in Firefox and WebKit if they are installed
    #[arg(long)]
    npm: bool,
    /// Also packs the npm packages, builds the examples with them (React, Vue, Svelte, Next.js, SvelteKit, Astro) and uses each in Chromium
    #[arg(long)]
    examples: bool,
}

fn main() -> ExitCode {
    match Web::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

impl Web {
    /// Builds it and prints its sizes.
    fn run(self) -> Result<()> {
        site::build(&self.out, &self.inline)?;
        for names in
            [&site::PLAYER[..], &site::OTHERS, &site::EXPORT, &site::FACE, &site::CHARACTER, &site::CONVERTER, &site::MACHINE]
        {
            let sizes = site::sizes(&self.out, names);
            sizes.iter().for_each(|Size { name, bytes }| say(&format!("{name:<24} {bytes:>9} bytes")));
        }
        let out = self.out.display();
        if !self.no_docs {
            docs(&self.out.join("docs"))?;
        }
        say(&format!("wrote {out}; `cargo pantin serve --site {out}` shows it"));
        if self.program {
            program(&self.out)?;
        }
        if !self.npm && !self.examples {
            return Ok(());
        }
        let folder = paths::root().join("target/npm");
        let packed = npm::pack(&self.out, &folder)?;
        for npm::Packed { name, file, sizes: [packed, whole] } in &packed {
            say(&format!("{name:<24} {packed:>9} bytes packed, {whole} bytes in {}", file.display()));
        }
        if self.examples {
            let built = npm::examples(&packed, &folder.join("examples"))?;
            say(&format!("the examples are built and work: {}", built.join(", ")));
        }
        if self.npm { packages(&packed, &self.out, &folder) } else { Ok(()) }
    }
}

/// Writes the documentation as a site, by the command that is a workspace of its own.
fn docs(out: &Path) -> Result<()> {
    let mut book = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    book.arg("run").arg("--manifest-path").arg(paths::root().join("xtask/book/Cargo.toml"));
    book.arg("--target-dir").arg(paths::root().join("target/book")).args(["--", "-o"]).arg(out);
    ensure!(book.status().context("cannot start cargo")?.success(), "cargo xtask book");
    Ok(())
}

/// Builds the host tool with the site inside.
fn program(site: &Path) -> Result<()> {
    let packed = Site::read(site)?.pack()?;
    let file = paths::root().join("target/site.pack");
    write_whole(&file, &packed)?;
    let program = build::cargo(&Build {
        workspace: paths::root(),
        arguments: ["--release", "--package", "pantin-tools", "--bin", "pantin", "--target-dir", "target/site"]
            .map(Into::into)
            .into(),
        environment: vec![("PANTIN_SITE".into(), file.into())],
        product: "pantin".into(),
        ..Build::default()
    })?;
    say(&format!("{} has the site inside, {} bytes", program.display(), packed.len()));
    Ok(())
}

/// Uses the packages, and the page, which has the same player.
fn packages(packed: &[npm::Packed], site: &Path, folder: &Path) -> Result<()> {
    let npm::Checked { measured, places } = npm::check(packed, site, &folder.join("check"))?;
    let [characters, joints] = ["characters", "joints"].map(|field| measured[field].as_u64().unwrap_or_default());
    let ms = measured["ms"].as_f64().unwrap_or_default();
    say(&format!("{characters} characters of {joints} joints are decoded and posed in {ms:.2} ms a frame"));
    say(&format!("the packages work in Node, with strict types, and in {}", places.join(", ")));
    let drawn = npm::pixels(&folder.join("check"))?;
    drawn.iter().for_each(|line| say(&format!("drawn by three.js as their own animation and as a clip: {line}")));
    if drawn.is_empty() {
        say("not compared with glTF's own animations: PANTIN_DATA names no captured clips");
    }
    let Tried { browsers, notes } = browsers::check(site)?;
    say(&format!("the page works in {}", browsers.join(", ")));
    notes.iter().for_each(|note| say(note));
    Ok(())
}

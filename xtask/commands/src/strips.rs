//! `cargo xtask strips [--board NAME] [--out DIR] [MOTION...]`: motions as the boards' displays show them, from the front, the side
//! and between.
//!
//! ```text
//! $ cargo xtask strips motions/run.keys
//! ```
//! leaves a picture for each board and motion, `strips/sx1-run.png`: two rows a view.

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::build::Firmware;
use harness::display::Picture;
use harness::qemu::{self, BOARDS, Launch, Machine};
use harness::sync::Session;
use harness::{clips, paths, setup};
use pantin::Clip;
use pantin_tools::output::write_whole;

use harness::pictures;
use xtask::steps::say;

/// Degrees about the figure, and their names.
const VIEWS: [(i16, &str); 3] = [(0, "front"), (-90, "side"), (-50, "three quarters")];
/// Pictures of a motion in a view.
const COUNT: u32 = 8;
/// And in a row of them.
const COLUMNS: usize = 4;
/// They are taken out of this time: a step or two.
const SECONDS: f64 = 1.4;
/// The longest that a board may play.
const LIMIT: Duration = Duration::from_secs(180);

/// Shows motions on the boards' displays from the front, the side and three quarters.
#[derive(Args)]
pub struct Strips {
    /// The motion files [default: our own walk and run, and a captured walk]
    motions: Vec<PathBuf>,
    /// The machine [default: all]
    #[arg(long)]
    board: Option<String>,
    /// The folder for the pictures
    #[arg(long, default_value = "strips")]
    out: PathBuf,
}

impl Strips {
    /// Converts, plays, writes the pictures.
    pub fn run(self) -> Result<()> {
        let boards = self.board.as_deref().map_or(Ok(BOARDS.to_vec()), |name| qemu::board(name).map(|board| vec![board]))?;
        boards.iter().try_for_each(|board| setup::install_emulator(board.emulator).map(drop))?;
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make {}", self.out.display()))?;
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let mut films = vec![];
        for motion in self.motions() {
            say(&format!("converting {}", motion.display()));
            films.push(Film::of(clips::convert(&motion, folder.path())?)?);
        }
        for board in boards {
            say(&format!("playing on QEMU's {}", board.name));
            let clips: Vec<&Path> = films.iter().map(|film| film.clip.as_path()).collect();
            let firmware = Firmware::featuring(&clips::features(board, &clips)?, board.name, board.name, board.target, &clips)?;
            let views = VIEWS.iter().map(|(view, _)| play(board, &firmware, *view, &films)).collect::<Result<Vec<_>>>()?;
            for (index, film) in films.iter().enumerate() {
                let rows = VIEWS.iter().zip(&views).flat_map(|((_, name), films)| {
                    film.frames.iter().zip(&films[index]).map(move |(frame, picture)| (format!("{name}, frame {frame}"), picture))
                });
                let path = self.out.join(format!("{}-{}.png", board.name, film.name()));
                write_whole(&path, &pictures::sheet(&rows.collect::<Vec<_>>(), COLUMNS)?)?;
                say(&format!("wrote {}", path.display()));
            }
        }
        Ok(())
    }

    fn motions(&self) -> Vec<PathBuf> {
        if !self.motions.is_empty() {
            return self.motions.clone();
        }
        let own = ["motions/walk.keys", "motions/run.keys"].map(|own| paths::root().join(own));
        own.into_iter().chain(paths::data().map(|data| data.join("bvh_bandai1_walk.bvh"))).collect()
    }
}

/// A clip, and the frames of it that are shown.
struct Film {
    clip: PathBuf,
    frames: Vec<u32>,
}

impl Film {
    fn of(path: PathBuf) -> Result<Self> {
        let bytes = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let clip = Clip::new_checked(&bytes).map_err(|error| anyhow::anyhow!("{}: {error}", path.display()))?;
        let span = ((SECONDS * 1e9 / f64::from(clip.frame_time_ns())) as u32).clamp(1, clip.frames());
        // What is longer has begun by then.
        let first = (clip.frames() - span) / 4;
        let count = COUNT.min(span);
        Ok(Self { clip: path, frames: (0..count).map(|index| first + index * span / count).collect() })
    }

    fn name(&self) -> String {
        self.clip.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// The pictures of each film on a board in a view.
fn play(board: Machine, firmware: &Firmware, view: i16, films: &[Film]) -> Result<Vec<Vec<Picture>>> {
    let launch = Launch::new(board, firmware.elf()).argument(format!("view={view}")).limit(LIMIT);
    let mut session = Session::start(launch)?;
    let mut shown = vec![];
    for (index, film) in films.iter().enumerate() {
        let mut at = session.step(if index > 0 { b"n" } else { b"" })?;
        let mut pictures = vec![];
        for &frame in &film.frames {
            while at < frame {
                at = session.step(b"")?;
            }
            ensure!(at == frame, "the board shows frame {at}, expected {frame}");
            pictures.push(session.picture()?);
        }
        shown.push(pictures);
    }
    ensure!(session.end()?.code == 0, "the board failed");
    Ok(shown)
}

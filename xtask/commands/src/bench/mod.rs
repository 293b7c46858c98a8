//! What `cargo xtask bench` measures: one part a file, and what the parts share.

mod animator;
mod argument;
mod board;
pub mod command;
mod decimation;
mod decode;
mod decode_keys;
mod document;
mod effort;
mod error;
mod face;
mod footprint;
mod frame;
mod goals;
mod guest;
mod host;
mod link;
mod link_board;
mod lvgl;
mod paper;
mod paper_keys;
mod peers;
mod plot;
mod recording;
mod reference;
mod short;
mod size;
mod table;
mod tool;
mod turns;
mod web;

pub use document::{store, write};
pub use goals::{Goal, print};

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::ValueEnum;
use harness::paths;

/// What can be measured by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// Bytes against error of the reference clips, compared with other codecs
    Size,
    /// Bytes against processor time at efforts 1 to 9, compared with other codecs
    Effort,
    /// What a doubled frame rate costs in bytes
    Decimation,
    /// Our own versions of the paper's walk and run
    Paper,
    /// Guest instructions per pose and per seek, and of reading a joint's angles and places
    Decode,
    /// Code, tables, RAM and stack of the decoder
    Footprint,
    /// Time per pose on this machine, and encoding speed
    Host,
    /// Guest instructions per frame on every machine, the firmware's size and memory, and the number of figures that fit
    Frame,
    /// Additions compared with polynomials, and a clip with a per-frame file over a link
    Argument,
    /// Faces: bits per second and smoothness, bytes of our own clips, guest instructions per frame, memory, the model's size
    Face,
    /// The web page: bytes, time to the first frame, time per frame, time to convert
    Web,
    /// Motion over a line that loses packets: time to recovery, and its cost
    Link,
    /// Guest instructions of transitions, layers and inverse kinematics, and the animator's code
    Animator,
    /// The widget for LVGL against LVGL's GIF and Lottie: flash, RAM, stack, guest instructions per frame
    Lvgl,
}

/// What every part works with.
pub struct Setting {
    /// The host tool, as its users have it.
    pub tool: tool::Tool,
    /// Where plots and clips go.
    pub out: PathBuf,
    /// Fewer and shorter clips.
    pub quick: bool,
    /// Only reference clips whose name holds this.
    pub only: Option<String>,
}

impl Setting {
    /// Builds the host tool and makes the folder.
    pub fn new(quick: bool, only: Option<String>) -> Result<Self> {
        let out = paths::root().join("target/bench");
        std::fs::create_dir_all(out.join("clips")).with_context(|| format!("cannot make {}", out.display()))?;
        Ok(Self { tool: tool::Tool::build(out.join("clips"))?, out, quick, only })
    }
}

impl Part {
    /// Measures, prints, and returns the rows of the table in docs/BENCHMARKS.md.
    pub fn run(self, setting: &Setting) -> Result<Vec<Goal>> {
        match self {
            Self::Size => size::run(setting),
            Self::Effort => effort::run(setting),
            Self::Decimation => decimation::run(setting),
            Self::Paper => paper::run(setting),
            Self::Decode => decode::run(setting),
            Self::Footprint => footprint::run(setting),
            Self::Host => host::run(setting),
            Self::Frame => frame::run(setting),
            Self::Argument => argument::run(setting),
            Self::Face => face::run(setting),
            Self::Web => web::run(),
            Self::Link => link::run(setting),
            Self::Animator => animator::run(setting),
            Self::Lvgl => lvgl::run(setting),
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

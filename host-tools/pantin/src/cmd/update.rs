//! `pantin update`.

use crate::board_clip;
use crate::output::{note, progress, report};
use anyhow::{Context, Result};
use pantin_line::update::place::Place;
use pantin_line::update::{self, RetryPolicy};
use serde_json::json;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Send a clip to a board, which plays it from then on, also after a power cycle.
///
/// The board's firmware must be built with feature `update`. The old clip keeps playing until the new one is complete and verified.
/// If the transfer is interrupted, the old clip stays, and the same command resumes the transfer.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin update walk.ptn --to serial:/dev/ttyACM0
  pantin update walk.ptn --to serial:/dev/ttyUSB0@9600 --name \"my walk\"
  pantin update walk.ptn --to serial:COM3
  pantin update walk.ptn --to tcp:localhost:4000      an emulator's line, or a serial server's

Exit codes: 0 the clip plays; 1 it does not, and the old one does; 2 the command line is wrong.")]
pub struct Arguments {
    /// The clip, which must contain its rig
    input: PathBuf,
    /// The board's line: serial:PORT[@BAUD] (default 115200), or tcp:HOST:PORT
    #[arg(long)]
    to: Place,
    #[command(flatten)]
    sent: board_clip::Sent,
    /// Seconds to wait for an answer before a message is sent again
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, value_parser = seconds)]
    patience: f64,
    /// Number of unanswered messages, or of restarts of the board, after which the transfer is given up
    #[arg(long, value_name = "COUNT", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    tries: u32,
}

fn seconds(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|seconds| (0.01..=3600.0).contains(seconds)).ok_or("expected seconds, 0.01 to 3600".into())
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let (clip, info) = board_clip::read(&arguments.input, &arguments.sent)?;
    let mut line = arguments.to.open()?;
    let bar = progress(info.length.into(), "{wide_bar} {bytes} of {total_bytes} {eta} left")?;
    let patience = RetryPolicy { answer: Duration::from_secs_f64(arguments.patience), tries: arguments.tries };
    let begun = Instant::now();
    let outcome = update::send(&mut line, &clip, &info, patience, &mut |bytes| bar.set_position(bytes.into()));
    bar.finish_and_clear();
    let outcome = outcome.with_context(|| format!("{} to {}", arguments.input.display(), arguments.to))?;
    let (name, seconds) = (info.name.as_str(), begun.elapsed().as_secs_f64());
    report(json!({"name": name, "sent_bytes": outcome.sent, "seconds": seconds, "messages_sent_again": outcome.again}));
    match outcome.sent {
        0 => note!("{name}: the board has it already"),
        sent => note!("{name}: plays; {sent} bytes in {seconds:.1} s, {} messages sent again", outcome.again),
    }
    Ok(())
}

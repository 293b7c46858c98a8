//! The web page: bytes that it loads, and times in Chromium on this machine.

use std::io::Write;

use anyhow::{Context, Result};
use flate2::Compression;
use flate2::write::GzEncoder;
use harness::paths;
use harness::web::browser::Browser;
use harness::web::{self, CONVERTER, FACE, PLAYER};
use serde_json::{Value, json};

use super::{Goal, table};
use xtask::steps::say;

/// Bytes of the player as the server sends it without compression.
const MOST: f64 = 40.0 * 1024.0;
/// A captured walk of 195 frames.
const MOTION: &str = "bvh_bandai1_walk.bvh";
/// What is played: a body of 22 channels, and it with a face.
const CLIPS: [&str; 2] = ["clips/walk.ptn", "clips/greet.ptn"];

/// All that is measured of the page.
pub fn run() -> Result<Vec<Goal>> {
    let site = web::served(vec![])?;
    let mut goals = sizes()?;
    let browser = Browser::ready()?;
    goals.extend(times(&browser, &site)?);
    goals.extend(conversion(&browser, &site)?);
    Ok(goals)
}

fn sizes() -> Result<Vec<Goal>> {
    let folder = paths::root().join("target/web");
    let (mut rows, mut sums) = (vec![], vec![]);
    for names in [&PLAYER[..], &FACE, &CONVERTER] {
        let mut sum = [0; 2];
        for &name in names {
            let bytes = std::fs::read(folder.join(name)).with_context(|| name.to_owned())?;
            let both = [bytes.len(), gzipped(&bytes)?];
            sum = [sum[0] + both[0], sum[1] + both[1]];
            rows.push([vec![name.to_owned()], both.iter().map(usize::to_string).collect()].concat());
        }
        sums.push(sum);
    }
    table::print(&["file", "bytes", "gzip"], &rows);
    let [player, face, converter] = sums[..] else { return Ok(vec![]) };
    Ok(vec![
        Goal::at_most("player, wasm and JavaScript, uncompressed", (player[0] + face[0]) as f64, MOST, 0, "bytes"),
        Goal::at_most("loaded by a page for clips without a face", player[0] as f64, MOST, 0, "bytes"),
        Goal::told("loaded in addition for a clip with a face", format!("{} bytes", face[0])),
        Goal::told("player, gzip", format!("{} bytes, {} of them for the face", player[1] + face[1], face[1])),
        Goal::told("converter, uncompressed", format!("{} bytes", converter[0])),
        Goal::told("converter, gzip", format!("{} bytes", converter[1])),
    ])
}

fn gzipped(bytes: &[u8]) -> Result<usize> {
    let mut encoder = GzEncoder::new(vec![], Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?.len())
}

fn times(browser: &Browser, site: &str) -> Result<Vec<Goal>> {
    let measured = browser.drive("times", &json!({ "site": site, "clips": CLIPS }))?;
    let frames = measured["frames"].as_object().context("times of frames")?;
    let row = |(what, one): (&String, &Value)| {
        let pixels = format!("{}x{}", one["width"], one["height"]);
        vec![what.clone(), pixels, format!("{:.3}", one["ms"].as_f64().unwrap_or_default())]
    };
    table::print(&["frames of", "canvas", "ms a frame"], &frames.iter().map(row).collect::<Vec<_>>());
    let first = measured["first"].as_f64().context("time to the first frame")?;
    let mut goals = vec![Goal::told("time to the first frame of our walk, no cache, median of 5", format!("{first:.0} ms"))];
    goals.extend(frames.iter().map(|(what, one)| {
        Goal::told(
            format!("time per frame in Chromium, decoded and drawn, {what}"),
            format!("{:.2} ms", one["ms"].as_f64().unwrap_or_default()),
        )
    }));
    Ok(goals)
}

fn conversion(browser: &Browser, site: &str) -> Result<Vec<Goal>> {
    let Some(data) = paths::data() else { return Ok(vec![]) };
    let motion = data.join(MOTION);
    if !motion.is_file() {
        say(&format!("   {}: not there", motion.display()));
        return Ok(vec![]);
    }
    let mut goals = vec![];
    for effort in ["fast", "default"] {
        let done = browser.drive("drop", &json!({ "site": site, "files": [motion], "effort": effort }))?;
        let seconds = done["seconds"].as_f64().context("time of the conversion")?;
        goals.push(Goal::told(
            format!("6.5 s of captured motion converted in the page, effort {effort}"),
            format!("{seconds:.1} s"),
        ));
    }
    Ok(goals)
}

//! The web page: bytes that it loads, and times in Chromium on this machine.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::web::browser::Browser;
use harness::web::{self, CHARACTER, CONVERTER, EXPORT, FACE, MACHINE, OTHERS, PLAYER, tools};
use harness::{build, paths};
use serde_json::{Value, json};

use super::{Goal, table};
use xtask::steps::say;
use xtask::{npm, setup};

/// Bytes of a page's player: for clips of bodies, and with faces; as sent with brotli, and raw.
const MOST: [[f64; 2]; 2] = [[14.0 * 1024.0, 36.0 * 1024.0], [22.0 * 1024.0, 72.0 * 1024.0]];
/// Bytes of the player with our character, of all its scripts, and of the decoder by itself, as sent.
const MOST_WITH: [f64; 3] = [32.0 * 1024.0, 40.0 * 1024.0, 5.1 * 1024.0];
/// Our character, as sent.
const BANK: &str = "clips/character.ptb.br";
/// Lines: the page, latency in ms, and kilobits per second; and the time to the first figure in seconds.
const LINES: [(&str, &str, f64, f64, f64); 3] = [
    ("fast 3G", "embed.html", 400.0, 1440.0, 1.0),
    ("slow 3G", "embed.html", 2000.0, 400.0, 4.4),
    ("slow 3G, decoder and clip inlined in the page", "walk.html", 2000.0, 400.0, 2.4),
];
/// The part of a core's time that 30 players take, in per cent.
const MOST_BUSY: f64 = 30.0;
/// Milliseconds of a frame of body and face in lines, and of a captured body.
const MOST_FRAME: [f64; 2] = [2.0, 1.0];
/// Another's page, with the links that let all files be fetched at once.
const EMBED: &str = r#"<!doctype html>
<html lang="en">
<title>A walk</title>
<link rel="modulepreload" href="pantin-player.js">
<link rel="preload" as="fetch" crossorigin href="clips/walk.ptn">
<script type="module" src="pantin-player.js"></script>
<pantin-player src="clips/walk.ptn" autoplay loop></pantin-player>
</html>
"#;
/// A captured walk of 195 frames.
const MOTION: &str = "bvh_bandai1_walk.bvh";
/// What is played: a body of 22 channels, and it with a face; and [`MOTION`] where it is at hand.
const CLIPS: [&str; 2] = ["clips/walk.ptn", "clips/greet.ptn"];
const CAPTURED: &str = "captured.ptn";

/// All that is measured of the page.
pub fn run() -> Result<Vec<Goal>> {
    let mut extras = vec![("/embed.html".into(), EMBED.into())];
    let captured = captured()?;
    let clips: Vec<&str> = CLIPS.into_iter().chain(captured.iter().map(|_| CAPTURED)).collect();
    extras.extend(captured.map(|clip| (format!("/{CAPTURED}"), clip)));
    let site = web::served(extras)?;
    let mut goals = sizes()?;
    let browser = Browser::ready()?;
    goals.extend(times(&browser, &site, &clips)?);
    goals.extend(conversion(&browser, &site)?);
    goals.extend(side_by_side(&browser)?);
    Ok(goals)
}

/// Other players of our walk, on the lines of [`LINES`]: what npm installs is not in the repository.
fn side_by_side(browser: &Browser) -> Result<Vec<Goal>> {
    let folder = paths::root().join("target/compare");
    let source = paths::root().join("web/compare");
    npm::install(&source, &folder)?;
    for name in ["compare.mjs", "three.js"] {
        std::fs::copy(source.join(name), folder.join(name)).with_context(|| name.to_owned())?;
    }
    let site = paths::root().join("target/web");
    let walk = folder.join("walk.json");
    web::compare::lottie(&site.join("clips/walk.ptn"), &walk)?;
    let lines: Vec<Value> = LINES[..2].iter().map(|(name, _, latency, kilobits, _)| json!([name, latency, kilobits])).collect();
    let mut node = Command::new(setup::emulator("node")?);
    node.arg("compare.mjs").arg(&site).arg(&walk).arg(json!(lines).to_string()).current_dir(&folder).envs(browser.environment());
    let output = node.output().context("cannot start node")?;
    ensure!(output.status.success(), "compare.mjs: {}", String::from_utf8_lossy(&output.stderr).trim());
    let measured: serde_json::Map<String, Value> = serde_json::from_slice(&output.stdout).context("compare.mjs")?;
    let goal = |(name, one): (&String, &Value)| {
        let bytes = one["bytes"].as_u64().with_context(|| name.clone())?;
        let first = LINES.iter().filter_map(|(line, ..)| {
            let ms = one["first"][line].as_f64()?;
            Some(format!(", {:.2} s on {line}", ms / 1000.0))
        });
        let busy = one["busy"].as_f64().map(|part| format!(", {:.1} % of a core", 100.0 * part)).unwrap_or_default();
        Ok(Goal::told(format!("side by side, our walk: {name}"), format!("{bytes} bytes{}{busy}", first.collect::<String>())))
    };
    measured.iter().map(goal).collect()
}

fn sizes() -> Result<Vec<Goal>> {
    let folder = paths::root().join("target/web");
    let (mut rows, mut sums) = (vec![], vec![]);
    for names in [&PLAYER[..], &FACE, &CONVERTER, &CHARACTER, &OTHERS, &EXPORT, &MACHINE] {
        let mut sum = [0; 3];
        for &name in names {
            let bytes = |end: &str| {
                Ok::<_, anyhow::Error>(std::fs::read(folder.join(format!("{name}{end}"))).with_context(|| name.to_owned())?.len())
            };
            let all = [bytes(".br")?, bytes(".gz")?, bytes("")?];
            sum.iter_mut().zip(all).for_each(|(sum, one)| *sum += one);
            rows.push([vec![name.to_owned()], all.iter().map(usize::to_string).collect()].concat());
        }
        sums.push(sum);
    }
    table::print(&["file", "brotli", "gzip", "raw bytes"], &rows);
    let [player, face, converter, character, others, export, machine] = sums[..] else { return Ok(vec![]) };
    let bank = std::fs::read(folder.join(BANK)).context(BANK)?.len();
    let scripts = player[0] + face[0] + character[0] + others[0] + export[0];
    let alone = tempfile::tempdir().context("a folder for the decoder")?;
    std::fs::write(alone.path().join("decoder.js"), web::bundle::decoder()?).context("the decoder")?;
    tools::compress(alone.path())?;
    let decoder = std::fs::read(alone.path().join("decoder.js.br")).context("the decoder")?.len();
    if !tools::installed() {
        say("   terser and wasm-opt are missing: the files are larger than they could be");
    }
    let [bodies, faces] = MOST;
    Ok(vec![
        Goal::at_most("a page with bodies, as sent (brotli)", player[0] as f64, bodies[0], 0, "bytes"),
        Goal::at_most("a page with bodies, raw", player[2] as f64, bodies[1], 0, "bytes"),
        Goal::at_most("a page with faces, as sent (brotli)", (player[0] + face[0]) as f64, faces[0], 0, "bytes"),
        Goal::at_most("a page with faces, raw", (player[2] + face[2]) as f64, faces[1], 0, "bytes"),
        Goal::at_most(
            "a page with our character and its bank, as sent (brotli)",
            (player[0] + character[0] + bank) as f64,
            MOST_WITH[0],
            0,
            "bytes",
        ),
        Goal::at_most("all scripts of the player, as sent (brotli)", scripts as f64, MOST_WITH[1], 0, "bytes"),
        Goal::at_most("the decoder alone, minified, as sent (brotli)", decoder as f64, MOST_WITH[2], 0, "bytes"),
        Goal::told("a page with bodies, gzip", format!("{} bytes", player[1])),
        Goal::told("converter, brotli", format!("{} bytes", converter[0])),
        Goal::told("converter, raw", format!("{} bytes", converter[2])),
        Goal::told("compiler of state machines and its editor, brotli", format!("{} bytes", machine[0])),
        Goal::told("compiler of state machines and its editor, raw", format!("{} bytes", machine[2])),
    ])
}

/// The captured motion as a clip, in segments: a page fetches no other module for it.
fn captured() -> Result<Option<Vec<u8>>> {
    let Some(motion) = paths::data().map(|data| data.join(MOTION)).filter(|motion| motion.is_file()) else { return Ok(None) };
    let folder = tempfile::tempdir().context("a folder for a clip")?;
    let clip = folder.path().join(CAPTURED);
    let mut tool = Command::new(build::host_tool()?);
    let output = tool.arg("convert").arg(&motion).args(["--segments", "--max-error", "0.5cm", "-o"]).arg(&clip).output();
    let output = output.context("cannot start the host tool")?;
    ensure!(output.status.success(), "pantin convert: {}", String::from_utf8_lossy(&output.stderr).trim());
    std::fs::read(&clip).context("pantin convert wrote nothing").map(Some)
}

fn times(browser: &Browser, site: &str, clips: &[&str]) -> Result<Vec<Goal>> {
    let lines: Vec<Value> =
        LINES.iter().map(|(name, page, latency, kilobits, _)| json!([name, page, latency, kilobits])).collect();
    let measured = browser.drive("times", &json!({ "site": site, "clips": clips, "lines": lines }))?;
    let frames = measured["frames"].as_object().context("times of frames")?;
    let row = |(what, one): (&String, &Value)| {
        let pixels = format!("{}x{}", one["width"], one["height"]);
        vec![what.clone(), pixels, format!("{:.3}", one["ms"].as_f64().unwrap_or_default())]
    };
    table::print(&["frames of", "canvas", "ms a frame"], &frames.iter().map(row).collect::<Vec<_>>());
    let first = measured["first"].as_f64().context("time to the first frame")?;
    let mut goals = vec![Goal::told("time to the first frame of our walk, no cache, median of 5", format!("{first:.0} ms"))];
    for (name, .., most) in LINES {
        let ms = measured["slow"][name].as_f64().with_context(|| name.to_owned())?;
        goals.push(Goal::at_most(format!("first figure on {name}, from the request of the page"), ms / 1000.0, most, 2, "s"));
    }
    let part = |place: &str| measured["crowd"][place].as_f64().map(|part| 100.0 * part).with_context(|| place.to_owned());
    goals.push(Goal::at_most("30 players of a walk on screen, of one core", part("on screen")?, MOST_BUSY, 0, "%"));
    goals.push(Goal::told("30 players off screen, of one core", format!("{:.1} %", part("off screen")?)));
    for (what, one) in frames {
        let name = format!("time per frame in Chromium, decoded and drawn, {what}");
        let most = MOST_FRAME[usize::from(what.starts_with(CAPTURED))];
        goals.push(Goal::at_most(name, one["ms"].as_f64().unwrap_or_default(), most, 2, "ms"));
    }
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

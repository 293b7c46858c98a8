//! What our walk takes in other formats, measured when the site is built: the page's first sentence compares them.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use xtask::{build, paths, setup};

/// Marks in the page: the walk's bytes, and a sentence about other formats.
const WALK: &str = "@WALK@";
const OTHERS: &str = "@OTHERS@";
/// Pixels of the GIF, which is what the player draws.
const SIZE: &str = "480x240";

/// The page with the sizes of our walk, from the site's clips. Those of text are as servers send them; without Node.js, which compresses it, they are left out.
pub fn filled(site: &Path, page: &str) -> Result<String> {
    let walk = site.join("clips/walk.ptn");
    let bytes = std::fs::read(&walk).context("our walk")?.len();
    let mut others = vec![("a GIF", gif(&walk)?)];
    if setup::emulator("node").is_ok() {
        others.insert(0, ("Lottie", lottie(&walk)?));
        others.push(("BVH", sent(&site.join("clips/walk.bvh"))?));
    }
    ensure!([WALK, OTHERS].iter().all(|mark| page.contains(mark)), "the page has no place for the walk's sizes");
    let others: Vec<String> = others.iter().map(|(format, bytes)| format!("{} as {format}", text(*bytes))).collect();
    Ok(page.replace(WALK, &text(bytes)).replace(OTHERS, &others.join(", ")))
}

/// Bytes as a reader sees them: 652 bytes, 7.5 KB, 120 KB.
fn text(bytes: usize) -> String {
    let kilobytes = bytes as f64 / 1000.0;
    match bytes {
        0..1000 => format!("{bytes} bytes"),
        1000..10_000 => format!("{kilobytes:.1} KB"),
        _ => format!("{kilobytes:.0} KB"),
    }
}

/// Bytes of a GIF of the clip, as the host tool draws it.
fn gif(clip: &Path) -> Result<usize> {
    let folder = tempfile::tempdir().context("a folder for a GIF")?;
    let out = folder.path().join("walk.gif");
    let mut tool = Command::new(build::host_tool()?);
    let output = tool.arg("render").arg(clip).arg("-o").arg(&out).args(["--size", SIZE, "--palette", "paper"]).output();
    let output = output.context("cannot start the host tool")?;
    ensure!(output.status.success(), "pantin render: {}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(std::fs::read(&out).context("pantin render wrote nothing")?.len())
}

/// Bytes of the clip's picture as a Lottie file, as sent.
fn lottie(clip: &Path) -> Result<usize> {
    let folder = tempfile::tempdir().context("a folder for a Lottie file")?;
    let out = folder.path().join("walk.json");
    let mut node = Command::new(setup::emulator("node")?);
    let output =
        node.arg(paths::root().join("web/tools/lottie.mjs")).arg(clip).arg(&out).output().context("cannot start node")?;
    ensure!(output.status.success(), "lottie.mjs: {}", String::from_utf8_lossy(&output.stderr).trim());
    sent(&out)
}

/// Bytes of a file compressed with brotli.
fn sent(file: &Path) -> Result<usize> {
    const SCRIPT: &str = r#"
        import { readFileSync } from "node:fs";
        import { brotliCompressSync } from "node:zlib";
        console.log(brotliCompressSync(readFileSync(process.argv[1])).length);
    "#;
    let mut node = Command::new(setup::emulator("node")?);
    let output = node.args(["--input-type=module", "--eval", SCRIPT]).arg(file).output().context("cannot start node")?;
    ensure!(output.status.success(), "compression: {}", String::from_utf8_lossy(&output.stderr).trim());
    String::from_utf8_lossy(&output.stdout).trim().parse().context("compression")
}

#[cfg(test)]
mod tests {
    use super::text;

    #[test]
    fn sizes_are_bytes_or_kilobytes() {
        assert_eq!([999, 1000, 9949, 10_000, 123_456].map(text), ["999 bytes", "1.0 KB", "9.9 KB", "10 KB", "123 KB"]);
    }
}

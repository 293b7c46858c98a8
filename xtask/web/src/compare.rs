//! Bytes that are measured when the site is built: our walk's in other formats, which the page's first sentence and its table compare, those of the scripts that play it, and those
//! of the archives.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use xtask::{build, paths, setup};

use crate::site::PLAYER;
use crate::{bundle, downloads};

/// Marks in the page: the walk's bytes, a sentence about other formats, the rows of a table, and the archives' bytes.
const WALK: &str = "@WALK@";
const OTHERS: &str = "@OTHERS@";
const ROWS: &str = "@ROWS@";
const ARCHIVES: [(&str, &str); 2] = [("@LVGL@", downloads::LVGL), ("@ARDUINO@", downloads::ARDUINO)];
/// Pixels of the GIF, which is what the player draws.
const SIZE: &str = "480x240";

/// The page with its sizes, of the site's other files. Those of text are as servers send them; without Node.js, which compresses it, they are left out.
pub fn filled(site: &Path, page: &str) -> Result<String> {
    let walk = site.join("clips/walk.ptn");
    let bytes = std::fs::read(&walk).context("our walk")?.len();
    let mut others = vec![("a GIF", gif(&walk)?)];
    let mut scripts = vec![];
    if setup::emulator("node").is_ok() {
        let folder = tempfile::tempdir().context("a folder for a Lottie file")?;
        let file = folder.path().join("walk.json");
        lottie(&walk, &file)?;
        others.insert(0, ("Lottie", sent(&file)?));
        others.push(("BVH", sent(&site.join("clips/walk.bvh"))?));
        scripts.push(("the player of this page", sent(&site.join(PLAYER[0]))?));
        let folder = tempfile::tempdir().context("a folder for the decoder")?;
        let decoder = folder.path().join("decoder.js");
        std::fs::write(&decoder, bundle::decoder()?).context("the decoder")?;
        scripts.push(("the decoder alone, in JavaScript", sent(&decoder)?));
    }
    let mut marks = [WALK, OTHERS, ROWS].into_iter().chain(ARCHIVES.map(|(mark, _)| mark));
    marks.try_for_each(|mark| page.contains(mark).then_some(()).with_context(|| format!("the page has no {mark}")))?;
    let formats = others.iter().map(|(format, bytes)| (format!("the walk as {format}"), *bytes));
    let scripts = scripts.iter().map(|(name, bytes)| ((*name).to_owned(), *bytes));
    let all = std::iter::once(("the walk as a clip".to_owned(), bytes)).chain(formats).chain(scripts);
    let rows: String =
        all.map(|(name, bytes)| format!("<tr><th scope=\"row\">{name}</th><td>{}</td></tr>", text(bytes))).collect();
    let others: Vec<String> = others.iter().map(|(format, bytes)| format!("{} as {format}", text(*bytes))).collect();
    let mut page = page.replace(WALK, &text(bytes)).replace(OTHERS, &others.join(", ")).replace(ROWS, &rows);
    for (mark, name) in ARCHIVES {
        let bytes = std::fs::metadata(site.join(name)).with_context(|| name.to_owned())?.len();
        page = page.replace(mark, &text(bytes as usize));
    }
    Ok(page)
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

/// Writes the clip's picture as a Lottie file.
pub fn lottie(clip: &Path, out: &Path) -> Result<()> {
    let mut node = Command::new(setup::emulator("node")?);
    let output = node.arg(paths::root().join("web/tools/lottie.mjs")).arg(clip).arg(out).output().context("cannot start node")?;
    ensure!(output.status.success(), "lottie.mjs: {}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(())
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

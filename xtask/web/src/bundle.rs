//! Scripts of several modules in one file: a browser that has the file shows a figure without another request.

use std::collections::HashSet;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use xtask::paths;

use crate::{inline, script, tools};

/// A module that the build writes: the face's model as a text.
const FACE_MODEL: &str = "player/face-model.js";
/// The modules of each script of the player, below `web/packages`. The last one keeps its exports.
pub const SCRIPTS: [(&str, &[&str]); 14] = [
    ("pantin-player.js", &["decoder/tables.js", "decoder/clip.js", "player/figure.js", "player/element.js"]),
    ("pantin-controls.js", &["player/controls.js"]),
    ("pantin-stream.js", &["player/stream.js"]),
    ("pantin-export.js", &["player/webm.js", "player/export.js"]),
    ("pantin-oled.js", &["player/oled.js"]),
    ("pantin-solid.js", &["player/solid.js"]),
    ("pantin-looks.js", &["player/looks.js"]),
    ("pantin-keys.js", &["decoder/keys.js"]),
    ("pantin-words.js", &["player/words.js"]),
    ("pantin-table.js", &["player/table.js"]),
    ("pantin-face.js", &["decoder/names.js", FACE_MODEL, "player/face-lines.js", "player/face.js"]),
    ("pantin-bars.js", &["player/bars.js"]),
    ("pantin-bank.js", &["player/bank.js"]),
    (
        "pantin-character.js",
        &[
            "decoder/turning.js",
            "animator/channels.js",
            "animator/track.js",
            "animator/animator.js",
            "animator/gait.js",
            "animator/machine-table.js",
            "animator/machine.js",
            "animator/feet.js",
            "animator/open.js",
            "player/character.js",
        ],
    ),
];
/// The modules of the decoder's minified build.
pub const DECODER: [&str; 5] =
    ["decoder/tables.js", "decoder/names.js", "decoder/clip.js", "decoder/pose.js", "decoder/index.js"];

/// The modules of the minified build of rotations.
const TURNS: [&str; 2] = ["decoder/turning.js", "decoder/turns.js"];

/// The minified build of rotations.
pub fn turns() -> Result<Vec<u8>> {
    tools::minified(bundle(&paths::root().join("web/packages"), &TURNS)?.into_bytes())
}

/// The decoder's minified build.
pub fn decoder() -> Result<Vec<u8>> {
    tools::minified(bundle(&paths::root().join("web/packages"), &DECODER)?.into_bytes())
}

/// The modules as one script, each behind those that it imports. Their names share one scope: a name that two of them declare is an error.
pub fn bundle(packages: &Path, modules: &[&str]) -> Result<String> {
    let (mut whole, mut names) = (String::new(), HashSet::new());
    for (index, module) in modules.iter().enumerate() {
        let path = packages.join(module);
        let text = if *module == FACE_MODEL {
            face_model(&std::fs::read(paths::root().join("firmware/face/face.model"))?)?
        } else {
            std::fs::read_to_string(&path).with_context(|| path.display().to_string())?
        };
        let mut out = String::new();
        for line in text.lines() {
            // Documentation, whose apostrophes begin no texts.
            if ["/**", "* ", "*/"].iter().any(|mark| line.trim_start().starts_with(mark)) {
                continue;
            }
            if line.starts_with("import ") {
                ensure!(line.ends_with(".js\";"), "{module}: an import of more than one line, or of another package: {line}");
                continue;
            }
            let line = if index + 1 < modules.len() { line.strip_prefix("export ").unwrap_or(line) } else { line };
            for name in declared(line.strip_prefix("export ").unwrap_or(line)) {
                ensure!(names.insert(name.to_owned()), "{module}: {name} is declared by another module, too");
            }
            // The exports of a module that others import are names of the one scope.
            if !(line.starts_with('{') && index + 1 < modules.len()) {
                out += line;
                out.push('\n');
            }
        }
        // The decoder's texts and patterns are more than the short form understands.
        whole += &if ["player/", "animator/"].iter().any(|folder| module.starts_with(folder)) {
            String::from_utf8(script::shortened(out.as_bytes())?)? + "\n"
        } else {
            out
        };
    }
    Ok(whole)
}

/// Bytes of a face's model before its points, and of a point with its normal, of a triangle and of a name.
const HEAD: usize = 21;
const POINT: usize = 9;
const TRIANGLE: usize = 3;
const NAME: usize = 7;

/// A face's model as the script reads it, for fewer bytes as sent: triangles as the differences of their corners from those before, and names without the highest
/// byte of their hashes, as three bytes tell them apart.
fn face_model(model: &[u8]) -> Result<String> {
    let number = |at: usize| -> Result<usize> {
        let bytes = model.get(at..).and_then(|rest| rest.first_chunk()).context("a face's model")?;
        Ok(u16::from_le_bytes(*bytes).into())
    };
    let [middles, pairs, triangles, names] = [number(3)?, number(5)?, number(11)?, number(15)?];
    let first = HEAD + POINT * (middles + pairs);
    let (last, names) = (first + TRIANGLE * triangles, model.len().saturating_sub(NAME * names));
    ensure!(last <= names, "a face's model");
    let mut bytes = model[..names].to_vec();
    for at in first + TRIANGLE..last {
        bytes[at] = model[at].wrapping_sub(model[at - TRIANGLE]);
    }
    bytes.extend(model[names..].chunks_exact(NAME).flat_map(|name| name[..3].iter().chain(&name[4..])));
    Ok(format!("export const FACE_MODEL = `{}`;", inline::text(&bytes)))
}

/// The names that a line declares at the top of a module.
fn declared(line: &str) -> Vec<&str> {
    let words = ["const ", "let ", "function ", "async function ", "function* ", "class "];
    let Some(rest) = words.iter().find_map(|word| line.strip_prefix(word)) else { return vec![] };
    let end =
        if rest.starts_with(['{', '[']) { rest.find(['}', ']']) } else { rest.find(|c: char| !c.is_alphanumeric() && c != '_') };
    let names = rest.get(..end.unwrap_or(rest.len())).unwrap_or_default();
    names.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|name| !name.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::bundle;

    fn bundled(modules: &[(&str, &str)]) -> anyhow::Result<String> {
        let folder = tempfile::tempdir()?;
        for (name, text) in modules {
            std::fs::write(folder.path().join(name), text)?;
        }
        bundle(folder.path(), &modules.iter().map(|(name, _)| *name).collect::<Vec<_>>())
    }

    #[test]
    fn imports_leave_and_the_last_module_keeps_its_exports() {
        let script = bundled(&[
            ("a.js", "export const one = 1;\nconst two = 2;\nexport { two };\n"),
            ("b.js", "import { one, two } from \"./a.js\";\nexport const three = one + two;\n"),
        ]);
        assert_eq!(script.unwrap(), "const one = 1;\nconst two = 2;\nexport const three = one + two;\n");
    }

    #[test]
    fn names_that_meet_are_refused() {
        for second in ["const [a, sign] = f();\n", "export function sign() {\n", "const { sign } = Math;\n"] {
            assert!(bundled(&[("a.js", "const { abs, sign } = Math;\n"), ("b.js", second)]).is_err(), "{second}");
        }
        assert!(bundled(&[("a.js", "import x from \"three\";\n")]).is_err());
    }
}

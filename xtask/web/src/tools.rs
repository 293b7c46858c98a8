//! A minifier and WebAssembly's optimizer, from npm: the site is built without them where they cannot be installed, and is larger.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use anyhow::{Context, Result, ensure};
use xtask::npm;

use xtask::{paths, setup};

/// Features that Rust's own target uses.
const FEATURES: [&str; 6] =
    ["bulk-memory", "bulk-memory-opt", "sign-ext", "mutable-globals", "nontrapping-float-to-int", "multivalue"];

/// The programs' folder; none where they cannot be installed, which is reported once.
static PROGRAMS: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
    let folder = paths::root().join("target/web-tools");
    match npm::install(&paths::root().join("web/tools"), &folder) {
        Ok(()) => Some(folder.join("node_modules")),
        Err(error) => {
            eprintln!("note: the site is built without terser and wasm-opt, and is larger than it could be: {error:#}");
            None
        }
    }
});

/// Whether the programs are installed.
pub fn installed() -> bool {
    PROGRAMS.is_some()
}

/// A script with short names, or as it is.
pub fn minified(script: Vec<u8>) -> Result<Vec<u8>> {
    let script = with_let(&String::from_utf8(script).context("a script that is not UTF-8")?).into_bytes();
    let options = [
        "--module",
        "--compress",
        "passes=3,unsafe=true,pure_getters=true,if_return=false,comparisons=false,lhs_constants=false,reduce_funcs=false",
        "--mangle",
        "--ecma",
        "2022",
    ];
    run("terser/bin/terser", "js", script, |from, to| {
        let mut arguments = vec![from.into()];
        arguments.extend(options.map(PathBuf::from));
        arguments.extend(["--output".into(), to.into()]);
        arguments
    })
}

/// A smaller module that does the same, or the module as it is.
pub fn optimized(module: Vec<u8>) -> Result<Vec<u8>> {
    run("binaryen/bin/wasm-opt", "wasm", module, |from, to| {
        let mut arguments = vec![from.into()];
        let steps = ["-Oz", "--converge", "--flatten", "--rereloop", "-Oz", "--strip-debug", "--strip-producers"];
        arguments.extend(steps.map(PathBuf::from));
        arguments.push("--strip-target-features".into());
        arguments.extend(FEATURES.map(|feature| format!("--enable-{feature}").into()));
        arguments.extend(["-o".into(), to.into()]);
        arguments
    })
}

/// The script with `let` in place of `const`: it is shorter, and no constant of a script that runs is assigned to.
fn with_let(script: &str) -> String {
    let mut out = String::with_capacity(script.len());
    for (index, part) in script.split("const").enumerate() {
        let begins = out.chars().last().is_none_or(|before| before.is_whitespace() || ";{}(".contains(before));
        if index > 0 {
            out += if begins && part.starts_with([' ', '[', '{']) { "let" } else { "const" };
        }
        out += part;
    }
    out
}

/// Writes what a server may send in place of files of a folder: each with brotli and gzip, where node is there. Clips are left out: they play while they arrive. A bank is shown
/// once it is whole, and its tables become much smaller.
pub fn compress(folder: &Path) -> Result<()> {
    const SCRIPT: &str = r#"
        import { readFileSync, readdirSync, writeFileSync } from "node:fs";
        import { brotliCompressSync, constants, gzipSync } from "node:zlib";
        const [, folder] = process.argv;
        for (const name of readdirSync(folder).filter((name) => /\.(html|css|js|json|ptb|toml|wasm)$/.test(name))) {
          const bytes = readFileSync(`${folder}/${name}`);
          // Brotli's best quality by default: the converter takes 9 s, and is an eighth smaller than in half a second.
          const params = { [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length };
          writeFileSync(`${folder}/${name}.br`, brotliCompressSync(bytes, { params }));
          writeFileSync(`${folder}/${name}.gz`, gzipSync(bytes, { level: 9 }));
        }
    "#;
    let Ok(node) = setup::emulator("node") else {
        eprintln!("note: the site's files are not compressed, because node is missing");
        return Ok(());
    };
    let output = Command::new(node).args(["--input-type=module", "--eval", SCRIPT]).arg(folder).output();
    let output = output.context("cannot start node")?;
    ensure!(output.status.success(), "compression: {}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(())
}

fn run(program: &str, kind: &str, bytes: Vec<u8>, arguments: impl Fn(&Path, &Path) -> Vec<PathBuf>) -> Result<Vec<u8>> {
    let Some(programs) = PROGRAMS.as_ref() else { return Ok(bytes) };
    let folder = tempfile::tempdir().context("a folder for a program of npm")?;
    let [from, to] = ["from", "to"].map(|name| folder.path().join(name).with_extension(kind));
    std::fs::write(&from, bytes).context("a program's input")?;
    let mut node = Command::new(setup::emulator("node")?);
    let output = node.arg(programs.join(program)).args(arguments(&from, &to)).output().context("cannot start node")?;
    ensure!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr).trim());
    std::fs::read(&to).with_context(|| format!("{program} wrote nothing"))
}

#[cfg(test)]
mod tests {
    use super::with_let;

    #[test]
    fn constants_become_variables_and_other_words_stay() {
        assert_eq!(with_let("const a=1;for(const b of c)const_=aconst d"), "let a=1;for(let b of c)const_=aconst d");
    }
}

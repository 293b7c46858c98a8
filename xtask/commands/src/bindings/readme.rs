//! The programs of the README of the decoder in C, as written.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{build, paths};
use pantin::{Clip, EulerOrder, Room};
use tempfile::TempDir;

use super::{home, output};

/// Compiles the first program with the README's own command, beside the header that `pantin expand` writes, and compares the angles that it prints. The
/// program that opens a file opens one and a part of it. The other programs are compiled alone, as C and as C++. Each row of the table of parts
/// names all files that it needs.
pub fn run(folder: &TempDir) -> Result<()> {
    let place = folder.path().join("readme");
    std::fs::create_dir_all(&place)?;
    let readme = std::fs::read_to_string(home().join("README.md"))?;
    let program = readme.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).context("the README has no program")?;
    let compile = readme.lines().find(|line| line.starts_with("cc ")).context("the README does not compile its program")?;
    std::fs::write(place.join("play.c"), program)?;
    let clip = paths::root().join("motions/walk.ptn");
    for (file, header) in [("walk.ptn", "walk.h"), ("character.ptb", "character.h"), ("looks/cat.look", "cat.h")] {
        let mut expand = Command::new(build::host_tool()?);
        expand.arg("expand").arg(paths::root().join("motions").join(file)).arg("-o").arg(place.join(header));
        output(expand)?;
    }
    // The command names the sources from the folder of the decoder.
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(home().join("src")).arg(&place);
    output(copy)?;
    let mut shell = Command::new("sh");
    shell.current_dir(&place).args(["-c", compile]);
    let printed = String::from_utf8(output(shell)?.stdout)?;
    let expected = angles(&std::fs::read(&clip)?)?;
    ensure!(printed == expected, "the program prints\n{printed}");
    parts(&place, &readme)?;
    let others: Vec<&str> = readme.split("```c\n").skip(2).filter_map(|rest| rest.split("```").next()).collect();
    for (index, program) in others.iter().enumerate() {
        let source = place.join(format!("further-{index}.c"));
        std::fs::write(&source, program)?;
        for (compiler, language) in [("gcc", &["-std=c99"][..]), ("g++", &["-x", "c++", "-std=c++11"])] {
            let mut command = Command::new(compiler);
            command.current_dir(&place).args(language).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-Isrc", "-I.", "-c"]);
            command.arg(&source).args(["-o", "further.o"]);
            output(command)?;
        }
    }
    println!("   {} frames, {} further programs", expected.lines().count(), others.len());
    ensure!(others.len() >= 4, "few programs");
    let opens = others.iter().find(|program| program.contains("int open_file(")).context("no program opens a file")?;
    open_file(&place, opens, &clip)
}

/// Links the files of each row of the table of parts, which need no others.
fn parts(place: &Path, readme: &str) -> Result<()> {
    let rows = readme.lines().skip_while(|line| *line != "| to use | compile with your program |").skip(2);
    let rows: Vec<&str> = rows.take_while(|line| line.starts_with('|')).collect();
    ensure!(rows.len() >= 8, "the README's table of parts has {} rows", rows.len());
    for row in rows {
        let files = row.split('`').filter(|word| word.ends_with(".c")).map(|name| format!("src/{name}"));
        let mut gcc = Command::new("gcc");
        gcc.current_dir(place).args(["-std=c99", "-fPIC", "-shared", "-Wl,-z,defs", "-Isrc"]).args(files).args(["-o", "part.so"]);
        output(gcc).with_context(|| row.to_owned())?;
    }
    Ok(())
}

/// Opens a clip, a part of it and no file by the program of the README.
fn open_file(place: &Path, program: &str, clip: &Path) -> Result<()> {
    let main = "int main(int count, char **names) { return open_file(names[count - 1]) ? (int)clip.frames & 127 : 128; }\n";
    std::fs::write(place.join("open.c"), format!("{program}\n{main}"))?;
    let mut gcc = Command::new("gcc");
    gcc.current_dir(place).args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-Isrc", "open.c", "src/pantin.c", "-o", "open"]);
    output(gcc)?;
    let bytes = std::fs::read(clip)?;
    std::fs::write(place.join("part.ptn"), &bytes[..bytes.len() - 1])?;
    let frames = Clip::new_checked(&bytes)?.frames();
    for (path, expected) in [(clip, frames as i32 & 127), (&place.join("part.ptn"), 128), (&place.join("none.ptn"), 128)] {
        let status = Command::new(place.join("open")).arg(path).status()?;
        ensure!(status.code() == Some(expected), "{}: {status}", path.display());
    }
    Ok(())
}

/// What the program prints: each frame, and an angle of the left shin.
fn angles(clip: &[u8]) -> Result<String> {
    let clip = Clip::new_checked(clip)?;
    let shin = clip.find("left-shin").context("the joint")?;
    let mut memory = Room::<64, 64>::new();
    let mut player = memory.player(clip)?;
    let mut printed = String::new();
    for frame in 0..player.clip().frames() {
        player.seek(frame);
        let [x, _, _] = player.turn(&shin)?.euler(EulerOrder::XYZ);
        printed += &format!("frame {frame}: {}\n", x.centidegrees());
    }
    Ok(printed)
}

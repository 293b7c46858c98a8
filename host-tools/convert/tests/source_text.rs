//! Source text of clips and banks: it compiles, holds the bytes, and its types have the sizes that players need.

use pantin::{Bank, Clip};
use pantin_convert::export::source::{self, Described, RustText};
use pantin_convert::facts::MemoryNeeds;
use std::path::{Path, PathBuf};
use std::process::Command;

fn motion(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions").join(name)).unwrap()
}

/// Stands in for the crates that the types are from: their sizes are what the text gives them.
const CRATES: &str = "#![deny(warnings)]
extern crate self as pantin;
extern crate self as pantin_figure;
pub struct Room<const MOVING: usize, const CHANNELS: usize>;
impl<const MOVING: usize, const CHANNELS: usize> Room<MOVING, CHANNELS> { pub const SIZES: [usize; 2] = [MOVING, CHANNELS]; }
pub struct FigureRenderer<const N: usize>;
impl<const N: usize> FigureRenderer<N> { pub const JOINTS: usize = N; }
";

/// Compiles and runs `program` beside other files, and returns what it prints.
fn printed(compiler: &str, options: &[&str], files: &[(&str, &str)]) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    let runs: PathBuf = folder.path().join("program").with_extension(std::env::consts::EXE_EXTENSION);
    let source = folder.path().join(files[0].0);
    let Ok(compiled) = Command::new(compiler).args(options).arg(source).arg("-o").arg(&runs).output() else {
        println!("skipped: no {compiler} here");
        return None;
    };
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    Some(String::from_utf8(Command::new(runs).output().unwrap().stdout).unwrap())
}

fn rust(files: &[(&str, &str)]) -> Option<String> {
    printed("rustc", &["--edition=2024"], files)
}

#[test]
fn a_module_of_a_clip_has_the_type_of_its_room() {
    let bytes = motion("walk.ptn");
    let clip = Clip::new_checked(&bytes).unwrap();
    let module = source::rust_module(&clip, &bytes, "walk").unwrap();
    let needs = MemoryNeeds::of(&clip).unwrap();
    assert!(!module.contains("pantin_figure::FigureRenderer<"), "a program of servos has no figure");
    let main = format!(
        "{CRATES}pub mod walk;\nfn main() {{ println!(\"{{:?}} {{}} {{}}\", walk::WalkRoom::SIZES, walk::WALK.len(), walk::WALK_FIGURE_JOINTS); }}\n"
    );
    let expected = format!("{:?} {} {}\n", [needs.moving, needs.channels], bytes.len(), needs.figure_joints);
    assert_eq!(rust(&[("main.rs", &main), ("walk.rs", &module)]).unwrap_or(expected.clone()), expected);
}

#[test]
fn items_are_included_and_need_no_use() {
    let bytes = motion("walk.ptn");
    let described = Described::of(&bytes).unwrap();
    let text = RustText::named("GAIT_2").unwrap().figure_type(true).line("Verified: a\u{202e}b.").items(&described);
    assert!(text.contains("/// A pantin clip: ") && text.contains("///\n/// Verified: a_b.\n"), "{text}");
    let main = format!(
        "{CRATES}include!(\"gait_2.rs\");\nfn main() {{ print!(\"{{:?}} {{}}\", Gait2Room::SIZES, Gait2Figure::JOINTS); }}\n"
    );
    let needs = described.memory();
    let expected = format!("{:?} {}", [needs.moving, needs.channels], needs.figure_joints);
    assert_eq!(rust(&[("main.rs", &main), ("gait_2.rs", &text)]).unwrap_or(expected.clone()), expected);
}

#[test]
fn a_bank_has_the_sizes_of_its_largest_clip() {
    let bytes = motion("character.ptb");
    let bank = Bank::new_checked(&bytes).unwrap();
    let most = MemoryNeeds::of_bank(&bank).unwrap();
    let clips: Vec<MemoryNeeds> = bank.entries().map(|entry| MemoryNeeds::of(&bank.open(&entry).unwrap()).unwrap()).collect();
    assert_eq!(Some(most.moving), clips.iter().map(|needs| needs.moving).max());
    assert!(clips.iter().all(|needs| needs.channels == most.channels && needs.figure_joints <= most.figure_joints));
    let module = source::rust_module_of_bank(&bank, &bytes, "moves").unwrap();
    let main = format!(
        "{CRATES}pub mod moves;\nuse moves::*;\nfn main() {{ print!(\"{{:?}} {{}} {{}}\", MovesRoom::SIZES, MOVES_CLIPS, MOVES_CLIP_NAMES[0]); }}\n"
    );
    let first = bank.entries().next().unwrap().name();
    let expected = format!("{:?} {} {first}", [most.moving, most.channels], bank.len());
    assert_eq!(rust(&[("main.rs", &main), ("moves.rs", &module)]).unwrap_or(expected.clone()), expected);

    let header = source::c_header_of_bank(&bank, &bytes, "moves").unwrap();
    let main = "#include <stdio.h>\n#include \"moves.h\"\n#include \"moves.h\"\nstatic const char *const names[BANK_MOVES_CLIPS] = { BANK_MOVES_CLIP_NAMES };\n\
                int main(void) { printf(\"[%d, %d] %d %s\", BANK_MOVES_MOVING, BANK_MOVES_CHANNELS, BANK_MOVES_CLIPS, names[0]); return sizeof BANK_MOVES != BANK_MOVES_LEN; }\n";
    let options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"];
    let found = printed("cc", &options, &[("main.c", main), ("moves.h", &header)]);
    assert_eq!(found.unwrap_or(expected.clone()), expected);
}

#[test]
fn numbers_have_the_same_names_in_c_and_in_rust() {
    for (bytes, prefix) in [(motion("walk.ptn"), "CLIP"), (motion("character.ptb"), "BANK")] {
        let described = Described::of(&bytes).unwrap();
        let (c, rust) = (source::header(&described, "moves"), RustText::of_stem("moves").module(&described));
        let sizes = described.memory().sizes();
        for size in sizes {
            assert!(c.contains(&format!("#define {prefix}_MOVES_{} {}\n", size.name, size.value)), "{c}");
            assert!(rust.contains(&format!("pub const MOVES_{}: usize = {};\n", size.name, size.value)), "{rust}");
        }
        let constants = rust.matches("\npub const MOVES_").count();
        assert_eq!(constants, c.matches(&format!("\n#define {prefix}_MOVES_")).count() - 1, "all but LEN");
    }
}

#[test]
fn files_that_are_damaged_or_of_another_kind_are_refused() {
    let walk = motion("walk.ptn");
    assert!((0..walk.len()).all(|len| Described::of(&walk[..len]).is_err()));
    // A bank that ends with a whole section is a bank: the sections that every program reads must be there.
    let bank = motion("character.ptb");
    assert!((0..bank.len() / 2).all(|len| Described::of(&bank[..len]).is_err()));
    assert!(Described::of(b"HIERARCHY").is_err());
    assert!(["walk", "", "2ND", "A B"].iter().all(|name| RustText::named(name).is_err()));
}

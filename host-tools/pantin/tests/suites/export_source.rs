//! What `pantin expand` writes for firmware compiles, and holds the clip's bytes.

use pantin_convert::encode::{clip, rig};
use pantin_convert::export::source::{c_header, rust_module};
use pantin_convert::fit::{fit, level::Level};
use pantin_convert::import::ImportOptions;
use pantin_convert::pose_bound::PoseBound;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Stands in for the crate whose type the text uses.
const CRATE: &str = "extern crate self as pantin;\npub struct Room<const MOVING: usize, const CHANNELS: usize>;\n";

fn walk() -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.keys");
    let motion = crate::told::load(&path, &ImportOptions::new()).unwrap().motion;
    let coded = fit(&motion, Level::FAST.plan(PoseBound::places(1.0)), 0.02, &mut |_| ()).unwrap();
    clip::encode(&coded, &rig::encode(&motion.rig).unwrap(), false).unwrap()
}

/// Compiles and runs a program that prints the clip's bytes; `None` without the compiler.
fn printed(compiler: &str, program: &Path, folder: &Path) -> Option<Vec<u8>> {
    printed_with(compiler, &[], program, folder)
}

/// The same with options of the compiler.
fn printed_with(compiler: &str, options: &[&str], program: &Path, folder: &Path) -> Option<Vec<u8>> {
    let runs = folder.join("program").with_extension(std::env::consts::EXE_EXTENSION);
    let Ok(compiled) = Command::new(compiler).args(options).arg(program).arg("-o").arg(&runs).output() else {
        println!("skipped: no {compiler} here");
        return None;
    };
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let ran = Command::new(runs).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    Some(ran.stdout)
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pantin-export-source-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_rust_module_holds_the_clip() {
    let (bytes, folder) = (walk(), folder("rust"));
    let opened = pantin::Clip::new_checked(&bytes).unwrap();
    std::fs::write(folder.join("walk.rs"), rust_module(&opened, &bytes, "walk").unwrap()).unwrap();
    let main = String::from(CRATE)
        + "mod walk;\nuse std::io::Write;\nfn main() {\n    assert!(walk::WALK_FRAMES == 160 && walk::WALK_MOVING <= walk::WALK_CHANNELS && walk::WALK_FRAME_TIME_NS > 0);\n    assert!(walk::WALK_FIGURE_JOINTS == 25 && walk::WALK_WORKSPACE == 29 && walk::WALK_NAMES[0] == \"root.Zposition\");\n    std::io::stdout().write_all(&walk::WALK).unwrap();\n}\n";
    std::fs::write(folder.join("main.rs"), main).unwrap();
    if let Some(out) = printed("rustc", &folder.join("main.rs"), &folder) {
        assert_eq!(out, bytes);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_c_header_holds_the_clip() {
    let (bytes, folder) = (walk(), folder("c"));
    let opened = pantin::Clip::new_checked(&bytes).unwrap();
    let header = c_header(&opened, &bytes, "walk").unwrap();
    assert!(
        header.contains("/*    0 root: Zposition */") && header.contains("160 frames at 120.000 frames a second"),
        "{header}"
    );
    std::fs::write(folder.join("walk.h"), header).unwrap();
    let main = "#include <stdio.h>\n#include \"walk.h\"\n#include \"walk.h\"\nstatic const char *const names[CLIP_WALK_CHANNELS] = { CLIP_WALK_NAMES };\nint main(void) { return fwrite(CLIP_WALK, 1, CLIP_WALK_LEN, stdout) != sizeof CLIP_WALK || CLIP_WALK_FRAMES != 160 || CLIP_WALK_FIGURE_JOINTS != 25 || CLIP_WALK_WORKSPACE != 29 || names[0][0] != 'r' || !names[CLIP_WALK_CHANNELS - 1]; }\n";
    std::fs::write(folder.join("main.c"), main).unwrap();
    if let Some(out) = printed("cc", &folder.join("main.c"), &folder) {
        assert_eq!(out, bytes);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Where a clip codes Euler angles as an exponential map, firmware reads the map's components: the source text says so.
#[test]
fn channels_are_named_as_the_clip_codes_them() {
    let bytes = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/kneebend.ptn")).unwrap();
    let clip = pantin::Clip::new_checked(&bytes).unwrap();
    let texts = [rust_module(&clip, &bytes, "bend").unwrap(), c_header(&clip, &bytes, "bend").unwrap()];
    for text in texts {
        assert!(text.contains(" left-shin: Xexponential, Yexponential, Zexponential"), "{text}");
        assert!(text.contains("\"left-shin.Yexponential\"") && text.contains("\"spine.Xrotation\""), "{text}");
        assert!(!text.contains("left-shin.Xrotation"), "{text}");
    }
}

/// Names of files that are no identifiers, are words of a language, or look like another one's constant.
const STEMS: [&str; 19] = [
    "walk",
    "Walk",
    "WALK",
    "a-b",
    "a_b",
    "a b",
    "EOF",
    "int",
    "fn",
    "walk_frames",
    "walk_len",
    "",
    "2nd",
    "é",
    "\u{202e}gnp",
    "walk_h",
    "x*/y",
    "NULL",
    "crate",
];

/// A clip whose joints and scalars have hostile names.
fn hostile_clip() -> Vec<u8> {
    let names = ["*/ #error", "\u{202e}x\u{2066}", "a\"b\\", "??/", "tab\there", "x\r\ny", "e\u{301}", "\u{200b}", ""];
    let joint = |(index, name): (usize, &&str)| pantin_convert::motion::Joint {
        name: name.to_string(),
        parent: index.checked_sub(1),
        offset: [0.0, 1.0, 0.0],
        kinds: vec![pantin_convert::motion::Kind::Xrotation],
        end_site: false,
        helper: false,
    };
    let scalar = |name: &&str| pantin_convert::motion::Scalar { name: name.to_string(), full_scale: 1.0 };
    let rig = pantin_convert::motion::Rig {
        joints: names.iter().enumerate().map(joint).collect(),
        scalars: names.iter().map(scalar).collect(),
        cm_per_unit: 1.0,
        ..Default::default()
    };
    let channels = rig.channels();
    let values = vec![vec![0.0, 0.5]; channels];
    let keys = vec![None; channels];
    let motion = pantin_convert::motion::Motion {
        rig,
        frame_time: 0.1,
        frames: 2,
        keys,
        values,
        looped: false,
        events: Vec::new(),
        origin: Default::default(),
    };
    let coded = fit(&motion, Level::FAST.plan(PoseBound::places(1.0)), 0.02, &mut |_| ()).unwrap();
    clip::encode(&coded, &rig::encode(&motion.rig).unwrap(), false).unwrap()
}

#[test]
fn headers_of_any_names_compile_together() {
    let (clips, folder) = ([walk(), hostile_clip()], folder("hostile"));
    let (mut c, mut length) = (String::from("#include <stdio.h>\n#include <stdlib.h>\n"), String::new());
    let mut rust = String::new();
    let mut uses = String::new();
    for (index, stem) in STEMS.iter().enumerate() {
        let bytes = &clips[index % 2];
        let opened = pantin::Clip::new_checked(bytes).unwrap();
        let (header, module) = (c_header(&opened, bytes, stem).unwrap(), rust_module(&opened, bytes, stem).unwrap());
        for text in [&header, &module] {
            let hostile = text.chars().find(|c| *c != '\n' && pantin_tools::output::is_hostile(*c));
            assert_eq!(hostile, None, "{stem:?}");
        }
        let name = header.lines().find_map(|line| line.strip_prefix("#define ")?.strip_suffix("_H")).unwrap();
        let name = name.strip_prefix("PANTIN_").unwrap();
        c += &format!(
            "#include \"{index}.h\"\n#include \"{index}.h\"\nstatic const char *const names{index}[] = {{ {name}_NAMES }};\n"
        );
        length += &format!(" + (sizeof {name} == {name}_LEN && names{index}[{name}_CHANNELS - 1] && {name}_FRAMES)");
        rust += &format!("#[path = \"{index}.rs\"]\nmod m{index};\nuse m{index}::*;\n");
        let name = name.strip_prefix("CLIP_").unwrap();
        uses += &format!(" + usize::from({name}.len() == {} && {name}_NAMES.len() == {name}_CHANNELS)", bytes.len());
        std::fs::write(folder.join(format!("{index}.h")), header).unwrap();
        std::fs::write(folder.join(format!("{index}.rs")), module).unwrap();
    }
    c += &format!("int main(void) {{ printf(\"%d\", 0{length}); return 0; }}\n");
    rust += &format!("fn main() {{ print!(\"{{}}\", 0{uses}); }}\n");
    std::fs::write(folder.join("main.c"), &c).unwrap();
    std::fs::write(folder.join("main.rs"), format!("#![deny(warnings)]\n#![allow(dead_code)]\n{CRATE}{rust}")).unwrap();
    for (compiler, options, program) in [
        ("cc", &["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"][..], "main.c"),
        ("rustc", &["--edition=2024"][..], "main.rs"),
    ] {
        if let Some(out) = printed_with(compiler, options, &folder.join(program), &folder) {
            assert_eq!(String::from_utf8(out).unwrap(), STEMS.len().to_string(), "{compiler}");
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn two_clips_of_one_name_are_an_error_and_not_left_out() {
    let (first, second, folder) = (walk(), hostile_clip(), folder("twins"));
    for (name, bytes) in [("a.h", &first), ("b.h", &second)] {
        let header = c_header(&pantin::Clip::new_checked(bytes).unwrap(), bytes, "walk").unwrap();
        std::fs::write(folder.join(name), header).unwrap();
    }
    std::fs::write(folder.join("main.c"), "#include \"a.h\"\n#include \"b.h\"\nint main(void) { return 0; }\n").unwrap();
    match Command::new("cc").arg("-fsyntax-only").arg(folder.join("main.c")).output() {
        Ok(compiled) => {
            let said = String::from_utf8_lossy(&compiled.stderr);
            assert!(!compiled.status.success() && said.contains("two clips have the name CLIP_WALK"), "{said}");
        }
        Err(_) => println!("skipped: no cc here"),
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

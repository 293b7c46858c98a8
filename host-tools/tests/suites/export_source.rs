//! What `pantin expand` writes for firmware compiles, and holds the clip's bytes.

use pantin_tools::encode::{clip, rig};
use pantin_tools::export::source::{c_header, rust_module};
use pantin_tools::fit::{descent::Level, fit};
use pantin_tools::import::{self, Options};
use std::path::{Path, PathBuf};
use std::process::Command;

fn walk() -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../motions/walk.keys");
    let motion = import::load(&path, &Options::default()).unwrap().motion;
    let coded = fit(&motion, Level::Fast.plan(1.0), 0.02, &mut |_| ()).unwrap();
    clip::encode(&coded, &rig::encode(&motion.rig).unwrap(), false).unwrap()
}

/// Compiles and runs a program that prints the clip's bytes; `None` without the compiler.
fn printed(compiler: &str, program: &Path, folder: &Path) -> Option<Vec<u8>> {
    let runs = folder.join("program").with_extension(std::env::consts::EXE_EXTENSION);
    let Ok(compiled) = Command::new(compiler).arg(program).arg("-o").arg(&runs).output() else {
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
    let main = "mod walk;\nuse std::io::Write;\nfn main() {\n    assert!(walk::WALK_FRAMES == 160 && walk::WALK_MOVING <= walk::WALK_CHANNELS && walk::WALK_FRAME_TIME_NS > 0);\n    assert!(walk::WALK_FIGURE_JOINTS == 25 && walk::WALK_WORKSPACE == 29 && walk::WALK_NAMES[0] == \"root.Zposition\");\n    std::io::stdout().write_all(&walk::WALK).unwrap();\n}\n";
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
    let main = "#include <stdio.h>\n#include \"walk.h\"\n#include \"walk.h\"\nstatic const char *const names[WALK_CHANNELS] = { WALK_NAMES };\nint main(void) { return fwrite(WALK, 1, WALK_LEN, stdout) != sizeof WALK || WALK_FRAMES != 160 || WALK_FIGURE_JOINTS != 25 || WALK_WORKSPACE != 29 || names[0][0] != 'r' || !names[WALK_CHANNELS - 1]; }\n";
    std::fs::write(folder.join("main.c"), main).unwrap();
    if let Some(out) = printed("cc", &folder.join("main.c"), &folder) {
        assert_eq!(out, bytes);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Where a clip codes Euler angles as an exponential map, firmware reads the map's components: the source text says so.
#[test]
fn channels_are_named_as_the_clip_codes_them() {
    let bytes = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../motions/kneebend.ptn")).unwrap();
    let clip = pantin::Clip::new_checked(&bytes).unwrap();
    let texts = [rust_module(&clip, &bytes, "bend").unwrap(), c_header(&clip, &bytes, "bend").unwrap()];
    for text in texts {
        assert!(text.contains(" left-shin: Xexponential, Yexponential, Zexponential"), "{text}");
        assert!(text.contains("\"left-shin.Yexponential\"") && text.contains("\"spine.Xrotation\""), "{text}");
        assert!(!text.contains("left-shin.Xrotation"), "{text}");
    }
}

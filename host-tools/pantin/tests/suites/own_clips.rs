//! The clips that boards play of their own are what `pantin convert` makes of our motions by its defaults, but for the bound:
//! they are drawn as lines between joints, so that the places of joints are bounded alone. They hold segments, which images without feature `keys` play.
//!
//! After a change of the motions, the fit or the format, `PANTIN_UPDATE=1 cargo test -p pantin-tools own_clips::` writes them again.

use std::path::{Path, PathBuf};
use std::process::Command;

/// All of them, without their endings, from the folder `motions`.
const CLIPS: [&str; 8] = ["walk", "run", "greet", "kneebend", "face/hello", "face/joy", "face/surprise", "face/wink"];

fn motions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions")
}

fn converted(motion: &Path, clip: &Path) -> Vec<u8> {
    let out = Command::new(env!("CARGO_BIN_EXE_pantin"))
        .args(["convert", "--places-only", "--segments"])
        .arg(motion)
        .arg("-o")
        .arg(clip)
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    std::fs::read(clip).unwrap()
}

#[test]
fn the_committed_clips_are_what_the_tool_makes() {
    let folder = std::env::temp_dir().join(format!("pantin-own-clips-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("face")).unwrap();
    let update = std::env::var_os("PANTIN_UPDATE").is_some();
    let mut stale = vec![];
    for name in CLIPS {
        let file = |folder: &Path, ending: &str| folder.join(name).with_extension(ending);
        let bytes = converted(&file(&motions(), "keys"), &file(&folder, "ptn"));
        let committed = file(&motions(), "ptn");
        if update {
            std::fs::write(&committed, &bytes).unwrap();
        } else if std::fs::read(&committed).ok().as_ref() != Some(&bytes) {
            stale.push(name);
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(stale.is_empty(), "{stale:?}: set PANTIN_UPDATE=1 to write them again");
}

#[test]
fn no_other_clip_is_committed() {
    let ours = ["", "face"].iter().flat_map(|folder| std::fs::read_dir(motions().join(folder)).unwrap());
    let clips = ours.filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|ending| ending == "ptn"));
    assert_eq!(clips.count(), CLIPS.len());
}

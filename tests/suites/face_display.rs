//! Faces, alone and with their body, on the boards' displays: what the same program shows on the host, pixel by pixel.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use harness::build::Firmware;
use harness::icount::FRAME_REGIONS;
use harness::qemu::{LM3S6965EVB, MICROBIT, MPS2_AN386, Machine, RISCV_VIRT, SX1};
use harness::{clips, equal, paths, setup, simulator};
use pantin_figure::rotation::Rotation;
use tempfile::TempDir;

/// A clip and the number of pictures that are compared: more than its frames go round.
struct Part {
    clip: PathBuf,
    pictures: usize,
}

/// Our own as they are committed, and a recorded one where there are any.
static PARTS: LazyLock<(TempDir, Vec<Part>)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let own = |name: &str, pictures| Part { clip: paths::root().join("motions").join(name), pictures };
    let mut parts = vec![own("face/hello.ptn", 60), own("greet.ptn", 60), own("face/wink.ptn", 20)];
    let recorded = paths::data().map(|data| data.join("face_neurosync_angry_arkit.csv")).filter(|path| path.exists());
    match recorded {
        Some(motion) => parts.push(Part { clip: clips::convert(&motion, folder.path()).unwrap(), pictures: 50 }),
        None => println!("skipped: no recorded face in $PANTIN_DATA"),
    }
    (folder, parts)
});

fn files() -> Vec<PathBuf> {
    PARTS.1.iter().map(|part| part.clip.clone()).collect()
}

fn firmware(machine: Machine) -> Firmware {
    let files = files();
    let clips: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    Firmware::featuring("face", machine.name, machine.name, machine.target, &clips).unwrap()
}

fn plays(machine: Machine, firmware: &Firmware, keys: &[&[u8]]) -> Vec<f64> {
    let expected = simulator::play::<Rotation>(machine.display.unwrap(), &files(), &[], keys).unwrap();
    equal::shows(machine, firmware, &expected, keys).iter().map(|kind| kind.mean()).collect()
}

/// All clips in turn, then the keys that turn the view, in the face alone and in both.
fn plays_faces(machine: Machine) {
    if setup::host_only(&format!("faces on {}", machine.name)) {
        return;
    }
    let firmware = firmware(machine);
    let through = |part: &Part| std::iter::repeat_n(&b""[..], part.pictures - 1).chain([&b"n"[..]]);
    let keys: Vec<&[u8]> = PARTS.1.iter().flat_map(through).collect();
    plays(machine, &firmware, &keys);
    let turns: [&[u8]; 12] = [b"", b"a", b"dd", b"w", b"ss", b"v", b"i", b"n", b"a", b"w", b"vg", b"n"];
    plays(machine, &firmware, &turns);
    let talk = vec![&b""[..]; 59];
    let means = plays(machine, &firmware, &talk);
    println!("{}: instructions per frame of hello: {FRAME_REGIONS:?} {means:.0?}", machine.name);
}

#[test]
fn lm3s6965evb_plays_faces_as_the_host_does() {
    plays_faces(LM3S6965EVB);
}

#[test]
fn microbit_plays_faces_as_the_host_does() {
    plays_faces(MICROBIT);
}

#[test]
fn mps2_an386_plays_faces_as_the_host_does() {
    plays_faces(MPS2_AN386);
}

#[test]
fn riscv_virt_plays_faces_as_the_host_does() {
    plays_faces(RISCV_VIRT);
}

#[test]
fn sx1_plays_faces_as_the_host_does() {
    plays_faces(SX1);
}

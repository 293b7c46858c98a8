//! The solid figure: every emulated machine shows what the host shows, pixel by pixel, on surfaces of two colours, 16 greys and 65,536 colours.

use std::path::{Path, PathBuf};

use harness::build::Firmware;
use harness::icount::FRAME_REGIONS;
use harness::qemu::{LM3S6965EVB, MICROBIT, MPS2_AN386, Machine, RISCV_VIRT, SX1};
use harness::{equal, paths, setup, simulator};
use pantin_figure::rotation::Rotation;

/// Pictures of our walk and our run.
const PICTURES: [(&str, usize); 2] = [("walk", 14), ("run", 10)];
/// Letters that turn the view, and change the style to lines and back.
const LETTERS: [&[u8]; 9] = [b"v", b"w", b"sss", b"a", b"dd", b"f", b"o", b"og", b"+"];

fn shows_what_the_host_shows(machine: Machine) {
    if setup::host_only(&format!("the solid figure on {}", machine.name)) {
        return;
    }
    let clips: Vec<PathBuf> = PICTURES.map(|(name, _)| paths::root().join("motions").join(name).with_extension("ptn")).into();
    let files: Vec<&Path> = clips.iter().map(PathBuf::as_path).collect();
    let firmware = Firmware::featuring("solid", machine.name, machine.name, machine.target, &files).unwrap();
    let through = |(_, pictures)| std::iter::repeat_n(&b""[..], pictures - 1).chain([&b"n"[..]]);
    // The first letter changes from lines to volume.
    let keys: Vec<&[u8]> = [&b"o"[..]].into_iter().chain(PICTURES.into_iter().flat_map(through)).chain(LETTERS).collect();
    let expected = simulator::play::<Rotation>(machine.display.unwrap(), &clips, &[], &keys).unwrap();
    let means: Vec<f64> = equal::shows(machine, &firmware, &expected, &keys).iter().map(|kind| kind.mean()).collect();
    println!("{}: {} pictures are equal; instructions per frame: {FRAME_REGIONS:?} {means:.0?}", machine.name, expected.len());
}

#[test]
fn a_cortex_m3_shows_the_hosts_solid_figure_in_greys() {
    shows_what_the_host_shows(LM3S6965EVB);
}

#[test]
fn a_cortex_m0_shows_the_hosts_solid_figure_in_two_colours() {
    shows_what_the_host_shows(MICROBIT);
}

#[test]
fn a_cortex_m4_shows_the_hosts_solid_figure() {
    shows_what_the_host_shows(MPS2_AN386);
}

#[test]
fn a_risc_v_shows_the_hosts_solid_figure() {
    shows_what_the_host_shows(RISCV_VIRT);
}

#[test]
fn a_phone_shows_the_hosts_solid_figure_in_colour() {
    shows_what_the_host_shows(SX1);
}

#[test]
fn a_cortex_m4_shows_the_hosts_face_on_the_neck() {
    const MACHINE: Machine = MPS2_AN386;
    if setup::host_only("a face on the neck") {
        return;
    }
    let clip = paths::root().join("motions/greet.ptn");
    let firmware = Firmware::featuring("neck", MACHINE.name, MACHINE.name, MACHINE.target, &[&clip]).unwrap();
    // From all sides, then as lines, which have no face.
    let keys: Vec<&[u8]> = std::iter::repeat_n(&b"dd"[..], 13).chain([&b"o"[..], b"o"]).collect();
    let words = ["solid", "neck"];
    let expected = simulator::play::<Rotation>(MACHINE.display.unwrap(), std::slice::from_ref(&clip), &words, &keys).unwrap();
    let beside = simulator::play::<Rotation>(MACHINE.display.unwrap(), std::slice::from_ref(&clip), &["solid"], &keys).unwrap();
    assert!(expected.iter().zip(&beside).all(|(neck, beside)| neck.1 != beside.1));
    let means: Vec<f64> =
        equal::shows_with(MACHINE, &firmware, &words, &expected, &keys).iter().map(|kind| kind.mean()).collect();
    println!(
        "{} pictures with a face on the neck are equal; instructions per frame: {FRAME_REGIONS:?} {means:.0?}",
        expected.len()
    );
}

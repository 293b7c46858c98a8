//! The same poses on every core: each plays all golden vectors, and finds the CRCs that stand in the repository.

use std::process::Command;

use harness::conformance::{CORES, Expected, Place};
use harness::{paths, setup, vectors};

fn agrees(core: &str) {
    let (_, place) = CORES.into_iter().find(|(name, _)| *name == core).unwrap();
    if !matches!(place, Place::Host) && setup::host_only(core) {
        return;
    }
    let expected = Expected::load().unwrap();
    let agreed = expected.check(place).unwrap_or_else(|error| panic!("{core}: {error:#}"));
    assert!(agreed.vectors >= 20 && agreed.poses > 1000, "{agreed:?}");
}

#[test]
fn this_host_agrees() {
    agrees("this host");
}

#[test]
fn cortex_m0_agrees() {
    agrees("Cortex-M0");
}

#[test]
fn cortex_m0_plus_agrees() {
    agrees("Cortex-M0+");
}

#[test]
fn cortex_m3_agrees() {
    agrees("Cortex-M3");
}

#[test]
fn cortex_m4f_agrees() {
    agrees("Cortex-M4F");
}

#[test]
fn armv4t_agrees() {
    agrees("ARMv4T");
}

#[test]
fn rv32imac_agrees() {
    agrees("RV32IMAC");
}

#[test]
fn webassembly_agrees() {
    agrees("wasm32");
}

#[test]
fn a_decoder_written_from_the_format_alone_agrees() {
    if setup::host_only("the independent decoder") {
        return;
    }
    let script = paths::root().join("tests/independent/decode.mjs");
    for folder in [vectors::folder(), vectors::keyed::folder()] {
        let output = Command::new(setup::emulator("node").unwrap()).arg(&script).arg(&folder).output().unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{told}{}", String::from_utf8_lossy(&output.stderr));
        let banks = std::fs::read_dir(&folder).unwrap();
        let banks =
            banks.filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|extension| extension == "ptb")).count();
        assert_eq!(told.lines().count(), vectors::load(&folder).unwrap().len() + banks);
    }
}

/// The JavaScript package: the vectors by steps and seeks, joints placed by matrices, and damaged files that the independent decoder reads too.
#[test]
fn the_decoder_for_the_web_agrees() {
    if setup::host_only("the decoder of the npm package") {
        return;
    }
    let script = paths::root().join("web/packages/decoder/test/vectors.mjs");
    let output = Command::new(setup::emulator("node").unwrap()).arg(script).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn the_tables_of_the_decoder_for_the_web_are_those_of_the_format() {
    if setup::host_only("the tables of the npm package") {
        return;
    }
    let package = paths::root().join("web/packages/decoder");
    for (arguments, name) in [(&[][..], "tables.js"), (&["names"], "names.js")] {
        let tables = std::fs::File::open(vectors::folder().join("tables.json")).unwrap();
        let mut node = Command::new(setup::emulator("node").unwrap());
        let output = node.arg(package.join("make-tables.mjs")).args(arguments).stdin(tables).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.stdout, std::fs::read(package.join(name)).unwrap(), "make-tables.mjs writes {name}");
    }
}

//! What a decoder brings into an image of the smallest processor: no way to panic, no division, no float, tables of 2 KiB, and no code that
//! is not called.

use harness::image::{DECODERS, Image};
use harness::qemu::MICROBIT;
use harness::setup;

/// Bytes of code of each of [`DECODERS`], without the compiler's memory functions: growth is to be meant. (`cargo xtask bench footprint` says
/// what the goals are.)
const CODE: [u64; DECODERS.len()] = [5400, 6730, 8230, 10440];
/// Bytes of tables.
const TABLES: u64 = 2420;

#[test]
fn the_decoder_alone_cannot_panic_and_stays_small() {
    setup::rust_target(MICROBIT.target).unwrap();
    let empty = Image::read("image-empty").unwrap();
    let parts = ["Clip::open", "Player::step", "segment::read", "crc::update", "tables::NUMBER"];
    let seeks = ["Player::go", "PlayState::run_to"];
    for ((name, what), most) in DECODERS.into_iter().zip(CODE) {
        let image = Image::read(name).unwrap();
        let holds = |part: &&str| image.symbols.iter().any(|(name, _)| name.contains(part));
        assert!(parts.iter().all(holds), "{name} lacks one of {parts:?}: it measures something else");
        // Code that is not called is not linked.
        let expected = if name == "image-step" { 0 } else { seeks.len() };
        assert_eq!(seeks.iter().filter(|part| holds(part)).count(), expected, "{name}");
        assert!(image.unwanted().is_empty(), "{name}: {:?}", image.unwanted());
        let (code, tables) = (image.code - empty.code, image.tables - empty.tables);
        println!("{what}: {code} bytes of code, {tables} of tables");
        assert!(code <= most && tables <= TABLES, "{what}: {code} bytes of code, {tables} of tables");
    }
}

#[test]
fn a_joints_angles_stay_small() {
    setup::rust_target(MICROBIT.target).unwrap();
    let (step, euler) = (Image::read("image-step").unwrap(), Image::read("image-euler").unwrap());
    let holds = |part: &&str| euler.symbols.iter().any(|(name, _)| name.contains(part));
    assert!(["Rig::find", "trig::atan2"].iter().all(holds), "it measures something else");
    assert!(euler.unwanted().is_empty(), "{:?}", euler.unwanted());
    let bytes = euler.size() - step.size();
    assert!(bytes <= 3072, "{bytes} bytes of code and tables");
}

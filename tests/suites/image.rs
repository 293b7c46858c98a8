//! What a decoder brings into an image of the smallest processor: no way to panic, no division, no float, tables of 2 KiB.

use harness::image::Image;
use harness::qemu::MICROBIT;
use harness::setup;

/// Bytes of code, the compiler's memory functions among them: growth is to be meant. (`cargo xtask bench footprint` says what the goal is.)
/// Since poses have a form, the header has one parser for files and streams: 700 bytes more, and a jump table.
const CODE: u64 = 12_600;
/// Bytes of tables.
const TABLES: u64 = 2112;

#[test]
fn the_decoder_alone_cannot_panic_and_stays_small() {
    setup::rust_target(MICROBIT.target).unwrap();
    let (empty, decoder) = (Image::read("image-empty").unwrap(), Image::read("image-decoder").unwrap());
    let named = |part: &str| decoder.symbols.iter().any(|(name, _)| name.contains(part));
    for part in ["Clip::open", "Player::step", "Player::go", "segment::read", "crc::update", "tables::NUMBER"] {
        assert!(named(part), "the image has no {part}: it measures something else");
    }
    assert!(decoder.unwanted().is_empty(), "{:?}", decoder.unwanted());
    let (code, tables) = (decoder.code - empty.code, decoder.tables - empty.tables);
    println!("{code} bytes of code, {tables} of tables");
    assert!(code <= CODE && tables <= TABLES, "{code} bytes of code, {tables} of tables");
}

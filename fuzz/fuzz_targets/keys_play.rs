//! Runs the fuzz target `keys_play` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("keys_play").expect("a target of this name");
    let _ = (target.run)(bytes);
});

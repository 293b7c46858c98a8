//! Runs the fuzz target `live_bvh` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("live_bvh").expect("a target of this name");
    let _ = (target.run)(bytes);
});

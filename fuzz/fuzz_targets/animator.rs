//! Runs the fuzz target `animator` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("animator").expect("a target of this name");
    let _ = (target.run)(bytes);
});

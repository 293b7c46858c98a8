//! Runs the fuzz target `update_receive` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("update_receive").expect("a target of this name");
    let _ = (target.run)(bytes);
});

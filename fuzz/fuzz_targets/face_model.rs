//! Runs the fuzz target `face_model` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("face_model").expect("a target of this name");
    let _ = (target.run)(bytes);
});

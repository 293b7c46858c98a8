//! Runs the fuzz target `import_livelink` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("import_livelink").expect("a target of this name");
    let _ = (target.run)(bytes);
});

//! Runs the fuzz target `import_proc` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("import_proc").expect("a target of this name");
    let _ = (target.run)(bytes);
});

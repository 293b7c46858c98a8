//! Runs the fuzz target `bank_open` of the `hostile` package.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = hostile::fuzz_target("bank_open").expect("a target of this name");
    let _ = (target.run)(bytes);
});

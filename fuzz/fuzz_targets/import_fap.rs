//! The door `import_fap` of the `hostile` package, which says what must hold.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let door = hostile::door("import_fap").expect("a door of this name");
    let _ = (door.enter)(bytes);
});

//! The door `import_vrml` of the `hostile` package, which says what must hold.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let door = hostile::door("import_vrml").expect("a door of this name");
    let _ = (door.enter)(bytes);
});

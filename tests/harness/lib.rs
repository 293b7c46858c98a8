//! Emulators, screens and images of the firmware, for tests and for `cargo xtask`.

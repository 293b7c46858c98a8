//! Core libraries that cargo compiles from source.

use std::ffi::OsString;

use crate::{paths, setup};

/// Arguments and variables with which cargo builds the core library of a target itself; none where Rust ships it compiled.
#[derive(Default)]
pub struct Core {
    /// Arguments for cargo.
    pub arguments: Vec<OsString>,
    /// Variables for it.
    pub environment: Vec<(OsString, OsString)>,
}

impl Core {
    /// For a Rust target of the firmware.
    pub fn of(target: &str) -> Core {
        if setup::is_from_source(target) { from_source() } else { Core::default() }
    }
}

/// Cargo compiles core itself: unstable, so the stable compiler must be allowed to. In a folder of its own, since build
/// scripts run again whenever that permission comes or goes.
fn from_source() -> Core {
    let folder = paths::firmware().join("target/core-from-source");
    Core {
        arguments: vec!["-Zbuild-std=core".into()],
        environment: vec![("RUSTC_BOOTSTRAP".into(), "1".into()), ("CARGO_TARGET_DIR".into(), folder.into())],
    }
}

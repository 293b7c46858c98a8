//! Nothing: `Cargo.toml` says why.
#![no_std]

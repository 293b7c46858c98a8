//! The suites that need more than one crate, one module each: on the host, in QEMU, in a Pico's emulator and in Chromium.

mod conformance;
mod differential;
mod display;
mod download;
mod examples;
mod face_display;
mod gba;
mod hostile;
mod icount;
mod image;
mod independent;
mod laws;
mod link;
mod memory;
mod panels;
mod pico;
mod pico_update;
mod qemu;
mod soak;
mod solid;
mod stack;
mod steered;
mod stm32;
mod update;
mod vectors;
mod web;

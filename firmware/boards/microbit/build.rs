//! The board's memory map, and the clips.

fn main() {
    let update = std::env::var_os("CARGO_FEATURE_UPDATE").is_some();
    board_build::memory_map(if update { "update.x" } else { "memory.x" });
    board_build::link(&["--nmagic", "-Tlink.x", "-Tdefmt.x"]);
    if update {
        board_build::interrupts("device.x");
    }
    board_build::clips();
}

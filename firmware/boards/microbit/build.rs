//! The board's memory map, and the clips.

fn main() {
    let update = board_build::feature("update");
    board_build::memory_map(if update { "update.x" } else { "memory.x" });
    board_build::link(&["--nmagic", "-Tlink.x", "-Tdefmt.x"]);
    if update {
        board_build::interrupts("device.x");
    }
    let clips = board_build::clips();
    let most = board_build::SMALL;
    // Any clip may come over the line.
    board_build::capacity(if update { most } else { clips }, most);
}

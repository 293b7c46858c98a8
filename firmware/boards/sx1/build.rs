//! The phone's memory map, and the clips.

fn main() {
    board_build::memory_map("memory.x");
    board_build::link(&["--nmagic", "-Tmemory.x", "-Tdefmt.x"]);
    board_build::clips();
}

//! The machine's memory map, and the clips.

fn main() {
    board_build::memory_map("memory.x");
    board_build::link(&["--nmagic", "-Tmemory.x", "-Tlink.x", "-Tdefmt.x"]);
    board_build::clips();
}

//! The machine's memory map, and the clips.

fn main() {
    board_build::board(&["--nmagic", "-Tmemory.x", "-Tlink.x", "-Tdefmt.x"]);
}

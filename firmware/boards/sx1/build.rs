//! The phone's memory map, and the clips.

fn main() {
    board_build::board(&["--nmagic", "-Tmemory.x", "-Tdefmt.x"]);
}

//! The board's memory map, and the clips.

fn main() {
    board_build::board(&["--nmagic", "-Tlink.x", "-Tdefmt.x"]);
}

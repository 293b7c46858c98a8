//! The memory map and the clips.

fn main() {
    let map = if board_build::feature("pins-xiao") { "xiao.x" } else { "memory.x" };
    board_build::board_in(map, &["--nmagic", "-Tlink.x"]);
}

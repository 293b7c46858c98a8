//! The reference machine's memory map, and the clips.

fn main() {
    board_build::memory_map("../../../memory.x");
    board_build::link(&["--nmagic", "-Tlink.x", "-Tdefmt.x"]);
    let clips = board_build::clips();
    let most = if board_build::feature("large") { [400, 256, 64] } else { board_build::SMALL };
    // Any clip may come over a line.
    let any = board_build::feature("link") || board_build::feature("ethernet");
    board_build::capacity(if any { most } else { clips }, most);
}

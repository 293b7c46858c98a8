//! The cartridge's memory map, and the clips.

fn main() {
    board_build::memory_map("memory.x");
    // What is drawn lies in the fast RAM: there is no room for both styles.
    let solid = std::env::var_os("CARGO_FEATURE_SOLID").is_some();
    board_build::memory_map_part(if solid { "fast-solid.x" } else { "fast-lines.x" }, "fast.x");
    board_build::link(&["--nmagic", "-Tmemory.x"]);
    board_build::capacity(board_build::clips(), MOST);
}

/// Channels, moving channels and joints of the largest clip: its buffers lie in the fast RAM.
const MOST: [usize; 3] = [400, 320, 80];

//! The cartridge's memory map, and the clips.

fn main() {
    board_build::memory_map("memory.x");
    board_build::link(&["--nmagic", "-Tmemory.x"]);
    board_build::capacity(board_build::clips(), MOST);
}

/// Channels, moving channels and joints of the largest clip: its buffers lie in the fast RAM.
const MOST: [usize; 3] = [400, 320, 80];

//! The board's memory map, and the clips.

fn main() {
    board_build::memory_map("memory.x");
    board_build::link(&["--nmagic", "-Tlink.x"]);
    if std::env::var_os("CARGO_FEATURE_DEFMT").is_some() {
        board_build::link(&["-Tdefmt.x"]);
    }
    board_build::clips();
}

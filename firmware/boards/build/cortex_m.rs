//! The build script of the boards with a Cortex-M that one can hold: `build = "../build/cortex_m.rs"` in their `Cargo.toml`.

fn main() {
    board_build::board(&["--nmagic", "-Tlink.x"]);
}

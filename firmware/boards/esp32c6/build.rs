//! The chip's memory map, which comes with its own crate, and the clips.

fn main() {
    board_build::link(&["-Tlinkall.x"]);
    board_build::display();
    board_build::clips();
}

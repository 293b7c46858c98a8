//! The chip's memory map, which comes with its own crate, and the clips.

fn main() {
    board_build::link(&["-Tlinkall.x"]);
    // The addresses to which src/flash.rs maps the slots: programs are linked below them.
    board_build::link(&["--defsym=_clips_start=0x3c400000", "--defsym=_clips_end=0x3c420000"]);
    board_build::display();
    board_build::clips();
}

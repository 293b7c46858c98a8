//! The memory map and the clips, also for the Nucleo-F411RE.

fn main() {
    // Their pictures leave too little of the 64 KiB for the stack.
    let is_large = ["st7789-240x320", "ili9341"].into_iter().any(board_build::feature);
    board_build::board_in(
        if is_large { "../blackpill/memory-128k.x" } else { "../blackpill/memory.x" },
        &["--nmagic", "-Tlink.x"],
    );
}

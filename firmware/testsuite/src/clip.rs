//! A clip that the emulator has put into the upper half of the flash, so that one image serves all clips.

/// Most channels of a clip that these programs play; they take 11 of the 16 KiB of RAM.
pub const CHANNELS: usize = 470;

/// The clip's bytes: the semihosting arguments say at which address they are, and how many.
pub fn bytes() -> &'static [u8] {
    let Ok(arguments) = semihosting::experimental::env::args::<64>() else { panic!() };
    let mut numbers = arguments.flatten().filter_map(|argument| argument.parse::<usize>().ok());
    let (Some(address), Some(length)) = (numbers.next(), numbers.next()) else { panic!() };
    // SAFETY: the harness has put that number of bytes there, into flash that the memory map leaves free. Nothing writes them.
    #[allow(unsafe_code)]
    unsafe {
        core::slice::from_raw_parts(address as *const u8, length)
    }
}

//! A clip that the emulator has put into the upper half of the flash, so that one image serves all clips.

/// Where the emulator puts it.
pub const ADDRESS: usize = 0x2_0000;

/// Most bytes of it: the rest of the flash.
pub const MOST_BYTES: usize = 0x2_0000;

/// Most channels of a clip that these programs play; so many take 11 of the 16 KiB of RAM.
pub const CHANNELS: usize = 470;

/// The clip's bytes; their number is the first semihosting argument.
pub fn bytes() -> &'static [u8] {
    let Ok(arguments) = semihosting::experimental::env::args::<64>() else { panic!() };
    let Some(length) = arguments.flatten().next().and_then(|length| length.parse().ok()) else { panic!() };
    assert!(length <= MOST_BYTES);
    // SAFETY: the memory map ends the image's part of the flash at ADDRESS. All of these bytes are flash, and nothing writes them.
    #[allow(unsafe_code)]
    unsafe {
        core::slice::from_raw_parts(ADDRESS as *const u8, length)
    }
}

//! The flash that each board reserves for clips.

/// A board's flash for clips: two adjacent slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The name of the board.
    pub board: &'static str,
    /// The address of the first slot, as flash tools expect it.
    pub address: u32,
    /// Bytes of a slot: a whole number of sectors.
    pub slot: u32,
    /// Bytes of a sector, the unit that is erased.
    pub sector: u32,
    /// Bytes of a word, the unit that is written.
    pub word: u32,
    /// The UF2 family of the chip, for boards with a drive that takes UF2 files.
    pub family: Option<u32>,
}

/// The boards with a store. Their memory maps contain the same addresses.
pub const REGIONS: [Region; 8] = [
    // The last two sectors of 512 KiB.
    Region { board: "blackpill", address: 0x0804_0000, slot: 128 << 10, sector: 128 << 10, word: 1, family: None },
    // The last 128 KiB of 4 MiB, as flash addresses; the firmware maps them elsewhere.
    Region { board: "esp32-c3", address: 0x003e_0000, slot: 64 << 10, sector: 4096, word: 4, family: None },
    // The last 64 KiB of 256.
    Region { board: "microbit", address: 0x0003_0000, slot: 32 << 10, sector: 1024, word: 4, family: None },
    // The last 128 KiB of 512.
    Region { board: "microbit-v2", address: 0x0006_0000, slot: 64 << 10, sector: 4096, word: 4, family: None },
    // The last 128 KiB of 1,024.
    Region { board: "nrf52840-dk", address: 0x000e_0000, slot: 64 << 10, sector: 4096, word: 4, family: None },
    // As the Black Pill's.
    Region { board: "nucleo-f411re", address: 0x0804_0000, slot: 128 << 10, sector: 128 << 10, word: 1, family: None },
    // The last 512 KiB of 2,048.
    Region { board: "pico", address: 0x1018_0000, slot: 256 << 10, sector: 4096, word: 256, family: Some(0xe48b_ff56) },
    // The last 128 KiB that its boot loader takes UF2 files for.
    Region { board: "xiao-nrf52840", address: 0x0008_d000, slot: 64 << 10, sector: 4096, word: 4, family: Some(0xada5_2840) },
];

impl Region {
    /// Finds a board by its name.
    pub fn of(board: &str) -> Option<&'static Region> {
        REGIONS.iter().find(|region| region.board == board)
    }
}

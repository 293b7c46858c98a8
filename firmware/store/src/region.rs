//! Where boards keep their clips.

/// A board's flash for clips: two slots, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The board.
    pub board: &'static str,
    /// Where the first slot begins, for who flashes it.
    pub address: u32,
    /// Bytes of a slot: complete sectors.
    pub slot: u32,
    /// Bytes that are erased at once.
    pub sector: u32,
    /// Bytes that are written at once.
    pub word: u32,
    /// Of a board with a drive that takes UF2 files: its chip's family.
    pub family: Option<u32>,
}

/// The boards that have a store. Their memory maps say the same.
pub const REGIONS: [Region; 5] = [
    // The last two sectors of 512 KiB.
    Region { board: "blackpill", address: 0x0804_0000, slot: 128 << 10, sector: 128 << 10, word: 1, family: None },
    // The last 128 KiB of 4 MiB, as they are flashed; the processor reads them where the firmware maps them.
    Region { board: "esp32-c3", address: 0x003e_0000, slot: 64 << 10, sector: 4096, word: 4, family: None },
    // The last 64 KiB of 256.
    Region { board: "microbit", address: 0x0003_0000, slot: 32 << 10, sector: 1024, word: 4, family: None },
    // The last 128 KiB of 512.
    Region { board: "microbit-v2", address: 0x0006_0000, slot: 64 << 10, sector: 4096, word: 4, family: None },
    // The last 512 KiB of 2,048.
    Region { board: "pico", address: 0x1018_0000, slot: 256 << 10, sector: 4096, word: 256, family: Some(0xe48b_ff56) },
];

impl Region {
    /// The board of this name.
    pub fn of(board: &str) -> Option<&'static Region> {
        REGIONS.iter().find(|region| region.board == board)
    }
}

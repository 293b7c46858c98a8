//! Where boards keep their clips.

/// A board's flash for clips: two slots, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The board.
    pub board: &'static str,
    /// Where the first slot begins, for the processor and for who flashes it.
    pub address: u32,
    /// Bytes of a slot: whole sectors.
    pub slot: u32,
    /// Bytes that are erased at once.
    pub sector: u32,
    /// Bytes that are written at once.
    pub word: u32,
}

/// The boards that have a store. Their memory maps say the same.
pub const REGIONS: [Region; 1] = [
    // The last 64 KiB of 256.
    Region { board: "microbit", address: 0x0003_0000, slot: 32 << 10, sector: 1024, word: 4 },
];

impl Region {
    /// The board of this name.
    pub fn of(board: &str) -> Option<&'static Region> {
        REGIONS.iter().find(|region| region.board == board)
    }
}

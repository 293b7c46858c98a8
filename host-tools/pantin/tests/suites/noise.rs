//! Repeatable noise: what a test draws is the same in every run.

/// A linear congruential generator of 64 bits with Knuth's constants for MMIX.
pub struct Noise(pub u64);

impl Noise {
    /// 31 bits.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }

    /// A number below `count`, which is not 0.
    pub fn below(&mut self, count: usize) -> usize {
        self.next() as usize % count
    }

    /// A number from -1 to 1.
    pub fn signed(&mut self) -> f64 {
        self.next() as f64 / f64::from(1u32 << 30) - 1.0
    }
}

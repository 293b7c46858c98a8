//! Repeatable noise, and damage made of it.

/// Marsaglia's xorshift of 64 bits.
#[derive(Clone, Debug)]
pub struct Noise(u64);

impl Noise {
    /// Noise that depends on nothing but `seed`.
    pub fn new(seed: u64) -> Noise {
        Noise(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number below `count`, which is not 0.
    pub fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 33) as usize % count
    }

    /// A number from `least` to `most`.
    pub fn between(&mut self, least: i32, most: i32) -> i32 {
        least + self.below((most - least + 1) as usize) as i32
    }

    /// `input` changed in one to three places; `other` lends bytes, `words` words.
    pub fn damage(&mut self, input: &[u8], other: &[u8], words: &[&str]) -> Vec<u8> {
        let mut bytes = input.to_vec();
        for _ in 0..1 + self.below(3) {
            let at = self.below(bytes.len() + 1);
            if bytes.get(at).is_some_and(u8::is_ascii_digit) && self.below(4) > 0 {
                // Numbers are most of a text, and any other digit leaves one.
                bytes[at] = b'0' + self.below(10) as u8;
                continue;
            }
            let end = (at + self.below(24)).min(bytes.len());
            match self.below(if words.is_empty() { 7 } else { 9 }) {
                0 | 1 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                2 if at < bytes.len() => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][self.below(5)],
                3 => drop(bytes.drain(at..end)),
                4 => {
                    let from = self.below(other.len() + 1);
                    let to = (from + self.below(24)).min(other.len());
                    bytes.splice(at..end, other[from..to].iter().copied());
                }
                5 => {
                    let again = bytes[at..end].to_vec();
                    bytes.splice(at..at, again);
                }
                6 if self.below(4) == 0 => bytes.truncate(at),
                7 | 8 => drop(bytes.splice(at..at, words[self.below(words.len())].bytes())),
                _ => {}
            }
        }
        bytes
    }
}

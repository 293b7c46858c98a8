//! The binary range coder: chances and bits become bytes.

use pantin::codec::keys::CHANCE_BITS;

/// A bit, and the chance in 2^-12 that it is 1.
pub type Split = (u16, bool);

/// The bytes of bits, as few as decode to them: bytes behind the end are zeros.
pub fn bytes(splits: &[Split]) -> Vec<u8> {
    // `low` is the 32-bit window of the least number that decodes to the bits so far; all before it is in `out`.
    let (mut out, mut low, mut range) = (Vec::new(), 0u64, u32::MAX);
    for &(chance, bit) in splits {
        let ones = (range >> CHANCE_BITS) * u32::from(chance);
        if bit {
            range = ones;
        } else {
            low = carried(&mut out, low + u64::from(ones));
            range -= ones;
        }
        while range < 1 << 24 {
            out.push((low >> 24) as u8);
            low = (low << 8) & u64::from(u32::MAX);
            range <<= 8;
        }
    }
    // The number of the range with most zero bytes at its end.
    let rounded = |bits: u32| low.div_ceil(1 << bits) << bits;
    let last = [32, 24, 16, 8, 0].map(rounded).into_iter().find(|&last| last < low + u64::from(range)).unwrap_or(low);
    let last = carried(&mut out, last) as u32;
    out.extend_from_slice(&last.to_be_bytes());
    while out.last() == Some(&0) {
        out.pop();
    }
    out
}

/// `low` without its 33rd bit, which is added to the bytes before.
fn carried(out: &mut [u8], low: u64) -> u64 {
    if low >> 32 != 0 {
        for byte in out.iter_mut().rev() {
            *byte = byte.wrapping_add(1);
            if *byte != 0 {
                break;
            }
        }
    }
    low & u64::from(u32::MAX)
}

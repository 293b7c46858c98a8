//! What several tests write files with.

/// A number in 7 bits a byte, as FORMAT.md 1 has it.
pub fn varint(number: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    pantin::codec::varint::put(number as u32, &mut |byte| bytes.push(byte));
    bytes
}

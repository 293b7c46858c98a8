//! Variable-length integers, as `pantin`'s byte cursor reads them.

/// LEB128: seven bits a byte, least significant first.
pub fn put(out: &mut Vec<u8>, mut value: u32) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// A number and how many bytes it takes, at most 5; bits beyond 32 are left out. `None` if it is cut short.
pub fn get(bytes: &[u8]) -> Option<(u32, usize)> {
    let mut value = 0;
    for (digit, &byte) in bytes.iter().enumerate().take(5) {
        value |= u32::from(byte & 0x7f) << (7 * digit);
        if byte & 0x80 == 0 || digit == 4 {
            return Some((value, digit + 1));
        }
    }
    None
}

/// A signed number as 0, -1, 1, -2, ...
pub fn put_zigzag(out: &mut Vec<u8>, value: i32) {
    put(out, ((value << 1) ^ (value >> 31)) as u32);
}

/// A length, then UTF-8.
pub fn put_name(out: &mut Vec<u8>, name: &str) {
    put(out, name.len() as u32);
    out.extend_from_slice(name.as_bytes());
}

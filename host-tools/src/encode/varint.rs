//! Variable-length integers, as `pantin`'s byte cursor reads them.

/// LEB128: seven bits a byte, least significant first.
pub fn put(out: &mut Vec<u8>, mut value: u32) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
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

//! The fields of files that hold numbers and names.

use pantin::codec::varint;
pub use pantin::codec::varint::get;

/// A number.
pub fn put(out: &mut Vec<u8>, value: u32) {
    varint::put(value, &mut |byte| out.push(byte));
}

/// A signed number as 0, -1, 1, -2, ...
pub fn put_zigzag(out: &mut Vec<u8>, value: i32) {
    varint::put_zigzag(value, &mut |byte| out.push(byte));
}

/// A length, then UTF-8.
pub fn put_name(out: &mut Vec<u8>, name: &str) {
    put(out, name.len() as u32);
    out.extend_from_slice(name.as_bytes());
}

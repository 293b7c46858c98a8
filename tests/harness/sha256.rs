//! SHA-256 as `sha256sum` writes and checks it.

use sha2::{Digest, Sha256};

/// The sum of bytes, in hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A file's line of a `SHA256SUMS`.
pub fn line(bytes: &[u8], name: &str) -> String {
    format!("{}  {name}\n", hex(bytes))
}

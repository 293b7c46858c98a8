//! Numbers as bytes in the machine's order, and back.

use pyo3::Python;
use pyo3::types::PyByteArray;

/// 64-bit floats as a `bytearray`, which becomes an array that can be written.
pub fn floats<'py>(py: Python<'py>, numbers: impl Iterator<Item = f64>) -> pyo3::Bound<'py, PyByteArray> {
    PyByteArray::new(py, &numbers.flat_map(f64::to_ne_bytes).collect::<Vec<u8>>())
}

/// Groups of N 64-bit floats; bytes that fill no group are left out.
pub fn groups<const N: usize>(bytes: &[u8]) -> Vec<[f64; N]> {
    let (numbers, _) = bytes.as_chunks::<8>();
    let (groups, _) = numbers.as_chunks::<N>();
    groups.iter().map(|group| group.map(f64::from_ne_bytes)).collect()
}

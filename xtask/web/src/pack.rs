//! Makes a WebAssembly module smaller without changing what it does: runs of zeros leave its data, since memory begins as zeros, and with them
//! the sections that only tools read.

use anyhow::{Context, Result, ensure};

/// Zeros that take more bytes in the file than the head of one more segment.
const RUN: usize = 16;
const CUSTOM: u8 = 0;
const DATA: u8 = 11;
const DATA_COUNT: u8 = 12;
/// `i32.const` and `end`.
const CONST: u8 = 0x41;
const END: u8 = 0x0b;

/// The smaller module.
pub fn pack(module: &[u8]) -> Result<Vec<u8>> {
    ensure!(module.starts_with(b"\0asm\x01\0\0\0"), "no WebAssembly module of version 1");
    let mut out = module[..8].to_vec();
    let mut rest = Bytes(&module[8..]);
    while let Ok(kind) = rest.byte() {
        let len = rest.number()?;
        let body = rest.take(len)?;
        match kind {
            CUSTOM | DATA_COUNT => {}
            DATA => section(&mut out, DATA, &without_zeros(body)?),
            _ => section(&mut out, kind, body),
        }
    }
    Ok(out)
}

fn section(out: &mut Vec<u8>, kind: u8, body: &[u8]) {
    out.push(kind);
    put(out, body.len() as u32);
    out.extend(body);
}

fn without_zeros(body: &[u8]) -> Result<Vec<u8>> {
    let mut body = Bytes(body);
    let (mut segments, mut count) = (vec![], 0);
    for _ in 0..body.number()? {
        // Others would be copied by instructions that name them by number.
        ensure!(body.byte()? == 0 && body.byte()? == CONST, "a segment that does not lie at a constant place");
        let place = body.signed()?;
        ensure!(body.byte()? == END, "a segment's place is more than a constant");
        let len = body.number()?;
        let bytes = body.take(len)?;
        for (from, to) in spans(bytes) {
            segments.extend([0, CONST]);
            put_signed(&mut segments, place + from as i64);
            segments.push(END);
            put(&mut segments, (to - from) as u32);
            segments.extend(&bytes[from..to]);
            count += 1;
        }
    }
    let mut out = vec![];
    put(&mut out, count);
    Ok([out, segments].concat())
}

/// What lies between runs of zeros.
fn spans(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut spans: Vec<(usize, usize)> = vec![];
    for (at, _) in bytes.iter().enumerate().filter(|(_, byte)| **byte != 0) {
        match spans.last_mut() {
            Some((_, to)) if at - *to < RUN => *to = at + 1,
            _ => spans.push((at, at + 1)),
        }
    }
    spans
}

struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, len: usize) -> Result<&'a [u8]> {
        let (front, rest) = self.0.split_at_checked(len).context("the module ends early")?;
        self.0 = rest;
        Ok(front)
    }

    fn byte(&mut self) -> Result<u8> {
        Ok(self.take(1)?[0])
    }

    fn number(&mut self) -> Result<usize> {
        let (mut value, mut shift) = (0, 0);
        loop {
            let byte = self.byte()?;
            value |= usize::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
            shift += 7;
            ensure!(shift < 35, "a number of more than 32 bits");
        }
    }

    fn signed(&mut self) -> Result<i64> {
        let (mut value, mut shift) = (0, 0);
        loop {
            let byte = self.byte()?;
            value |= i64::from(byte & 0x7f) << shift;
            shift += 7;
            if byte < 0x80 {
                return Ok(if byte & 0x40 != 0 { value - (1 << shift) } else { value });
            }
            ensure!(shift < 35, "a number of more than 32 bits");
        }
    }
}

fn put(out: &mut Vec<u8>, mut value: u32) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn put_signed(out: &mut Vec<u8>, mut value: i64) {
    loop {
        let byte = (value & 0x7f) as u8;
        value >>= 7;
        if (value == 0 && byte & 0x40 == 0) || (value == -1 && byte & 0x40 != 0) {
            return out.push(byte);
        }
        out.push(byte | 0x80);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A memory of a page, a custom section, and data at 1024.
    fn module(data: &[u8]) -> Vec<u8> {
        let mut module = b"\0asm\x01\0\0\0".to_vec();
        section(&mut module, 5, &[1, 0, 1]);
        section(&mut module, CUSTOM, b"\x04namehello");
        let mut body = vec![1, 0, CONST];
        put_signed(&mut body, 1024);
        body.push(END);
        put(&mut body, data.len() as u32);
        body.extend(data);
        section(&mut module, DATA, &body);
        module
    }

    #[test]
    fn zeros_and_names_leave_and_the_rest_stays_in_its_place() {
        let data = [&b"front"[..], &[0; 100], b"a\0b", &[0; 40]].concat();
        let packed = pack(&module(&data)).unwrap();
        let expected = [
            &b"\0asm\x01\0\0\0\x05\x03\x01\0\x01\x0b\x15\x02"[..],
            &[0, CONST, 0x80, 8, END, 5],
            b"front",
            &[0, CONST, 0xe9, 8, END, 3],
            b"a\0b",
        ];
        assert_eq!(packed, expected.concat().into_iter().collect::<Vec<_>>());
        assert_eq!(pack(&packed).unwrap(), packed);
    }

    #[test]
    fn what_is_no_module_is_refused() {
        assert!(pack(b"text").is_err());
        let module = module(b"data");
        // Between sections a cut leaves a whole module.
        (9..module.len()).filter(|&len| ![13, 25].contains(&len)).for_each(|len| assert!(pack(&module[..len]).is_err(), "{len}"));
    }
}

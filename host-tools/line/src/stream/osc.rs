//! Open Sound Control 1.0: the messages of a datagram.

use std::str;

/// Bundles within bundles: a datagram that nests them deeper is refused.
const MOST_DEPTH: u32 = 4;

/// An argument of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Argument<'a> {
    /// Of type f or d.
    Float(f64),
    /// Of type s.
    Text(&'a str),
    /// Of another type.
    Other,
}

/// A message.
#[derive(Clone, Debug, PartialEq)]
pub struct Message<'a> {
    /// Where it goes: `/VMC/Ext/Bone/Pos`.
    pub address: &'a str,
    /// Its arguments.
    pub arguments: Vec<Argument<'a>>,
}

/// The messages of a datagram, those of bundles in their order. Fails, with a clause for people, if any of them is damaged.
pub fn messages(datagram: &[u8]) -> Result<Vec<Message<'_>>, &'static str> {
    let mut out = Vec::new();
    packet(datagram, 0, &mut out)?;
    Ok(out)
}

fn packet<'a>(bytes: &'a [u8], depth: u32, out: &mut Vec<Message<'a>>) -> Result<(), &'static str> {
    match bytes.strip_prefix(b"#bundle\0") {
        Some(_) if depth == MOST_DEPTH => Err("bundles in bundles in bundles"),
        Some(rest) => {
            // Its time, which is not read: a pose is shown as soon as it has arrived.
            let mut rest = rest.get(8..).ok_or("a bundle without a time")?;
            while !rest.is_empty() {
                let (len, after) = rest.split_first_chunk::<4>().ok_or("a bundle that is cut off")?;
                let (element, after) =
                    after.split_at_checked(u32::from_be_bytes(*len) as usize).ok_or("a bundle that is cut off")?;
                packet(element, depth + 1, out)?;
                rest = after;
            }
            Ok(())
        }
        None => message(bytes).map(|message| out.push(message)),
    }
}

fn message(mut bytes: &[u8]) -> Result<Message<'_>, &'static str> {
    let address = text(&mut bytes)?;
    if !address.starts_with('/') {
        return Err("a message without an address");
    }
    let types = text(&mut bytes)?;
    let types = types.strip_prefix(',').ok_or("a message without types")?;
    let mut arguments = Vec::with_capacity(types.len());
    for kind in types.bytes() {
        arguments.push(match kind {
            b'f' => Argument::Float(f64::from(f32::from_be_bytes(number(&mut bytes)?))),
            b'd' => Argument::Float(f64::from_be_bytes(number(&mut bytes)?)),
            b's' | b'S' => Argument::Text(text(&mut bytes)?),
            b'i' | b'c' | b'r' | b'm' => number::<4>(&mut bytes).map(|_| Argument::Other)?,
            b'h' | b't' => number::<8>(&mut bytes).map(|_| Argument::Other)?,
            b'b' => {
                let len = u32::from_be_bytes(number(&mut bytes)?) as usize;
                bytes = bytes.get(len.checked_next_multiple_of(4).ok_or(CUT)?..).ok_or(CUT)?;
                Argument::Other
            }
            b'T' | b'F' | b'N' | b'I' => Argument::Other,
            _ => return Err("an argument of an unknown type"),
        });
    }
    if bytes.is_empty() { Ok(Message { address, arguments }) } else { Err("bytes behind the last argument") }
}

const CUT: &str = "a message that is cut off";

/// A text up to its zero, with zeros up to a multiple of four bytes.
fn text<'a>(bytes: &mut &'a [u8]) -> Result<&'a str, &'static str> {
    let len = bytes.iter().position(|byte| *byte == 0).ok_or(CUT)?;
    let (text, rest) = (&bytes[..len], bytes.get((len + 1).next_multiple_of(4)..).ok_or(CUT)?);
    *bytes = rest;
    str::from_utf8(text).map_err(|_| "a text that is not UTF-8")
}

fn number<const N: usize>(bytes: &mut &[u8]) -> Result<[u8; N], &'static str> {
    let (number, rest) = bytes.split_first_chunk::<N>().ok_or(CUT)?;
    *bytes = rest;
    Ok(*number)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A message's bytes: texts and floats.
    pub fn encoded(address: &str, texts: &[&str], floats: &[f32]) -> Vec<u8> {
        let mut out = Vec::new();
        let put = |text: &str, out: &mut Vec<u8>| {
            out.extend(text.as_bytes());
            out.resize((out.len() + 1).next_multiple_of(4), 0);
        };
        put(address, &mut out);
        put(&format!(",{}{}", "s".repeat(texts.len()), "f".repeat(floats.len())), &mut out);
        texts.iter().for_each(|text| put(text, &mut out));
        floats.iter().for_each(|float| out.extend(float.to_be_bytes()));
        out
    }

    /// A bundle of these elements.
    pub fn bundle(elements: &[Vec<u8>]) -> Vec<u8> {
        let mut out = b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec();
        for element in elements {
            out.extend((element.len() as u32).to_be_bytes());
            out.extend(element);
        }
        out
    }

    #[test]
    fn messages_come_out_of_bundles_in_order_and_nothing_is_read_beyond_the_end() {
        let one = encoded("/VMC/Ext/Bone/Pos", &["Hips"], &[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]);
        let both = bundle(&[one.clone(), bundle(&[encoded("/a", &["b", ""], &[])])]);
        let found = messages(&both).unwrap();
        assert_eq!((found.len(), found[0].address, found[1].address), (2, "/VMC/Ext/Bone/Pos", "/a"));
        assert_eq!(found[0].arguments[..2], [Argument::Text("Hips"), Argument::Float(1.0)]);
        for len in 0..both.len() {
            // A bundle may end behind any of its elements.
            assert!(messages(&both[..len]).is_err() || [16, 16 + 4 + one.len()].contains(&len), "{len}");
        }
        let mut deep = one;
        (0..5).for_each(|_| deep = bundle(std::slice::from_ref(&deep)));
        assert!(messages(&deep).is_err());
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_fail(bytes in prop::collection::vec(prop_oneof![Just(0u8), Just(b','), Just(b'/'), Just(b'b'), any::<u8>()], 0..64)) {
            let _ = messages(&bytes);
            let _ = messages(&bundle(&[bytes]));
        }
    }
}

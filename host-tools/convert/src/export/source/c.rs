//! C headers.

use super::described::{Content, Described};
use super::names::{hash, identifier};
use anyhow::Result;
use pantin::{Bank, Clip};
use std::fmt::Write as _;

/// A string literal of C, in ASCII.
fn c_literal(name: &str) -> String {
    let escaped = name.bytes().map(|byte| match byte {
        b'"' | b'\\' | b'?' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        _ => format!("\\{byte:03o}"),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

/// On an AVR and an ESP8266, constants are in RAM unless they are declared to be in flash.
const FLASH: &str = "#if defined(__AVR__)
#include <avr/pgmspace.h>
#define PANTIN_FLASH PROGMEM
#elif defined(ESP8266)
#include <pgmspace.h>
#define PANTIN_FLASH PROGMEM
#else
#define PANTIN_FLASH
#endif
";

/// A C header: the clip's bytes as `static const unsigned char CLIP_STEM[]`, and constants for the memory that it takes.
pub fn c_header(clip: &Clip, bytes: &[u8], stem: &str) -> Result<String> {
    Ok(header(&Described::of_clip(clip, bytes)?, stem))
}

/// A C header: the bank's bytes as `static const unsigned char BANK_STEM[]`, and constants for the memory that its clips take at most.
pub fn c_header_of_bank(bank: &Bank, bytes: &[u8], stem: &str) -> Result<String> {
    Ok(header(&Described::of_bank(bank, bytes)?, stem))
}

/// A C header with the bytes of a character of the solid figure, whose names are made of `stem`.
pub fn c_header_of_look(bytes: &[u8], stem: &str) -> String {
    let name = format!("LOOK_{}", identifier(stem));
    let rows: String = bytes
        .chunks(24)
        .map(|row| format!("    {}\n", row.iter().map(|byte| format!("{byte},")).collect::<Vec<_>>().join(" ")))
        .collect();
    format!(
        "/* A character of {} bytes for pantin_solid_look. Written by `pantin expand`. */\n#ifndef PANTIN_{name}_H\n#define PANTIN_{name}_H\n\n#define {name}_LEN {}\n\nstatic const unsigned char {name}[{name}_LEN] = {{\n{rows}}};\n\n#endif\n",
        bytes.len(),
        bytes.len()
    )
}

/// The header of a clip or a bank, whose names are made of `stem`.
pub fn header(described: &Described, stem: &str) -> String {
    let (kind, things, of_each, names) = match &described.content {
        Content::Clip { channels, .. } => ("CLIP", "clips", "CHANNELS", channels),
        Content::Bank { clips } => ("BANK", "banks", "CLIPS", clips),
    };
    // The prefix keeps names such as `EOF` away from those of other headers.
    let name = format!("{kind}_{}", identifier(stem));
    let mut out: String = described.comments().map(|line| format!("/* {line} */\n")).collect();
    // Another clip with this name must not be left out silently, as a plain include guard would do.
    let id = hash(described.bytes);
    let _ = write!(
        out,
        "#if defined(PANTIN_{name}_ID) && PANTIN_{name}_ID != {id}\n#error \"two {things} have the name {name}: rename one of their files\"\n#endif\n"
    );
    let _ = write!(out, "#ifndef PANTIN_{name}_H\n#define PANTIN_{name}_H\n#define PANTIN_{name}_ID {id}\n\n");
    numbers(described).iter().for_each(|(what, value)| out.push_str(&format!("#define {name}_{what} {value}\n")));
    let names: Vec<String> = names.iter().map(|name| c_literal(name)).collect();
    let list = if described.is_bank() { "CLIP_NAMES" } else { "NAMES" };
    let _ = write!(
        out,
        "/* Initializes an array of {name}_{of_each} strings. */\n#define {name}_{list} {}\n",
        names.join(", \\\n    ")
    );
    let rows = described.rows();
    let _ = write!(out, "\n{FLASH}\nstatic const unsigned char {name}[{name}_LEN] PANTIN_FLASH = {{\n{rows}}};\n\n#endif\n");
    out
}

/// All numbers, with the ends of their names.
fn numbers(described: &Described) -> Vec<(&'static str, usize)> {
    let mut numbers = vec![("LEN", described.bytes.len())];
    match &described.content {
        Content::Clip { frames, frame_time_ns, .. } => {
            numbers.extend([("FRAMES", *frames as usize), ("FRAME_TIME_NS", *frame_time_ns as usize)]);
        }
        Content::Bank { clips } => numbers.push(("CLIPS", clips.len())),
    }
    numbers.extend(described.memory.sizes().map(|size| (size.name, size.value)));
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_character_is_an_array_with_its_length() {
        let header = c_header_of_look(&[1, 2, 3], "big_cat");
        assert!(header.contains("#define LOOK_BIG_CAT_LEN 3\n") && header.contains("= {\n    1, 2, 3,\n};"), "{header}");
    }

    #[test]
    fn literals_are_ascii() {
        assert_eq!(c_literal("a\"\\?\né"), r#""a\"\\\?\012\303\251""#);
    }
}

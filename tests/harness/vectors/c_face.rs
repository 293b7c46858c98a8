//! `pantin_face_data.h` and `pantin_face_themes.h`: the cartoon model and the emotes of the crate pantin-face, and its other faces of filled shapes, for the
//! face in C.

use std::fmt::Write as _;
use std::path::PathBuf;

use pantin_face::{CARTOON, EMOTES, EYES, MINIMAL};

use crate::paths;

const START: &str = "/* The cartoon model and the 23 emotes, for pantin_face.h. `cargo xtask vectors` writes this file.
 * Include it in one source file. */
#ifndef PANTIN_FACE_DATA_H
#define PANTIN_FACE_DATA_H

#include \"pantin_face.h\"
#include \"pantin_flash.h\"
";

const THEMES_START: &str = "/* Two faces for pantin_face.h beside the cartoon: eyes alone, and a face of few strokes. `cargo xtask vectors` writes this file.
 * Include it in one source file. */
#ifndef PANTIN_FACE_THEMES_H
#define PANTIN_FACE_THEMES_H

#include \"pantin_face.h\"
#include \"pantin_flash.h\"
";

/// The longest line of numbers.
const WIDTH: usize = 132;

/// The committed file.
pub fn path() -> PathBuf {
    paths::root().join("bindings/c/src/pantin_face_data.h")
}

/// The file's text.
pub fn text() -> String {
    let mut text = START.to_owned();
    array(&mut text, "pantin_cartoon", CARTOON, " PANTIN_FLASH");
    for (name, clip) in EMOTES {
        array(&mut text, &format!("pantin_emote_{name}"), clip, "");
    }
    let _ =
        write!(text, "\n#define PANTIN_EMOTES {}\n\nstatic const pantin_emote pantin_emotes[PANTIN_EMOTES] = {{\n", EMOTES.len());
    for (name, _) in EMOTES {
        let _ = writeln!(text, "    {{\"{name}\", pantin_emote_{name}, sizeof pantin_emote_{name}}},");
    }
    text + "};\n\n#endif\n"
}

/// The committed file of the other faces.
pub fn themes_path() -> PathBuf {
    paths::root().join("bindings/c/src/pantin_face_themes.h")
}

/// Its text.
pub fn themes_text() -> String {
    let mut text = THEMES_START.to_owned();
    array(&mut text, "pantin_eyes", EYES, " PANTIN_FLASH");
    array(&mut text, "pantin_minimal", MINIMAL, " PANTIN_FLASH");
    text + "\n#endif\n"
}

fn array(text: &mut String, name: &str, bytes: &[u8], place: &str) {
    let _ = write!(text, "\nstatic const uint8_t {name}[{}]{place} = {{\n   ", bytes.len());
    let mut column = 3;
    for byte in bytes {
        let item = format!(" {byte},");
        if column + item.len() > WIDTH {
            text.push_str("\n   ");
            column = 3;
        }
        column += item.len();
        text.push_str(&item);
    }
    text.push_str("\n};\n");
}

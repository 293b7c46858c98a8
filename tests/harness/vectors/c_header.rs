//! `pantin_tables.h`: the format's tables for the decoder in C, from the same values as `tables.json`.

use std::fmt::Write as _;
use std::path::PathBuf;

use serde_json::Value;

use super::constants;
use crate::paths;

/// The longest line of numbers.
const WIDTH: usize = 132;

const START: &str = "/* Tables of the format (section 6), as sizes of symbols. `cargo xtask vectors` writes this file. */
#ifndef PANTIN_TABLES_H
#define PANTIN_TABLES_H

#include \"pantin_flash.h\"

";

/// The committed file.
pub fn path() -> PathBuf {
    paths::root().join("bindings/c/src/pantin_tables.h")
}

/// The file's text.
pub fn text() -> String {
    let tables: Value = serde_json::from_str(&constants::text()).unwrap_or_default();
    let mut text = START.to_owned();
    let magic = &tables["magic"];
    let numbers = [
        ("MAGIC_0", &magic[0]),
        ("MAGIC_1", &magic[1]),
        ("VERSION", &tables["version"]),
        ("LISTED", &tables["listed"]),
        ("START_MODE", &tables["start_mode"]),
        ("FIRST_STEP", &tables["first_step"]),
    ];
    for (name, number) in numbers {
        let _ = writeln!(text, "#define PANTIN_{name} {number}");
    }
    for name in ["frame_rates", "lengths", "status_in", "mode_after", "number_in"] {
        table(&mut text, "uint8_t", name, &tables[name]);
    }
    for name in ["status", "step_change", "position", "velocity", "mode", "number", "far"] {
        table(&mut text, "uint16_t", name, &tables[name]);
    }
    table(&mut text, "uint32_t", "steps", &tables["steps"]);
    text += "\n/* Each name ends with a space. */\nstatic const char pantin_live_link[] PANTIN_FLASH =";
    for names in list(&tables["live_link"]).chunks(6) {
        let names: String = names.iter().map(|name| format!("{} ", name.as_str().unwrap_or_default())).collect();
        let _ = write!(text, "\n    \"{names}\"");
    }
    text + ";\n\n#endif\n"
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// An array, or an array of arrays.
pub(super) fn table(text: &mut String, kind: &str, name: &str, values: &Value) {
    let values = list(values);
    let inner = values.first().map_or(&[][..], list);
    let columns = if inner.is_empty() { String::new() } else { format!("[{}]", inner.len()) };
    let _ = writeln!(text, "\nstatic const {kind} pantin_{name}[{}]{columns} PANTIN_FLASH = {{", values.len());
    if inner.is_empty() {
        *text += &rows("    ", values);
    } else {
        let tables: Vec<String> = values.iter().map(|row| format!("    {{\n{}    }}", rows("        ", list(row)))).collect();
        *text += &(tables.join(",\n") + "\n");
    }
    *text += "};\n";
}

fn rows(indent: &str, numbers: &[Value]) -> String {
    let mut lines = vec![indent.to_owned()];
    for (index, number) in numbers.iter().enumerate() {
        let number = if index + 1 < numbers.len() { format!("{number},") } else { number.to_string() };
        match lines.last_mut() {
            Some(line) if line.len() + 1 + number.len() <= WIDTH => {
                if line.len() > indent.len() {
                    line.push(' ');
                }
                line.push_str(&number);
            }
            _ => lines.push(format!("{indent}{number}")),
        }
    }
    lines.join("\n") + "\n"
}

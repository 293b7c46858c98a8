//! The tables of images' sizes that documents hold, between `<!-- sizes: IMAGE ... -->` and `<!-- /sizes -->`.

use std::fmt::Write;

use anyhow::{Context, Result};

use crate::sizes::{COLUMNS, Sizes};

/// The documents that hold one, from the repository's root.
pub const DOCUMENTS: [&str; 9] = [
    "docs/BOARDS.md",
    "firmware/boards/blackpill/README.md",
    "firmware/boards/esp32c3/README.md",
    "firmware/boards/microbit-v2/README.md",
    "firmware/boards/esp32c6/README.md",
    "firmware/boards/nrf52840-dk/README.md",
    "firmware/boards/nucleo-f411re/README.md",
    "firmware/boards/pico/README.md",
    "firmware/boards/pico2/README.md",
];

const START: &str = "<!-- sizes:";
const END: &str = "<!-- /sizes -->";

/// The document with the table of the images that its marker names.
pub fn filled(document: &str, sizes: &Sizes) -> Result<String> {
    let (head, rest) = document.split_once(START).with_context(|| format!("no {START} IMAGE ... -->"))?;
    let (images, rest) = rest.split_once("-->").with_context(|| format!("{START} has no end"))?;
    let (_, tail) = rest.split_once(END).with_context(|| format!("no {END}"))?;
    let [flash, ram, stack] = COLUMNS;
    let mut table = format!("| image | {flash} | {ram} | {stack} |\n|---|--:|--:|--:|\n");
    for image in images.split_whitespace() {
        let [flash, ram, stack] = sizes.images.get(image).with_context(|| format!("{START} no image {image}"))?.map(thousands);
        let _ = writeln!(table, "| `{image}` | {flash} | {ram} | {stack} |");
    }
    Ok(format!("{head}{START}{images}-->\n{table}{END}{tail}"))
}

/// A number with commas, as documents write them.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let places = digits.len();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (places - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_table_changes_and_filling_again_changes_nothing() {
        let mut sizes = Sizes::default();
        sizes.images.insert("pico".into(), [56_236, 1100, 1_018_756]);
        sizes.images.insert("sx1".into(), [1, 2, 3]);
        let before = "a\n<!-- sizes: sx1 pico -->\nold\n<!-- /sizes -->\nb\n";
        let after = filled(before, &sizes).unwrap();
        let table = "| image | flash | RAM | stack |\n|---|--:|--:|--:|\n| `sx1` | 1 | 2 | 3 |\n| `pico` | 56,236 | 1,100 | 1,018,756 |\n";
        assert_eq!(after, format!("a\n<!-- sizes: sx1 pico -->\n{table}<!-- /sizes -->\nb\n"));
        assert_eq!(filled(&after, &sizes).unwrap(), after);
    }

    #[test]
    fn what_cannot_be_filled_is_told() {
        let refused = |document: &str| filled(document, &Sizes::default()).unwrap_err().to_string();
        assert_eq!(refused("a"), "no <!-- sizes: IMAGE ... -->");
        assert_eq!(refused("<!-- sizes: a"), "<!-- sizes: has no end");
        assert_eq!(refused("<!-- sizes: a -->"), "no <!-- /sizes -->");
        assert_eq!(refused("<!-- sizes: a --><!-- /sizes -->"), "<!-- sizes: no image a");
    }
}

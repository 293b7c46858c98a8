//! The sizes of images, as stored in `tests/sizes.txt`, and their growth.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::{Context, Result, ensure};

/// Growth that the check allows, in percent.
pub const FREE: u64 = 2;

/// Names of the columns, all in bytes.
pub const COLUMNS: [&str; 3] = ["flash", "RAM", "stack"];

/// The sizes of an image, by column.
pub type Size = [u64; COLUMNS.len()];

/// The sizes of all images, by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sizes {
    /// The compiler that made them.
    pub compiler: String,
    /// The sizes of each image.
    pub images: BTreeMap<String, Size>,
}

impl Sizes {
    /// Reads the file's text: lines of an image and its numbers; `#` begins a remark.
    pub fn parse(text: &str) -> Result<Self> {
        let mut sizes = Sizes::default();
        for (number, line) in (1..).zip(text.lines()) {
            if let Some(compiler) = line.strip_prefix("# By ") {
                sizes.compiler = compiler.to_owned();
            }
            let words: Vec<&str> = line.split('#').next().unwrap_or_default().split_whitespace().collect();
            let Some((name, numbers)) = words.split_first() else { continue };
            let numbers = numbers.iter().map(|word| word.replace(',', "").parse()).collect::<Result<Vec<u64>, _>>();
            let size = numbers.ok().and_then(|numbers| Size::try_from(numbers).ok());
            let size = size.with_context(|| format!("line {number}: expected an image's name and {} numbers", COLUMNS.len()))?;
            let again = sizes.images.insert((*name).to_owned(), size);
            ensure!(again.is_none(), "line {number}: {name} was there before");
        }
        Ok(sizes)
    }

    /// The file's text.
    pub fn text(&self) -> String {
        let mut text = format!(
            "# Bytes that each image takes: written by `cargo xtask sizes --update`, whose help says what is counted.\n# By {}\n",
            self.compiler
        );
        text += &self.table();
        text
    }

    /// The numbers in columns, under a heading that reads as a remark.
    pub fn table(&self) -> String {
        let width = self.images.keys().map(String::len).max().unwrap_or(0).max("# image".len());
        let [flash, ram, stack] = COLUMNS;
        let mut text = format!("{:<width$} {flash:>9} {ram:>9} {stack:>9}\n", "# image");
        for (name, [flash, ram, stack]) in &self.images {
            let _ = writeln!(text, "{name:<width$} {flash:>9} {ram:>9} {stack:>9}");
        }
        text
    }

    /// Lists how `self` violates the file: growth by more than [`FREE`] percent, an image that is not in the file, one that no longer exists.
    pub fn against(&self, kept: &Sizes) -> Vec<String> {
        let mut complaints = vec![];
        for (name, size) in &self.images {
            match kept.images.get(name) {
                None => complaints.push(format!("{name} is new: it is not in the file")),
                Some(old) => complaints.extend(growth(name, old, size)),
            }
        }
        let gone = kept.images.keys().filter(|name| !self.images.contains_key(*name));
        complaints.extend(gone.map(|name| format!("{name} is in the file, and is built no more")));
        if !complaints.is_empty() && self.compiler != kept.compiler {
            complaints
                .push(format!("(the file is by {}, this is {}: growth may be the compiler's)", kept.compiler, self.compiler));
        }
        complaints
    }
}

fn growth(name: &str, old: &Size, new: &Size) -> Vec<String> {
    let pairs = COLUMNS.iter().zip(old.iter().zip(new));
    let grown = pairs.filter(|(_, (old, new))| *new * 100 > *old * (100 + FREE));
    grown.map(|(column, (old, new))| format!("{name}: {column} grew from {old} to {new} bytes{}", percent(*old, *new))).collect()
}

fn percent(old: u64, new: u64) -> String {
    if old == 0 { String::new() } else { format!(", by {:.1} %", 100.0 * (new - old) as f64 / old as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes(images: &[(&str, Size)]) -> Sizes {
        let images = images.iter().map(|(name, size)| ((*name).to_owned(), *size)).collect();
        Sizes { compiler: "rustc 1".into(), images }
    }

    #[test]
    fn two_percent_are_free_and_one_byte_more_is_not() {
        let kept = sizes(&[("pico", [50_000, 1000, 300])]);
        assert!(sizes(&[("pico", [51_000, 1020, 306])]).against(&kept).is_empty());
        assert!(sizes(&[("pico", [40_000, 0, 1])]).against(&kept).is_empty());
        let complaints = sizes(&[("pico", [51_001, 1000, 307])]).against(&kept);
        let said = ["pico: flash grew from 50000 to 51001 bytes, by 2.0 %", "pico: stack grew from 300 to 307 bytes, by 2.3 %"];
        assert_eq!(complaints, said);
    }

    #[test]
    fn what_was_nothing_may_not_become_something() {
        let kept = sizes(&[("pico", [1, 0, 1])]);
        assert!(kept.against(&kept).is_empty());
        assert_eq!(sizes(&[("pico", [1, 1, 1])]).against(&kept), ["pico: RAM grew from 0 to 1 bytes"]);
    }

    #[test]
    fn an_image_that_is_new_and_one_that_is_gone_are_told() {
        let kept = sizes(&[("pico", [1, 1, 1])]);
        let complaints = sizes(&[("pico-face", [1, 1, 1])]).against(&kept);
        assert_eq!(complaints, ["pico-face is new: it is not in the file", "pico is in the file, and is built no more"]);
    }

    #[test]
    fn another_compiler_is_told_where_something_grew() {
        let kept = Sizes { compiler: "rustc 0".into(), ..sizes(&[("pico", [1, 1, 1])]) };
        assert!(sizes(&[("pico", [1, 1, 1])]).against(&kept).is_empty());
        let complaints = sizes(&[("pico", [2, 1, 1])]).against(&kept);
        assert_eq!(complaints[1], "(the file is by rustc 0, this is rustc 1: growth may be the compiler's)");
    }

    #[test]
    fn the_file_is_read_as_it_was_written() {
        let kept = sizes(&[("pico", [58_716, 1100, 145_304]), ("sx1-face", [1, 2, 3])]);
        assert_eq!(Sizes::parse(&kept.text()).unwrap(), kept);
        let refused = |text: &str| Sizes::parse(text).unwrap_err().to_string();
        assert_eq!(refused("# image\npico 1 2"), "line 2: expected an image's name and 3 numbers");
        assert_eq!(refused("pico 1 x 2"), "line 1: expected an image's name and 3 numbers");
        assert_eq!(refused("pico 1 2 3\npico 1 2 3"), "line 2: pico was there before");
    }
}

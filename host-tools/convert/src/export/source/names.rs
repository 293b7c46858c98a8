//! Names in source text: of clips and banks, and how joints' names stand in comments.

/// A name that ends no comment and no line, and turns no text around.
pub(super) fn plain(name: &str) -> String {
    // What `Debug` escapes does not print; compilers refuse some of it even in comments.
    let prints = |c: char| matches!(c, '\'' | '"') || c.escape_debug().len() == 1;
    let name: String = name.chars().map(|c| if prints(c) { c } else { '_' }).collect();
    name.replace("*/", "*_").replace("/*", "_*")
}

/// What follows a clip's name in the names of its constants. A clip that ended so would share a name with another one's constant.
const SUFFIXES: [&str; 11] = [
    "_len",
    "_frames",
    "_frame_time_ns",
    "_channels",
    "_moving",
    "_figure_joints",
    "_workspace",
    "_names",
    "_clips",
    "_id",
    "_h",
];

/// The name of a clip's constants: `DANCE_2` for the stem `dance_2`. A stem that is no lower-case identifier is cleaned and gets eight
/// hexadecimal digits of its hash, so that different stems have different names: `DANCE_2_5E7D3A10` for `dance-2`.
pub fn identifier(stem: &str) -> String {
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let hashed =
        |stem: &str| stem.rsplit_once('_').is_some_and(|(_, end)| end.len() == 8 && end.chars().all(|c| c.is_ascii_hexdigit()));
    let plain = stem.starts_with(|c: char| c.is_ascii_lowercase())
        && stem.chars().all(letters)
        && !hashed(stem)
        && !SUFFIXES.iter().any(|suffix| stem.ends_with(suffix))
        && !KEYWORDS.contains(&stem)
        && stem.len() <= LONGEST_NAME;
    if plain {
        return stem.to_ascii_uppercase();
    }
    let clean = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    let name: String = stem.chars().take(LONGEST_NAME).map(clean).collect();
    let name = if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("N{name}") };
    format!("{}_{:08X}", name.trim_end_matches('_'), hash(stem.as_bytes()))
}

/// Longer names are cut: C compilers need not tell apart what differs later.
const LONGEST_NAME: usize = 40;
/// Lower-case words that are no identifiers in C or Rust, or mean something in upper case.
const KEYWORDS: [&str; 73] = [
    "abstract", "as", "asm", "async", "auto", "await", "become", "bool", "box", "break", "case", "char", "const", "continue",
    "crate", "default", "do", "double", "dyn", "else", "enum", "eof", "extern", "false", "final", "float", "fn", "for", "gen",
    "goto", "if", "impl", "in", "inline", "int", "let", "long", "loop", "macro", "main", "match", "mod", "move", "mut", "null",
    "override", "priv", "pub", "ref", "register", "restrict", "return", "self", "short", "signed", "sizeof", "static", "struct",
    "super", "switch", "trait", "true", "try", "type", "typedef", "typeof", "union", "unsafe", "unsigned", "use", "virtual",
    "void", "while",
];

/// FNV-1a with 32 bits.
pub(super) fn hash(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash: u32, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// The name of a type that belongs to a constant: `LeftTurn` for `LEFT_TURN`.
pub(super) fn type_name(constant: &str) -> String {
    let part = |part: &str| {
        let (first, rest) = part.split_at(part.len().min(1));
        first.to_string() + &rest.to_ascii_lowercase()
    };
    constant.split('_').map(part).collect()
}

/// Whether `name` is one of a constant in Rust: capital letters, digits and `_` after a letter.
pub fn is_constant(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_identifiers_and_end_no_comment() {
        assert_eq!([identifier("dance_2"), identifier("walk")], ["DANCE_2", "WALK"]);
        let odd = ["dance-2", "Dance_2", "2nd", "é", "", "EOF", "while", "walk_frames", "dance_2_5E7D3A10", "_", "a\u{202e}b"];
        let names: std::collections::BTreeSet<String> = odd.iter().map(|stem| identifier(stem)).collect();
        assert_eq!(names.len(), odd.len());
        for name in names {
            assert!(name.starts_with(|c: char| c.is_ascii_uppercase()), "{name}");
            assert!(name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_'), "{name}");
            let digits = &name[name.len() - 9..];
            assert!(digits.starts_with('_') && digits[1..].chars().all(|c| c.is_ascii_hexdigit()), "{name}");
        }
        assert_eq!(plain("a*/b\n\\ 'é' \u{202e}"), "a*_b__ 'é' _");
    }
    #[test]
    fn types_are_named_as_rust_does() {
        assert_eq!(
            [type_name("WALK"), type_name("DANCE_2"), type_name("LEFT_TURN_5E7D3A10")],
            ["Walk", "Dance2", "LeftTurn5e7d3a10"]
        );
        assert!(["WALK", "A", "DANCE_2"].iter().all(|name| is_constant(name)));
        assert!(["", "walk", "2ND", "A-B", "_", "É"].iter().all(|name| !is_constant(name)));
    }
}

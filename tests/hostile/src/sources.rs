//! Source text that is made of clips: whatever their names are, it is what a compiler reads as comments, names and literals.

use pantin::Clip;
use pantin_convert::export::source::{c_header, rust_module};

use crate::clips::RIG;
use crate::fix;

/// Names that would end a comment or a literal, or turn the text around.
pub const WORDS: [&str; 10] = ["*/", "/*", "\"", "\\", "??/", "\n", "\u{202e}", "//", "#endif", "'"];

/// Bytes of clips whose text is made: it is five times as long.
const CLIP_BYTES: usize = 4096;

/// Mends the CRCs, makes both texts of a clip that opens, and checks their lexical form. Returns whether it opened.
pub fn export_source(bytes: &[u8]) -> bool {
    if bytes.len() > CLIP_BYTES {
        return false;
    }
    let mut bytes = bytes.to_vec();
    fix::clip(&mut bytes);
    let Ok(clip) = Clip::with_rig(&bytes, RIG) else { return false };
    let stem = clip.rig().joints().map(|joint| joint.name()).find(|name| !name.is_empty()).unwrap_or("clip");
    // An error is of the figure's memory: nothing is written.
    if let (Ok(c), Ok(rust)) = (c_header(&clip, &bytes, stem), rust_module(&clip, &bytes, stem)) {
        let channels = clip.rig().channels();
        // In a comment that ends on its line a trigraph has no effect.
        assert!(!c.lines().any(|line| line.contains("??") && !line.starts_with("/* ")), "a trigraph");
        // One more is the message of `#error`.
        check(&c, channels + 1, |line| line.strip_prefix("/* ").and_then(|line| line.strip_suffix(" */")));
        check(&rust, channels, |line| line.strip_prefix("//"));
    }
    true
}

/// Every line is a comment, or ASCII in which each string literal ends on its line; there are `expected` literals. (Rust's literals may hold
/// other printing characters.)
fn check(text: &str, expected: usize, comment: impl Fn(&str) -> Option<&str>) {
    let mut literals = 0;
    for line in text.split('\n') {
        let plain = |c: char| c == '"' || c == '\'' || c == '\\' || c.escape_debug().len() == 1;
        assert!(line.chars().all(plain), "{line:?} holds what does not print");
        if let Some(comment) = comment(line) {
            assert!(!comment.contains("*/") && !comment.contains("/*"), "{line:?} ends a comment or begins one");
            continue;
        }
        let (mut inside, mut escaped) = (false, false);
        for c in line.chars() {
            match c {
                _ if escaped => escaped = false,
                '\\' if inside => escaped = true,
                '"' => {
                    inside = !inside;
                    literals += usize::from(inside);
                }
                _ => assert!(inside || c.is_ascii(), "{line:?} holds {c:?} outside of a literal"),
            }
        }
        assert!(!inside && !escaped, "{line:?} does not end its literal");
    }
    assert_eq!(literals, expected);
}

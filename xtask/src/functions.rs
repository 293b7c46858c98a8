//! How long functions are: as rustfmt lays them out, from the line with `fn` to the first `}` of the same indentation.

use anyhow::{Context, Result};

use crate::paths;

/// Most lines of a function, its signature and both braces included.
pub const MOST_LINES: usize = 80;

/// Left out: inputs of fuzzing may have any name.
const FUZZING: &str = "fuzz/";

/// A function with a body.
#[derive(Debug, PartialEq, Eq)]
pub struct Function {
    /// Its file, from the root of the repository.
    pub file: String,
    /// The number of its first line, from 1.
    pub line: usize,
    /// Its name.
    pub name: String,
    /// Number of lines.
    pub lines: usize,
}

/// The functions with more than [`MOST_LINES`] lines in the Rust files among these, the longest first.
pub fn long(files: &[String]) -> Result<Vec<Function>> {
    let mut found = vec![];
    for file in files.iter().filter(|file| file.ends_with(".rs") && !file.starts_with(FUZZING)) {
        let text = std::fs::read_to_string(paths::root().join(file)).with_context(|| file.clone())?;
        found.extend(functions(file, &text).into_iter().filter(|function| function.lines > MOST_LINES));
    }
    found.sort_by_key(|function| std::cmp::Reverse(function.lines));
    Ok(found)
}

/// The functions of a file that have bodies of more than one line.
fn functions(file: &str, text: &str) -> Vec<Function> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = vec![];
    for (start, line) in lines.iter().enumerate() {
        let Some(name) = name(line) else { continue };
        // The signature ends where the body opens; a declaration ends in a semicolon, and `fn f() {}` in a brace.
        let open = (start..lines.len()).find(|&at| lines[at].ends_with(['{', ';', '}']));
        let Some(open) = open.filter(|&open| lines[open].ends_with('{')) else { continue };
        let indentation = &line[..line.len() - line.trim_start().len()];
        let closes = |at: &usize| lines[*at].strip_prefix(indentation).is_some_and(|rest| rest.starts_with('}'));
        let Some(end) = (open + 1..lines.len()).find(closes) else { continue };
        found.push(Function { file: file.into(), line: start + 1, name: name.into(), lines: end + 1 - start });
    }
    found
}

/// The name of the function whose signature begins in this line.
fn name(line: &str) -> Option<&str> {
    let (before, after) = line.trim_start().split_once("fn ").filter(|(before, _)| before.is_empty() || before.ends_with(' '))?;
    // `extern "C"` and `pub(in crate::a)` are two words.
    let is_qualifier = |word: &str| {
        ["const", "async", "unsafe", "extern", "default", "pub"].contains(&word)
            || word.starts_with('"')
            || word.starts_with("pub(")
            || word.ends_with(')')
    };
    let name = after.split(['(', '<']).next()?;
    before.split_whitespace().all(is_qualifier).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_functions(text: &str, wanted: &[(usize, &str, usize)]) {
        let found = functions("a.rs", text);
        let found: Vec<_> = found.iter().map(|function| (function.line, function.name.as_str(), function.lines)).collect();
        assert_eq!(found, wanted, "{text}");
    }

    #[test]
    fn lines_are_counted_from_the_signature_to_the_brace() {
        assert_functions("fn f() {\n    g();\n}\n", &[(1, "f", 3)]);
        assert_functions("/// Why.\npub fn f(\n    a: u8,\n) -> u8\nwhere\n    u8: Copy,\n{\n    a\n}\n", &[(2, "f", 8)]);
        assert_functions("impl A {\n    pub(in crate::a) const unsafe fn f<T>(a: T) {\n    }\n}\n", &[(2, "f", 2)]);
        assert_functions("pub extern \"C\" fn f() {\n}\nasync fn g() {\n}\n", &[(1, "f", 2), (3, "g", 2)]);
    }

    #[test]
    fn a_function_in_another_counts_in_both() {
        assert_functions("fn f() {\n    fn g() {\n    }\n    g();\n}\n", &[(1, "f", 5), (2, "g", 2)]);
    }

    #[test]
    fn declarations_empty_bodies_and_words_are_none() {
        assert_functions(
            "trait A {\n    fn f();\n    fn g(\n        a: u8,\n    );\n    fn h() {}\n}\nfn i() {\n}\n",
            &[(8, "i", 2)],
        );
        assert_functions("// fn f() {\n// }\nlet f: fn (u8) = g;\nlet a = \"a fn in text {\n}\";\n", &[]);
    }
}

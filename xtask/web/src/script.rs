//! Makes a script shorter without changing what it does, by what can be told without its grammar: comments on lines of their own, white space, and the names
//! of private members leave. Every statement of it ends with a semicolon or a brace.

use anyhow::{Context, Result, ensure};

/// The shorter script.
pub fn shortened(script: &[u8]) -> Result<Vec<u8>> {
    let script = std::str::from_utf8(script).context("a script that is not UTF-8")?;
    let lines = script.lines().map(str::trim).filter(|line| !line.starts_with("//"));
    let lines: String = lines.flat_map(|line| [line, "\n"]).collect();
    let (mut rest, mut out, mut names) = (lines.as_str(), String::new(), vec![]);
    while let Some(next) = rest.chars().next() {
        let len = match next {
            '"' | '\'' | '`' => text(rest, next)?,
            '#' => 1 + word(&rest[1..]),
            _ if next.is_whitespace() => rest.len() - rest.trim_start().len(),
            _ => word(rest).max(next.len_utf8()),
        };
        let (token, after) = rest.split_at(len);
        rest = after;
        match next {
            '`' => {
                ensure!(!token.contains("this.#"), "a private name within a text: {token:.60}");
                out += &style(token);
            }
            '#' => out += &private(token, &mut names),
            '}' if out.ends_with(';') => out.replace_range(out.len() - 1.., token),
            _ if !next.is_whitespace() => out += token,
            // What would become one word, or one operator, stays apart.
            _ => {
                let (before, after) = (out.chars().last().unwrap_or(';'), rest.chars().next().unwrap_or(';'));
                if in_word(before) && (in_word(after) || after == '#') || before == after && "+-".contains(before) {
                    out.push(' ');
                }
            }
        }
    }
    Ok(out.into_bytes())
}

fn in_word(letter: char) -> bool {
    letter.is_alphanumeric() || "_$".contains(letter)
}

fn word(rest: &str) -> usize {
    rest.find(|letter| !in_word(letter)).unwrap_or(rest.len())
}

/// Bytes of a text with its quotes. An escaped letter ends none.
fn text(rest: &str, quote: char) -> Result<usize> {
    let mut escaped = true;
    let end = rest.find(|letter| {
        let ends = letter == quote && !escaped;
        escaped = letter == '\\' && !escaped;
        ends
    });
    Ok(end.with_context(|| format!("a text that does not end: {rest:.60}"))? + 1)
}

/// A letter in place of a private name; after the last letter, one with a number.
fn private<'s>(name: &'s str, names: &mut Vec<&'s str>) -> String {
    let index = names.iter().position(|known| *known == name).unwrap_or_else(|| {
        names.push(name);
        names.len() - 1
    });
    let letter = ('a'..='z').chain('A'..='Z').nth(index % 52).unwrap_or_default();
    match index / 52 {
        0 => format!("#{letter}"),
        round => format!("#{letter}{round}"),
    }
}

/// A text; a style sheet of an element's without the spaces that part nothing.
fn style(text: &str) -> String {
    let Some(sheet) = text.strip_prefix('`').and_then(|sheet| sheet.trim_start().strip_suffix('`')) else {
        return text.to_owned();
    };
    if !sheet.starts_with(":host") {
        return text.to_owned();
    }
    let (mut out, mut letters) = (String::new(), sheet.chars().peekable());
    while let Some(letter) = letters.next() {
        let parts = |other: Option<char>, marks: &str| other.is_some_and(|other| marks.contains(other));
        let parts = parts(out.chars().last(), "{};:,>") || parts(letters.peek().copied(), "{}");
        if !(letter.is_whitespace() && parts) {
            out.push(letter);
        }
    }
    format!("`{}`", out.replace(";}", "}"))
}

#[cfg(test)]
mod tests {
    use super::shortened;

    fn short(script: &str) -> String {
        String::from_utf8(shortened(script.as_bytes()).unwrap()).unwrap()
    }

    #[test]
    fn words_texts_and_operators_stay_what_they_are() {
        assert_eq!(
            short("// said\nconst a = \"b  //  c\" + 'it\\'s';\n\nreturn a - -1;\n"),
            "const a=\"b  //  c\"+'it\\'s';return a- -1;"
        );
        assert_eq!(
            short("class A {\n  #long = 1;\n  get #other() { return this.#long; }\n}"),
            "class A{#a=1;get #b(){return this.#a}}"
        );
        assert_eq!(short("f(`${a} ; b`, x in y ? /a b/ : 2)"), "f(`${a} ; b`,x in y?/a b/:2)");
        assert_eq!(
            short("f(`\n:host .a { color: red; }\n.b, .c { margin: 0 1px; }\n`, `p : b ; `)"),
            "f(`:host .a{color:red}.b,.c{margin:0 1px}`,`p : b ; `)"
        );
    }

    #[test]
    fn what_would_be_changed_is_refused() {
        assert!(shortened(b"f(`${this.#a}`)").is_err() && shortened(b"f(\"a)").is_err());
    }
}

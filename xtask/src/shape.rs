//! `cargo xtask shape`: the crates and what they need, lines that boards repeat, circles of imports, and long functions.
//!
//! ```text
//! $ cargo xtask shape
//! decoder             ->  nothing
//! ...
//! crates that need themselves: none
//! equal lines among the boards: 2 places of 6 lines or more
//!   9 lines: blackpill/src/board.rs:12 and esp32c3/src/board.rs:20
//!   ...
//! import circles in firmware/app/src: none
//! ...
//! functions of more than 80 lines: none
//! ```
//!
//! A line counts where it holds code: comments, attributes and imports are left out before lines are compared. A module imports
//! another where it names it by `crate::`, `super::` or `self::`, or where it names a module of its own; a path that `pub use`
//! passes on leads to where it comes from, and the unit tests of a file are left out.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::functions::{self, Function};
use crate::{crates, paths, repository_files};

/// Equal lines of code that make a repetition.
pub const LINES: usize = 6;

/// The crates whose imports must make no circle.
pub const CRATES: [&str; 2] = ["firmware/app/src", "firmware/face/src"];

/// Lines of code that stand at two places.
#[derive(Debug, PartialEq, Eq)]
pub struct Repetition {
    /// Both places: a file and the number of its line.
    pub places: [(PathBuf, usize); 2],
    /// Number of lines.
    pub lines: usize,
}

/// Prints the crates, repetitions, circles and long functions.
pub fn print() -> Result<()> {
    let crates = crates::all()?;
    print!("{}", crates::drawn(&crates));
    let found = crates::circles(&crates);
    println!("crates that need themselves: {}", if found.is_empty() { "none".into() } else { found.join(", ") });
    crates::forbidden(&crates).iter().for_each(|arrow| println!("must not be: {arrow}"));
    let found = among_boards()?;
    println!("equal lines among the boards: {} places of {LINES} lines or more", found.len());
    for Repetition { places: [one, other], lines } in &found {
        println!("  {lines} lines: {}:{} and {}:{}", one.0.display(), one.1, other.0.display(), other.1);
    }
    for folder in CRATES {
        let found = circles(&paths::root().join(folder))?;
        println!("import circles in {folder}: {}", if found.is_empty() { "none".into() } else { found.len().to_string() });
        found.iter().for_each(|circle| println!("  {}", circle.join(", ")));
    }
    if let Some(files) = repository_files::files()? {
        print_long(&functions::long(&files)?);
    }
    Ok(())
}

fn print_long(found: &[Function]) {
    let count = if found.is_empty() { "none".into() } else { found.len().to_string() };
    println!("functions of more than {} lines: {count}", functions::MOST_LINES);
    for Function { file, line, name, lines } in found {
        println!("  {lines} lines: {file}:{line} {name}");
    }
}

/// Repetitions in `firmware/boards/*/src`.
pub fn among_boards() -> Result<Vec<Repetition>> {
    let boards = paths::firmware().join("boards");
    let mut files = vec![];
    for board in entries(&boards)? {
        files.extend(sources(&board.join("src"))?);
    }
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        Ok((path.strip_prefix(&boards).unwrap_or(&path).to_path_buf(), text))
    };
    Ok(repetitions(&files.into_iter().map(read).collect::<Result<Vec<_>>>()?))
}

/// Runs of [`LINES`] or more equal lines of code in these files.
fn repetitions(files: &[(PathBuf, String)]) -> Vec<Repetition> {
    let code: Vec<Vec<(usize, &str)>> = files.iter().map(|(_, text)| code_lines(text)).collect();
    let line = |file: usize, at: usize| code[file].get(at).map(|(_, line)| *line);
    let mut seen: HashMap<Vec<&str>, Vec<(usize, usize)>> = HashMap::new();
    let mut found = vec![];
    for (file, lines) in code.iter().enumerate() {
        for at in 0..(lines.len() + 1).saturating_sub(LINES) {
            let window: Vec<&str> = lines[at..at + LINES].iter().map(|(_, line)| *line).collect();
            let places = seen.entry(window).or_default();
            for &(other, there) in places.iter() {
                // Lines that continue a run were counted with its first one.
                if at > 0 && there > 0 && line(file, at - 1) == line(other, there - 1) {
                    continue;
                }
                let equal = |step: &usize| line(file, at + step).is_some() && line(file, at + step) == line(other, there + step);
                let place = |file: usize, at: usize| (files[file].0.clone(), code[file][at].0);
                let lines = (0..).take_while(equal).count();
                found.push(Repetition { places: [place(other, there), place(file, at)], lines });
            }
            places.push((file, at));
        }
    }
    found
}

/// The lines that hold code, with their numbers from 1: without comments, attributes, imports and blank lines.
fn code_lines(text: &str) -> Vec<(usize, &str)> {
    let mut lines = vec![];
    // What ends an attribute or an import that goes on over several lines.
    let mut until: Option<char> = None;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(end) = until {
            if line.ends_with(end) {
                until = None;
            }
            continue;
        }
        let import = ["use ", "pub use ", "pub(crate) use ", "pub(super) use "].iter().any(|word| line.starts_with(word));
        if import || line.starts_with("#[") || line.starts_with("#![") {
            let end = if import { ';' } else { ']' };
            until = (!line.ends_with(end)).then_some(end);
        } else if !line.is_empty() && !line.starts_with("//") {
            lines.push((index + 1, line));
        }
    }
    lines
}

/// Sets of modules below a crate's `src` that import each other, each by itself or by way of others.
pub fn circles(folder: &Path) -> Result<Vec<Vec<String>>> {
    let mut modules = BTreeMap::new();
    for path in sources(folder)? {
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        modules.insert(module_of(path.strip_prefix(folder).unwrap_or(&path)), text);
    }
    Ok(circles_of(&modules))
}

/// A module's place in its crate; the crate's own is empty.
type Module = Vec<String>;

fn module_of(file: &Path) -> Module {
    let mut names: Module = file.with_extension("").iter().map(|name| name.to_string_lossy().into_owned()).collect();
    if names.last().is_some_and(|name| ["mod", "lib", "main"].contains(&name.as_str())) {
        names.pop();
    }
    names
}

fn circles_of(modules: &BTreeMap<Module, String>) -> Vec<Vec<String>> {
    let paths: BTreeMap<&Module, Vec<Import>> = modules.iter().map(|(module, text)| (module, imports(text))).collect();
    let edges: BTreeMap<&Module, BTreeSet<Module>> = paths
        .iter()
        .map(|(module, imports)| {
            let own = imports.iter().filter(|import| !import.passed_on);
            let targets = own.filter_map(|import| target(&import.path, module, &paths, 0));
            (*module, targets.filter(|target| target != *module).collect())
        })
        .collect();
    let reached: BTreeMap<&Module, BTreeSet<Module>> = edges.keys().map(|module| (*module, reached(module, &edges))).collect();
    let mut circles = vec![];
    let mut done = BTreeSet::new();
    for (module, from_here) in &reached {
        if done.contains(*module) || !from_here.contains(*module) {
            continue;
        }
        let circle: Vec<&Module> = from_here.iter().filter(|other| reached[*other].contains(*module)).collect();
        done.extend(circle.iter().map(|module| (*module).clone()));
        circles.push(circle.into_iter().map(name).collect());
    }
    circles
}

fn name(module: &Module) -> String {
    if module.is_empty() { "the crate's root".into() } else { module.join("::") }
}

fn reached(module: &Module, edges: &BTreeMap<&Module, BTreeSet<Module>>) -> BTreeSet<Module> {
    let mut reached = BTreeSet::new();
    let mut next = vec![module.clone()];
    while let Some(module) = next.pop() {
        let new = edges.get(&module).into_iter().flatten().filter(|target| reached.insert((*target).clone()));
        next.extend(new.cloned().collect::<Vec<_>>());
    }
    reached
}

/// The module that a path in `from` leads to: that of the item itself where modules in between only pass it on.
fn target(path: &[String], from: &Module, paths: &BTreeMap<&Module, Vec<Import>>, depth: usize) -> Option<Module> {
    let mut rest = path.iter();
    let mut module = match path.first()?.as_str() {
        "crate" => {
            rest.next();
            vec![]
        }
        "self" => {
            rest.next();
            from.clone()
        }
        "super" => {
            let mut module = from.clone();
            while rest.as_slice().first().is_some_and(|word| word == "super") {
                module.pop();
                rest.next();
            }
            module
        }
        first => {
            let child: Module = from.iter().cloned().chain([first.to_owned()]).collect();
            // Another crate, or an item of this module.
            paths.contains_key(&child).then(|| from.clone())?
        }
    };
    while let Some(word) = rest.clone().next() {
        let child: Module = module.iter().cloned().chain([word.clone()]).collect();
        if !paths.contains_key(&child) {
            break;
        }
        module = child;
        rest.next();
    }
    let item = rest.next();
    let passed_on = item.and_then(|item| paths[&module].iter().find(|import| import.passed_on && import.name == *item));
    match passed_on {
        Some(import) if depth < 8 => target(&import.path, &module, paths, depth + 1).or(Some(module)),
        _ => Some(module),
    }
}

/// A path that a module names.
struct Import {
    path: Vec<String>,
    /// What it is called here.
    name: String,
    /// By `pub use`: others find it here.
    passed_on: bool,
}

/// The paths of a file that may lead to another module.
fn imports(text: &str) -> Vec<Import> {
    let tokens = tokens(text);
    let mut found = vec![];
    let mut at = 0;
    while at < tokens.len() {
        match tokens[at].as_str() {
            // A unit test may import anything.
            "#" if tokens[at..].iter().take(7).map(String::as_str).eq(["#", "[", "cfg", "(", "test", ")", "]"]) => {
                at = after_item(&tokens, at + 7);
            }
            "use" => {
                let passed_on = at > 0 && (tokens[at - 1] == "pub" || tokens[at - 1] == ")");
                at = tree(&tokens, at + 1, &[], passed_on, &mut found);
            }
            word if is_name(word) && tokens.get(at + 1).is_some_and(|next| next == "::") => {
                let path = path(&tokens, &mut at);
                let name = path.last().cloned().unwrap_or_default();
                found.push(Import { path, name, passed_on: false });
            }
            _ => at += 1,
        }
    }
    found
}

/// Where what follows an attribute ends.
fn after_item(tokens: &[String], mut at: usize) -> usize {
    let mut depth = 0;
    while at < tokens.len() {
        match tokens[at].as_str() {
            "{" => depth += 1,
            "}" if depth == 1 => return at + 1,
            "}" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => (),
        }
        at += 1;
    }
    at
}

/// Names with `::` between.
fn path(tokens: &[String], at: &mut usize) -> Vec<String> {
    let mut path = vec![];
    while tokens.get(*at).is_some_and(|token| is_name(token)) {
        path.push(tokens[*at].clone());
        *at += 1;
        if tokens.get(*at).is_none_or(|token| token != "::") {
            break;
        }
        *at += 1;
    }
    path
}

/// The paths of a tree of imports; where it ends.
fn tree(tokens: &[String], mut at: usize, before: &[String], passed_on: bool, found: &mut Vec<Import>) -> usize {
    let mut whole = before.to_vec();
    whole.extend(path(tokens, &mut at));
    match tokens.get(at).map(String::as_str) {
        Some("{") => {
            at += 1;
            while tokens.get(at).is_some_and(|token| token != "}") {
                at = tree(tokens, at, &whole, passed_on, found);
                if tokens.get(at).is_some_and(|token| token == ",") {
                    at += 1;
                }
            }
            return at + 1;
        }
        Some("*") => {
            at += 1;
            found.push(Import { path: whole, name: "*".into(), passed_on });
            return at;
        }
        _ => (),
    }
    if whole.last().is_some_and(|word| word == "self") {
        whole.pop();
    }
    let mut name = whole.last().cloned().unwrap_or_default();
    if tokens.get(at).is_some_and(|token| token == "as") {
        name = tokens.get(at + 1).cloned().unwrap_or_default();
        at += 2;
    }
    found.push(Import { path: whole, name, passed_on });
    at
}

fn is_name(token: &str) -> bool {
    token.starts_with(|first: char| first.is_alphabetic() || first == '_')
}

/// Names, `::` and single signs, without comments, text and characters.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = vec![];
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if first == '"' {
            text_length(rest)
        } else if first == '\'' {
            // A lifetime has no second quote right after.
            let character = if rest[1..].starts_with('\\') { rest[2..].find('\'').map(|end| end + 3) } else { None };
            let width = rest[1..].chars().next().map_or(0, char::len_utf8);
            character.unwrap_or(if rest[1 + width..].starts_with('\'') { width + 2 } else { 1 })
        } else if is_name(rest) {
            rest.find(|sign: char| !sign.is_alphanumeric() && sign != '_').unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let token = &rest[..length];
        if is_name(token) || token == "::" || (length == 1 && "{}()[],;*#".contains(first)) {
            tokens.push(token.to_owned());
        }
        rest = &rest[length..];
    }
    tokens
}

fn text_length(rest: &str) -> usize {
    let mut escaped = false;
    for (at, sign) in rest.char_indices().skip(1) {
        match sign {
            '"' if !escaped => return at + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    rest.len()
}

/// What a folder holds, in order.
fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut entries = read.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

/// All Rust files below a folder, or none where it is absent.
fn sources(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(vec![]);
    }
    let mut files = vec![];
    for entry in entries(folder)? {
        if entry.is_dir() {
            files.extend(sources(&entry)?);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            files.push(entry);
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<Repetition> {
        repetitions(&files.iter().map(|(path, text)| (path.into(), (*text).to_owned())).collect::<Vec<_>>())
    }

    fn modules(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        circles_of(&files.iter().map(|(path, text)| (module_of(Path::new(path)), (*text).to_owned())).collect())
    }

    #[test]
    fn six_equal_lines_are_found_and_five_are_not() {
        let six = "a();\nb();\nc();\nd();\ne();\nf();\n";
        let parted = "use x::{\n    y,\n};\n#[inline]\na();\n// why\nb();\n\nc();\nd();\ne();\nf();\ng();\n";
        let places = [(PathBuf::from("one.rs"), 1), (PathBuf::from("two.rs"), 5)];
        assert_eq!(found(&[("one.rs", six), ("two.rs", parted)]), [Repetition { places, lines: 6 }]);
        assert_eq!(found(&[("one.rs", &six[5..]), ("two.rs", parted)]), []);
        assert_eq!(found(&[("one.rs", &six.repeat(2))]).len(), 1);
    }

    #[test]
    fn a_circle_is_found_through_parents_and_what_they_pass_on() {
        let circle = modules(&[
            ("lib.rs", "mod a;\nmod b;\npub use b::Thing;\npub const MOST: u8 = 1;"),
            ("a.rs", "use crate::{MOST, Thing};\npub fn a() {}"),
            ("b/mod.rs", "mod c;\nfn f() { c::g() }"),
            ("b/c.rs", "pub fn g() { crate::a::a() }"),
        ]);
        // Through `Thing`, a imports b; b calls c, and c calls a.
        assert_eq!(circle, [["a", "b", "b::c"]]);
    }

    #[test]
    fn imports_that_all_lead_down_make_none() {
        let none = modules(&[
            ("lib.rs", "mod a;\nmod b;\npub use a::A;\npub const MOST: u8 = 1;"),
            ("a.rs", "use crate::b::{self, B as Other};\nuse crate::MOST;\n#[cfg(test)]\nmod tests { use super::*; }"),
            ("b.rs", "//! use crate::a::A;\nconst TEXT: &str = \"crate::a::A\";\nfn f<'a>(x: &'a u8) -> char { ':' }"),
        ]);
        assert_eq!(none, Vec::<Vec<String>>::new());
    }
}

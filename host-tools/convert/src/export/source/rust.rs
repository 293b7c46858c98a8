//! Rust modules, and the same items for a module that exists.

use super::described::{Content, Described};
use super::names::{identifier, is_constant, plain, type_name};
use crate::error::{Error, require};
use anyhow::Result;
use pantin::{Bank, Clip};
use std::fmt::{Display, Write as _};

/// A Rust module: the clip's bytes as `pub static STEM`, constants for the memory that it takes, and the type of a player's memory.
pub fn rust_module(clip: &Clip, bytes: &[u8], stem: &str) -> Result<String> {
    Ok(RustText::of_stem(stem).module(&Described::of_clip(clip, bytes)?))
}

/// A Rust module: the bank's bytes as `pub static STEM`, constants for the memory that its clips take at most, and the type of a player's memory.
pub fn rust_module_of_bank(bank: &Bank, bytes: &[u8], stem: &str) -> Result<String> {
    Ok(RustText::of_stem(stem).module(&Described::of_bank(bank, bytes)?))
}

/// How Rust text is written.
///
/// ```
/// use pantin_convert::export::source::{Described, RustText};
///
/// # let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../motions/walk.ptn"))?;
/// let text = RustText::of_stem("walk").figure_type(true).items(&Described::of(&bytes)?);
/// assert!(text.contains("pub type WalkRoom = pantin::Room<WALK_MOVING, WALK_CHANNELS>;"));
/// assert!(text.contains("pub type WalkFigure = pantin_figure::FigureRenderer<WALK_FIGURE_JOINTS>;"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RustText {
    name: String,
    figure_type: bool,
    more: Vec<String>,
}

impl RustText {
    /// Names made of a file's stem: `WALK` of `walk`. Different stems have different names.
    pub fn of_stem(stem: &str) -> RustText {
        RustText { name: identifier(stem), figure_type: false, more: Vec::new() }
    }

    /// A name that the user gives. Fails unless it has capital letters, digits and `_` alone and begins with a letter.
    pub fn named(name: &str) -> Result<RustText, Error> {
        let refusal = || {
            Error::source(format!("{name:?} is no name of a constant; expected capital letters, digits and `_`, as in WALK_2"))
        };
        require!(is_constant(name), refusal());
        Ok(RustText { name: name.into(), figure_type: false, more: Vec::new() })
    }

    /// Adds a type of the figure, for programs that depend on `pantin-figure`.
    pub fn figure_type(self, figure_type: bool) -> RustText {
        RustText { figure_type, ..self }
    }

    /// Adds a line to the documentation of the bytes.
    pub fn line(mut self, line: &str) -> RustText {
        self.more.push(plain(line));
        self
    }

    /// The name of the bytes: `WALK`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text of a module of its own. None of its items has to be used.
    pub fn module(&self, described: &Described) -> String {
        let mut out: String = described.comments().map(|line| format!("//! {line}\n")).collect();
        out.push_str("#![allow(dead_code)]\n\n");
        self.write(&mut out, described, None, "");
        out
    }

    /// The items alone, for `include!` in a module. None of them has to be used.
    pub fn items(&self, described: &Described) -> String {
        let mut out: String = described.lines.iter().map(|line| format!("// {line}\n")).collect();
        self.write(&mut out, described, Some(&described.title), "#[allow(dead_code)]\n");
        out
    }

    fn write(&self, out: &mut String, described: &Described, title: Option<&str>, allowed: &str) {
        let name = &self.name;
        let mut constant = |doc: &str, what: &str, kind: &str, value: &dyn Display| {
            let _ = write!(out, "/// {doc}\n{allowed}pub const {name}_{what}: {kind} = {value};\n");
        };
        if let Content::Clip { frames, frame_time_ns, .. } = &described.content {
            constant("Number of frames.", "FRAMES", "u32", frames);
            constant("Nanoseconds from a frame to the next.", "FRAME_TIME_NS", "u32", frame_time_ns);
        }
        if let Content::Bank { clips } = &described.content {
            constant("Number of clips.", "CLIPS", "usize", &clips.len());
        }
        for size in described.memory.sizes() {
            let most = if described.is_bank() { " The most of any clip." } else { "" };
            constant(&format!("{}{most}", size.meaning), size.name, "usize", &size.value);
        }
        self.write_types(out, allowed);
        let (doc, list, of_each, names) = match &described.content {
            Content::Clip { channels, .. } => ("The name of each channel.", "NAMES", "CHANNELS", channels),
            Content::Bank { clips } => ("The name of each clip.", "CLIP_NAMES", "CLIPS", clips),
        };
        let names: String = names.iter().map(|name| format!("    {name:?},\n")).collect();
        let _ = write!(
            out,
            "/// {doc}\n{allowed}#[rustfmt::skip]\npub const {name}_{list}: [&str; {name}_{of_each}] = [\n{names}];\n"
        );
        if described.has_keys() {
            // Without the feature it would compile, and fail when it runs.
            let _ = write!(
                out,
                "/// Key clips take feature `keys` of the crate `pantin`.\nconst _: fn(&pantin::Clip<'_>) -> bool = pantin::Clip::has_keys;\n"
            );
        }
        self.write_bytes(out, described, title, allowed);
    }

    /// The types of a player's memory and of the figure.
    fn write_types(&self, out: &mut String, allowed: &str) {
        let (name, of_type) = (&self.name, type_name(&self.name));
        let _ = write!(
            out,
            "/// Memory of a player.\n{allowed}pub type {of_type}Room = pantin::Room<{name}_MOVING, {name}_CHANNELS>;\n"
        );
        if self.figure_type {
            let _ = write!(
                out,
                "/// The figure that is drawn.\n{allowed}pub type {of_type}Figure = pantin_figure::FigureRenderer<{name}_FIGURE_JOINTS>;\n"
            );
        }
    }

    fn write_bytes(&self, out: &mut String, described: &Described, title: Option<&str>, allowed: &str) {
        let kind = if described.is_bank() { "bank" } else { "clip" };
        let title = title.map_or_else(|| format!("The {kind}."), String::from);
        let _ = writeln!(out, "/// {title}");
        self.more.iter().for_each(|line| out.push_str(&format!("///\n/// {line}\n")));
        let (name, len, rows) = (&self.name, described.bytes.len(), described.rows());
        let _ = write!(out, "{allowed}#[rustfmt::skip]\npub static {name}: [u8; {len}] = [\n{rows}];\n");
    }
}

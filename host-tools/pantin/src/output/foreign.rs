//! Names that belong to another kind of file: `-o walk.bvh` for a clip would destroy a capture, or fool whoever opens it.

use anyhow::{Result, bail};
use pantin_convert::import::FORMATS;
use std::path::Path;

/// What a command writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// A clip.
    Clip,
    /// Clips of one rig.
    Bank,
    /// A rig that is kept apart from its clips.
    Rig,
    /// A motion, or source text.
    Motion,
    /// Key-frame text.
    Keys,
    /// A picture.
    Picture,
    /// A face's model.
    Model,
    /// A Rust source file.
    Source,
    /// A list of names, one per line: text.
    Names,
    /// Anything else that a command checks by itself.
    Other,
}

/// The hint for files that are read and not written.
const READ_ALONE: &str = "Pantin reads these files and does not write them; `pantin expand` writes .bvh, .glb, .keys and .csv";

/// Kinds of file, their extensions, and which command writes them.
const KINDS: &[(Wanted, &[&str], &str)] = &[
    (Wanted::Clip, &["ptn"], "`pantin convert` writes clips"),
    (Wanted::Bank, &["ptb"], "`pantin pack` and `pantin convert FOLDER` write banks"),
    (Wanted::Rig, &["rig"], "`pantin convert --rig-out` writes rigs"),
    (Wanted::Motion, &["bvh", "glb", "csv", "h"], "to write a motion or source text use `pantin expand`"),
    (Wanted::Keys, &["keys"], "`pantin face fit`, `pantin face speak` and `pantin expand` write .keys"),
    (Wanted::Picture, &["png", "apng", "gif", "svg"], "to draw a clip use `pantin render`"),
    (
        Wanted::Other,
        &["jpg", "jpeg", "webp", "bmp", "tif", "tiff", "pdf", "mp4", "webm", "mov", "avi", "mkv"],
        "`pantin render` writes .png, .apng, .gif and .svg",
    ),
    (Wanted::Model, &["model"], "`pantin face model` writes models"),
    (Wanted::Source, &["rs"], "`pantin expand` writes Rust modules"),
    (Wanted::Other, &["uf2", "hex", "bin", "elf"], "to write an image for a board use `pantin flash-image`"),
    (Wanted::Other, &["obj"], "`pantin face export` writes .obj"),
    (Wanted::Names, &["txt"], "that is another kind of file"),
    (
        Wanted::Other,
        &["md", "json", "html", "htm", "js", "py", "c", "cpp", "toml", "yaml", "yml", "xml", "log", "gz"],
        "that is another kind of file",
    ),
];

/// The kind of file that an extension belongs to, and a hint; none where the extension is no kind's. What Pantin reads, it reads alone
/// unless [`KINDS`] says more.
fn kind(extension: &str) -> Option<(Wanted, &'static str)> {
    let known = KINDS.iter().find(|(_, extensions, _)| extensions.contains(&extension)).map(|&(kind, _, hint)| (kind, hint));
    let is_read =
        || FORMATS.iter().any(|format| format.extensions.iter().chain(format.companion_extensions).any(|&its| its == extension));
    known.or_else(|| is_read().then_some((Wanted::Other, READ_ALONE)))
}

/// Refuses an output whose extension belongs to another kind of file than the one `wanted`, and says which command writes that kind.
pub fn refuse_foreign(path: &Path, wanted: Wanted) -> Result<()> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let Some((kind, hint)) = kind(&extension).filter(|(kind, _)| *kind != wanted) else { return Ok(()) };
    let expected = match wanted {
        Wanted::Clip => "a clip's name ends in .ptn",
        Wanted::Bank => "a bank's name ends in .ptb",
        Wanted::Rig => "a rig's name ends in .rig",
        Wanted::Motion => "expected a name that ends in .bvh, .glb, .keys, .csv, .h or .rs",
        Wanted::Keys => "key-frame text has a name that ends in .keys",
        Wanted::Picture => "expected a name that ends in .gif, .apng, .png or .svg",
        Wanted::Model => "a model's name ends in .model",
        Wanted::Source => "expected a name that ends in .rs",
        Wanted::Names => "a list of names ends in .txt, or has no extension",
        Wanted::Other => "expected another name",
    };
    if wanted == Wanted::Motion && kind == Wanted::Source {
        return Ok(());
    }
    bail!("{}: {expected}; {hint}", path.display())
}

//! One file of motion that a build script turns into Rust.

use crate::Error;
use pantin_convert::export::source::{Described, RustText};
use pantin_convert::facts::FileKind;
use pantin_convert::import::{Disk, Files};
use pantin_convert::{Converted, Note, Recipe, Remedy};
use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// A clip from the file `path`: a motion in any format that pantin reads, or a clip (`.ptn`). Relative paths start at the folder of the package.
pub fn clip(path: impl Into<PathBuf>) -> Asset {
    Asset { path: path.into(), kind: FileKind::Clip, recipe: None, name: None, figure: false }
}

/// The bank (`.ptb`) `path`. Relative paths start at the folder of the package.
pub fn bank(path: impl Into<PathBuf>) -> Asset {
    Asset { kind: FileKind::Bank, ..clip(path) }
}

/// A file of motion, and what is made of it. [`Asset::emit`] does the work.
///
/// ```
/// let walk = pantin_build::clip("../../motions/walk.keys").name("STROLL").with_figure().generate()?;
/// assert_eq!(walk.file_name, "stroll.rs");
/// assert!(walk.text.contains("pub static STROLL: [u8; "));
/// assert!(walk.text.contains("pub type StrollRoom = pantin::Room<STROLL_MOVING, STROLL_CHANNELS>;"));
/// assert!(walk.text.contains("pub type StrollFigure = pantin_figure::FigureRenderer<STROLL_FIGURE_JOINTS>;"));
/// # Ok::<(), pantin_build::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is written before `emit`"]
pub struct Asset {
    path: PathBuf,
    kind: FileKind,
    recipe: Option<Recipe>,
    name: Option<String>,
    figure: bool,
}

/// What [`Asset::generate`] made.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Generated {
    /// The name of the file in `OUT_DIR`: `walk.rs` for `WALK`.
    pub file_name: String,
    /// The items of Rust.
    pub text: String,
    /// The bytes of the clip or the bank.
    pub bytes: Vec<u8>,
    /// Every file that was read, in order of names.
    pub inputs: Vec<PathBuf>,
    /// What may be wrong with the result, a line each.
    pub warnings: Vec<String>,
}

/// Bytes of a clip or a bank, how they were verified, and what is odd.
struct Contents {
    bytes: Vec<u8>,
    verified: Option<String>,
    notes: Vec<Note>,
}

impl Asset {
    /// Sets how the motion is read, changed and coded. Without it the motion is coded as it is, with the default bounds. Clips and banks are
    /// converted already: for them a recipe is an error.
    pub fn recipe(self, recipe: Recipe) -> Asset {
        Asset { recipe: Some(recipe), ..self }
    }

    /// Sets the name of the `static`, from which all other names are made: capital letters, digits and `_`, as in `WALK_2`. Without it the name
    /// is that of the file.
    pub fn name(self, name: impl Into<String>) -> Asset {
        Asset { name: Some(name.into()), ..self }
    }

    /// Adds a type for the figure, `WalkFigure`. The program must depend on `pantin-figure`.
    pub fn with_figure(self) -> Asset {
        Asset { figure: true, ..self }
    }

    /// Does all the work of a build script: writes the items to `OUT_DIR`, names every file that was read to cargo, so that a change runs the
    /// script again, and prints warnings. Fails outside of a build script, and where [`Asset::generate`] fails.
    pub fn emit(&self) -> Result<(), Error> {
        println!("cargo::rerun-if-changed={}", self.path.display());
        let help = "call `emit` from a build script, which cargo runs with OUT_DIR, or call `generate`";
        let folder = env::var_os("OUT_DIR").ok_or_else(|| Error::of_file(&self.path, "there is no OUT_DIR to write to", help))?;
        let generated = self.generate()?;
        generated
            .inputs
            .iter()
            .filter(|input| **input != self.path)
            .for_each(|input| println!("cargo::rerun-if-changed={}", input.display()));
        generated.warnings.iter().for_each(|warning| println!("cargo::warning={warning}"));
        let path = Path::new(&folder).join(&generated.file_name);
        let help = "make room on the disk, or give another target directory";
        fs::write(&path, generated.text).map_err(|error| Error::of_file(&path, format!("cannot be written: {error}"), help))
    }

    /// The items of Rust, without writing or printing anything. Fails for a file that cannot be read or converted, for a damaged clip or bank, and
    /// for settings that do not fit the file.
    pub fn generate(&self) -> Result<Generated, Error> {
        let text = self.names()?;
        let recipe = self.recipe.clone().unwrap_or_default();
        let disk = Disk::new(recipe.import.memory);
        let Contents { bytes, verified, notes } = self.contents(&disk, &recipe)?;
        let damaged = |error| Error::of_file(&self.path, format!("{error:#}"), "make the file again with `pantin convert`");
        let described = Described::of(&bytes).map_err(damaged)?;
        if self.figure && described.memory().figure_joints == 0 {
            return Err(Error::of_file(&self.path, "there is no figure in it", "leave out `with_figure`"));
        }
        let source = self.path.file_name().unwrap_or_default().to_string_lossy();
        let text = text.figure_type(self.figure).line(&format!("Source: {source}."));
        let text = verified.iter().fold(text, |text, line| text.line(line));
        let mut inputs: BTreeSet<PathBuf> = disk.read_so_far().into_iter().collect();
        inputs.insert(self.path.clone());
        Ok(Generated {
            file_name: format!("{}.rs", text.name().to_ascii_lowercase()),
            text: text.items(&described),
            inputs: inputs.into_iter().collect(),
            warnings: notes.iter().filter(|note| note.is_warning()).map(|note| self.warning(note)).collect(),
            bytes,
        })
    }

    fn names(&self) -> Result<RustText, Error> {
        match &self.name {
            Some(name) => {
                RustText::named(name).map_err(|error| Error::of_file(&self.path, error, "give `name` a name such as WALK"))
            }
            None => Ok(RustText::of_stem(&self.path.file_stem().unwrap_or_default().to_string_lossy())),
        }
    }

    /// The bytes that the program gets: those of the file, or of the clip that its motion becomes.
    fn contents(&self, disk: &Disk, recipe: &Recipe) -> Result<Contents, Error> {
        let fail = |error: &pantin_convert::Error| Error::of_conversion(&self.path, error);
        let head = disk.head(&self.path, 16).map_err(|error| {
            let help = "check the path; relative paths start at the folder of the package";
            Error::of_file(&self.path, format!("cannot be read: {error}"), help)
        })?;
        match (FileKind::of(&head), self.kind) {
            (Some(FileKind::Bank), FileKind::Clip) => {
                Err(Error::of_file(&self.path, "a bank, not a clip or a motion", "use `pantin_build::bank`"))
            }
            (None | Some(FileKind::Clip), FileKind::Bank) => {
                let help = "use `pantin_build::clip`, or make a bank with `pantin convert A B -o C.ptb`";
                Err(Error::of_file(&self.path, "not a bank", help))
            }
            (Some(_), _) if self.recipe.is_some() => {
                let help = "leave out `recipe`, or give the motion that the file was made of";
                Err(Error::of_file(&self.path, "converted already, so a recipe has no effect", help))
            }
            (Some(_), _) => {
                let bytes = disk.read(&self.path).map_err(|error| {
                    let help = "check the file and the rights to read it";
                    Error::of_file(&self.path, format!("cannot be read: {error}"), help)
                })?;
                Ok(Contents { bytes, verified: None, notes: Vec::new() })
            }
            (None, FileKind::Clip) if recipe.options.rig_apart => {
                let help = "leave out `rig_apart` of the recipe's options";
                Err(Error::of_file(&self.path, "the recipe keeps the rig out of the clip", help))
            }
            (None, FileKind::Clip) => {
                let Converted { clip, motion, report, notes, .. } =
                    recipe.convert(disk, &self.path, &mut |_| ()).map_err(|error| fail(&error))?;
                Ok(Contents { bytes: clip, verified: Some(format!("Verified: {}.", report.to_text(&motion))), notes })
            }
        }
    }

    /// A warning on one line.
    fn warning(&self, note: &Note) -> String {
        let help = note.remedy.map(|remedy| format!("; to change this, {} in the recipe", Remedy::text(remedy)));
        let text = format!("{}: {}{}", self.path.display(), note.text, help.unwrap_or_default());
        text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
    }
}

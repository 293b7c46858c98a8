//! `cargo xtask vectors`: adds golden vectors.
//!
//! A vector of this version of the format never changes; one that is new takes a name of its own. Those of another version are replaced as a whole.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::vectors::{
    self, Vector, bank, c_face, c_figure, c_header, constants, coverage, faces, keyed, own, record, sums, synthetic, turns,
};
use pantin::codec::layout::VERSION;
use pantin_tools::output::write_whole;

/// Adds what tests/vectors lacks: clips, the CRC of each of their frames, the format's tables as JSON
#[derive(Args)]
pub struct Vectors {}

impl Vectors {
    /// Writes what is new, and refuses to change what is there.
    pub fn run(self) -> Result<()> {
        let made = synthetic::all();
        let missing = coverage::left_out(&made)?;
        ensure!(missing.is_empty(), "the vectors leave out: {}", missing.join(", "));
        let folder = vectors::folder();
        fs::create_dir_all(&folder)?;
        remove_other_versions(&folder)?;
        let mut files = BTreeMap::new();
        for vector in own::vectors(|name| !folder.join(name).with_extension("ptn").exists())? {
            put(&mut files, &vector)?;
        }
        for made in &made {
            put(&mut files, &made.vector()?)?;
        }
        let bank = bank::bytes()?;
        files.insert(format!("{}.json", bank::NAME), bank::record(&bank)?.into_bytes());
        files.insert(format!("{}.ptb", bank::NAME), bank);
        let mut added = 0;
        for (name, bytes) in &files {
            let path = folder.join(name);
            match fs::read(&path) {
                Ok(there) => ensure!(
                    there == *bytes,
                    "{name}: a vector of version {VERSION} never changes, and would have other bytes now"
                ),
                Err(_) => {
                    write_whole(&path, bytes)?;
                    println!("{name}: {} bytes, new", bytes.len());
                    added += 1;
                }
            }
        }
        println!("{} new files of key clips", put_keyed()?);
        write_whole(&folder.join(constants::NAME), constants::text().as_bytes())?;
        write_whole(&c_header::path(), c_header::text().as_bytes())?;
        write_whole(&c_figure::path(), c_figure::text().as_bytes())?;
        write_whole(&c_face::path(), c_face::text().as_bytes())?;
        write_whole(&c_face::themes_path(), c_face::themes_text().as_bytes())?;
        write_whole(&folder.join(faces::NAME), faces::text()?.as_bytes())?;
        write_whole(&folder.join(turns::NAME), turns::text(&folder)?.as_bytes())?;
        write_whole(&folder.join(turns::SUMS), turns::sums_text(&folder)?.as_bytes())?;
        write_whole(&folder.join(sums::NAME), sums::text(&folder)?.as_bytes())?;
        println!("{} files as they were, {added} new", files.len() - added);
        Ok(())
    }
}

/// Adds the vectors of key clips that are missing, and returns how many files that were.
fn put_keyed() -> Result<usize> {
    let folder = keyed::folder();
    fs::create_dir_all(&folder)?;
    let (mut files, mut added) = (BTreeMap::new(), 0);
    for vector in keyed::all()? {
        put(&mut files, &vector)?;
    }
    let bank = keyed::bank()?;
    files.insert(format!("{}.json", bank::NAME), bank::record(&bank)?.into_bytes());
    files.insert(format!("{}.ptb", bank::NAME), bank);
    for (name, bytes) in &files {
        let path = folder.join(name);
        match fs::read(&path) {
            Ok(there) => ensure!(there == *bytes, "{name}: a vector of key clips never changes, and would have other bytes now"),
            Err(_) => {
                write_whole(&path, bytes)?;
                added += 1;
            }
        }
    }
    write_whole(&keyed::tables_path(&folder), keyed::tables().as_bytes())?;
    write_whole(&folder.join(sums::NAME), sums::text(&folder)?.as_bytes())?;
    Ok(added)
}

/// Takes the vectors away if they are not of this version.
fn remove_other_versions(folder: &Path) -> Result<()> {
    let tables = fs::read_to_string(folder.join(constants::NAME)).unwrap_or_default();
    let tables: serde_json::Value = serde_json::from_str(&tables).unwrap_or_default();
    if tables["version"] == VERSION {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| ["ptn", "ptb", "rig", "json"].iter().any(|ours| extension == *ours)) {
            fs::remove_file(&path).with_context(|| path.display().to_string())?;
        }
    }
    Ok(())
}

fn put(files: &mut BTreeMap<String, Vec<u8>>, vector: &Vector) -> Result<()> {
    let record = record::of(&vector.open()?)?;
    files.insert(format!("{}.ptn", vector.name), vector.clip.clone());
    files.insert(format!("{}.json", vector.name), record.into_bytes());
    if let Some(rig) = &vector.rig {
        files.insert(format!("{}.rig", vector.name), rig.clone());
    }
    Ok(())
}

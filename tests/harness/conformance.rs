//! Plays every golden vector on every core: one image per core, whose CRCs must equal those of the records.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, ensure};

use crate::build::Firmware;
use crate::qemu::{LM3S6965EVB, Launch, MICROBIT, MPS2_AN386, Machine, SX1, VIRT};
use crate::rp2040::{self, Request};
use crate::vectors::record::{self, Crcs};
use crate::vectors::{self, Vector};
use crate::{paths, setup, steered};

/// A way to play the vectors.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// This process.
    Host,
    /// A machine in QEMU.
    Emulated(Machine),
    /// The Raspberry Pi Pico in rp2040js.
    Pico,
    /// WebAssembly under Node.js.
    Node,
}

/// Name of each core, and how it plays.
pub const CORES: [(&str, Place); 8] = [
    ("this host", Place::Host),
    ("Cortex-M0", Place::Emulated(MICROBIT)),
    ("Cortex-M0+", Place::Pico),
    ("Cortex-M3", Place::Emulated(LM3S6965EVB)),
    ("Cortex-M4F", Place::Emulated(MPS2_AN386)),
    ("ARMv4T", Place::Emulated(SX1)),
    ("RV32IMAC", Place::Emulated(VIRT)),
    ("wasm32", Place::Node),
];

/// The Rust target of WebAssembly.
const WASM: &str = "wasm32-unknown-unknown";

/// Time limit of an image's run.
const LIMIT: Duration = Duration::from_secs(60);

/// The results of a core that agrees.
#[derive(Clone, Copy, Debug)]
pub struct Agreed {
    /// Number of vectors played.
    pub vectors: usize,
    /// Number of poses compared, by stepping and by seeking.
    pub poses: usize,
    /// Duration, including the emulator's start.
    pub time: Duration,
}

/// The expected results.
pub struct Expected {
    vectors: Vec<Vector>,
    crcs: BTreeMap<String, Crcs>,
}

impl Expected {
    /// Reads the records in the repository.
    pub fn load() -> Result<Expected> {
        let folder = vectors::folder();
        let vectors = vectors::load(&folder)?;
        let crcs = vectors.iter().map(|vector| Ok((vector.name.clone(), record::read(&folder, &vector.name)?)));
        let mut crcs: BTreeMap<String, Crcs> = crcs.collect::<Result<_>>()?;
        crcs.insert(conformance::STEERED.into(), steered::recorded()?);
        Ok(Expected { crcs, vectors })
    }

    /// Plays all vectors on a core, and compares every pose.
    pub fn check(&self, place: Place) -> Result<Agreed> {
        let (time, found) = match place {
            Place::Host => self.here()?,
            Place::Emulated(machine) => emulated(machine)?,
            Place::Pico => pico()?,
            Place::Node => node()?,
        };
        ensure!(found.len() == self.crcs.len(), "{} vectors were played, of {}", found.len(), self.crcs.len());
        for (name, expected) in &self.crcs {
            let found = found.get(name).with_context(|| format!("vector {name} was not played"))?;
            agree("step", &expected.stepped, &found.stepped).with_context(|| format!("vector {name}"))?;
            agree("seek", &expected.sought, &found.sought).with_context(|| format!("vector {name}"))?;
        }
        let poses = self.crcs.values().map(|crcs| crcs.stepped.len() + crcs.sought.len()).sum();
        Ok(Agreed { vectors: found.len(), poses, time })
    }

    fn here(&self) -> Result<(Duration, BTreeMap<String, Crcs>)> {
        let started = Instant::now();
        let found = self.vectors.iter().map(|vector| Ok((vector.name.clone(), record::crcs(&vector.open()?)?)));
        let mut found: BTreeMap<String, Crcs> = found.collect::<Result<_>>()?;
        found.insert(conformance::STEERED.into(), steered::crcs()?);
        Ok((started.elapsed(), found))
    }
}

fn agree(way: &str, expected: &[u16], found: &[u16]) -> Result<()> {
    ensure!(expected.len() == found.len(), "{} poses by {way}, expected {}", found.len(), expected.len());
    let differs = expected.iter().zip(found).position(|(expected, found)| expected != found);
    differs.map_or(Ok(()), |at| Err(anyhow!("pose {at} by {way} has CRC {:04x}, expected {:04x}", found[at], expected[at])))
}

fn emulated(machine: Machine) -> Result<(Duration, BTreeMap<String, Crcs>)> {
    setup::emulator(machine.emulator)?;
    let image = Firmware::build("conformance-image", "conformance", machine.target, &[])?;
    let started = Instant::now();
    let outcome = Launch::new(machine, image.elf()).limit(LIMIT).start()?.wait()?;
    ensure!(outcome.code == 0, "the image ended with code {}: {}", outcome.code, outcome.stderr.trim());
    Ok((started.elapsed(), parse(&outcome.stdout)?))
}

fn pico() -> Result<(Duration, BTreeMap<String, Crcs>)> {
    let image = Firmware::featuring("rp2040", "conformance-image", "conformance", rp2040::TARGET, &[])?;
    let (_folder, image) = rp2040::bare_image(image.elf())?;
    let started = Instant::now();
    let outcome = Request::new(&image, None).bare().run()?;
    ensure!(outcome.ended == "code 0", "the image ended with {}", outcome.ended);
    Ok((started.elapsed(), parse(outcome.printed.as_bytes())?))
}

fn node() -> Result<(Duration, BTreeMap<String, Crcs>)> {
    let node = setup::emulator("node")?;
    let image = Firmware::build("conformance-image", "conformance", WASM, &[])?;
    let started = Instant::now();
    let output = Command::new(node).arg(script()).arg(image.elf()).stdin(Stdio::null()).output().context("cannot start node")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "node ended with {}: {}", output.status, words.trim());
    Ok((started.elapsed(), parse(&output.stdout)?))
}

fn script() -> PathBuf {
    paths::root().join("tests/harness/conformance.mjs")
}

/// Parses an image's output.
fn parse(text: &[u8]) -> Result<BTreeMap<String, Crcs>> {
    let mut found = BTreeMap::new();
    let mut last: Option<&mut Crcs> = None;
    for line in std::str::from_utf8(text).context("the image printed no text")?.lines() {
        match (line.split_once(' '), &mut last) {
            (None, _) => last = Some(found.entry(line.to_owned()).or_insert_with(Crcs::default)),
            (Some((way, crc)), Some(crcs)) => {
                let crc = u16::from_str_radix(crc, 16).with_context(|| format!("the image printed {line:?}"))?;
                if way == "step" { crcs.stepped.push(crc) } else { crcs.sought.push(crc) }
            }
            (Some(_), None) => return Err(anyhow!("the image printed {line:?} before a vector's name")),
        }
    }
    Ok(found)
}

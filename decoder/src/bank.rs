//! A bank: the clips of one rig in one file, by name, opened in place.

use crate::OpenError;
use crate::blocks;
use crate::bytes::Reader;
use crate::clip::Clip;
use crate::crc;
use crate::layout::{BANK_MAGIC, CRC_BYTES, VERSION, section};
use crate::rig::Rig;

/// A checked bank (`pantin pack`). Its clips are checked when they are opened.
///
/// ```
/// # fn play(bytes: &[u8]) -> Result<(), pantin::OpenError> {
/// let bank = pantin::Bank::new_checked(bytes)?;
/// let walk = bank.clip("walk")?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bank<'a> {
    rig: Rig<'a>,
    /// All sections: those that this page names and others.
    sections: &'a [u8],
    /// Names and lengths, without their CRC.
    contents: &'a [u8],
    clips: &'a [u8],
}

/// One clip of a bank, not yet opened.
#[derive(Clone, Copy, Debug)]
pub struct BankEntry<'a> {
    name: &'a [u8],
    bytes: &'a [u8],
}

impl<'a> BankEntry<'a> {
    /// Its name; empty for one that is not UTF-8.
    pub fn name(&self) -> &'a str {
        core::str::from_utf8(self.name).unwrap_or("")
    }

    /// Its file, which has no rig: [`Bank::open`] opens it with the bank's.
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }
}

/// Iterates over the clips of a bank.
#[derive(Clone, Debug)]
pub struct BankEntries<'a> {
    contents: Reader<'a>,
    clips: Reader<'a>,
}

impl<'a> Iterator for BankEntries<'a> {
    type Item = BankEntry<'a>;

    fn next(&mut self) -> Option<BankEntry<'a>> {
        if self.contents.rest().is_empty() {
            return None;
        }
        let name = self.contents.name();
        Some(BankEntry { name, bytes: self.clips.take(self.contents.varint()) })
    }
}

impl<'a> Bank<'a> {
    /// Checks the rig and the contents of a bank.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Bank<'a>, OpenError> {
        let mut reader = Reader::new(bytes);
        let (magic, version) = ([reader.byte(), reader.byte()], reader.byte());
        reader.check()?;
        if magic != BANK_MAGIC {
            return Err(OpenError::BadMagic);
        }
        if !is_known(version) {
            return Err(OpenError::UnsupportedVersion(version));
        }
        let sections = reader.rest();
        let mut parts = [None; section::KNOWN];
        while let Some((kind, body)) = next_section(&mut reader) {
            // What is before the end ends there: this does not go on for ever.
            reader.check()?;
            let known = usize::from(kind).checked_sub(1).and_then(|at| parts.get_mut(at));
            if known.is_some_and(|part| part.replace(body).is_some()) {
                return Err(OpenError::Malformed);
            }
        }
        let [Some(rig_bytes), Some(contents), Some(clips)] = parts else { return Err(OpenError::Truncated) };
        if !blocks::is_intact(contents, crc::INITIAL) {
            return Err(OpenError::BadCrc);
        }
        let contents = contents.split_last_chunk::<CRC_BYTES>().map_or(&[][..], |(contents, _)| contents);
        let (mut walk, mut rest) = (Reader::new(contents), Reader::new(clips));
        let mut named = !contents.is_empty();
        while !walk.rest().is_empty() {
            named &= !walk.name().is_empty();
            rest.take(walk.varint());
        }
        walk.check()?;
        rest.check()?;
        if !rest.rest().is_empty() || !named {
            return Err(OpenError::Malformed);
        }
        Ok(Bank { rig: Rig::new_checked(rig_bytes)?, sections, contents, clips })
    }

    /// The figure of all clips.
    pub fn rig(&self) -> Rig<'a> {
        self.rig
    }

    /// The rig's bytes with their CRC, as a clip that is kept apart from its rig needs them.
    pub fn rig_bytes(&self) -> &'a [u8] {
        self.sections().find(|(kind, _)| *kind == section::RIG).map_or(&[], |(_, body)| body)
    }

    /// The types and bodies of all sections in their order: those of the format and those of applications, whose bodies are not checked.
    pub fn sections(&self) -> impl Iterator<Item = (u8, &'a [u8])> + use<'a> {
        let mut reader = Reader::new(self.sections);
        core::iter::from_fn(move || next_section(&mut reader))
    }

    /// The body of the only section of a type; `None` if there is none, [`OpenError::Malformed`] if there are several.
    pub fn section(&self, kind: u8) -> Result<Option<&'a [u8]>, OpenError> {
        let mut bodies = self.sections().filter_map(|(own, body)| (own == kind).then_some(body));
        let body = bodies.next();
        if bodies.next().is_some() { Err(OpenError::Malformed) } else { Ok(body) }
    }

    /// Number of clips, at least 1.
    #[allow(clippy::len_without_is_empty, reason = "a bank is never empty")]
    pub fn len(&self) -> usize {
        self.entries().count()
    }

    /// The clips in their order.
    pub fn entries(&self) -> BankEntries<'a> {
        BankEntries { contents: Reader::new(self.contents), clips: Reader::new(self.clips) }
    }

    /// Finds a clip by its name, of equal names the first. Names are compared byte by byte.
    pub fn find(&self, name: &str) -> Option<BankEntry<'a>> {
        self.entries().find(|entry| entry.name == name.as_bytes())
    }

    /// Checks one of the bank's clips.
    pub fn open(&self, entry: &BankEntry<'a>) -> Result<Clip<'a>, OpenError> {
        Clip::with_checked_rig(entry.bytes, self.rig)
    }

    /// Finds and checks a clip; [`OpenError::NoSuchClip`] if the bank has none of this name.
    pub fn clip(&self, name: &str) -> Result<Clip<'a>, OpenError> {
        self.open(&self.find(name).ok_or(OpenError::NoSuchClip)?)
    }
}

/// Whether a bank of this version can be opened.
fn is_known(version: u8) -> bool {
    #[cfg(feature = "keys")]
    if version == crate::keys::layout::KEY_VERSION {
        return true;
    }
    version == VERSION
}

/// The type and the body of the next section; `None` at the end. [`Reader::check`] reports a section that ends too early.
fn next_section<'a>(reader: &mut Reader<'a>) -> Option<(u8, &'a [u8])> {
    if reader.rest().is_empty() {
        return None;
    }
    let kind = reader.byte();
    Some((kind, reader.name()))
}

//! Flash in memory: it counts what is done to it, refuses what flash does not do, and loses its power when told to.
#![allow(dead_code)]

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use pantin_store::{Slot, Store};
use std::cell::Cell;
use std::rc::Rc;

/// What is there for both slots.
#[derive(Debug, Default)]
pub struct Power {
    /// Words and sectors that may still be written and erased; without end where there is none.
    pub left: Cell<Option<u32>>,
    /// What the operation leaves at which it fails: nothing of it was done if 0, else bits of it by chance.
    pub torn: Cell<u64>,
    /// Words written and sectors erased so far.
    pub done: Cell<u32>,
}

/// A slot of words of `WORD` bytes and sectors of `SECTOR`.
#[derive(Clone, Debug)]
pub struct Mock<const WORD: usize, const SECTOR: usize> {
    pub flash: Vec<u8>,
    pub erases: Vec<u32>,
    power: Rc<Power>,
}

impl Power {
    /// Whether an operation is done, in part (then the bits of it that are), or not at all.
    fn spend(&self) -> Spent {
        match self.left.get() {
            Some(0) => Spent::Gone,
            Some(left) => {
                self.left.set(Some(left - 1));
                self.done.set(self.done.get() + 1);
                if left > 1 { Spent::Whole } else { Spent::Torn(Chance(self.torn.get())) }
            }
            None => {
                self.done.set(self.done.get() + 1);
                Spent::Whole
            }
        }
    }

    /// On again, for ever.
    pub fn restore(&self) {
        self.left.set(None);
    }

    /// Cuts power at the operation after `after` more.
    pub fn cut(&self, after: u32, torn: u64) {
        self.left.set(Some(after + 1));
        self.torn.set(torn);
    }
}

enum Spent {
    Whole,
    Torn(Chance),
    Gone,
}

/// Bits that are done of an operation: none at 0.
pub struct Chance(pub u64);

impl Chance {
    /// SplitMix64 (S. Vigna).
    pub fn byte(&mut self) -> u8 {
        if self.0 == 0 {
            return 0;
        }
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb) >> 56) as u8
    }
}

/// Makes two slots of `sectors` sectors, filled with old bytes.
pub fn store<const WORD: usize, const SECTOR: usize>(sectors: usize) -> (Store<Mock<WORD, SECTOR>>, Rc<Power>) {
    let power = Rc::new(Power::default());
    let slot = || Mock { flash: vec![0; sectors * SECTOR], erases: vec![0; sectors], power: power.clone() };
    (Store::new([slot(), slot()]), power)
}

impl<const WORD: usize, const SECTOR: usize> ErrorType for Mock<WORD, SECTOR> {
    type Error = NorFlashErrorKind;
}

impl<const WORD: usize, const SECTOR: usize> ReadNorFlash for Mock<WORD, SECTOR> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        bytes.copy_from_slice(&self.flash[offset as usize..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.flash.len()
    }
}

impl<const WORD: usize, const SECTOR: usize> NorFlash for Mock<WORD, SECTOR> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        let (from, to) = (from as usize, to as usize);
        assert!(from < to && from.is_multiple_of(SECTOR) && to.is_multiple_of(SECTOR), "no whole sectors: {from} to {to}");
        if to > self.flash.len() {
            return Err(NorFlashErrorKind::OutOfBounds);
        }
        for (sector, bytes) in self.flash[from..to].chunks_mut(SECTOR).enumerate() {
            match self.power.spend() {
                Spent::Whole => bytes.fill(0xff),
                Spent::Torn(mut chance) => bytes.iter_mut().for_each(|byte| *byte |= chance.byte()),
                Spent::Gone => return Err(NorFlashErrorKind::Other),
            }
            self.erases[from / SECTOR + sector] += 1;
        }
        if self.power.left.get() == Some(0) { Err(NorFlashErrorKind::Other) } else { Ok(()) }
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        let offset = offset as usize;
        assert!(offset.is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD), "no whole words: {} at {offset}", bytes.len());
        if offset + bytes.len() > self.flash.len() {
            return Err(NorFlashErrorKind::OutOfBounds);
        }
        for (word, to) in bytes.chunks(WORD).zip(self.flash[offset..].chunks_mut(WORD)) {
            assert!(to.iter().all(|&byte| byte == 0xff), "a word at {offset} is written that was not erased");
            match self.power.spend() {
                Spent::Whole => to.copy_from_slice(word),
                Spent::Torn(mut chance) => to.iter_mut().zip(word).for_each(|(to, from)| *to &= from | !chance.byte()),
                Spent::Gone => return Err(NorFlashErrorKind::Other),
            }
        }
        if self.power.left.get() == Some(0) { Err(NorFlashErrorKind::Other) } else { Ok(()) }
    }
}

impl<const WORD: usize, const SECTOR: usize> Slot for Mock<WORD, SECTOR> {
    fn bytes(&self) -> &[u8] {
        &self.flash
    }
}

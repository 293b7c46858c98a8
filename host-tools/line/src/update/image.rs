//! A store's flash with one clip in it.

use super::uf2::{self, PAGE};
use anyhow::{Context, Result, ensure};
use ihex::Record;
use pantin_store::header::Header;
use pantin_store::region::Region;
use pantin_store::{BLOCK_BYTES, ClipInfo};

/// Bytes of a line of Intel HEX.
const LINE: usize = 32;

/// What the first slot begins with: the header's block and the clip.
fn slot(region: &Region, clip: &[u8], info: &ClipInfo) -> Result<Vec<u8>> {
    let room = region.slot as usize - BLOCK_BYTES;
    ensure!(clip.len() <= room, "the clip has {} bytes; {} has room for {room}", clip.len(), region.board);
    let mut bytes = Header { info: *info, sequence: 1 }.bytes().to_vec();
    bytes.resize(BLOCK_BYTES, 0xff);
    bytes.extend(clip);
    Ok(bytes)
}

/// The whole region: the clip in the first slot, all else as it is when erased.
pub fn binary(region: &Region, clip: &[u8], info: &ClipInfo) -> Result<Vec<u8>> {
    let mut bytes = slot(region, clip, info)?;
    bytes.resize(2 * region.slot as usize, 0xff);
    Ok(bytes)
}

/// The same as Intel HEX, without what is erased: the clip, and the block of the second slot's header, so that no newer clip stays there.
pub fn hex(region: &Region, clip: &[u8], info: &ClipInfo) -> Result<String> {
    let slot = slot(region, clip, info)?;
    let mut records = vec![];
    data(region.address, &slot, &mut records);
    data(region.address + region.slot, &[0xff; BLOCK_BYTES], &mut records);
    records.push(Record::EndOfFile);
    Ok(ihex::create_object_file_representation(&records)?)
}

/// The same as UF2, in whole sectors, as boards erase them: the clip's, and that of the second slot's header.
pub fn uf2(region: &Region, clip: &[u8], info: &ClipInfo) -> Result<Vec<u8>> {
    let family = region.family.with_context(|| format!("{} has no drive that takes UF2 files: use .hex", region.board))?;
    let sector = region.sector as usize;
    let mut slot = slot(region, clip, info)?;
    slot.resize(slot.len().next_multiple_of(sector), 0xff);
    let second = vec![0xff; sector];
    let of = |start: u32, bytes: &[u8]| -> Vec<(u32, [u8; PAGE])> {
        (start..).step_by(PAGE).zip(bytes.as_chunks().0.iter().copied()).collect()
    };
    let pages = [of(region.address, &slot), of(region.address + region.slot, &second)].concat();
    Ok(uf2::file(family, &pages.into_iter().collect()))
}

/// Records of bytes from an address on, which is a multiple of a line's bytes.
fn data(address: u32, bytes: &[u8], records: &mut Vec<Record>) {
    for (address, line) in (address..).step_by(LINE).zip(bytes.chunks(LINE)) {
        let high = (address >> 16) as u16;
        let last = records.iter().rev().find_map(|record| match record {
            Record::ExtendedLinearAddress(high) => Some(*high),
            _ => None,
        });
        if last != Some(high) {
            records.push(Record::ExtendedLinearAddress(high));
        }
        records.push(Record::Data { offset: address as u16, value: line.into() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_store::region::REGIONS;

    #[test]
    fn both_forms_say_the_same() {
        let clip: Vec<u8> = (0..9000u32).map(|byte| (byte % 251) as u8).collect();
        let info = ClipInfo::of(&clip, "walk").unwrap();
        for region in &REGIONS {
            let binary = binary(region, &clip, &info).unwrap();
            assert_eq!(binary.len() as u32, 2 * region.slot);
            assert_eq!(Header::read(&binary), Some(Header { info, sequence: 1 }));
            assert_eq!(binary[BLOCK_BYTES..][..clip.len()], clip);
            let text = hex(region, &clip, &info).unwrap();
            let (mut high, mut memory, mut told) = (0, vec![0xff; binary.len()], 0);
            for record in ihex::Reader::new(&text) {
                match record.unwrap() {
                    Record::ExtendedLinearAddress(address) => high = u32::from(address) << 16,
                    Record::Data { offset, value } => {
                        let at = (high + u32::from(offset) - region.address) as usize;
                        memory[at..at + value.len()].copy_from_slice(&value);
                        told += value.len();
                    }
                    _ => {}
                }
            }
            assert_eq!(memory, binary);
            assert_eq!(told, BLOCK_BYTES + clip.len() + BLOCK_BYTES);
        }
    }

    #[test]
    fn a_drive_gets_whole_sectors() {
        let clip: Vec<u8> = (0..9000u32).map(|byte| (byte % 251) as u8).collect();
        let info = ClipInfo::of(&clip, "walk").unwrap();
        let region = Region::of("pico").unwrap();
        let (file, binary) = (uf2(region, &clip, &info).unwrap(), binary(region, &clip, &info).unwrap());
        // Three sectors of header and clip, and one of the second slot.
        assert_eq!(file.len(), 4 * 4096 / PAGE * uf2::BLOCK);
        let mut sectors = std::collections::BTreeMap::<u32, usize>::new();
        for block in file.chunks(uf2::BLOCK) {
            let word = |at: usize| u32::from_le_bytes(block[at..at + 4].try_into().unwrap());
            let at = (word(12) - region.address) as usize;
            assert_eq!(block[32..32 + PAGE], binary[at..at + PAGE]);
            *sectors.entry(word(12) / region.sector * region.sector).or_default() += PAGE;
        }
        let slots = [0, 4096, 8192, region.slot].map(|at| region.address + at);
        assert!(sectors.keys().copied().eq(slots) && sectors.values().all(|bytes| *bytes == 4096), "{sectors:x?}");
        let error = uf2(Region::of("microbit").unwrap(), &clip, &info).unwrap_err().to_string();
        assert!(error.contains("use .hex"), "{error}");
    }

    #[test]
    fn one_that_is_too_long_is_refused() {
        let region = &REGIONS[0];
        let clip = vec![0; region.slot as usize];
        let error = binary(region, &clip, &ClipInfo::of(&clip, "").unwrap()).unwrap_err().to_string();
        assert!(error.contains(&format!("has room for {}", region.slot as usize - BLOCK_BYTES)), "{error}");
    }
}

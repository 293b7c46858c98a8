//! Power that goes at any operation of the flash: the board plays a whole clip afterwards, and takes the next one.

use crate::board::{NEW, OLD, THIRD, info, playing, send, which};
use crate::mock::store;
use pantin_store::{Response, Store};
use proptest::prelude::*;

/// Cuts at every operation of a transfer (or every `step`th), cleanly and with three kinds of half-done words and sectors.
fn survives_every_cut<const WORD: usize, const SECTOR: usize>(sectors: usize, step: usize) {
    let done = Some(Response::Done { id: info(NEW).crc });
    let (mut fresh, power) = store::<WORD, SECTOR>(sectors);
    assert_eq!(playing(&mut fresh), None);
    send(&mut fresh, OLD);
    let slots = fresh.into_slots();
    power.done.set(0);
    let mut whole = Store::new(slots.clone());
    assert_eq!(send(&mut whole, NEW), done);
    let operations = power.done.get();
    let used = whole.into_slots()[1].erases.iter().sum::<u32>();
    assert_eq!(used as usize, (256 + NEW.len()).div_ceil(SECTOR), "a sector is erased once, and only where the clip comes");
    for torn in [0, 1, 2, 3] {
        let mut news = 0;
        for cut in (0..operations).step_by(step) {
            let mut store = Store::new(slots.clone());
            power.cut(cut, torn);
            let answer = send(&mut store, NEW);
            assert_ne!(answer, done, "cut {cut} of {operations}: the board says what is not so");
            power.restore();
            match playing(&mut store) {
                Some("old") => {}
                // The last words of the header may have been done by chance.
                Some("new") if cut + 12 >= operations => news += 1,
                other => panic!("cut {cut} of {operations}, torn {torn}: plays {other:?}"),
            }
            assert_eq!(send(&mut store, THIRD), Some(Response::Done { id: info(THIRD).crc }), "cut {cut} of {operations}");
            assert_eq!(playing(&mut store), Some("third"), "cut {cut} of {operations}");
        }
        println!("words of {WORD}, sectors of {SECTOR}: {operations} cuts of kind {torn}, {news} of them with the new clip");
    }
}

#[test]
fn nrf51() {
    survives_every_cut::<4, 1024>(4, 1);
}

#[test]
fn rp2040() {
    survives_every_cut::<256, 4096>(2, 1);
}

#[test]
fn stm32f411() {
    survives_every_cut::<4, 131_072>(1, 1);
}

#[test]
fn flash_of_single_bytes() {
    survives_every_cut::<1, 256>(16, 13);
}

#[test]
fn a_first_clip_that_was_cut_off_leaves_none() {
    let (fresh, power) = store::<4, 1024>(4);
    let slots = fresh.into_slots();
    power.done.set(0);
    send(&mut Store::new(slots.clone()), NEW);
    let operations = power.done.get();
    for cut in 0..operations - 1 {
        let mut store = Store::new(slots.clone());
        power.cut(cut, 0);
        send(&mut store, NEW);
        power.restore();
        assert_eq!(playing(&mut store), None, "cut {cut} of {operations}: the board plays what it was built with");
    }
}

#[test]
fn a_bit_that_flips_in_the_newest_clip_leaves_the_one_before() {
    let (mut fresh, _) = store::<4, 1024>(4);
    send(&mut fresh, OLD);
    send(&mut fresh, NEW);
    let slots = fresh.into_slots();
    let written = (0..48 * 8).chain(256 * 8..(256 + NEW.len()) * 8);
    for bit in written {
        let mut slots = slots.clone();
        slots[1].flash[bit / 8] ^= 1 << (bit % 8);
        let mut store = Store::new(slots);
        assert_eq!(playing(&mut store), Some("old"), "bit {bit}");
    }
    let mut slots = slots.clone();
    slots[0].flash[300] ^= 1;
    slots[1].flash[300] ^= 1;
    assert_eq!(playing(&mut Store::new(slots)), None);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Whatever happens in whatever order, what plays is the clip that was sealed last, or the one that was being sealed.
    #[test]
    fn the_last_sealed_clip_plays(happenings in prop::collection::vec((0usize..3, prop::option::of(0u32..800), any::<u64>()), 1..12)) {
        let (mut store, power) = store::<4, 1024>(4);
        let mut sealed = None;
        for (clip, cut, torn) in happenings {
            let clip = [OLD, NEW, THIRD][clip];
            if let Some(cut) = cut {
                power.cut(cut, torn);
            }
            let answer = send(&mut store, clip);
            power.restore();
            let now = playing(&mut store);
            if answer == Some(Response::Done { id: info(clip).crc }) {
                prop_assert_eq!(now, Some(which(clip)));
            } else {
                prop_assert!(now == sealed || now == Some(which(clip)), "{:?} in place of {:?}", now, sealed);
            }
            sealed = now;
        }
    }

    /// Whatever stands in the flash, what is handed over can be opened.
    #[test]
    fn any_flash_at_all(seed in 1u64.., headers in any::<[bool; 2]>(), length in 0u32..5000, flips in prop::collection::vec(0usize..4096, 0..4)) {
        let (mut fresh, _) = store::<4, 1024>(4);
        send(&mut fresh, OLD);
        let mut slots = fresh.into_slots();
        let mut chance = crate::mock::Chance(seed);
        for (slot, header) in slots.iter_mut().zip(headers) {
            if header {
                let info = pantin_store::ClipInfo { length, ..info(OLD) };
                slot.flash.iter_mut().for_each(|byte| *byte = chance.byte());
                slot.flash[..48].copy_from_slice(&pantin_store::header::Header { info, sequence: 7 }.bytes());
            }
            flips.iter().for_each(|&at| slot.flash[at] = chance.byte());
        }
        if let (Some(stored), _) = Store::new(slots).open() {
            prop_assert!(pantin::Clip::new_checked(stored.bytes).is_ok());
        }
    }
}

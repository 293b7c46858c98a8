//! A Reed-Solomon code over GF(256) with x^8 + x^4 + x^3 + x^2 + 1: 8 parity bytes after at most 247 bytes correct 4 wrong bytes.
//!
//! The crate `reed-solomon` copies whole packets a dozen times on the stack, and can panic.

/// Parity bytes of a packet.
pub const PARITY: usize = 8;
/// Most bytes that are corrected.
const MOST: usize = PARITY / 2;
/// Longest code word in bytes.
const LONGEST: usize = 255;

const EXP: [u8; 512] = {
    let mut exp = [0; 512];
    let (mut i, mut x) = (0, 1u32);
    while i < 512 {
        exp[i] = x as u8;
        x <<= 1;
        if x > 255 {
            x ^= 0x11d;
        }
        i += 1;
    }
    exp
};

const LOG: [u8; 256] = {
    let mut log = [0; 256];
    let mut i = 0;
    while i < 255 {
        log[EXP[i] as usize] = i as u8;
        i += 1;
    }
    log
};

const fn times(a: u8, b: u8) -> u8 {
    if a == 0 || b == 0 { 0 } else { EXP[LOG[a as usize] as usize + LOG[b as usize] as usize] }
}

/// Returns 1 / a, and 1 for 0, which no caller passes.
fn inverse(a: u8) -> u8 {
    EXP[255 - usize::from(LOG[usize::from(a)])]
}

/// Returns a power of the field's generator.
fn power(n: usize) -> u8 {
    EXP[n % 255]
}

/// The generator polynomial without its leading 1, the highest power first. Its roots are the powers 0 to 7.
const GENERATOR: [u8; PARITY] = {
    let mut all = [0u8; PARITY + 1];
    all[0] = 1;
    let mut root = 0;
    while root < PARITY {
        let mut i = root + 1;
        while i > 0 {
            all[i] ^= times(all[i - 1], EXP[root]);
            i -= 1;
        }
        root += 1;
    }
    let mut lower = [0; PARITY];
    let mut i = 0;
    while i < PARITY {
        lower[i] = all[i + 1];
        i += 1;
    }
    lower
};

/// Returns the parity bytes of the concatenated `parts`.
pub(crate) fn of(parts: &[&[u8]]) -> [u8; PARITY] {
    let mut parity = [0; PARITY];
    for &byte in parts.iter().copied().flatten() {
        let [first, ..] = parity;
        parity.rotate_left(1);
        if let Some(last) = parity.last_mut() {
            *last = 0;
        }
        let back = byte ^ first;
        parity.iter_mut().zip(GENERATOR).for_each(|(own, part)| *own ^= times(back, part));
    }
    parity
}

/// Evaluates a polynomial whose lowest coefficient comes first.
fn value(polynomial: &[u8], at: u8) -> u8 {
    polynomial.iter().rev().fold(0, |sum, &coefficient| times(sum, at) ^ coefficient)
}

/// Returns the syndromes: all are zero if no byte is wrong.
fn syndromes(bytes: &[u8]) -> [u8; PARITY] {
    let mut all = [0; PARITY];
    for (root, own) in all.iter_mut().enumerate() {
        *own = bytes.iter().fold(0, |sum, &byte| times(sum, power(root)) ^ byte);
    }
    all
}

/// Corrects bytes that end with their parity. Returns false if there are too many wrong bytes; then `bytes` may have changed.
pub(crate) fn correct(bytes: &mut [u8]) -> bool {
    let syndromes = syndromes(bytes);
    if syndromes == [0; PARITY] {
        return true;
    }
    let (locator, wrong) = locate(&syndromes);
    if wrong > MOST || bytes.len() > LONGEST {
        return false;
    }
    // The product of syndromes and locator, below x^8.
    let mut evaluator = [0; PARITY];
    for (power, own) in evaluator.iter_mut().enumerate() {
        let pairs = locator.iter().zip(syndromes.get(..=power).unwrap_or(&[]).iter().rev());
        *own = pairs.fold(0, |sum, (&a, &b)| sum ^ times(a, b));
    }
    // The locator's derivative: in a field of characteristic 2, only the odd powers remain.
    let mut slope = [0; PARITY];
    slope.iter_mut().zip(locator.iter().skip(1)).step_by(2).for_each(|(own, &odd)| *own = odd);
    let mut found = 0;
    for (places, byte) in bytes.iter_mut().rev().enumerate() {
        let back = power(255 - places);
        if value(&locator, back) == 0 {
            *byte ^= times(power(places), times(value(&evaluator, back), inverse(value(&slope, back))));
            found += 1;
        }
    }
    found == wrong && self::syndromes(bytes) == [0; PARITY]
}

/// Returns the error locator polynomial and the number of wrong bytes (Berlekamp-Massey).
fn locate(syndromes: &[u8; PARITY]) -> ([u8; PARITY + 1], usize) {
    let (mut locator, mut before) = ([0; PARITY + 1], [0; PARITY + 1]);
    (locator[0], before[0]) = (1, 1);
    let (mut wrong, mut last) = (0, 1);
    for step in 0..PARITY {
        before.rotate_right(1);
        let seen = syndromes.get(..=step).unwrap_or(&[]).iter().rev();
        let off = locator.iter().zip(seen).fold(0, |sum, (&a, &b)| sum ^ times(a, b));
        if off == 0 {
            continue;
        }
        let kept = locator;
        let part = times(off, inverse(last));
        locator.iter_mut().zip(before).for_each(|(own, other)| *own ^= times(part, other));
        if 2 * wrong <= step {
            (wrong, before, last) = (step + 1 - wrong, kept, off);
        }
    }
    (locator, wrong)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_codes_generator() {
        // Checked by hand for x - 1 and x - 2, and by another program for all eight roots.
        assert_eq!(GENERATOR, [255, 11, 81, 54, 239, 173, 200, 24]);
    }

    proptest! {
        #[test]
        fn up_to_four_wrong_bytes_are_mended(
            data in prop::collection::vec(any::<u8>(), 0..=247),
            wrong in prop::collection::btree_map(0..255usize, 1..=255u8, 0..=4),
        ) {
            let sent = [&data[..], &of(&[&data])].concat();
            let mut came = sent.clone();
            for (at, mask) in wrong {
                if let Some(byte) = came.get_mut(at) {
                    *byte ^= mask;
                }
            }
            prop_assert!(correct(&mut came));
            prop_assert_eq!(came, sent);
        }

        #[test]
        fn any_bytes_end(mut bytes in prop::collection::vec(any::<u8>(), 0..600)) {
            correct(&mut bytes);
        }
    }
}

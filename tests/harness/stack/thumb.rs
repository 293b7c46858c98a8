//! Thumb instructions of ARMv6-M and ARMv7-M that use the stack, call or take addresses (encodings: ARM DDI 0403, A5 to A7).

use anyhow::{Context, Result, bail};

use super::Effect::{self, Call, Frame, Indirect, Jump, Takes};

const SP: u32 = 13;
const LR: u32 = 14;

/// What those at an address do; `word` reads the image, for literals.
pub fn effects(code: &[u8], start: u32, word: impl Fn(u32) -> Option<u32>) -> Result<Vec<Effect>> {
    let half = |at: usize| code.get(at..at + 2).map(|bytes| u32::from(bytes[0]) | u32::from(bytes[1]) << 8);
    let mut effects = vec![];
    // What literal loads and MOVW have left in the registers.
    let mut known = [None; 16];
    let mut at = 0;
    while let Some(first) = half(at) {
        let address = start + at as u32;
        if first >> 11 < 0b11101 {
            at += 2;
            narrow(first, address, &mut known, &word, &mut effects)?;
        } else {
            at += 4;
            let Some(second) = half(at - 2) else { break };
            wide(first, second, address, &mut known, &mut effects)?;
        }
    }
    Ok(effects)
}

fn narrow(
    code: u32,
    address: u32,
    known: &mut [Option<u32>; 16],
    word: impl Fn(u32) -> Option<u32>,
    effects: &mut Vec<Effect>,
) -> Result<()> {
    let register = (code >> 3 & 15) as usize;
    match code {
        // PUSH
        _ if code & 0xfe00 == 0xb400 => effects.push(Frame(4 * (code & 0x1ff).count_ones())),
        // SUB sp, #
        _ if code & 0xff80 == 0xb080 => effects.push(Frame(4 * (code & 0x7f))),
        // LDR rt, [pc, #]
        _ if code & 0xf800 == 0x4800 => {
            known[(code >> 8 & 7) as usize] = word(((address + 4) & !3) + 4 * (code & 0xff));
        }
        // ADD sp, rm: a negative literal makes a large frame, a positive one ends it
        _ if code & 0xff87 == 0x4485 => {
            let value = known[register].context("a register that no literal was loaded to is added to the stack pointer")?;
            effects.extend((value as i32).checked_neg().filter(|bytes| *bytes > 0).map(|bytes| Frame(bytes as u32)));
        }
        // BLX rm, BX rm
        _ if code & 0xff87 == 0x4780 => effects.push(Indirect),
        _ if code & 0xff87 == 0x4700 && register as u32 != LR => effects.push(Indirect),
        // B<c>, B
        _ if code & 0xf000 == 0xd000 && code & 0x0e00 != 0x0e00 => {
            effects.push(Jump(target(address, 2 * signed(code & 0xff, 8))));
        }
        _ if code & 0xf800 == 0xe000 => effects.push(Jump(target(address, 2 * signed(code & 0x7ff, 11)))),
        _ => {}
    }
    Ok(())
}

fn wide(first: u32, second: u32, address: u32, known: &mut [Option<u32>; 16], effects: &mut Vec<Effect>) -> Result<()> {
    let destination = (second >> 8 & 15) as usize;
    let immediate = (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xff;
    match (first, second) {
        // BL; B; B<c>
        _ if first & 0xf800 == 0xf000 && second & 0xd000 == 0xd000 => effects.push(Call(target(address, far(first, second)))),
        _ if first & 0xf800 == 0xf000 && second & 0xd000 == 0x9000 => effects.push(Jump(target(address, far(first, second)))),
        _ if first & 0xf800 == 0xf000 && second & 0xd000 == 0x8000 && first & 0x0380 != 0x0380 => {
            let high = (first >> 10 & 1) << 19 | (second >> 11 & 1) << 18 | (second >> 13 & 1) << 17 | (first & 0x3f) << 11;
            effects.push(Jump(target(address, 2 * signed(high | second & 0x7ff, 20))));
        }
        // PUSH.W; STR and STRD to [sp, #-n]!; VPUSH
        (0xe92d, _) => effects.push(Frame(4 * second.count_ones())),
        (0xf84d, _) if second & 0x0f00 == 0x0d00 => effects.push(Frame(second & 0xff)),
        (0xe96d, _) => effects.push(Frame(4 * (second & 0xff))),
        _ if first & 0xffbf == 0xed2d => effects.push(Frame(4 * (second & 0xff))),
        // SUB.W sp, sp, #; SUBW sp, sp, #; by a register
        _ if first & 0xfbef == 0xf1ad && second & 0x8000 == 0 && destination as u32 == SP => {
            effects.push(Frame(expanded(immediate)));
        }
        _ if first & 0xfbff == 0xf2ad && second & 0x8000 == 0 && destination as u32 == SP => effects.push(Frame(immediate)),
        _ if first == 0xebad && destination as u32 == SP => bail!("a register is taken from the stack pointer"),
        // MOVW, MOVT
        _ if first & 0xfbf0 == 0xf240 && second & 0x8000 == 0 => known[destination] = Some((first & 15) << 12 | immediate),
        _ if first & 0xfbf0 == 0xf2c0 && second & 0x8000 == 0 => {
            let high = (first & 15) << 12 | immediate;
            effects.extend(known[destination].map(|low| Takes(high << 16 | low & 0xffff)));
        }
        _ => {}
    }
    Ok(())
}

/// Offset of BL and B.
fn far(first: u32, second: u32) -> i32 {
    let sign = first >> 10 & 1;
    let [one, two] = [13, 11].map(|bit| !(second >> bit ^ sign) & 1);
    2 * signed(sign << 23 | one << 22 | two << 21 | (first & 0x3ff) << 11 | second & 0x7ff, 24)
}

/// A modified immediate constant of 12 bits: ThumbExpandImm.
fn expanded(immediate: u32) -> u32 {
    let byte = immediate & 0xff;
    match immediate >> 8 {
        0 => byte,
        1 => byte * 0x0001_0001,
        2 => byte * 0x0100_0100,
        3 => byte * 0x0101_0101,
        _ => (0x80 | immediate & 0x7f).rotate_right(immediate >> 7),
    }
}

fn target(address: u32, offset: i32) -> u32 {
    (address + 4).wrapping_add_signed(offset)
}

fn signed(value: u32, bits: u32) -> i32 {
    ((value << (32 - bits)) as i32) >> (32 - bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(halves: &[u16]) -> Vec<Effect> {
        let code: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
        effects(&code, 0x1000, |address| (address == 0x1008).then_some(0xffff_fbc0)).unwrap()
    }

    #[test]
    fn frames_calls_and_addresses_are_read() {
        // push {r4-r7, lr}; sub sp, #20; ldr r6, [pc, #0]; add sp, r6 (by -1088, which lies behind)
        assert_eq!(of(&[0xb5f0, 0xb085, 0x4e00, 0x44b5]), [Frame(20), Frame(20), Frame(1088)]);
        // push.w {r4-r11, lr}; str r8, [sp, #-4]!; vpush {d8}; sub.w sp, sp, #1040; subw sp, sp, #1041
        let frames = of(&[0xe92d, 0x4ff0, 0xf84d, 0x8d04, 0xed2d, 0x8b02, 0xf5ad, 0x6d82, 0xf2ad, 0x4d11]);
        assert_eq!(frames, [Frame(36), Frame(4), Frame(8), Frame(1040), Frame(1041)]);
        // bl back to the start, b.w on; blx r3; bx lr; bx r3
        assert_eq!(of(&[0xf7ff, 0xfffe, 0xf000, 0xb800]), [Call(0x1000), Jump(0x1008)]);
        assert_eq!(of(&[0x4798, 0x4770, 0x4718]), [Indirect, Indirect]);
        // movw r0, #0x1235; movt r0, #0x2000
        assert_eq!(of(&[0xf241, 0x2035, 0xf2c2, 0x0000]), [Takes(0x2000_1235)]);
    }
}

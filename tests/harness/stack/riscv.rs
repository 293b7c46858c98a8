//! RISC-V instructions of RV32IC that use the stack, call or take addresses (encodings: the RISC-V Instruction Set Manual, volume I).

use anyhow::{Context, Result};

use super::Effect::{self, Call, Frame, Indirect, Jump, Takes};

const RA: u32 = 1;
const SP: u32 = 2;

/// What those at an address do.
pub fn effects(code: &[u8], start: u32) -> Result<Vec<Effect>> {
    let half = |at: usize| code.get(at..at + 2).map(|bytes| u32::from(bytes[0]) | u32::from(bytes[1]) << 8);
    let mut reader = Registers { known: [None; 32], effects: vec![] };
    let mut at = 0;
    while let Some(low) = half(at) {
        let address = start + at as u32;
        if low & 3 == 3 {
            at += 4;
            let Some(high) = half(at - 2) else { break };
            reader.wide(high << 16 | low, address)?;
        } else {
            at += 2;
            reader.narrow(low, address)?;
        }
    }
    Ok(reader.effects)
}

struct Registers {
    /// What LUI, AUIPC and additions to them have left in the registers.
    known: [Option<u32>; 32],
    effects: Vec<Effect>,
}

impl Registers {
    fn narrow(&mut self, code: u32, address: u32) -> Result<()> {
        let (destination, source) = (code >> 7 & 31, code >> 2 & 31);
        let immediate = signed((code >> 12 & 1) << 5 | code >> 2 & 31, 6);
        let jump = || address.wrapping_add_signed(jump_offset(code));
        match code & 0xe003 {
            // C.ADDI16SP, C.LUI
            0x6001 if destination == SP => self.moved(stack_offset(code)),
            0x6001 => self.known[destination as usize] = Some((immediate << 12) as u32),
            // C.ADDI, C.LI
            0x0001 if destination == SP => self.moved(immediate),
            0x0001 => self.added(destination, destination, immediate),
            0x4001 => self.known[destination as usize] = Some(immediate as u32),
            // C.JAL, C.J
            0x2001 => self.effects.push(Call(jump())),
            0xa001 => self.effects.push(Jump(jump())),
            // C.JR, C.MV, C.JALR, C.ADD
            0x8002 => match (code >> 12 & 1, destination, source) {
                (0, RA, 0) | (1, 0, 0) => {}
                (_, register, 0) => self.goes(register, 0),
                (1, SP, register) => self.by_register(register, 1)?,
                (_, register, _) => self.known[register as usize] = None,
            },
            _ => {}
        }
        Ok(())
    }

    fn wide(&mut self, code: u32, address: u32) -> Result<()> {
        let (destination, source, second) = (code >> 7 & 31, code >> 15 & 31, code >> 20 & 31);
        let immediate = code as i32 >> 20;
        match code & 0x7f {
            // LUI, AUIPC
            0x37 => self.known[destination as usize] = Some(code & !0xfff),
            0x17 => self.known[destination as usize] = Some(address.wrapping_add(code & !0xfff)),
            // ADDI
            0x13 if code >> 12 & 7 == 0 && (destination, source) == (SP, SP) => self.moved(immediate),
            0x13 if code >> 12 & 7 == 0 => self.added(destination, source, immediate),
            // ADD, SUB
            0x33 if code & 0x000f_ffff == 0x0001_0133 => match code >> 25 {
                0x00 => self.by_register(second, 1)?,
                0x20 => self.by_register(second, -1)?,
                _ => {}
            },
            // JAL, JALR
            0x6f => {
                let target = address.wrapping_add_signed(long_jump_offset(code));
                self.effects.push(if destination == 0 { Jump(target) } else { Call(target) });
            }
            0x67 if destination == 0 && source == RA && immediate == 0 => {}
            0x67 => self.goes(source, immediate),
            _ => {}
        }
        Ok(())
    }

    fn moved(&mut self, by: i32) {
        self.effects.extend((by < 0).then_some(Frame(by.unsigned_abs())));
    }

    fn by_register(&mut self, register: u32, sign: i32) -> Result<()> {
        let value = self.known[register as usize].context("an unknown number is added to the stack pointer")?;
        self.moved(sign.wrapping_mul(value as i32));
        Ok(())
    }

    fn added(&mut self, destination: u32, source: u32, immediate: i32) {
        let sum = self.known[source as usize].map(|value| value.wrapping_add_signed(immediate));
        self.known[destination as usize] = if source == 0 { Some(immediate as u32) } else { sum };
        self.effects.extend(sum.map(Takes));
    }

    fn goes(&mut self, register: u32, offset: i32) {
        let target = self.known[register as usize].map(|value| Call(value.wrapping_add_signed(offset)));
        self.effects.push(target.unwrap_or(Indirect));
        self.known[register as usize] = None;
    }
}

/// Puts bits of a code (lowest, count) to places, and extends the sign of a number with that many bits.
fn gathered(code: u32, parts: &[(u32, u32, u32)], bits: u32) -> i32 {
    signed(parts.iter().fold(0, |value, (from, count, to)| value | (code >> from & ((1 << count) - 1)) << to), bits)
}

fn stack_offset(code: u32) -> i32 {
    gathered(code, &[(12, 1, 9), (6, 1, 4), (5, 1, 6), (3, 2, 7), (2, 1, 5)], 10)
}

fn jump_offset(code: u32) -> i32 {
    let parts = [(12, 1, 11), (11, 1, 4), (9, 2, 8), (8, 1, 10), (7, 1, 6), (6, 1, 7), (3, 3, 1), (2, 1, 5)];
    gathered(code, &parts, 12)
}

fn long_jump_offset(code: u32) -> i32 {
    gathered(code, &[(31, 1, 20), (21, 10, 1), (20, 1, 11), (12, 8, 12)], 21)
}

fn signed(value: u32, bits: u32) -> i32 {
    ((value << (32 - bits)) as i32) >> (32 - bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_calls_are_read() {
        let of = |code: &[u8]| effects(code, 0x1000).unwrap();
        // addi sp, sp, -16 short; addi sp, sp, -160 short and long; addi sp, sp, 32 short
        assert_eq!(of(&[0x41, 0x11]), [Frame(16)]);
        assert_eq!(of(&[0x35, 0x71]), [Frame(160)]);
        assert_eq!(of(&0xf601_0113_u32.to_le_bytes()), [Frame(160)]);
        assert_eq!(of(&[0x05, 0x61]), []);
        // lui a0, 1; sub sp, sp, a0
        assert_eq!(of(&[0x05, 0x65, 0x33, 0x01, 0xa1, 0x40]), [Frame(4096)]);
        // auipc ra, 0; jalr 98(ra); then a jalr to an unknown place, and a return
        assert_eq!(of(&[0x97, 0, 0, 0, 0xe7, 0x80, 0x20, 0x06]), [Call(0x1062)]);
        assert_eq!(of(&[0x02, 0x96, 0x82, 0x80]), [Indirect]);
        // j back by 2, jal to 8 on
        assert_eq!(of(&[0xfd, 0xbf]), [Jump(0x0ffe)]);
        assert_eq!(of(&0x0080_00ef_u32.to_le_bytes()), [Call(0x1008)]);
    }
}

//! Arm instructions of ARMv4T that use the stack or call (encodings: ARM DDI 0100, A3 and A4).

use anyhow::{Result, bail};

use super::Effect::{self, Call, Frame, Indirect, Jump};

/// What those at an address do.
pub fn effects(code: &[u8], start: u32) -> Result<Vec<Effect>> {
    let words = code.chunks_exact(4).map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let mut effects = vec![];
    for (word, address) in words.zip((start..).step_by(4)) {
        // Whatever the condition.
        let code = word & 0x0fff_ffff;
        let target = (address + 8).wrapping_add_signed((word << 8) as i32 >> 6);
        effects.push(match code {
            // STMDB sp!; STR rt, [sp, #-n]!
            _ if code & 0x0fff_0000 == 0x092d_0000 => Frame(4 * (code & 0xffff).count_ones()),
            _ if code & 0x0fff_0000 == 0x052d_0000 => Frame(code & 0xfff),
            // SUB sp, sp, #; by a register
            _ if code & 0x0fff_f000 == 0x024d_d000 => Frame((code & 0xff).rotate_right(2 * (code >> 8 & 15))),
            _ if code & 0x0fff_f000 == 0x004d_d000 => bail!("a register is taken from the stack pointer"),
            // BL; B; BX; MOV pc, rm
            _ if code & 0x0f00_0000 == 0x0b00_0000 => Call(target),
            _ if code & 0x0f00_0000 == 0x0a00_0000 => Jump(target),
            _ if code & 0x0fff_fff0 == 0x012f_ff10 && code & 15 != 14 => Indirect,
            _ if code & 0x0fff_fff0 == 0x01a0_f000 && code & 15 != 14 => Indirect,
            _ => continue,
        });
    }
    Ok(effects)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_calls_are_read() {
        // push {r4, r5, lr}; sub sp, sp, #1024; bl 0x1000; b 0x1010; bx lr; bx r3
        let words: [u32; 6] = [0xe92d_4030, 0xe24d_db01, 0xebff_fffc, 0xeaff_ffff, 0xe12f_ff1e, 0xe12f_ff13];
        let code: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        assert_eq!(effects(&code, 0x1000).unwrap(), [Frame(12), Frame(1024), Call(0x1000), Jump(0x1010), Indirect]);
    }
}

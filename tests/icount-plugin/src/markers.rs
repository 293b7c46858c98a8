//! Which instructions are markers: ones that do nothing and that no compiler emits.

/// The guest's instruction set.
#[derive(Clone, Copy)]
pub enum Isa {
    /// ARM and Thumb: `mov r9, r9` starts, `mov r10, r10` stops.
    Arm,
    /// RISC-V: `slti x0, x0, 0x101` starts, `slti x0, x0, 0x102` stops.
    RiscV,
}

/// What a marker says.
#[derive(Clone, Copy)]
pub enum Marker {
    /// A region starts after this instruction.
    Start,
    /// The region ended before this instruction.
    Stop,
}

impl Isa {
    /// The instruction set of QEMU's target of this name.
    pub fn named(target: &str) -> Self {
        if target.starts_with("riscv") { Self::RiscV } else { Self::Arm }
    }

    /// Whether an instruction is a marker. The set must be known: Thumb's `mov r9, r9` is RISC-V's `c.li a3, 18`.
    pub fn marker(self, instruction: &[u8]) -> Option<Marker> {
        match (self, instruction) {
            (Self::Arm, [0xc9, 0x46] | [0x09, 0x90, 0xa0, 0xe1]) => Some(Marker::Start),
            (Self::Arm, [0xd2, 0x46] | [0x0a, 0xa0, 0xa0, 0xe1]) => Some(Marker::Stop),
            (Self::RiscV, [0x13, 0x20, 0x10, 0x10]) => Some(Marker::Start),
            (Self::RiscV, [0x13, 0x20, 0x20, 0x10]) => Some(Marker::Stop),
            _ => None,
        }
    }
}

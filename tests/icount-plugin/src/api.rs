//! The part of QEMU's plugin interface that this plugin uses, declared from its documentation.

use std::ffi::{c_char, c_int, c_uint, c_void};

/// The head of what QEMU tells a plugin about itself; more follows that is not read here.
#[repr(C)]
pub struct Info {
    /// The guest: `arm`, `riscv32`, ...
    pub target_name: *const c_char,
    /// Oldest interface version that this QEMU accepts.
    pub minimum: c_int,
    /// The interface version that this QEMU speaks.
    pub current: c_int,
}

/// A block of translated instructions, opaque.
#[repr(C)]
pub struct Block {
    opaque: [u8; 0],
}

/// One instruction of a block, opaque.
#[repr(C)]
pub struct Instruction {
    opaque: [u8; 0],
}

/// The callback reads and writes no register of the guest.
pub const NO_REGISTERS: c_int = 0;

type Executed = extern "C" fn(c_uint, *mut c_void);

// SAFETY: signatures as in the interface's versions 1 to 4, except `qemu_plugin_insn_data`, see `bytes_of`.
unsafe extern "C" {
    pub fn qemu_plugin_register_vcpu_tb_trans_cb(id: u64, callback: extern "C" fn(u64, *mut Block));
    pub fn qemu_plugin_register_atexit_cb(id: u64, callback: extern "C" fn(u64, *mut c_void), data: *mut c_void);
    pub fn qemu_plugin_tb_n_insns(block: *const Block) -> usize;
    pub fn qemu_plugin_tb_get_insn(block: *const Block, index: usize) -> *mut Instruction;
    pub fn qemu_plugin_register_vcpu_insn_exec_cb(
        instruction: *mut Instruction,
        callback: Executed,
        flags: c_int,
        data: *mut c_void,
    );
    fn qemu_plugin_insn_vaddr(instruction: *const Instruction) -> u64;
    fn qemu_plugin_insn_size(instruction: *const Instruction) -> usize;
    fn qemu_plugin_insn_data();
}

/// An instruction's bytes, in the order in which they lie in the guest's memory.
pub struct Bytes {
    bytes: [u8; 4],
    length: usize,
}

impl Bytes {
    /// The bytes; none of an instruction longer than four.
    pub fn as_slice(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

/// Bytes of a page of the smallest kind that QEMU has for ARM.
const PAGE: u64 = 1024;

/// Reads an instruction's bytes from a QEMU of the given interface version.
///
/// # Safety
/// `instruction` must be alive: from QEMU, during the translation callback.
pub unsafe fn bytes_of(instruction: *const Instruction, interface: c_int) -> Bytes {
    // SAFETY: the instruction is alive, as the caller promises.
    let last = unsafe { qemu_plugin_insn_vaddr(instruction) } % PAGE == PAGE - 4;
    type Lent = unsafe extern "C" fn(*const Instruction) -> *const u8;
    type Copied = unsafe extern "C" fn(*const Instruction, *mut u8, usize) -> usize;
    let function = qemu_plugin_insn_data as unsafe extern "C" fn();
    let mut bytes = [0; 4];
    // SAFETY: the instruction is alive, as the caller promises. QEMU lends a pointer to the instruction's bytes before
    // version 3 of the interface and copies them into a buffer from version 3 on, so each cast restores the real signature.
    let length = unsafe {
        let length = qemu_plugin_insn_size(instruction);
        if length > bytes.len() {
            0
        } else if interface < 3 {
            let lent = std::mem::transmute::<unsafe extern "C" fn(), Lent>(function)(instruction);
            std::ptr::copy_nonoverlapping(lent, bytes.as_mut_ptr(), length);
            length
        } else {
            std::mem::transmute::<unsafe extern "C" fn(), Copied>(function)(instruction, bytes.as_mut_ptr(), length)
        }
    };
    // QEMU looks past a Thumb instruction of two bytes there, and takes what it sees for a part of it.
    let two = last && length == 4 && matches!(bytes, [0xc9 | 0xd2, 0x46, ..]);
    Bytes { bytes, length: if two { 2 } else { length } }
}

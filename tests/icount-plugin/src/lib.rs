//! A QEMU (TCG) plugin: counts the guest's instructions from one marker instruction to the next.
//!
//! `-plugin FILE,out=PATH` writes one line a region to PATH when QEMU ends: the number of instructions executed after
//! the start marker and before the stop marker, in the order of execution. A region opened twice, or closed while none
//! is open, writes `unbalanced` instead of a number.
#![cfg(unix)]
// QEMU's plugin interface is C: its functions are foreign, its symbols are looked up by name, its arguments are pointers.
#![allow(unsafe_code)]

mod api;
mod markers;
mod regions;

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::ptr::null_mut;
use std::sync::OnceLock;

use api::{Block, Info};
use markers::{Isa, Marker};

/// The interface that this build speaks; QEMU refuses a plugin outside what it supports.
#[unsafe(no_mangle)]
#[allow(non_upper_case_globals)]
pub static qemu_plugin_version: c_int = match option_env!("QEMU_PLUGIN_API") {
    Some(version) if matches!(version.as_bytes(), b"2") => 2,
    Some(version) if matches!(version.as_bytes(), b"3") => 3,
    _ => 1,
};

/// What the guest is, and which interface QEMU itself speaks.
static GUEST: OnceLock<(Isa, c_int)> = OnceLock::new();

/// Called by QEMU when it has loaded the plugin; anything but 0 stops QEMU.
///
/// # Safety
/// `info` and the `argc` strings at `argv` must be what QEMU's plugin interface promises.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qemu_plugin_install(id: u64, info: *const Info, argc: c_int, argv: *const *const c_char) -> c_int {
    // SAFETY: QEMU passes a valid `info`, its name a C string, and `argc` C strings, all alive during this call.
    let (guest, interface, arguments) = unsafe {
        let name = CStr::from_ptr((*info).target_name).to_string_lossy();
        let arguments = (0..argc as usize).map(|index| CStr::from_ptr(*argv.add(index)).to_string_lossy().into_owned());
        (Isa::named(&name), (*info).current, arguments.collect::<Vec<_>>())
    };
    let Some(path) = arguments.iter().find_map(|argument| argument.strip_prefix("out=")) else {
        eprintln!("icount-plugin: needs out=PATH, got {arguments:?}");
        return 1;
    };
    if let Err(error) = regions::open(path) {
        eprintln!("icount-plugin: {path}: {error}");
        return 1;
    }
    GUEST.get_or_init(|| (guest, interface));
    // SAFETY: `id` is ours, and both functions have the signatures that QEMU expects.
    unsafe {
        api::qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
        api::qemu_plugin_register_atexit_cb(id, ended, null_mut());
    }
    0
}

/// Attaches to a newly translated block: a callback at each marker, and one for each run of instructions beside them.
///
/// A run is counted when its first instruction executes. Only a fault can leave a run before its end (interrupts are
/// taken between blocks), and a fault ends the programs measured here.
extern "C" fn translated(_id: u64, block: *mut Block) {
    let Some(&(isa, interface)) = GUEST.get() else { return };
    // SAFETY: the block is valid during this call.
    let length = unsafe { api::qemu_plugin_tb_n_insns(block) };
    let mut run = None;
    for index in 0..length {
        // SAFETY: the index is below the block's length, and the instruction is used during this call only.
        let (instruction, bytes) = unsafe {
            let instruction = api::qemu_plugin_tb_get_insn(block, index);
            (instruction, api::bytes_of(instruction, interface))
        };
        match isa.marker(bytes.as_slice()) {
            None => {
                let (_, count) = run.get_or_insert((instruction, 0_usize));
                *count += 1;
            }
            Some(marker) => {
                attach_run(run.take());
                let callback = match marker {
                    Marker::Start => started,
                    Marker::Stop => stopped,
                };
                // SAFETY: the instruction is alive during this call and the callback has the expected signature.
                unsafe { api::qemu_plugin_register_vcpu_insn_exec_cb(instruction, callback, api::NO_REGISTERS, null_mut()) };
            }
        }
    }
    attach_run(run);
}

fn attach_run(run: Option<(*mut api::Instruction, usize)>) {
    if let Some((first, count)) = run {
        let count = std::ptr::without_provenance_mut::<c_void>(count);
        // SAFETY: as above; the count travels in the user data, which QEMU hands back untouched.
        unsafe { api::qemu_plugin_register_vcpu_insn_exec_cb(first, executed, api::NO_REGISTERS, count) };
    }
}

extern "C" fn executed(_cpu: c_uint, count: *mut c_void) {
    regions::add(count.addr() as u64);
}

extern "C" fn started(_cpu: c_uint, _data: *mut c_void) {
    regions::start();
}

extern "C" fn stopped(_cpu: c_uint, _data: *mut c_void) {
    regions::stop();
}

extern "C" fn ended(_id: u64, _data: *mut c_void) {
    regions::close();
}

//! The C library of ufbx, which reads FBX files: memory, bytes and mathematics of Rust's library, by the names that ufbx gives them with `UFBX_NO_LIBC`.

use std::alloc::{Layout, alloc, dealloc, realloc};
use std::ffi::{CStr, c_char, c_int};
use std::{ptr, slice};

/// What ufbx supposes of memory.
const ALIGNMENT: usize = 16;

fn layout(size: usize) -> Option<Layout> {
    Layout::from_size_align(size.max(1), ALIGNMENT).ok()
}

// SAFETY: nothing else is named so; this holds for every export below.
#[unsafe(no_mangle)]
extern "C" fn ufbx_malloc(size: usize) -> *mut u8 {
    // SAFETY: the size is not 0.
    layout(size).map_or(ptr::null_mut(), |layout| unsafe { alloc(layout) })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_realloc(place: *mut u8, old: usize, new: usize) -> *mut u8 {
    if place.is_null() {
        return ufbx_malloc(new);
    }
    match (layout(old), layout(new)) {
        // SAFETY: ufbx hands over memory of `ufbx_malloc` with its size.
        (Some(old), Some(new)) => unsafe { realloc(place, old, new.size()) },
        _ => ptr::null_mut(),
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_free(place: *mut u8, size: usize) {
    if let Some(layout) = layout(size).filter(|_| !place.is_null()) {
        // SAFETY: ufbx hands over memory of `ufbx_malloc` with its size.
        unsafe { dealloc(place, layout) }
    }
}

/// `count` bytes. Of none, C allows any place.
///
/// # Safety
/// `place` holds them while they are used.
unsafe fn bytes<'a>(place: *const u8, count: usize) -> &'a [u8] {
    // SAFETY: the caller's promise.
    if count == 0 { &[] } else { unsafe { slice::from_raw_parts(place, count) } }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_memcpy(to: *mut u8, from: *const u8, count: usize) -> *mut u8 {
    // SAFETY: as C demands of the caller: both hold `count` bytes and are apart.
    unsafe { ptr::copy_nonoverlapping(from, to, count) }
    to
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_memmove(to: *mut u8, from: *const u8, count: usize) -> *mut u8 {
    // SAFETY: as C demands of the caller: both hold `count` bytes.
    unsafe { ptr::copy(from, to, count) }
    to
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_memset(to: *mut u8, byte: c_int, count: usize) -> *mut u8 {
    // SAFETY: as C demands of the caller: it holds `count` bytes.
    unsafe { ptr::write_bytes(to, byte as u8, count) }
    to
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_memchr(place: *const u8, byte: c_int, count: usize) -> *const u8 {
    // SAFETY: as C demands of the caller: it holds `count` bytes.
    let bytes = unsafe { bytes(place, count) };
    bytes.iter().position(|&other| other == byte as u8).map_or(ptr::null(), |at| place.wrapping_add(at))
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_memcmp(one: *const u8, other: *const u8, count: usize) -> c_int {
    // SAFETY: as C demands of the caller: both hold `count` bytes.
    let [one, other] = [one, other].map(|place| unsafe { bytes(place, count) });
    one.cmp(other) as c_int
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_strlen(text: *const c_char) -> usize {
    // SAFETY: as C demands of the caller: the text ends with a 0.
    unsafe { CStr::from_ptr(text) }.count_bytes()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_strcmp(one: *const c_char, other: *const c_char) -> c_int {
    // SAFETY: as C demands of the caller: both texts end with a 0.
    let [one, other] = [one, other].map(|text| unsafe { CStr::from_ptr(text) }.to_bytes());
    one.cmp(other) as c_int
}

#[unsafe(no_mangle)]
unsafe extern "C" fn ufbx_strncmp(one: *const c_char, other: *const c_char, count: usize) -> c_int {
    for at in 0..count {
        // SAFETY: as C demands of the caller: both texts end with a 0 or have `count` bytes.
        let [one, other] = [one, other].map(|text| unsafe { *text.wrapping_add(at) } as u8);
        if one != other || one == 0 {
            return one.cmp(&other) as c_int;
        }
    }
    0
}

/// Functions of one number, by their names in Rust's library.
macro_rules! of_one_number {
    ($($c:ident = $rust:ident),* $(,)?) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $c(x: f64) -> f64 {
                x.$rust()
            }
        )*
    };
}

/// Functions of two numbers, by their names in Rust's library.
macro_rules! of_two_numbers {
    ($($c:ident = $rust:ident),* $(,)?) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $c(x: f64, y: f64) -> f64 {
                x.$rust(y)
            }
        )*
    };
}

of_one_number! {
    ufbx_sqrt = sqrt, ufbx_sin = sin, ufbx_cos = cos, ufbx_tan = tan, ufbx_asin = asin, ufbx_acos = acos, ufbx_atan = atan,
    ufbx_fabs = abs, ufbx_rint = round_ties_even, ufbx_floor = floor, ufbx_ceil = ceil,
}
of_two_numbers! {
    ufbx_atan2 = atan2, ufbx_pow = powf, ufbx_fmin = min, ufbx_fmax = max, ufbx_copysign = copysign,
}

/// The number next to `x` on the way to `to`.
#[unsafe(no_mangle)]
extern "C" fn ufbx_nextafter(x: f64, to: f64) -> f64 {
    match x.partial_cmp(&to) {
        Some(std::cmp::Ordering::Less) => x.next_up(),
        Some(std::cmp::Ordering::Greater) => x.next_down(),
        _ => to,
    }
}

#[unsafe(no_mangle)]
extern "C" fn ufbx_isnan(x: f64) -> c_int {
    x.is_nan().into()
}

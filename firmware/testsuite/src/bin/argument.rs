//! The paper's argument: one frame of every channel by three additions, by Horner's rule, and by cubics rebuilt from keys.
//! Regions in turn: additions, Horner with 32-bit values, Horner with 16-bit values, Hermite from keys with 32-bit values.
#![no_std]
#![no_main]

use core::hint::black_box;

use testsuite::markers;

/// Channels per region: enough that the loop's own start and end are negligible.
const CHANNELS: usize = 64;

#[derive(Clone, Copy)]
struct State {
    p: i32,
    v: i32,
    w: i32,
    k: i32,
}

/// a t^3 + b t^2 + c t + d; t in 2^-16 of the segment, a channel its own: segments end where they like.
#[derive(Clone, Copy)]
struct Cubic {
    a: i32,
    b: i32,
    c: i32,
    d: i32,
    t: i32,
}

/// Value and slope at both keys, t as above.
#[derive(Clone, Copy)]
struct Keys {
    p0: i32,
    p1: i32,
    m0: i32,
    m1: i32,
    t: i32,
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut states = black_box([State { p: 1 << 20, v: 1 << 10, w: 3, k: 1 }; CHANNELS]);
    let mut out = [0; CHANNELS];
    additions(&mut states);
    black_box(&states);
    let cubics = black_box([Cubic { a: 100_000, b: -200_000, c: 300_000, d: 40_000, t: 0x4000 }; CHANNELS]);
    horner(&cubics, &mut out);
    // 100 000 / 64 - 200 000 / 16 + 300 000 / 4 + 40 000 = 104 062.5
    assert!((out[0] - 104_062).abs() <= 3);
    let small = black_box([Cubic { a: 1_000, b: -2_000, c: 3_000, d: 400, t: 0x4000 }; CHANNELS]);
    horner_small(&small, &mut out);
    // 1000 / 64 - 2000 / 16 + 3000 / 4 + 400 = 1040.6
    assert!((out[0] - 1_040).abs() <= 3);
    // The same cubic as the first: p1 = a + b + c + d, m1 = 3 a + 2 b + c.
    let keys = black_box([Keys { p0: 40_000, p1: 240_000, m0: 300_000, m1: 200_000, t: 0x4000 }; CHANNELS]);
    hermite(&keys, &mut out);
    assert!((out[0] - 104_062).abs() <= 3);
    semihosting::process::exit(0)
}

#[inline(never)]
fn additions(states: &mut [State; CHANNELS]) {
    markers::start();
    for state in states {
        state.p = state.p.wrapping_add(state.v);
        state.v = state.v.wrapping_add(state.w);
        state.w = state.w.wrapping_add(state.k);
    }
    markers::stop();
}

#[inline(never)]
fn horner(cubics: &[Cubic; CHANNELS], out: &mut [i32; CHANNELS]) {
    markers::start();
    for (cubic, out) in cubics.iter().zip(out) {
        *out = at(cubic);
    }
    markers::stop();
}

/// A product of 32 bits and 2^-16: 64 bits in between.
#[inline(always)]
fn scaled(value: i32, t: i32) -> i32 {
    ((i64::from(value) * i64::from(t)) >> 16) as i32
}

#[inline(always)]
fn at(Cubic { a, b, c, d, t }: &Cubic) -> i32 {
    let value = scaled(*a, *t).wrapping_add(*b);
    let value = scaled(value, *t).wrapping_add(*c);
    scaled(value, *t).wrapping_add(*d)
}

/// As [`horner`], for coefficients that fit 15 bits: t is cut to 16 bits and no product needs more than 32.
#[inline(never)]
fn horner_small(cubics: &[Cubic; CHANNELS], out: &mut [i32; CHANNELS]) {
    markers::start();
    for (cubic, out) in cubics.iter().zip(out) {
        let value = ((cubic.a * cubic.t) >> 16) + cubic.b;
        let value = ((value * cubic.t) >> 16) + cubic.c;
        *out = ((value * cubic.t) >> 16) + cubic.d;
    }
    markers::stop();
}

#[inline(never)]
fn hermite(keys: &[Keys; CHANNELS], out: &mut [i32; CHANNELS]) {
    markers::start();
    for (&Keys { p0, p1, m0, m1, t }, out) in keys.iter().zip(out) {
        let rise = p1.wrapping_sub(p0);
        let a = m0.wrapping_add(m1).wrapping_sub(rise.wrapping_mul(2));
        let b = rise.wrapping_sub(m0).wrapping_sub(a);
        *out = at(&Cubic { a, b, c: m0, d: p0, t });
    }
    markers::stop();
}

//! Logs three messages by defmt, then panics.
#![no_std]
#![no_main]

use testsuite as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    defmt::info!("{} frames of {=u8} channels", 160, 23_u8);
    defmt::warn!("angle {=f32}", 0.5);
    defmt::error!("ends");
    panic!()
}

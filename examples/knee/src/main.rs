//! Prints the left knee's Euler angles at every frame, in hundredths of a degree: `cargo run --release` in `examples/knee`.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use pantin::{Clip, EulerOrder, Room};

static CLIP: &[u8] = include_bytes!("../../../motions/kneebend.ptn");

#[entry]
fn main() -> ! {
    let clip = Clip::new_checked(CLIP).unwrap();
    let knee = clip.find("left-shin").unwrap();
    let mut room = Room::<128, 256>::new();
    let mut player = room.player(clip).unwrap();
    for frame in 0..clip.frames() {
        let [z, y, x] = player.turn(&knee).unwrap().euler(EulerOrder::ZYX).map(|angle| angle.centidegrees());
        hprintln!("{}: {} {} {}", frame, z, y, x);
        player.step();
    }
    debug::exit(debug::EXIT_SUCCESS);
    loop {}
}

//! Plays a motion that `build.rs` converts, and prints a knee's angles at every frame, in the joint's own order and in hundredths of a
//! degree: `cargo run --release` in `examples/build`.
#![no_std]
#![no_main]

use core::fmt::Display;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use pantin::{Clip, EulerOrder};

// `WALK`, the clip, and `WalkRoom`, the memory that it takes.
include!(concat!(env!("OUT_DIR"), "/walk.rs"));

/// Any error, which is printed where it occurs.
struct Failure;

impl<E: Display> From<E> for Failure {
    fn from(error: E) -> Failure {
        hprintln!("error: {}", error);
        Failure
    }
}

fn play() -> Result<(), Failure> {
    let clip = Clip::new_checked(&WALK)?;
    let knee = clip.find("left-shin").ok_or("the clip has no joint left-shin")?;
    let order = knee.euler_order().unwrap_or(EulerOrder::ZXY);
    let mut room = WalkRoom::new();
    let mut player = room.player(clip)?;
    for frame in 0..clip.frames() {
        let [a, b, c] = player.turn(&knee)?.euler(order).map(|angle| angle.centidegrees());
        hprintln!("{}: {} {} {}", frame, a, b, c);
        player.step();
    }
    Ok(())
}

#[entry]
fn main() -> ! {
    debug::exit(play().map_or(debug::EXIT_FAILURE, |()| debug::EXIT_SUCCESS));
    loop {}
}

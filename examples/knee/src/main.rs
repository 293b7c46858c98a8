//! Prints the left knee's Euler angles (its own order: z, y, x) in hundredths of a degree: `cargo run --release` in `examples/knee`.
//! They are limited to the 90 degrees to either side that a servo reaches; `--max-channel-error 1` bounds each of them in a conversion.
#![no_std]
#![no_main]
use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use pantin::{Clip, EulerOrder, Room};

static CLIP: &[u8] = include_bytes!("../../../motions/kneebend.ptn");

#[cortex_m_rt::entry]
fn main() -> ! {
    let result = print_angles("left-shin").map_err(|what| hprintln!("{}", what));
    debug::exit(if result.is_ok() { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    loop {}
}

fn print_angles(joint: &str) -> Result<(), &str> {
    let clip = Clip::new_checked(CLIP).map_err(|_| "the clip is damaged")?;
    let knee = clip.find(joint).ok_or(joint).inspect_err(|_| hprintln!("the clip lacks this joint:"))?;
    let mut room = Room::<128, 256>::new();
    let mut player = room.player(clip).map_err(|_| "the clip has too many channels")?;
    for frame in 0..clip.frames() {
        let turn = player.turn(&knee).map_err(|_| "the joint is of another rig")?;
        let [z, y, x] = turn.euler(EulerOrder::ZYX).map(|angle| angle.centidegrees().clamp(-9_000, 9_000));
        hprintln!("{}: {} {} {}", frame, z, y, x);
        player.step();
    }
    Ok(())
}

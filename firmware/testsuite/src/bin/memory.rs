//! Plays a clip and logs what it takes: sizes in bytes, and stack by painting.
#![no_std]
#![no_main]

use core::hint::black_box;

use pantin::{ChannelState, Clip, OpenError, Player, TooSmall};
use testsuite::{clip, paint};

/// Enough for the clips that it is run with, and leaves room for the painted stack.
const CHANNELS: usize = 160;

#[cortex_m_rt::entry]
fn main() -> ! {
    let bytes = clip::bytes();
    let mut states = [ChannelState::default(); CHANNELS];
    let mut pose = [0; CHANNELS];
    defmt::info!("channel {=usize}", size_of::<ChannelState>());
    defmt::info!("player {=usize}", size_of::<Player>());
    let opening = paint::used(&mut || {
        black_box(Clip::new_checked(black_box(bytes)).is_ok());
    });
    let Ok(clip) = Clip::new_checked(bytes) else { panic!() };
    let starting = paint::used(&mut || {
        black_box(Player::new(clip, &mut states, &mut pose).is_ok());
    });
    let Ok(mut player) = Player::new(clip, &mut states, &mut pose) else { panic!() };
    let last = clip.frames() - 1;
    let stepping = paint::used(&mut || (0..last).for_each(|_| player.step()));
    let seeking = paint::used(&mut || {
        player.seek(0);
        player.seek(last);
    });
    // What holds the result is the caller's: a player's own bytes are printed above.
    defmt::info!("open {=usize}", opening - size_of::<Result<Clip, OpenError>>());
    defmt::info!("start {=usize}", starting - size_of::<Result<Player, TooSmall>>());
    defmt::info!("step {=usize}", stepping);
    defmt::info!("seek {=usize}", seeking);
    semihosting::process::exit(0)
}

//! Plays a clip by time in an embassy task: `cargo run --release` in `examples/embassy`.
#![no_std]
#![no_main]

mod ticks;

use cortex_m_semihosting::{debug, hprintln};
use embassy_executor::Spawner;
use embassy_time::{Duration, Ticker};
use panic_semihosting as _;
use pantin::{Clip, Clock, Room};

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    ticks::start(12_500_000);
    let clip = Clip::new_checked(include_bytes!("../../../motions/walk.ptn")).unwrap();
    let mut room = Room::<96, 144>::new();
    let mut player = room.player(clip).unwrap();
    let mut clock = Clock::new(&clip);
    let thigh = clip.find("left-thigh").unwrap();
    let order = thigh.euler_order().unwrap();
    // A display of 25 pictures a second shows what is due.
    let mut ticker = Ticker::every(Duration::from_millis(40));
    for _ in 0..10 {
        let angles = player.turn(&thigh).unwrap().euler(order);
        hprintln!("frame {}: {} degrees", player.frame(), angles[0].degrees().to_num::<i32>());
        ticker.next().await;
        player.advance(&mut clock, 40_000);
    }
    debug::exit(debug::EXIT_SUCCESS);
}

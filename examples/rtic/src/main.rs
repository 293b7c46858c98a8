//! Plays a clip by time in an RTIC task: `cargo run --release` in `examples/rtic`.
#![no_std]
#![no_main]

use panic_semihosting as _;
use rtic_monotonics::systick::prelude::*;

systick_monotonic!(Mono, 1000);

#[rtic::app(device = lm3s6965, dispatchers = [SSI0])]
mod app {
    use super::*;
    use cortex_m_semihosting::{debug, hprintln};
    use pantin::{Clip, Clock, Room};

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        room: Room<96, 144>,
    }

    #[init]
    fn init(context: init::Context) -> (Shared, Local) {
        Mono::start(context.core.SYST, 12_500_000);
        play::spawn().unwrap();
        (Shared {}, Local { room: Room::new() })
    }

    #[task(local = [room], priority = 1)]
    async fn play(context: play::Context) {
        let clip = Clip::new_checked(include_bytes!("../../../motions/walk.ptn")).unwrap();
        let mut player = context.local.room.player(clip).unwrap();
        let mut clock = Clock::new(&clip);
        let thigh = clip.find("left-thigh").unwrap();
        let order = thigh.euler_order().unwrap();
        // A display of 25 pictures a second shows what is due.
        for _ in 0..10 {
            let angles = player.turn(&thigh).unwrap().euler(order);
            hprintln!("frame {}: {} degrees", player.frame(), angles[0].degrees().to_num::<i32>());
            Mono::delay(40.millis()).await;
            player.advance(&mut clock, 40_000);
        }
        debug::exit(debug::EXIT_SUCCESS);
    }
}

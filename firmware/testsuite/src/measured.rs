//! What the images that are measured, and not run, have around the calls that each is measured for.

use core::hint::black_box;

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo) -> ! {
    loop {}
}

/// Memory that stands elsewhere.
pub fn lent<'a, T>() -> &'a mut [T] {
    black_box(&mut [])
}

/// `fn play`: opens a clip and makes these calls with its player, whose pose is then used.
macro_rules! play {
    ($player:ident: $($calls:tt)*) => {
        #[inline(never)]
        fn play(bytes: &[u8], states: &mut [pantin::ChannelState], pose: &mut [i32]) {
            let Ok(clip) = pantin::Clip::new_checked(bytes) else { return };
            let Ok(mut $player) = pantin::Player::new(clip, states, pose) else { return };
            $($calls)*
            core::hint::black_box($player.pose().values);
        }
    };
}

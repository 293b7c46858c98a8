//! Times a player on this machine: `speed CLIP` prints nanoseconds a pose, by steps and by seeks.

use std::hint::black_box;
use std::time::Instant;

use pantin::{ChannelState, Clip, Player};

/// Rounds over the whole clip; the median counts.
const ROUNDS: usize = 51;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: speed CLIP")?;
    let bytes = std::fs::read(&path).map_err(|error| format!("{path}: {error}"))?;
    let clip = Clip::new_checked(&bytes).map_err(|error| format!("{path}: {error}"))?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose).map_err(|error| error.to_string())?;
    let frames = clip.frames();
    let step = median(|| {
        player.rewind();
        let start = Instant::now();
        for _ in 1..frames {
            player.step();
            black_box(player.pose().values);
        }
        start.elapsed().as_secs_f64() / f64::from(frames.max(2) - 1)
    });
    // A stride that is prime meets frames everywhere, and goes back about as often as forward.
    let targets: Vec<u32> = (0..50).map(|prev_sign| prev_sign * 7919 % frames).collect();
    let seek = median(|| {
        let start = Instant::now();
        for &target in &targets {
            player.seek(target);
            black_box(player.pose().values);
        }
        start.elapsed().as_secs_f64() / targets.len() as f64
    });
    println!("step_ns {:.1}\nseek_ns {:.1}", step * 1e9, seek * 1e9);
    Ok(())
}

fn median(mut measure: impl FnMut() -> f64) -> f64 {
    let mut times: Vec<f64> = (0..ROUNDS).map(|_| measure()).collect();
    times.sort_by(f64::total_cmp);
    times[ROUNDS / 2]
}

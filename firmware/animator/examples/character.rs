//! Plays a state machine: `cargo run -p pantin-animator --example character -- motions/character.ptb`
//!
//! The figure stands, walks for three seconds, waves meanwhile, and stops. A line a change of state, or half a second.

use pantin_animator::{Character, LayerWorkspace, Workspace, layer::Weight};

/// Moving channels and channels of the clips: `pantin info` of a clip prints them.
const MOVING: usize = 64;
const CHANNELS: usize = 100;
/// Microseconds of a picture.
const PICTURE_US: u32 = 33_333;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or("motions/character.ptb".into());
    let bank = std::fs::read(&path).map_err(|error| format!("{path}: {error}"))?;
    // What is lent stands before the character.
    let mut memory = Workspace::<MOVING, CHANNELS>::new();
    let mut layers = [const { LayerWorkspace::<MOVING, CHANNELS>::new() }; 4];
    let mut character = Character::new(&bank, memory.lend())?;
    // A layer without memory does not play.
    for layer in layers.iter_mut().take(character.table().layers()) {
        character.lend_layer(layer.lend())?;
    }
    let clip = pantin_animator::first_clip(&bank)?;
    let input = |name: &str| character.table().input(name);
    let [go, wave] = [input("go"), input("wave")].map(|input| input.unwrap_or(0));
    let mut shown = None;
    for picture in 0u32..200 {
        match picture {
            30 => character.machine().hold(go, true),
            75 => character.machine().fire(wave),
            120 => character.machine().hold(go, false),
            _ => {}
        }
        character.update(PICTURE_US)?;
        let state = character.state();
        if shown != Some(state) || picture % 15 == 0 {
            shown = Some(state);
            // The pose has no place: a renderer draws it at the placement (`pantin_figure::FigureRenderer::set_pose_at`).
            let (pose, placement) = character.pose();
            let [a, b] = placement.place_cm(&clip);
            println!(
                "{:5.2} s  {:6} at {a:7.1} {b:7.1} cm, turned by {} degrees; {} channels{}",
                f64::from(picture * PICTURE_US) * 1e-6,
                character.table().state_name(state),
                placement.heading.degrees(),
                pose.values.len(),
                if character.layer_weight(0) == Weight::ZERO { "" } else { ", waves" },
            );
        }
    }
    Ok(())
}

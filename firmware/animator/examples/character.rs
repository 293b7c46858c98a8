//! Plays a state machine: `cargo run -p pantin-animator --example character -- motions/character.ptb`
//!
//! The figure stands, walks for three seconds, waves meanwhile, and stops. A line a change of state, or half a second.

use pantin_animator::{Character, Error, LayerMemory, Memory, Workspace, layer::Weight};

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
    let mut layers = [const { Layer::NEW }; 4];
    let mut character = new(&bank, memory.lend(), &mut layers)?;
    // A unit of places is 2^exponent units of the rig; this one's are cm.
    let clip = pantin_animator::first_clip(&bank)?;
    let cm = f64::from(clip.rig().unit_micro_cm()) * 1e-6 * f64::from(clip.length_exponent()).exp2();
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
            let [a, b] = placement.place.map(|steps| steps as f64 * cm);
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

/// Memory of a layer.
struct Layer {
    states: [pantin::ChannelState; MOVING],
    values: [i32; CHANNELS],
    sampled: [i32; CHANNELS],
    words: [u32; CHANNELS.div_ceil(32)],
}

impl Layer {
    const NEW: Layer = Layer {
        states: [pantin::ChannelState::NEW; MOVING],
        values: [0; CHANNELS],
        sampled: [0; CHANNELS],
        words: [0; CHANNELS.div_ceil(32)],
    };
}

/// The character, with memory for each layer of its table: a layer without memory does not play.
fn new<'a, 'm>(bank: &'a [u8], memory: Memory<'m>, layers: &'m mut [Layer]) -> Result<Character<'a, 'm>, Error> {
    let mut character = Character::new(bank, memory)?;
    for Layer { states, values, sampled, words } in layers.iter_mut().take(character.table().layers()) {
        character.lend_layer(LayerMemory { states, values, sampled, words })?;
    }
    Ok(character)
}

//! Pictures of a clip whose scalars drive the face, by the device's own code.

use super::Face;
use super::draw::Artist;
use crate::render::screen::{CANVAS, Picture};
use anyhow::Result;
use pantin::{ChannelState, Clip, Player};
use pantin_face::{Binding, View, Weights};

/// Whether a clip drives a face.
pub fn binds(clip: &Clip) -> Result<bool> {
    let face = Face::new()?;
    Ok(Binding::of(&clip.rig(), &face.model()?).is_face())
}

/// Draws the face at a clip's `frames`, which must ascend, on the reference board's display.
pub fn pictures(clip: &Clip, view: View, frames: impl IntoIterator<Item = u32>) -> Result<Vec<Picture>> {
    let face = Face::new()?;
    let model = face.model()?;
    let binding = Binding::of(&clip.rig(), &model);
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(*clip, &mut states, &mut pose)?;
    let mut artist = Artist::new(model, CANVAS, view);
    let mut weights = Weights::new();
    let draw = |frame| {
        player.seek(frame);
        binding.weigh(player.pose(), &mut weights);
        Picture { pixels: artist.draw(&weights).iter().map(|shade| shade >> 4).collect() }
    };
    Ok(frames.into_iter().map(draw).collect())
}

//! A figure of another size.

use crate::motion::{Keys, Motion, Piece};

/// Makes the figure `factor` times as large: its bones, and the places that joints take.
pub fn scale(motion: &Motion, factor: f64) -> Motion {
    let mut out = motion.clone();
    out.rig.joints.iter_mut().for_each(|joint| joint.offset = joint.offset.map(|x| x * factor));
    out.origin.error_cm *= factor;
    let kinds = motion.rig.channel_kinds();
    for (channel, _) in kinds.iter().enumerate().filter(|(_, (_, kind))| kind.is_position()) {
        out.values[channel].iter_mut().for_each(|value| *value *= factor);
        out.keys[channel] = out.keys[channel].take().map(|keys| scaled(keys, factor));
    }
    out
}

/// The curve times a factor.
pub(super) fn scaled(keys: Keys, factor: f64) -> Keys {
    let all = |mut pieces: Vec<Piece>| {
        for piece in &mut pieces {
            [piece.p, piece.c, piece.w, piece.k] = [piece.p, piece.c, piece.w, piece.k].map(|x| x * factor);
        }
        pieces
    };
    match keys {
        Keys::OnFrames { interpolation, mut keys, pieces } => {
            keys.iter_mut().for_each(|(_, value)| *value *= factor);
            Keys::OnFrames { interpolation, keys, pieces: all(pieces) }
        }
        Keys::Pieces(pieces) => Keys::Pieces(all(pieces)),
    }
}

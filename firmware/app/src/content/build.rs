//! Chooses what a clip is drawn as.

#[cfg(feature = "neck")]
use super::neck;
use super::{AnyContent, body};
#[cfg(feature = "face")]
use super::{both, face};
use crate::board::Board;
use crate::session::{Outcome, PlayContext};
use pantin::Player;

/// Builds the content of a player's clip and hands it to `then`.
pub(crate) fn build<B: Board>(
    player: &mut Player,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    #[cfg(feature = "face")]
    if face::is_in::<B::Layout>(player.clip()) {
        return match player.clip().rig().joint_count() {
            0 => face::build(player, context, then),
            #[cfg(feature = "neck")]
            _ if context.view_state.neck && context.view_state.style.solid && neck::is_there::<B>(player) => {
                neck::build(player, context, then)
            }
            _ => both::build(player, context, then),
        };
    }
    body::build(player, context, then)
}

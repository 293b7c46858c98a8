//! Motions that a clip leaves out: of joints that are not bounded, and rotations that places do not show.

use crate::encode::clip::{Coded, Start};
use crate::motion::Motion;
use crate::note::{Note, NoteKind, Remedy, first_of};
use crate::pose_bound::{PoseBound, bounded};

/// Motions that a clip without a bound on rotations leaves out are mentioned from this many degrees on.
const TOLD_DEGREES: f64 = 1.0;
/// So many of them are named.
const NAMED_CHANNELS: usize = 3;

/// Names channels that move in `motion` and are still in the clip although no bound asks for that.
pub fn left_out(motion: &Motion, coded: &Coded, pose: &PoseBound) -> Vec<Note> {
    let bounded = bounded(&motion.rig);
    let range = |channel: usize| {
        let values = motion.values[channel].iter();
        values.clone().copied().fold(f64::MIN, f64::max) - values.copied().fold(f64::MAX, f64::min)
    };
    let still = |channel: &usize| matches!(coded.channels[*channel].start, Start::Rest | Start::Constant { .. });
    let kinds = motion.rig.channel_kinds();
    let helper = |joint: Option<usize>| joint.is_some_and(|joint| !bounded[joint]);
    let turns = |channel: usize| kinds[channel].1.is_rotation() || kinds[channel].1.is_exponential();
    let channels = |of: &dyn Fn(usize) -> bool| -> Vec<String> {
        let found = (0..motion.rig.joint_channels()).filter(still).filter(|&channel| of(channel));
        found.map(|channel| motion.rig.channel_name(channel)).collect()
    };
    let helpers = channels(&|channel| helper(kinds[channel].0) && range(channel) > 0.0);
    let rotations = channels(&|channel| {
        !pose.sees_rotations() && !helper(kinds[channel].0) && turns(channel) && range(channel) > TOLD_DEGREES
    });
    let note = |names: Vec<String>, what: &str| {
        (!names.is_empty()).then(|| Note::info(NoteKind::Unbounded, format!("{what}: {}", first_of(&names, NAMED_CHANNELS))))
    };
    let helpers = note(helpers, "helper bones are not bounded, and stay at rest in the clip");
    let rotations = note(rotations, "places alone are bounded: rotations that hardly move a joint are constant in the clip");
    helpers.into_iter().chain(rotations.map(|note| note.remedy(Remedy::BoundShell))).collect()
}

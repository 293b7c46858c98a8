//! What is said when a bound cannot be met.

use super::figure::{Figure, Poses};
use super::measure::Measure;

/// `x` with four digits of what `bound` has, however small that is.
pub fn amount(x: f64, bound: f64) -> String {
    let digits = if bound > 0.0 { (3.0 - bound.log10().floor()).clamp(0.0, 15.0) } else { 4.0 };
    format!("{x:.0$}", digits as usize)
}

/// Names the joint and frame at which a channel without a code has the least room: `moved` are the joints that it moves.
pub fn refusal(figure: &Figure, measure: &Measure, poses: &Poses, original: &Poses, channel: usize, moved: &[usize]) -> String {
    let name = figure.rig.channel_name(channel);
    let off = |joint: usize, frame: usize| (joint, frame, measure.distance_cm(figure, poses, original, joint, frame));
    let all = moved
        .iter()
        .flat_map(|&joint| (0..figure.frames).map(move |frame| (joint, frame)))
        .map(|(joint, frame)| off(joint, frame));
    let Some((joint, frame, off)) = all.max_by(|a, b| a.2.total_cmp(&b.2)) else {
        return format!("channel {name}: no code within its bound was found");
    };
    let (off, bound) = (amount(off, measure.max_cm), amount(measure.max_cm, measure.max_cm));
    let joint = figure.rig.joint_name(joint);
    let rotations = measure.rotation_bounds();
    format!(
        "channel {name}: no code within {bound} cm{rotations} was found; joint {joint} at frame {frame} is {off} cm off before it is coded"
    )
}

#[cfg(test)]
mod tests {
    use super::amount;

    #[test]
    fn amounts_show_what_differs() {
        assert_eq!(amount(0.51234, 0.5), "0.5123");
        assert_eq!(amount(2.5e-8, 1e-8), "0.00000002500");
        assert_eq!(amount(30.0, 25.0), "30.00");
    }
}

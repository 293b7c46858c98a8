//! Files of others, where they are at hand, and what every conversion of one must keep.

mod files;
mod places;
pub mod probe;

pub use files::files;
pub use places::{SAME, distance};

use pantin_convert::Level;
use pantin_convert::fit::fit;
use pantin_convert::import::units;
use pantin_convert::motion::Motion;
use pantin_convert::pose_bound::PoseBound;
use pantin_convert::{encode, expand, fk, verify};

/// Part of the figure's height, and of scalars' full scale, that conversions keep to.
const BOUND: f64 = 0.005;
const SCALAR_BOUND: f64 = 0.02;

/// The figure's height in cm, or 1 for what has none.
pub fn height(motion: &Motion) -> f64 {
    let height = units::posed_height_cm(motion);
    if height > 0.0 { height } else { 1.0 }
}

/// Converts at 0.5 % of the figure's height and 2 % of scalars' full scale, expands, and compares every place and every scalar.
pub fn converts(name: &str, motion: &Motion) {
    let bound = BOUND * height(motion);
    let rig = encode::rig::encode(&motion.rig).unwrap();
    let coded = fit(motion, Level::FAST.plan(PoseBound::places(bound)), SCALAR_BOUND, &mut |_| ()).unwrap();
    let bytes = encode::clip::encode(&coded, &rig, false).unwrap();
    verify::verify(&bytes, &[], motion, &PoseBound::places(bound), SCALAR_BOUND).unwrap();
    let back = expand::expand(&pantin::Clip::new_checked(&bytes).unwrap()).unwrap();
    assert_eq!((back.frames, back.rig.joints.len()), (motion.frames, motion.rig.joints.len()));
    let (mut worst, mut worst_scalar) = (0f64, 0f64);
    for frame in 0..motion.frames {
        let places = [motion, &back].map(|motion| fk::positions(&motion.rig, &motion.values, frame));
        let far = places[0].iter().zip(&places[1]).map(|(a, b)| distance(*a, *b));
        worst = far.fold(worst, f64::max);
        for (index, scalar) in motion.rig.scalars.iter().enumerate() {
            let values = [motion, &back].map(|motion| motion.values[motion.rig.joint_channels() + index][frame]);
            worst_scalar = worst_scalar.max((values[0] - values[1]).abs() / scalar.full_scale);
        }
    }
    println!("{name}: {} bytes, {worst:.4} of {bound:.4} cm, scalars {:.2} %", bytes.len(), 100.0 * worst_scalar);
    assert!(worst <= bound * (1.0 + 1e-6), "{name}: {worst} cm");
    assert!(worst_scalar <= SCALAR_BOUND + 1e-6, "{name}: {worst_scalar}");
}

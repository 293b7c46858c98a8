//! A body and its face, recorded apart, as one motion.

use super::cut::cut;
use super::resample::resample;
use crate::memory::Memory;
use crate::motion::Motion;
use anyhow::{Result, ensure};

/// Adds the scalars and events of `other`, brought to the same rate, to `motion`; what is longer ends with what is shorter. Joints of `other` are left out. Two
/// loops of one length are a loop.
pub fn join(motion: &Motion, other: &Motion, memory: Memory) -> Result<Motion> {
    ensure!(!other.rig.scalars.is_empty(), "it has no scalars");
    let known = |name: &str| motion.rig.scalars.iter().any(|scalar| scalar.name == name);
    if let Some(twice) = other.rig.scalars.iter().find(|scalar| known(&scalar.name)) {
        anyhow::bail!("both have a scalar {}", twice.name);
    }
    let other = resample(other, 1.0 / motion.frame_time, memory)?;
    let frames = motion.frames.min(other.frames);
    let looped = motion.looped && other.looped && motion.frames == other.frames;
    let whole = |motion: &Motion| cut(motion, None, Some(frames - 1));
    let (mut joined, other) = (whole(motion)?, whole(&other)?);
    let joints = other.rig.joint_channels();
    joined.rig.scalars.extend(other.rig.scalars);
    joined.values.extend(other.values.into_iter().skip(joints));
    joined.keys.extend(other.keys.into_iter().skip(joints));
    joined.add_events(other.events);
    joined.looped = looped;
    Ok(joined)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Rig, Scalar};

    fn scalars(names: &[&str], frames: usize, fps: f64) -> Motion {
        let scalar = |name: &&str| Scalar { name: (*name).into(), full_scale: 1.0 };
        let rig = Rig { scalars: names.iter().map(scalar).collect(), cm_per_unit: 1.0, ..Rig::default() };
        let values = names.iter().map(|_| (0..frames).map(|frame| frame as f64 / fps).collect()).collect();
        Motion {
            rig,
            frame_time: 1.0 / fps,
            frames,
            values,
            keys: vec![None; names.len()],
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        }
    }

    #[test]
    fn the_shorter_ends_it_at_the_first_ones_rate() {
        let joined = join(&scalars(&["a"], 30, 30.0), &scalars(&["b", "c"], 31, 60.0), Memory::default()).expect("they join");
        assert_eq!((joined.frames, joined.values.len(), joined.keys.len()), (16, 3, 3));
        assert!(
            joined.values.iter().flatten().zip((0..16).cycle()).all(|(value, frame)| (value - frame as f64 / 30.0).abs() < 1e-9)
        );
        assert!(join(&joined, &scalars(&["b"], 5, 30.0), Memory::default()).is_err());
    }
    #[test]
    fn events_of_both_are_kept_and_two_loops_of_one_length_are_a_loop() {
        let event = |frame: usize, name: &str| crate::motion::Event { frame, name: name.into() };
        let motion = |name: &str, frames: usize, fps: f64, looped: bool| Motion { looped, ..scalars(&[name], frames, fps) };
        let one = Motion { events: vec![event(3, "left"), event(25, "late")], ..motion("a", 30, 30.0, true) };
        let other = Motion { events: vec![event(4, "blink"), event(35, "end")], ..motion("b", 41, 60.0, true) };
        let joined = join(&one, &other, Memory::default()).unwrap();
        let found: Vec<(usize, &str)> = joined.events.iter().map(|event| (event.frame, event.name.as_str())).collect();
        assert_eq!(found, [(2, "blink"), (3, "left"), (18, "end")]);
        assert!(!joined.looped);
        assert!(join(&motion("a", 30, 30.0, true), &motion("b", 30, 30.0, true), Memory::default()).unwrap().looped);
        assert!(!join(&motion("a", 30, 30.0, true), &motion("b", 30, 30.0, false), Memory::default()).unwrap().looped);
    }
}

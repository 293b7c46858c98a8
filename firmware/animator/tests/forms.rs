//! Clips of one rig in different forms follow each other without a jump.

use fixed::types::I16F16;
use pantin::{Clip, Turn};
use pantin_animator::{Animator, Transition, Workspace};

/// The golden vectors that hold their rig.
fn vectors() -> Vec<Vec<u8>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/vectors");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let clips = paths.iter().filter(|path| path.extension().is_some_and(|extension| extension == "ptn"));
    clips.map(|path| std::fs::read(path).unwrap()).collect()
}

/// The same bytes read in another form: a bit of the head that says how a joint is coded is turned over, and the CRC is mended.
fn in_another_form(file: &[u8]) -> Option<Vec<u8>> {
    let clip = Clip::new_checked(file).ok()?;
    let start = file.len().checked_sub(clip.motion_len()).filter(|_| clip.crc_len() == 2)?;
    (0..8 * 12).find_map(|bit| {
        let mut changed = file.to_vec();
        *changed.get_mut(start + bit / 8)? ^= 1 << (bit % 8);
        let (body, crc) = changed[start..].split_last_chunk_mut::<2>()?;
        *crc = pantin::codec::crc::update(pantin::codec::crc::of_prefix(file[3], clip.motion_len() as u32), body).to_le_bytes();
        let (form, exponent) = (clip.form(), clip.length_exponent());
        let other = Clip::new_checked(&changed).ok()?;
        let is_other = other.frames() == clip.frames() && other.length_exponent() == exponent && other.form() != form;
        is_other.then_some(changed)
    })
}

/// How far two rotations of a joint are apart: the largest difference of their matrices' elements.
fn apart(a: Turn, b: Turn) -> f64 {
    let rows = |turn: Turn| turn.matrix().rows.map(|row| row.map(|x| x.to_num::<f64>()));
    let (a, b) = (rows(a), rows(b));
    a.iter().flatten().zip(b.iter().flatten()).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

#[test]
fn a_switch_to_another_form_keeps_the_rotations() {
    let mut bytes = vectors();
    let others: Vec<_> = bytes.iter().filter_map(|bytes| in_another_form(bytes)).collect();
    bytes.extend(others);
    let clips: Vec<Clip<'_>> = bytes.iter().filter_map(|bytes| Clip::new_checked(bytes).ok()).collect();
    let (mut pairs, mut others) = (0, 0);
    for from in clips.iter().filter(|clip| clip.rig().joint_count() > 0) {
        for to in clips.iter().filter(|to| to.rig().id() == from.rig().id()) {
            let mut memory = Box::new(Workspace::<512, 512>::new());
            let mut animator = Animator::new(*from, memory.lend()).unwrap();
            animator.seek(from.frames() / 3);
            let joints: Vec<_> = (0..from.rig().joint_count()).filter_map(|index| from.rig().joint_ref(index)).collect();
            let before: Vec<_> = joints.iter().map(|joint| animator.pose().turn(joint).unwrap()).collect();
            let heading = animator.placement().heading;
            animator.switch(*to, to.frames() / 2, I16F16::ONE, Transition::Inertialized(10)).unwrap();
            assert_eq!(animator.form(), to.form_ref());
            pairs += 1;
            others += usize::from(from.form_ref() != to.form_ref());
            // The root is turned by what its placement takes over.
            let turned = animator.placement().heading != heading;
            for (joint, before) in joints.iter().zip(before).skip(usize::from(turned)) {
                let apart = apart(before, animator.pose().turn(joint).unwrap());
                assert!(apart < 2e-4, "joint {}: {apart}", joint.index());
            }
            for _ in 0..10 {
                animator.step().unwrap_or(());
            }
            assert_eq!(animator.transition_left(), 0);
        }
    }
    println!("{pairs} pairs, {others} of different forms");
    assert!(others > 0);
}

//! The animator: any table with any inputs, in bounded time, and every joint of a random pose.

use fixed::types::I16F16;
use pantin::{Angle, Bank, Clip};
use pantin_animator::layer::{Weight, add, blend};
use pantin_animator::machine::{FEET_SECTION, FEET_VERSION, LAYERS, Machine, SECTION, Table};
use pantin_animator::session::Session;
use pantin_animator::{
    Animator, Character, Feet, FootLock, Group, LayerMemory, Limb, Limits, Look, Mask, Share, Track, Transition, Workspace,
};

use crate::noise::Noise;

/// Most things that one input does.
const STEPS: usize = 120;

/// The bank whose clips play.
const BANK: &[u8] = include_bytes!("../../vectors/bank.ptb");

/// Clips of one rig.
const CLIPS: [&[u8]; 2] = [include_bytes!("../../vectors/walk.ptn"), include_bytes!("../../vectors/run-coarse.ptn")];

fn noise_of(seed: &[u8]) -> Noise {
    Noise::new(seed.iter().fold(seed.len() as u64, |hash, byte| hash.wrapping_mul(31).wrapping_add((*byte).into())))
}

fn word(noise: &mut Noise) -> u32 {
    ((noise.below(1 << 16) << 16) | noise.below(1 << 16)) as u32
}

/// A table, as it is and with its CRC mended, that plays with random inputs; then an animator that does anything in any order.
pub fn animator(bytes: &[u8]) -> bool {
    let bank = Bank::new_checked(BANK).expect("a vector opens");
    anything(bytes);
    let read = machine(bytes, bytes, &bank);
    let mut mended = bytes.to_vec();
    if let Some((body, crc)) = mended.split_last_chunk_mut::<2>() {
        *crc = pantin::codec::crc::of(body).to_le_bytes();
    }
    let mut read = machine(&mended, bytes, &bank) || read;
    read |= character(&mended, bytes);
    read
}

/// A table of feet with anything in it that its rules allow, and sometimes what they do not.
fn feet_of(seed: &[u8]) -> Vec<u8> {
    let mut noise = noise_of(seed);
    let clips = Bank::new_checked(BANK).map_or(0, |bank| bank.len());
    let (feet, contacts, entries) = (1 + noise.below(2), clips * noise.below(4), noise.below(12));
    let mut body = vec![FEET_VERSION, feet as u8, clips as u8, 0, contacts as u8, 0, entries as u8, 0];
    for _ in 0..feet {
        body.extend([noise.below(24) as u8, 0, noise.below(5) as u8, 0]);
        body.extend((0..4).flat_map(|_| [noise.below(24) as u8, 0]));
    }
    (1..=clips).for_each(|clip| body.extend([(clip * contacts / clips) as u8, 0]));
    for _ in 0..contacts {
        let from = noise.below(30);
        body.extend([noise.below(feet) as u8, noise.below(2) as u8, from as u8, 0, (from + 1 + noise.below(30)) as u8, 0]);
    }
    (0..entries).for_each(|_| body.extend([noise.below(8) as u8, 0, noise.below(60) as u8, 0, noise.below(60) as u8, 0]));
    body.extend(pantin::codec::crc::of(&body).to_le_bytes());
    body
}

/// The same table with its layers, steered by a session of random text.
fn character(table: &[u8], seed: &[u8]) -> bool {
    let mut bytes = BANK.to_vec();
    bytes.push(SECTION);
    pantin::codec::varint::put(table.len() as u32, &mut |byte| bytes.push(byte));
    bytes.extend(table);
    let section = feet_of(seed);
    bytes.push(FEET_SECTION);
    pantin::codec::varint::put(section.len() as u32, &mut |byte| bytes.push(byte));
    bytes.extend(section);
    let (mut memory, mut feet) = (Workspace::<512, 512>::new(), Feet::new());
    let mut rooms = [(); LAYERS].map(|()| ([pantin::ChannelState::NEW; 512], [0; 512], [0; 512], [0; 32]));
    let Ok(mut character) = Character::new(&bytes, memory.lend()) else { return false };
    for (states, values, sampled, words) in &mut rooms {
        let _ = character.lend_layer(LayerMemory { states, values, sampled, words });
    }
    let mut noise = noise_of(seed);
    let _ = character.lend_feet(&mut feet);
    let _ = Session::new_checked(&String::from_utf8_lossy(seed), character.table());
    let words = ["press", "hold", "release", "set", "end", ""];
    let mut text = String::new();
    for line in 0..noise.below(20) {
        let name = match noise.below(3) {
            0 => character.table().parameter_name(noise.below(8) as u8),
            _ => character.table().input_name(noise.below(32) as u8),
        };
        text += &format!("{}.{} {} {name} {}\n", line / 8, noise.below(99), words[noise.below(6)], noise.below(200));
    }
    for text in [text.clone(), text + "5 end"] {
        if let Ok(session) = Session::new_checked(&text, character.table()) {
            assert!(session.inputs().count() <= text.lines().count());
        }
    }
    for _ in 0..STEPS / 2 {
        match noise.below(4) {
            0 => character.machine().fire(noise.below(32) as u8),
            1 => character.machine().hold(noise.below(32) as u8, noise.below(2) == 1),
            // Clips of a bank can have different forms, over which a layer does not go.
            _ => drop(character.update(word(&mut noise) >> noise.below(32))),
        }
        let (pose, _) = character.pose();
        assert!(pose.values.len() <= 512);
    }
    true
}

fn machine(table: &[u8], seed: &[u8], bank: &Bank<'_>) -> bool {
    let Ok(table) = Table::new(table, bank.len()) else { return false };
    let mut noise = noise_of(seed);
    let mut machine = Machine::new(table);
    let mut memory = Workspace::<512, 512>::new();
    let first = machine.first_clip(bank).expect("a table names clips that are there");
    let mut animator = Animator::new(first, memory.lend()).expect("there is memory enough");
    let (mut states, mut values) = ([pantin::ChannelState::NEW; 512], [0; 512]);
    let mut second = Track::new(first, &mut states, &mut values).expect("there is memory enough");
    for _ in 0..STEPS {
        match noise.below(6) {
            0 => machine.fire(noise.below(256) as u8),
            1 => machine.hold(noise.below(256) as u8, noise.below(2) == 1),
            2 => machine.set(noise.below(256) as u8, noise.below(1 << 16) as u16 as i16),
            _ => {
                let elapsed = word(&mut noise) >> noise.below(32);
                // Clips of a bank can have different forms, which do not mix.
                let _ = machine.update(elapsed, bank, &mut animator, Some(&mut second));
                assert!(usize::from(machine.state()) < table.states());
                animator.events().take();
            }
        }
    }
    true
}

/// Anything in any order, with clips of one rig.
fn anything(seed: &[u8]) {
    let mut noise = noise_of(seed);
    let clips = CLIPS.map(|bytes| Clip::new_checked(bytes).expect("a vector opens"));
    let pick = |noise: &mut Noise| clips[noise.below(clips.len())];
    let number = |noise: &mut Noise| (word(noise) as i32) >> noise.below(32);
    let mut memory = Workspace::<512, 512>::new();
    let mut animator = Animator::new(pick(&mut noise), memory.lend()).expect("there is memory enough");
    let (mut states, mut values) = ([pantin::ChannelState::NEW; 512], [0; 512]);
    let mut layer = Track::new(pick(&mut noise), &mut states, &mut values).expect("there is memory enough");
    let rig = clips[0].rig();
    let mut words = [0; 32];
    let mut mask = Mask::new(&rig, &mut words).expect("there is memory enough");
    for joint in 0..rig.joint_count() {
        mask.put(joint, noise.below(2) == 1);
    }
    for _ in 0..STEPS {
        match noise.below(10) {
            0 => {
                let frames = noise.below(256) as u8;
                let how = [Transition::Cut, Transition::Inertialized(frames), Transition::Faded(frames)];
                let clip = pick(&mut noise);
                let (frame, speed) = (word(&mut noise), I16F16::from_bits(number(&mut noise)));
                animator.switch(clip, frame, speed, how[noise.below(3)]).expect("there is memory enough");
            }
            1 => animator.seek(word(&mut noise) >> noise.below(32)),
            2 => animator.set_speed(I16F16::from_bits(number(&mut noise))),
            3 => {
                let _ = animator.step();
            }
            4 => {
                let (clip, frame, speed) = (pick(&mut noise), noise.below(300) as u32, I16F16::from_bits(number(&mut noise)));
                layer.start(clip, frame, speed).expect("there is memory enough");
            }
            5 => {
                layer.update(word(&mut noise) >> noise.below(32));
                let weight = Weight::from_bits(noise.below(1 << 16) as u16);
                let reference = layer.pose().values.to_vec();
                let (pose, groups, form) = animator.parts();
                let _ = blend(pose, groups, form, layer.pose(), &mask, weight);
                let _ = add(pose, groups, form, layer.pose(), &reference, &mask, weight);
            }
            6 => reach(&mut noise, &mut animator),
            _ => {
                let _ = animator.update(word(&mut noise) >> noise.below(32));
            }
        }
        assert!(animator.pose().values.len() == rig.channels());
        let _ = (animator.placement(), animator.take_increment());
    }
}

/// Inverse kinematics of any joint to any place in any pose.
fn reach(noise: &mut Noise, animator: &mut Animator<'_, '_>) {
    let clip = *animator.track().clip();
    let groups: Vec<Group> = animator.groups().to_vec();
    let names: Vec<String> = clip.rig().joints().map(|joint| joint.name().to_owned()).collect();
    let name = &names[noise.below(names.len())];
    let number = |noise: &mut Noise| (word(noise) as i32) >> noise.below(32);
    let limits = Limits { least: Angle::from_bits(number(noise)), greatest: Angle::from_bits(number(noise)) };
    for value in animator.pose_mut() {
        if noise.below(4) == 0 {
            *value = number(noise);
        }
    }
    let placement = animator.placement();
    let place = [number(noise), number(noise), number(noise)];
    let pole = (noise.below(2) == 1).then(|| [number(noise), number(noise), number(noise)]);
    if let Ok(mut limb) = Limb::to(&clip, &groups, name, limits) {
        limb.reach(animator.pose_mut(), place, pole);
        let near = limb.end(animator.pose().values);
        limb.reach(animator.pose_mut(), near.map(|x| x.wrapping_add(number(noise) >> 8)), pole);
    }
    if let Ok(mut foot) = FootLock::new(&clip, &groups, name, limits, noise.below(1 << 20) as u32) {
        for step in 0..4 {
            foot.update(animator.pose_mut(), placement, step % 2 == 0, noise.below(1 << 24) as u32);
        }
    }
    let share = Share { part: noise.below(1 << 16) as u16, most: Angle::from_bits(number(noise)) };
    if let Ok(look) = Look::of(&clip, &groups, name, &[share; 2], place) {
        look.at(animator.pose_mut(), [number(noise), number(noise), number(noise)]);
    }
}

/// A table of two states that the target can change.
pub fn tables() -> Vec<Vec<u8>> {
    let mut bytes = vec![1, 2, 3, 1, 1, 0, 0, 0];
    bytes.extend([0, 1, 0, 0, 0, 1, 0, 1]);
    bytes.extend([1, 255, 0, 0, 0, 2, 1, 2]);
    bytes.extend([1, 0, 0, 0, 1, 1, 12, 0]);
    bytes.extend([0, 0, 0, 0, 0, 2, 20, 255]);
    bytes.extend([4, 0, 50, 0, 0, 1, 8, 0]);
    bytes.extend([0, 0, 100, 0, 10, 0]);
    bytes.extend([0, 0, 0, 0]);
    let crc = pantin::codec::crc::of(&bytes);
    bytes.extend(crc.to_le_bytes());
    vec![bytes]
}

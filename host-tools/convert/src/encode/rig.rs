//! The rig's bytes.

use super::varint;
use crate::error::{Error, require};
use crate::motion::{Joint, Kind, Rig, Scalar};
use crate::note::Remedy;
use anyhow::{Result, bail, ensure};
use pantin::codec::{crc, layout};

/// Bits of the longest offset: an error of 2^-22 of it a joint is far below what a figure shows.
const OFFSET_BITS: i32 = 21;

/// A joint's offset as the rig keeps it: that of a root, or of the only child of a root that stands still in it, is where
/// the clip begins and no bone of the figure, when position channels replace it anyway.
pub fn rest_offset(rig: &Rig, joint: usize) -> [f64; 3] {
    let is_placement = |joint: &Joint| joint.kinds.iter().filter(|kind| kind.is_position()).count() == 3;
    let entry = &rig.joints[joint];
    let placed = match entry.parent {
        None => true,
        Some(parent) => {
            let siblings = rig.joints.iter().filter(|other| other.parent == Some(parent)).count();
            rig.joints[parent].parent.is_none() && siblings == 1
        }
    };
    if placed && is_placement(entry) { [0.0; 3] } else { entry.offset }
}

/// Step of the rig's offsets: 2^exponent units.
pub fn length_exponent(rig: &Rig) -> i8 {
    let longest =
        (0..rig.joints.len()).flat_map(|joint| rest_offset(rig, joint)).fold(0.0, |longest: f64, x| longest.max(x.abs()));
    if longest == 0.0 { 0 } else { (longest.log2().floor() as i32 + 1 - OFFSET_BITS).clamp(-31, 31) as i8 }
}

/// Step of a scalar's values: the least exponent whose range holds the scale.
pub fn scalar_exponent(full_scale: f64) -> i8 {
    (full_scale.abs().max(f64::MIN_POSITIVE).log2().floor() as i32 + 1).clamp(-31, 31) as i8
}

/// The bytes of `rig` with their CRC.
pub fn encode(rig: &Rig) -> Result<Vec<u8>> {
    ensure!(rig.joints.len() <= layout::MAX_JOINTS, "{} joints; a rig holds at most {}", rig.joints.len(), layout::MAX_JOINTS);
    let too_many = || Error::source(format!("{} channels; a rig holds at most {}", rig.channels(), layout::MAX_CHANNELS));
    require!(rig.channels() <= layout::MAX_CHANNELS, too_many().remedy(Remedy::LeaveOutJoints));
    let micro = (rig.cm_per_unit * 1e6).round();
    ensure!((1.0..4e9).contains(&micro), "a unit of {} cm is outside 0.000001 .. 4000 cm", rig.cm_per_unit);
    let exponent = length_exponent(rig);
    let mut out = Vec::new();
    varint::put(&mut out, micro as u32);
    out.push(exponent as u8);
    out.push(rig.up.byte());
    varint::put(&mut out, rig.joints.len() as u32);
    varint::put(&mut out, rig.scalars.len() as u32);
    for (index, joint) in rig.joints.iter().enumerate() {
        ensure!(joint.kinds.len() <= 15, "joint {} has {} channels; at most 15 fit", joint.name, joint.kinds.len());
        let end_site = if joint.end_site { layout::END_SITE } else { 0 };
        let helper = if joint.helper { layout::HELPER } else { 0 };
        out.push(joint.kinds.len() as u8 | end_site | helper);
        match joint.parent {
            None if index == 0 => varint::put(&mut out, 0),
            Some(parent) if parent < index => varint::put(&mut out, parent as u32 + 1),
            _ => bail!("joint {} stands before its parent or is a second root", joint.name),
        }
        for pair in joint.kinds.chunks(2) {
            out.push(code(pair[0]) | pair.get(1).map_or(0, |&kind| code(kind)) << 4);
        }
        for x in rest_offset(rig, index) {
            varint::put_zigzag(&mut out, (x / f64::from(exponent).exp2()).round() as i32);
        }
        if !joint.end_site {
            varint::put_name(&mut out, &joint.name);
        }
    }
    put_scalars(&mut out, &rig.scalars);
    let crc = crc::of(&out);
    out.extend_from_slice(&crc.to_le_bytes());
    Ok(out)
}

/// The scalars: those that stand together in Live Link Face's list, and have the same exponent, by where they stand there.
fn put_scalars(out: &mut Vec<u8>, scalars: &[Scalar]) {
    let list: Vec<&str> = pantin::names::LIVE_LINK.split(' ').collect();
    let mut left = scalars;
    while let Some(scalar) = left.first() {
        let exponent = scalar_exponent(scalar.full_scale);
        let Some(first) = list.iter().position(|&name| name == scalar.name) else {
            out.push(exponent as u8);
            varint::put_name(out, &scalar.name);
            left = &left[1..];
            continue;
        };
        let same = |(scalar, name): &(&Scalar, &&str)| scalar.name == **name && scalar_exponent(scalar.full_scale) == exponent;
        let count = left.iter().zip(&list[first..]).take_while(same).count();
        out.extend([layout::LISTED as u8, first as u8, count as u8 - 1, exponent as u8]);
        left = &left[count..];
    }
}

fn code(kind: Kind) -> u8 {
    kind as u8
}

impl From<&pantin::Rig<'_>> for Rig {
    /// Lengths are in the units of the source.
    fn from(rig: &pantin::Rig<'_>) -> Rig {
        decode(rig)
    }
}

/// The rig that a clip has, in source units.
pub fn decode(rig: &pantin::Rig) -> Rig {
    let step = f64::from(rig.length_exponent()).exp2();
    Rig {
        joints: rig
            .joints()
            .map(|joint| Joint {
                name: joint.name().to_string(),
                parent: joint.parent.map(usize::from),
                offset: joint.offset.map(|x| f64::from(x) * step),
                kinds: joint.kinds.collect(),
                end_site: joint.end_site,
                helper: joint.helper,
            })
            .collect(),
        scalars: rig
            .scalars()
            .map(|scalar| {
                // The greatest raw value: 2^exponent itself would ask for one exponent more.
                let full_scale = f64::from(i32::MAX) * (f64::from(scalar.exponent) - 31.0).exp2();
                Scalar { name: scalar.name().to_string(), full_scale }
            })
            .collect(),
        cm_per_unit: f64::from(rig.unit_micro_cm()) * 1e-6,
        up: rig.up(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion;

    fn small() -> Rig {
        let joint = |name: &str, parent, offset, kinds: &[Kind]| Joint {
            name: name.into(),
            parent,
            offset,
            kinds: kinds.to_vec(),
            end_site: name.is_empty(),
            helper: false,
        };
        use Kind::*;
        Rig {
            joints: vec![
                joint("hip", None, [0.0, 90.0, 0.0], &[Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation]),
                joint("knee", Some(0), [0.0, -45.0, 0.5], &[Zrotation, Xrotation, Yrotation]),
                joint("", Some(1), [0.0, -40.25, 0.0], &[]),
            ],
            scalars: vec![motion::Scalar { name: "smile".into(), full_scale: 1.0 }],
            cm_per_unit: 2.54,
            up: motion::Up::new(2, true).unwrap(),
        }
    }

    #[test]
    fn comes_back_but_for_where_the_clip_begins() {
        let rig = small();
        let bytes = encode(&rig).unwrap();
        let back = decode(&pantin::Rig::new_checked(&bytes).unwrap());
        let mut expected = rig.clone();
        expected.joints[0].offset = [0.0; 3];
        expected.scalars[0].full_scale = 2.0 - (-30f64).exp2();
        assert_eq!(scalar_exponent(back.scalars[0].full_scale), scalar_exponent(1.0));
        assert_eq!(back, expected);
    }

    #[test]
    fn a_face_has_its_names_by_a_list() {
        let named = |names: &[&str]| {
            let scalars = names.iter().map(|&name| Scalar { name: name.into(), full_scale: 1.0 }).collect();
            Rig { joints: vec![], scalars, cm_per_unit: 1.0, ..Rig::default() }
        };
        let all: Vec<&str> = pantin::names::LIVE_LINK.split(' ').collect();
        let mut turned = all.clone();
        turned.swap(3, 4);
        for (names, most) in
            [(&all[..], 13), (&all[..52], 13), (&all[60..], 13), (&turned[..], 25), (&["jawOpen", "JawOpen"], 22)]
        {
            let bytes = encode(&named(names)).unwrap();
            assert!(bytes.len() <= most, "{} names take {} bytes", names.len(), bytes.len());
            let rig = pantin::Rig::new_checked(&bytes).unwrap();
            assert!(rig.scalars().map(|scalar| scalar.name()).eq(names.iter().copied()));
            assert!(rig.scalars().all(|scalar| scalar.exponent == scalar_exponent(1.0)));
        }
    }

    #[test]
    fn a_list_that_ends_too_soon_has_no_more_names() {
        let mut bytes = vec![0xc0, 0x84, 0x3d, 0, 1, 0, 3, 127, 59, 9, 1];
        bytes.extend(crc::of(&bytes).to_le_bytes());
        let rig = pantin::Rig::new_checked(&bytes).unwrap();
        assert!(rig.scalars().map(|scalar| scalar.name()).eq(["RightEyePitch", "RightEyeRoll", ""]));
    }

    #[test]
    fn truncations_and_flipped_bits_are_refused() {
        let bytes = encode(&small()).unwrap();
        for len in 0..bytes.len() {
            assert!(pantin::Rig::new_checked(&bytes[..len]).is_err());
        }
        for bit in 0..bytes.len() * 8 {
            let mut bad = bytes.clone();
            bad[bit / 8] ^= 1 << (bit % 8);
            assert!(pantin::Rig::new_checked(&bad).is_err());
        }
    }
}

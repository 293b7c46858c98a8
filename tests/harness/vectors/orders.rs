//! A motion whose joints have Euler angles in every order, from one that has fewer.

use std::fmt::Write as _;

use anyhow::{Context, Result};
use pantin::{ChannelState, Clip, EulerOrder, JointRef, Player};

/// A joint of the file.
struct Joint<'a> {
    /// Which of its columns are positions.
    positions: Vec<bool>,
    /// If it turns: where the clip has it, and the order of its new angles.
    turn: Option<(JointRef<'a>, EulerOrder)>,
}

/// The BVH file of a clip, each joint that turns with three Euler angles: in the first order, the second one, and so on.
pub fn in_turn(bvh: &str, clip: &[u8]) -> Result<String> {
    let clip = Clip::new_checked(clip)?;
    let (figure, motion) = bvh.split_once("MOTION").context("a BVH file has a motion")?;
    let (text, joints) = figure_in_turn(figure, &clip)?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let mut lines = motion.trim_start().lines();
    let heads: Vec<&str> = lines.by_ref().take(2).collect();
    let mut text = format!("{text}MOTION\n{}\n", heads.join("\n"));
    for line in lines.filter(|line| !line.trim().is_empty()) {
        let mut columns = line.split_whitespace();
        for joint in &joints {
            for (is_position, value) in joint.positions.iter().zip(columns.by_ref()) {
                if *is_position {
                    write!(text, "{value} ")?;
                }
            }
            if let Some((handle, order)) = &joint.turn {
                let turn = player.turn(handle).map_err(|wrong| anyhow::anyhow!("{wrong}"))?;
                for angle in turn.euler(*order) {
                    write!(text, "{:.6} ", f64::from(angle.to_bits()) * 360.0 / 2f64.powi(32))?;
                }
            }
        }
        text.push('\n');
        player.step();
    }
    Ok(text)
}

/// The part of the file before the motion, and its joints.
fn figure_in_turn<'a>(figure: &str, clip: &Clip<'a>) -> Result<(String, Vec<Joint<'a>>)> {
    let (mut text, mut joints, mut name) = (String::new(), vec![], "");
    let mut orders = EulerOrder::ALL.iter().cycle();
    for line in figure.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("ROOT" | "JOINT") => name = words.next().unwrap_or_default(),
            Some("CHANNELS") => {
                let kinds: Vec<&str> = words.skip(1).collect();
                let positions: Vec<bool> = kinds.iter().map(|kind| kind.ends_with("position")).collect();
                let mut kept: Vec<String> =
                    kinds.iter().zip(&positions).filter(|(_, is)| **is).map(|(kind, _)| (*kind).to_owned()).collect();
                let mut turn = None;
                if positions.contains(&false) {
                    let order = *orders.next().context("there are orders")?;
                    kept.extend(order.axes().map(|axis| format!("{axis:?}rotation")));
                    turn = Some((clip.find(name).with_context(|| name.to_owned())?, order));
                }
                writeln!(text, "CHANNELS {} {}", kept.len(), kept.join(" "))?;
                joints.push(Joint { positions, turn });
                continue;
            }
            _ => {}
        }
        writeln!(text, "{line}")?;
    }
    Ok((text, joints))
}

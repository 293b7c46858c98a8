//! The channels of a key clip, each coded as is cheapest at its turn.

use super::coder::Coder;
use super::grid::Grid;
use super::predict::{Coded, Earlier, Predictor, Task, divided};
use super::range::Split;
use super::{Curve, KeyMotion, KeyedChannel};
use anyhow::{Result, ensure};
use pantin::codec::keys::{FIRST_QUANTUM, MAX_STATES, MAX_THOUSANDTHS, MAX_WORDS, QUANTA, QUANTUM_BITS, STATE_WORDS, context};
use pantin::codec::layout::status;
use pantin::{Kind, Rig};

/// What the channels before the next one leave behind.
struct Channels<'a> {
    motion: &'a KeyMotion,
    coder: Coder,
    grids: Vec<Grid>,
    coded: Vec<Coded>,
    status: u8,
    quanta: [u8; 3],
    distance: u32,
}

/// The bits of all channels, and the states that a player needs.
pub fn put(motion: &KeyMotion, rig: &Rig<'_>) -> Result<(Vec<Split>, u32)> {
    ensure!(motion.channels.len() == rig.channels(), "a rig of {} channels for {}", rig.channels(), motion.channels.len());
    let mut channels = Channels {
        motion,
        coder: Coder::new(),
        grids: Vec::new(),
        coded: Vec::new(),
        status: status::RESTS,
        quanta: [FIRST_QUANTUM; 3],
        distance: 1,
    };
    for (channel, (kind, rest)) in motion.channels.iter().zip(rests(rig)) {
        channels.channel(channel, kind, rest)?;
    }
    let states = channels.states()?;
    Ok((channels.coder.finish(), states))
}

/// Kind and value at rest, in thousandths, of every channel.
pub fn rests<'a>(rig: &Rig<'a>) -> impl Iterator<Item = (Kind, i32)> + use<'a> {
    let exponent = rig.length_exponent();
    let of_joints = rig.joints().flat_map(move |joint| {
        let offset = joint.offset;
        joint.kinds.map(move |kind| {
            let along = kind.axis().filter(|_| kind.is_position()).map_or(0, |axis| offset[axis]);
            (kind, rest(along, exponent))
        })
    });
    of_joints.chain(rig.scalars().map(|_| (Kind::Scalar, 0)))
}

/// An offset of a rig in thousandths of its unit; 0 if that is out of bounds.
fn rest(offset: i32, exponent: i8) -> i32 {
    let thousandths = i128::from(offset) * 1000;
    let rest = match u32::try_from(exponent) {
        Ok(exponent) => thousandths << exponent,
        Err(_) => {
            let bits = u32::from(exponent.unsigned_abs());
            (thousandths + (1 << (bits - 1))) >> bits
        }
    };
    i64::try_from(rest).ok().filter(|rest| rest.abs() < MAX_THOUSANDTHS).map_or(0, |rest| rest as i32)
}

/// The class of a kind: 0 for angles, 1 for positions, 2 for scalars and components of quaternions.
fn class(kind: Kind) -> usize {
    if kind.is_position() { 1 } else { 2 * usize::from(kind == Kind::Scalar || kind.is_quaternion()) }
}

impl Channels<'_> {
    fn channel(&mut self, channel: &KeyedChannel, kind: Kind, rest: i32) -> Result<()> {
        let class = class(kind);
        let before = 3 * usize::from(self.status) + class;
        self.coder.bit(context::KEYED + before, matches!(channel, KeyedChannel::Keyed(_)));
        if !matches!(channel, KeyedChannel::Keyed(_)) {
            self.coder.bit(context::CONSTANT + before, matches!(channel, KeyedChannel::Constant(_)));
        }
        match channel {
            KeyedChannel::Rest => self.status = status::RESTS,
            KeyedChannel::Constant(value) => {
                self.status = status::CONSTANT;
                ensure!(i64::from(*value).abs() < MAX_THOUSANDTHS, "a value of {value} thousandths");
                let weighed = self.quanta_of(&[*value], class).into_iter().map(|quantum| {
                    let mut scales = self.coder.scales();
                    put_constant(&mut scales, *value, rest, class, quantum, self.quanta[class]);
                    (scales.cost, quantum)
                });
                let (_, quantum) = weighed.min().unwrap_or((0, 0));
                put_constant(&mut self.coder, *value, rest, class, quantum, self.quanta[class]);
                self.quanta[class] = quantum;
            }
            KeyedChannel::Keyed(curve) => {
                self.status = status::MOVES;
                self.curve(curve, class, rest)?;
            }
        }
        Ok(())
    }

    /// Quanta of which all values are multiples: that of the last channel of its class, and the greatest.
    fn quanta_of(&self, values: &[i32], class: usize) -> Vec<u8> {
        let fits = |quantum: &u8| values.iter().all(|value| value % i32::from(QUANTA[usize::from(*quantum)]) == 0);
        let mut quanta: Vec<u8> = [self.quanta[class]].into_iter().filter(fits).collect();
        let greatest = (0..QUANTA.len() as u8).rev().find(fits).unwrap_or(0);
        if !quanta.contains(&greatest) {
            quanta.push(greatest);
        }
        quanta
    }

    fn curve(&mut self, curve: &Curve, class: usize, rest: i32) -> Result<()> {
        let &KeyMotion { frames, looped, .. } = self.motion;
        let Curve { interpolation, times, values } = curve;
        check(curve, if looped { frames } else { frames - 1 })?;
        let grid = Grid::new(*interpolation, times, frames, looped);
        let closed = values[0] == values[values.len() - 1];
        // A channel's grid comes behind its quantum, which the predictors need: both are weighed with the contexts of before.
        let known = self.grids.iter().position(|other| *other == grid);
        let task = Task { grid: &grid, class, values, rest, closed };
        let earlier = Earlier { coded: &self.coded, grids: &self.grids, looped };
        let mut best: Option<(u64, u8, Predictor)> = None;
        for quantum in self.quanta_of(values, class) {
            let unit = i32::from(QUANTA[usize::from(quantum)]);
            for predictor in earlier.candidates(&task) {
                let mut scales = self.coder.scales();
                put_quantum(&mut scales, class, quantum, self.quanta[class]);
                let mut distance = self.distance;
                if earlier.put(&mut scales, &task, &predictor, unit, &mut distance)
                    && best.is_none_or(|(cost, ..)| scales.cost < cost)
                {
                    best = Some((scales.cost, quantum, predictor));
                }
            }
        }
        let Some((_, quantum, predictor)) = best else { anyhow::bail!("no residual fits") };
        put_quantum(&mut self.coder, class, quantum, self.quanta[class]);
        self.quanta[class] = quantum;
        put_grid(&mut self.coder, &self.grids, self.coded.last().map(|coded| coded.grid), known, &grid, (frames, looped));
        self.coder.bit(context::CLOSED + 2 * class + usize::from(grid.last() == 1), closed);
        earlier.put(&mut self.coder, &task, &predictor, i32::from(QUANTA[usize::from(quantum)]), &mut self.distance);
        let index = known.unwrap_or(self.grids.len());
        self.coded.push(Coded { grid: index, class, values: values.clone() });
        if known.is_none() {
            self.grids.push(grid);
        }
        Ok(())
    }

    /// States that a player needs: one a channel with keys, and those whose words hold the keys.
    fn states(&self) -> Result<u32> {
        let of_keys = self.coded.iter().map(|coded| {
            let grid = &self.grids[coded.grid];
            grid.times.len() * if grid.is_spline() { 2 } else { 1 }
        });
        let most = self.grids.iter().filter(|grid| grid.is_spline()).map(|grid| grid.times.len()).max().unwrap_or(0);
        let words = of_keys.sum::<usize>() + self.grids.iter().map(Grid::words).sum::<usize>() + 3 * most;
        ensure!(words <= MAX_WORDS, "keys of {words} words; at most {MAX_WORDS}");
        let states = (self.coded.len() + words.div_ceil(STATE_WORDS)) as u32;
        ensure!(states <= MAX_STATES, "keys of {states} states; at most {MAX_STATES}");
        Ok(states)
    }
}

/// Refuses keys that the format cannot hold.
fn check(curve: &Curve, last: u32) -> Result<()> {
    let Curve { times, values, .. } = curve;
    ensure!(times.len() >= 2 && times.len() == values.len(), "{} keys and {} values", times.len(), values.len());
    ensure!(times.windows(2).all(|pair| pair[0] < pair[1]), "keys out of order");
    ensure!(times[0] == 0 && times[times.len() - 1] == last, "keys from {} to {}", times[0], times[times.len() - 1]);
    ensure!(values.iter().all(|&value| i64::from(value).abs() < MAX_THOUSANDTHS), "a value out of bounds");
    Ok(())
}

fn put_quantum(coder: &mut Coder, class: usize, quantum: u8, last: u8) {
    coder.bit(context::QUANTUM + class, quantum == last);
    if quantum != last {
        coder.raw(quantum.into(), QUANTUM_BITS);
    }
}

fn put_constant(coder: &mut Coder, value: i32, rest: i32, class: usize, quantum: u8, last: u8) {
    put_quantum(coder, class, quantum, last);
    let unit = i32::from(QUANTA[usize::from(quantum)]);
    coder.residual(false, None, value / unit - divided(rest, unit));
}

/// Codes which grid a channel has: `running` is that of the channel before, `known` where the own one is among those before.
fn put_grid(
    coder: &mut Coder,
    grids: &[Grid],
    running: Option<usize>,
    known: Option<usize>,
    grid: &Grid,
    (frames, looped): (u32, bool),
) {
    if let Some(running) = running {
        coder.bit(context::SAME_GRID, known == Some(running));
        if known == Some(running) {
            return;
        }
        coder.bit(context::NEW_GRID, known.is_none());
        if let Some(known) = known {
            let most = grids.len() as u32 - 1;
            coder.raw(most - known as u32, u32::BITS - most.leading_zeros());
            return;
        }
    }
    let before = running.map_or(4, |running| usize::from(grids[running].interpolation));
    let first = context::INTERPOLATION + 3 * before;
    let [high, low] = [grid.interpolation >> 1, grid.interpolation & 1];
    coder.bit(first, high != 0);
    coder.bit(first + 1 + usize::from(high), low != 0);
    grid.put(coder, frames, looped);
}

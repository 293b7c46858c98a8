//! A clip without joints in a terminal: a bar a channel, those that move most.

use super::cells::Grid;
use super::picture::Show;
use super::settings::Settings;
use anyhow::Result;
use pantin_convert::motion::Motion;
use pantin_figure::ink::BodyPart;
use pantin_images::palette::{FARTHEST, NEAREST};

/// Letters of a channel's name and of its value.
const NAME: usize = 22;
const VALUE: usize = 9;
/// A cell filled by a number of eighths from its left.
const EIGHTHS: [char; 9] = [' ', '▏', '▎', '▍', '▌', '▋', '▊', '▉', '█'];

/// A channel that moves.
struct Meter {
    name: String,
    channel: usize,
    least: f64,
    most: f64,
}

/// All that move, the liveliest first.
pub struct Meters {
    values: Vec<Vec<f64>>,
    meters: Vec<Meter>,
}

impl Meters {
    /// Looks through a motion of channels alone.
    pub fn of(motion: Motion) -> Meters {
        let first = motion.rig.joint_channels();
        let mut meters = Vec::new();
        for (channel, values) in motion.values.iter().enumerate() {
            let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(*x), most.max(*x)));
            let full = channel.checked_sub(first).map_or(1.0, |scalar| motion.rig.scalars[scalar].full_scale);
            if most > least {
                // A bar begins at 0 where the channel has it.
                let meter = Meter { name: motion.rig.channel_name(channel).to_string(), channel, least: least.min(0.0), most };
                meters.push(((most - least) / full, meter));
            }
        }
        meters.sort_by(|a, b| b.0.total_cmp(&a.0));
        Meters { values: motion.values, meters: meters.into_iter().map(|(_, meter)| meter).collect() }
    }
}

impl Show for Meters {
    fn draw(&mut self, frame: u32, settings: &Settings, grid: &mut Grid, rows: usize) -> Result<()> {
        let palette = &settings.palette;
        let (letters, paper) = (palette.letters(), palette.paper());
        let room = grid.columns.saturating_sub(NAME + VALUE + 2);
        for (row, meter) in self.meters.iter().take(rows).enumerate() {
            let value = self.values[meter.channel][frame as usize];
            let part = (value - meter.least) / (meter.most.max(0.0) - meter.least);
            let name: String = meter.name.chars().take(NAME).collect();
            grid.write_text(0, row, &format!(" {name:<NAME$}{value:>VALUE$.3} "), letters, paper);
            let ink = palette.pixel(BodyPart::Middle, FARTHEST + (part.clamp(0.0, 1.0) * f64::from(NEAREST - FARTHEST)) as u8);
            grid.write_text(NAME + VALUE + 2, row, &bar(part, room), ink, paper);
        }
        Ok(())
    }

    fn has_views(&self) -> bool {
        false
    }
}

fn bar(part: f64, room: usize) -> String {
    let eighths = (part.clamp(0.0, 1.0) * 8.0 * room as f64).round() as usize;
    (0..room).map(|cell| EIGHTHS[eighths.saturating_sub(8 * cell).min(8)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_is_as_long_as_its_part() {
        assert_eq!([0.0, 0.5, 1.0, 1.5].map(|part| bar(part, 4)), ["    ", "██  ", "████", "████"]);
        assert_eq!(bar(0.3, 4), "█▎  ");
    }
}

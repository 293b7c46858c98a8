//! From the columns of a feed to the channels of a clip.

use crate::output::note;
use anyhow::{Result, ensure};
use pantin::Rig;
use pantin_convert::import::one_line;
use pantin_line::sender::LiveChannel;

/// Columns that a warning lists.
const LISTED: usize = 20;

/// Where a channel of the pose comes from.
struct Place {
    /// Index of the feed's column; a channel without one stays 0.
    column: Option<usize>,
    /// Raw units in 1.
    scale: f64,
}

impl Place {
    /// A value in raw units, limited to what the channel holds, and whether it was outside.
    fn raw(&self, value: f64) -> (i32, bool) {
        let raw = (value * self.scale).round();
        (raw as i32, raw != f64::from(raw as i32))
    }
}

/// The columns of a feed, and which of them is each channel of a pose.
pub(super) struct Mapping {
    columns: Vec<String>,
    places: Vec<Place>,
    /// Values that were cut.
    cut: u32,
}

impl Mapping {
    /// Finds the column of each scalar of a rig by its name.
    pub fn new(rig: &Rig, columns: Vec<String>) -> Mapping {
        let place = |scalar: pantin::Scalar| Place {
            column: columns.iter().position(|name| name == scalar.name()),
            scale: (31.0 - f64::from(scalar.exponent)).exp2(),
        };
        Mapping { places: rig.scalars().map(place).collect(), columns, cut: 0 }
    }

    /// Number of channels that have a column.
    pub fn mapped(&self) -> usize {
        self.places.iter().filter(|place| place.column.is_some()).count()
    }

    /// Number of values that were outside what their channels hold.
    pub fn cut(&self) -> u32 {
        self.cut
    }

    /// Warns of columns that are no scalar of the rig.
    pub fn warn_of_unmapped(&self, rig: &Rig) {
        let is_unmapped = |name: &&String| !rig.scalars().any(|scalar| scalar.name() == **name);
        let left_out: Vec<&str> = self.columns.iter().filter(is_unmapped).map(String::as_str).collect();
        if left_out.is_empty() {
            return;
        }
        let (first, rest) = left_out.split_at(left_out.len().min(LISTED));
        let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
        note!("warning: columns that the clip has no channel for are left out: {}{more}", one_line(&first.join(", ")));
    }

    /// The channels with bounds of this many percent of their full scale. Fails unless these are more than 0 and less than 100.
    pub fn live_channels(&self, max_scalar_error: f64) -> Result<Vec<LiveChannel>> {
        let part = max_scalar_error / 100.0;
        ensure!(
            part > 0.0 && part < 1.0,
            "--max-scalar-error {max_scalar_error}: expected more than 0 and less than 100 percent"
        );
        let channel =
            |place: &Place| LiveChannel { bound: place.raw(part).0.max(1), way: place.raw(1.0).0.max(1) as u32, wraps: false };
        Ok(self.places.iter().map(channel).collect())
    }

    /// The pose of a frame of the feed. Values outside what their channels hold are cut, the first one with a warning.
    pub fn pose(&mut self, values: &[f64]) -> Vec<i32> {
        let mut pose = Vec::with_capacity(self.places.len());
        for place in &self.places {
            let column = place.column.and_then(|index| Some((index, *values.get(index)?)));
            let (index, value) = column.unwrap_or_default();
            let (raw, outside) = place.raw(value);
            if outside && self.cut == 0 {
                let most = 31f64.exp2() / place.scale;
                note!(
                    "warning: {}: {value} is outside what the clip's channel holds (-{most} to {most}), and is cut",
                    one_line(&self.columns[index])
                );
            }
            self.cut = self.cut.saturating_add(u32::from(outside));
            pose.push(raw);
        }
        pose
    }
}

//! CSV out: a row of names, then time and values frame by frame, for spreadsheets, plots, and the table importer.

use crate::motion::Motion;
use anyhow::Result;
use std::io::Write;

/// Significant digits of a channel's greatest value: what rounding takes is at most 5e-8 of it.
const DIGITS: i32 = 7;

/// Writes `motion` as CSV: `time` in seconds, joints' channels as `hip.Xrotation` in their units, scalars by their names.
pub fn write(motion: &Motion, out: impl Write) -> Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let channels = motion.rig.channels();
    writer.write_field("time")?;
    (0..channels).try_for_each(|channel| writer.write_field(motion.rig.channel_name(channel)))?;
    writer.write_record(None::<&[u8]>)?;
    let decimals: Vec<usize> = motion.values.iter().map(|values| decimals(values)).collect();
    for frame in 0..motion.frames {
        writer.write_field(number(frame as f64 * motion.frame_time, 9))?;
        for (values, &decimals) in motion.values.iter().zip(&decimals) {
            writer.write_field(number(values[frame], decimals))?;
        }
        writer.write_record(None::<&[u8]>)?;
    }
    Ok(writer.flush()?)
}

/// Decimals that leave `values` their digits.
fn decimals(values: &[f64]) -> usize {
    let peak = values.iter().fold(0f64, |peak, value| peak.max(value.abs()));
    if peak == 0.0 { 0 } else { (DIGITS - 1 - peak.log10().floor() as i32).max(0) as usize }
}

fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if short == "-0" { "0".into() } else { short.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Joint, Kind, Rig, Scalar};

    #[test]
    fn every_channel_has_a_column() {
        let joint = Joint { name: "hip".into(), parent: None, offset: [0.0; 3], kinds: vec![Kind::Xrotation], end_site: false };
        let scalars = ["jaw, open", "still"].map(|name| Scalar { name: name.into(), full_scale: 1.0 });
        let rig = Rig { joints: vec![joint], scalars: scalars.to_vec(), cm_per_unit: 1.0 };
        let values = vec![vec![-370.125, 12.0], vec![1.0 / 3.0, -1e-12], vec![0.0; 2]];
        let motion = Motion { rig, frame_time: 1.0 / 30.0, frames: 2, keys: vec![None; 3], values, looped: false };
        let mut out = Vec::new();
        write(&motion, &mut out).unwrap();
        let expected = "time,hip.Xrotation,\"jaw, open\",still\n0,-370.125,0.3333333,0\n0.033333333,12,0,0\n";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }
}

//! The peers' sizes at their errors, clip by clip: measured once, read from a file beside the motion data.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

/// The second-difference coder's zero-order entropy, without header or model: no coder can be made of it.
pub const IDEAL: &str = "delta2-entropy-estimate";

/// ACL with its own settings.
const ACL: &str = "acl-default";

/// Errors in cm and bytes of one peer on one clip.
pub type Curve = Vec<(f64, f64)>;

/// What the file says of a clip.
#[derive(Clone, Debug, Default)]
pub struct Clip {
    /// Length of its unit.
    pub cm_per_unit: f64,
    /// How long it plays.
    pub seconds: f64,
    /// Bytes against the greatest shell error, by peer.
    pub greatest: BTreeMap<String, Curve>,
    /// Bytes against the mean shell error, by peer.
    pub mean: BTreeMap<String, Curve>,
    /// The mean shell error in cm, and bytes, of ACL by default, by the precision that it was asked for.
    pub acl: BTreeMap<String, (f64, f64)>,
}

/// Bytes of the peers at one error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bytes {
    /// ACL, the better of its settings.
    pub acl: Option<f64>,
    /// The best working coder.
    pub real: Option<f64>,
    /// [`IDEAL`].
    pub ideal: Option<f64>,
}

/// Reads the file; `None` where it is absent.
pub fn read(path: &Path) -> Result<Option<BTreeMap<String, Clip>>> {
    let Ok(text) = std::fs::read_to_string(path) else { return Ok(None) };
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let mut clips: BTreeMap<String, Clip> = BTreeMap::new();
    for (index, line) in lines.enumerate() {
        // Settings hold spaces, never commas.
        let fields: Vec<&str> = line.split(',').collect();
        let field = |name: &str| {
            let column = header.iter().position(|&column| column == name);
            column
                .and_then(|column| fields.get(column).copied())
                .with_context(|| format!("{}:{}: no {name}", path.display(), index + 2))
        };
        let number = |name: &str| -> Result<f64> {
            field(name)?.parse().with_context(|| format!("{}:{}: {name} is no number", path.display(), index + 2))
        };
        let clip = clips.entry(field("clip")?.to_owned()).or_default();
        (clip.cm_per_unit, clip.seconds) = (number("cm_per_unit")?, number("frames")? / number("fps")?);
        // A row that was not measured at the shell cannot be compared.
        if field("max_shell_cm")?.is_empty() {
            continue;
        }
        let (peer, bytes) = (field("peer")?, number("bytes")?);
        clip.greatest.entry(peer.to_owned()).or_default().push((number("max_shell_cm")?, bytes));
        let mean = number("mean_shell_cm")?;
        clip.mean.entry(peer.to_owned()).or_default().push((mean, bytes));
        if peer == ACL {
            clip.acl.insert(field("setting")?.to_owned(), (mean, bytes));
        }
    }
    Ok(Some(clips))
}

impl Clip {
    /// The peers' bytes at this greatest shell error.
    pub fn at(&self, error: f64) -> Bytes {
        let mut found = Bytes::default();
        for (name, curve) in &self.greatest {
            let Some(bytes) = at(curve, error) else { continue };
            let least = |before: Option<f64>| Some(before.map_or(bytes, |before| before.min(bytes)));
            if name == IDEAL {
                found.ideal = least(found.ideal);
                continue;
            }
            found.real = least(found.real);
            if name.starts_with("acl") {
                found.acl = least(found.acl);
            }
        }
        found
    }

    /// The least bytes of any peer, the ideal one too, at this mean shell error.
    pub fn at_mean(&self, error: f64) -> Option<f64> {
        self.mean.values().filter_map(|curve| at(curve, error)).min_by(f64::total_cmp)
    }
}

/// Bytes at an error: off the lower envelope (fewest bytes at no more error), logarithmic between its points. `None` beyond the
/// largest error (nothing is extrapolated); below the smallest one the largest size.
pub fn at(curve: &[(f64, f64)], error: f64) -> Option<f64> {
    let mut points = curve.to_vec();
    points.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    let furthest = points.last()?.0;
    let mut envelope: Curve = vec![];
    for point in points {
        if envelope.last().is_none_or(|last| point.1 < last.1) {
            envelope.push(point);
        }
    }
    let (first, last) = (*envelope.first()?, *envelope.last()?);
    if error <= first.0 {
        return Some(first.1);
    }
    for pair in envelope.windows(2) {
        let &[(e0, b0), (e1, b1)] = pair else { continue };
        if error <= e1 {
            let t = (error.ln() - e0.ln()) / (e1.ln() - e0.ln());
            return Some((b0.ln() + t * (b1.ln() - b0.ln())).exp());
        }
    }
    (error <= furthest * 1.02).then_some(last.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_read_off_its_lower_envelope() {
        let curve = [(4.0, 100.0), (1.0, 400.0), (2.0, 500.0), (5.0, 120.0)];
        assert_eq!(at(&curve, 0.5), Some(400.0));
        // Halfway between 1 and 4, and between 400 and 100, in logarithms.
        assert!((at(&curve, 2.0).unwrap() - 200.0).abs() < 1e-9);
        assert_eq!(at(&curve, 5.0), Some(100.0));
        assert_eq!(at(&curve, 5.2), None);
        assert_eq!(at(&[], 1.0), None);
    }
}

//! Guest instructions of key clips: opening solves for the curves, and every span begins from its exact key.

use anyhow::{Context, Result, bail, ensure};
use harness::paths;
use harness::qemu::MICROBIT;

use super::guest::Guest;
use super::{Goal, Setting, table};

/// Our motions, and the most instructions that opening may take on a Cortex-M0.
const MOTIONS: [(&str, Option<f64>); 2] = [("walk", Some(500_000.0)), ("run", None)];

/// Plays our walk and run on a Cortex-M0.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let guest = Guest::featuring("keys", MICROBIT, "decode")?;
    let (mut rows, mut goals) = (vec![], vec![]);
    for (name, most) in MOTIONS {
        let path = paths::root().join("motions").join(name).with_extension("keys");
        let made = setting.tool.converted(&path, &format!("{name}-keys"), &["--exact", "--keys"].map(Into::into))?;
        let counts = guest.counts(Some(&made.clip)).with_context(|| name.to_owned())?;
        let &[open, ref steps @ .., seek] = &counts[..] else { bail!("{} regions: expected at least 2", counts.len()) };
        ensure!(!steps.is_empty(), "nothing moves");
        let mean = steps.iter().sum::<u64>() as f64 / steps.len() as f64;
        let worst = steps.iter().copied().max().unwrap_or(0);
        let row = [open.to_string(), format!("{mean:.0}"), worst.to_string(), seek.to_string()];
        rows.push([name.to_owned()].into_iter().chain(row).collect());
        let what = format!("Cortex-M0: instructions that open our {name} as a key clip");
        goals.push(match most {
            Some(most) => Goal::at_most(what, open as f64, most, 0, ""),
            None => Goal::told(what, open.to_string()),
        });
        goals.push(Goal::told(
            format!("Cortex-M0: instructions of a step of our {name} as a key clip, mean and worst"),
            format!("{mean:.0} and {worst}"),
        ));
    }
    table::print(&["key clip, Cortex-M0", "open", "step, mean", "step, worst", "seek"], &rows);
    Ok(goals)
}

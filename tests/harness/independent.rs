//! The evaluator in `tests/independent`: it converts motions with the host tool and measures the clips with readers, a decoder and kinematics that share no code
//! with the tool.

use std::ffi::OsStr;
use std::process::Command;

use anyhow::Result;

use crate::{build, paths, setup};

/// The evaluator over our own motions and over `random` random ones of this seed, as a command to which more arguments can be added. Builds the host tool.
pub fn command(random: usize, seed: u64) -> Result<Command> {
    let mut node = Command::new(setup::emulator("node")?);
    node.arg(paths::root().join("tests/independent/campaign.mjs")).arg(build::host_tool()?);
    node.arg("--own").arg(paths::root().join("motions"));
    node.args([OsStr::new("--random"), random.to_string().as_ref(), "--seed".as_ref(), seed.to_string().as_ref()]);
    Ok(node)
}

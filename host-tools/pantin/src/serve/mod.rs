//! The page with the player, and clips, from this machine's memory: what was not read at the start is not there.

mod http;
mod site;

pub use http::{MOST_CONNECTIONS, MOST_HEAD, PATIENCE, Times, serve};
pub use site::{CODINGS, Coding, File, Site};

//! The page, served to browsers of tests.

pub mod slow;

use std::net::TcpListener;
use std::thread;

use anyhow::{Context, Result};
use pantin_tools::serve::{Site, Times, serve};

pub use xtask::browser;
pub use xtask_web::site::{
    CHARACTER, CONVERTER, EXPORT, FACE, MACHINE, OTHERS, PLAYER, Size, build, face_module, player_module, sizes,
};
pub use xtask_web::{arduino, browsers, bundle, compare, tools};

use crate::paths;

/// Builds the site into `target/web`, with our walk and a key clip of a body and a face as pages in one file, and serves it, with some more files by their paths, as long as
/// this program runs; returns the page's address.
pub fn served(extras: Vec<(String, Vec<u8>)>) -> Result<String> {
    let folder = paths::root().join("target/web");
    build(&folder, &["motions/walk.ptn", "tests/key-vectors/greet.ptn"].map(|clip| paths::root().join(clip)))?;
    let mut site = Site::read(&folder)?;
    for (path, bytes) in extras {
        site.add(path, bytes)?;
    }
    let listener = TcpListener::bind("127.0.0.1:0").context("cannot listen on this machine")?;
    let address = format!("http://{}/", listener.local_addr()?);
    thread::spawn(move || serve(&listener, site, Times::default()));
    Ok(address)
}

//! `pantin serve`.

use crate::output::{self, outln};
use crate::serve::{Site, Times, serve};
use anyhow::{Context, Result};
use serde_json::json;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, TcpListener};
use std::path::PathBuf;

/// Serve the page that `cargo xtask web` builds, to show clips in a browser.
///
/// The server listens on this machine only, and answers only requests to localhost, 127.0.0.1 or ::1 with its port, unless --bind sets
/// another address. It opens no browser, and serves only the page and the clips named
/// here, as they are when it starts.
#[derive(clap::Args, Clone, Debug)]
#[command(after_help = "Examples:
  pantin serve
  pantin serve walk.ptn run.ptn
  pantin serve clips/*.ptn --port 8080 --bind 0.0.0.0
  pantin serve --cors")]
pub struct Arguments {
    /// Clips to show, instead of our own
    files: Vec<PathBuf>,
    /// The port; 0 selects a free one
    #[arg(long, default_value_t = 8000)]
    port: u16,
    /// The address to listen on
    #[arg(long, default_value = "127.0.0.1")]
    bind: IpAddr,
    /// The folder of the page; by default the page inside the program, if it was built with one, otherwise what `cargo xtask web` built
    #[arg(long)]
    site: Option<PathBuf>,
    /// Let pages of other sites load the player and the clips
    #[arg(long)]
    cors: bool,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let mut site = match (&arguments.site, Site::built_in()) {
        (None, Some(site)) => site?,
        (folder, _) => Site::read(&Site::find(folder.as_deref())?)?,
    };
    if !arguments.files.is_empty() {
        site.show(&arguments.files)?;
    }
    site.shared = arguments.cors;
    let place = (arguments.bind, arguments.port);
    let listener = TcpListener::bind(place);
    let listener = listener.with_context(|| format!("cannot listen on {}, port {}: --port takes another", place.0, place.1))?;
    let mut address = listener.local_addr()?;
    // No browser opens the address that stands for all.
    if address.ip().is_unspecified() {
        address.set_ip(if address.is_ipv4() { Ipv4Addr::LOCALHOST.into() } else { Ipv6Addr::LOCALHOST.into() });
    }
    output::report(json!({"url": format!("http://{address}/"), "clips": arguments.files.len()}));
    if output::is_json() {
        // The command has no end of its own.
        output::finish("serve")?;
    } else {
        outln!("http://{address}/ (Ctrl-C ends it)")?;
    }
    serve(&listener, site, Times::default());
    Ok(())
}

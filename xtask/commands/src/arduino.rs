//! `cargo xtask arduino [FOLDER]`: the Arduino library as a folder to copy.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use harness::paths;
pub use harness::web::arduino::{home, write};

/// Writes the Arduino library (also for PlatformIO) to a folder
#[derive(Args)]
pub struct Arduino {
    /// The library's folder, for example ~/Arduino/libraries/Pantin [default: target/arduino/Pantin of the repository]
    folder: Option<PathBuf>,
}

impl Arduino {
    /// Writes the folder, and prints how to use it.
    pub fn run(self) -> Result<()> {
        let folder = self.folder.unwrap_or_else(|| paths::root().join("target/arduino/Pantin"));
        let count = write(&folder)?;
        let place = folder.display();
        println!("{place}: {count} files");
        println!();
        println!(
            "Arduino IDE: put the folder into `libraries` of the sketchbook (File > Preferences has its place) and start the IDE again."
        );
        println!(
            "             File > Examples > Pantin has the examples; Sketch > Include Library > Pantin includes the library."
        );
        println!("arduino-cli: arduino-cli compile --fqbn arduino:avr:uno --library {place} {place}/examples/Servos");
        println!("PlatformIO:  put the folder into `lib` of a project.");
        println!("Your motion: cargo pantin expand CLIP.ptn -o clip.h writes the header that a sketch includes.");
        Ok(())
    }
}

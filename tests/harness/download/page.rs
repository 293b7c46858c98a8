//! The page of the folder: which file is for which board and display, its wires, and how it gets onto the board.

use super::{BOARDS, Board, Bus, File, SETS, Wiring};

/// The page's text, in HTML.
pub fn page(files: &[File]) -> String {
    let boards: String = BOARDS.iter().chain(&SETS).map(|board| section(board, files)).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>Pantin: images for boards</title>\n<style>\nbody {{ font: 16px/1.5 sans-serif; max-width: 60em; margin: 1em auto; padding: 0 1em }}\n\
         table {{ border-collapse: collapse; margin: 1em 0 }}\nth, td {{ border: 1px solid #999; padding: 0.2em 0.6em; text-align: left }}\n\
         td.sum {{ font: 12px monospace; word-break: break-all }}\n</style>\n<h1>Pantin: images for boards</h1>\n\
         <p>Choose your board and display, connect the wires while the board has no power, and flash the file. Each image plays a walk, a run and \
         faces. Programs of the Pico, the Black Pill and the Game Boy Advance \
         are tested in emulators, those of the micro:bit v2, the Pico 2, the Nucleo-F411RE, the ESP32-C3 and the ESP32-C6 in parts, and that of the nRF52840 DK is only built; <strong>none has run on a real board yet</strong>.</p>\n{boards}\
         <h2>If nothing shows</h2>\n<ol>\n<li>Measure 3.3 V at the display's VCC. A colour display needs 3.3 V at BL, too.</li>\n\
         <li>Swap the wires of the two-wire bus (SDA, SCL). The program looks for the display with each picture, so they can be changed while it \
         runs.</li>\n<li>An OLED that is shifted by two columns is an SH1106.</li>\n<li>A picture that is shifted, mirrored, or of exchanged colours \
         is that of another module: docs/BOARDS.md says what to change.</li>\n</ol>\n<p><code>sha256sum --check SHA256SUMS</code> checks the \
         files.</p>\n</html>\n"
    )
}

fn section(board: &Board, files: &[File]) -> String {
    let own: Vec<&File> = files.iter().filter(|file| file.image.board.name == board.name).collect();
    let Some(first) = own.first() else { return String::new() };
    let flashing = board.flashing.replace("FILE", &first.name);
    let rows: String = own.iter().map(|file| row(file)).collect();
    let wires: String = board.wirings.iter().map(|wiring| wires(board, wiring)).collect();
    format!(
        "<h2 id=\"{}\">{}</h2>\n<p>{flashing}</p>\n<table>\n<tr><th>file</th><th>display</th><th>bytes of the file</th><th>bytes of flash</th>\
         <th>SHA-256</th></tr>\n{rows}</table>\n{wires}",
        board.name,
        escaped(board.title),
    )
}

fn row(file: &File) -> String {
    let File { image, name, bytes, flash } = file;
    let display = image.display.map_or("its own", |display| display.title);
    format!(
        "<tr><td><a href=\"{name}\">{name}</a></td><td>{}</td><td>{}</td><td>{flash}</td><td class=\"sum\">{}</td></tr>\n",
        escaped(display),
        bytes.len(),
        file.sum(),
    )
}

fn wires(board: &Board, wiring: &Wiring) -> String {
    let supply = [["VCC", board.supply[0]], ["GND", board.supply[1]]];
    let supply = if wiring.bus.is_some() && !board.supply[0].is_empty() { &supply[..] } else { &[] };
    let rows: String =
        supply.iter().chain(wiring.wires).map(|[part, pin]| format!("<tr><td>{part}</td><td>{pin}</td></tr>\n")).collect();
    let bus = match wiring.bus {
        Some(Bus::I2c) => ", I2C, address 0x3c or 0x3d",
        Some(Bus::Spi) => ", SPI",
        None => "",
    };
    format!("<table>\n<tr><th>{}{bus}</th><th>pin of the board</th></tr>\n{rows}</table>\n", escaped(wiring.part))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

//! The pages of the book, in order.

/// A part of the book: its title, and its pages, each with its title and its path in the repository.
pub type Part = (&'static str, &'static [(&'static str, &'static str)]);

/// The first page.
pub const FRONT: &str = "README.md";

/// All other pages.
pub const PARTS: [Part; 5] = [
    (
        "Make motions",
        &[
            ("The command line", "docs/CLI.md"),
            ("Motion files", "docs/IMPORT.md"),
            ("Key frames by hand", "docs/KEYFRAMES.md"),
            ("Motions by rules", "docs/PROCEDURAL.md"),
            ("Faces", "docs/FACE.md"),
            ("Characters of the solid figure", "docs/LOOKS.md"),
            ("State machines", "firmware/animator/MACHINE.md"),
            ("Blender", "bindings/blender/README.md"),
        ],
    ),
    (
        "Play them",
        &[
            ("A talking face for your assistant", "docs/tutorials/talking-face.md"),
            ("Boards", "docs/BOARDS.md"),
            ("ESP32 and ESP32-S3", "docs/ESP32.md"),
            ("Updates of a board's clips", "docs/UPDATE.md"),
            ("Web pages", "docs/WEB.md"),
            ("The element for web pages", "web/packages/player/README.md"),
            ("JavaScript", "web/packages/decoder/README.md"),
            ("Characters in JavaScript", "web/packages/animator/README.md"),
            ("three.js", "web/packages/three/README.md"),
            ("C", "bindings/c/README.md"),
            ("LVGL", "bindings/lvgl/README.md"),
            ("Arduino", "bindings/arduino/README.md"),
            ("ESP-IDF", "bindings/esp-idf/README.md"),
            ("ESPHome", "bindings/esphome/README.md"),
            ("xiaozhi-esp32", "bindings/xiaozhi/README.md"),
            ("Python", "bindings/python/README.md"),
            ("MicroPython", "bindings/micropython/README.md"),
            ("Rust: the decoder", "decoder/README.md"),
            ("Rust: the animator", "firmware/animator/README.md"),
            ("Rust: figures", "firmware/figure/README.md"),
            ("Rust: faces", "firmware/face/README.md"),
        ],
    ),
    (
        "Formats",
        &[
            ("Clips and banks", "decoder/FORMAT.md"),
            ("The serial link", "firmware/link/LINK.md"),
            ("Models of faces", "firmware/face/MODEL.md"),
            ("Glossary", "docs/GLOSSARY.md"),
        ],
    ),
    (
        "How it works",
        &[("The method", "docs/METHOD.md"), ("Architecture", "docs/ARCHITECTURE.md"), ("Benchmarks", "docs/BENCHMARKS.md")],
    ),
    ("The project", &[("Changes", "CHANGELOG.md"), ("Contributing", "CONTRIBUTING.md"), ("Security", "SECURITY.md")]),
];

/// The paths of all pages.
pub fn paths() -> impl Iterator<Item = &'static str> {
    std::iter::once(FRONT).chain(PARTS.iter().flat_map(|(_, pages)| pages.iter().map(|(_, path)| *path)))
}

/// The summary that mdBook reads.
pub fn summary() -> String {
    let mut text = format!("# Summary\n\n[Pantin]({FRONT})\n");
    for (part, pages) in PARTS {
        text += &format!("\n# {part}\n\n");
        pages.iter().for_each(|(title, path)| text += &format!("- [{title}]({path})\n"));
    }
    text
}

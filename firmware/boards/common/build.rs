//! Tells the code whether the processor is an Armv8-M, which Rust does not, and compiles the solid figure's character, and names the bank that
//! is steered.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(armv8m)");
    if std::env::var("TARGET").is_ok_and(|target| target.starts_with("thumbv8m")) {
        println!("cargo::rustc-cfg=armv8m");
    }
    #[cfg(feature = "solid")]
    character();
    #[cfg(feature = "steer")]
    steered();
}

/// Names the bank that is steered: `PANTIN_CHARACTER`, an absolute path, or our character's.
#[cfg(feature = "steer")]
fn steered() {
    println!("cargo::rerun-if-env-changed=PANTIN_CHARACTER");
    let own = || concat!(env!("CARGO_MANIFEST_DIR"), "/../../../motions/character.ptb").into();
    let path = std::env::var("PANTIN_CHARACTER").unwrap_or_else(|_| own());
    println!("cargo::rerun-if-changed={path}");
    println!("cargo::rustc-env=PANTIN_CHARACTER={path}");
}

/// Writes `look.rs` with the character `PANTIN_LOOK`, an absolute path of a `.look` file, or the default character.
#[cfg(feature = "solid")]
fn character() {
    println!("cargo::rerun-if-env-changed=PANTIN_LOOK");
    let value = match std::env::var("PANTIN_LOOK") {
        Err(_) => "Look::DEFAULT".into(),
        Ok(path) => {
            println!("cargo::rerun-if-changed={path}");
            match std::fs::read_to_string(&path).map(|text| pantin_figure::solid::look_text::compile(&text)) {
                Ok(Ok(bytes)) => format!("match Look::new(&{bytes:?}) {{ Ok(look) => look, Err(_) => panic!() }}"),
                Ok(Err(error)) => return println!("cargo::error={path}: {error}"),
                Err(error) => {
                    return println!("cargo::error={path}: {error}: set PANTIN_LOOK to the absolute path of a .look file");
                }
            }
        }
    };
    let out = std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR for build scripts");
    let text =
        format!("use pantin_figure::solid::Look;\n\n/// The character of solid figures.\npub const LOOK: Look = {value};\n");
    std::fs::write(std::path::Path::new(&out).join("look.rs"), text).expect("OUT_DIR is writable");
}

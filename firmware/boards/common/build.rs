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
    let own = std::env::var("PANTIN_LOOK").map_or(Ok("Look::DEFAULT".into()), |path| look(&path));
    // What meets it.
    let other = look(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../motions/looks/dancer.look"));
    let (value, other) = match (own, other) {
        (Ok(own), Ok(other)) => (own, other),
        (Err(error), _) | (_, Err(error)) => {
            return println!("cargo::error={error}: set PANTIN_LOOK to the absolute path of a .look file");
        }
    };
    let out = std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR for build scripts");
    let text = format!(
        "use pantin_figure::solid::Look;\n\n/// The character of solid figures.\npub const LOOK: Look = {value};\n\n/// That of the one that it meets.\npub const OTHER_LOOK: Look = {other};\n"
    );
    std::fs::write(std::path::Path::new(&out).join("look.rs"), text).expect("OUT_DIR is writable");
}

/// A character's text as an expression.
#[cfg(feature = "solid")]
fn look(path: &str) -> Result<String, String> {
    println!("cargo::rerun-if-changed={path}");
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let bytes = pantin_figure::solid::look_text::compile(&text).map_err(|error| format!("{path}: {error}"))?;
    Ok(format!("match Look::new(&{bytes:?}) {{ Ok(look) => look, Err(_) => panic!() }}"))
}

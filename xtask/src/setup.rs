//! What a fresh machine may lack: Rust targets, QEMU, Node.js and npm. Each is installed where that is possible, and said.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, anyhow, bail, ensure};

use crate::paths;

/// Set to run without QEMU, Node.js and npm: tests that need them skip, and say so.
pub const HOST_ONLY: &str = "PANTIN_HOST_ONLY";

/// Whether tests in emulators are to be skipped; says it where no test runner swallows it.
pub fn host_only(test: &str) -> bool {
    let skip = std::env::var_os(HOST_ONLY).is_some_and(|value| !value.is_empty());
    if skip {
        use std::io::Write;
        let _ = writeln!(std::io::stderr(), "SKIPPED: {test} needs an emulator ({HOST_ONLY} is set)");
    }
    skip
}

/// An error that says how much is free, unless the disk of the build folders has `megabytes` to spare: linkers and tests that find a full disk
/// fail by the hundred, and name other reasons. Where `df` is missing, nothing is checked.
pub fn free_disk(megabytes: u64) -> Result<()> {
    let Ok(output) = Command::new("df").arg("-Pk").arg(paths::root()).output() else { return Ok(()) };
    let Some(free) = free_megabytes(&String::from_utf8_lossy(&output.stdout)) else { return Ok(()) };
    let folder = paths::root().display().to_string();
    ensure!(free >= megabytes, "the disk of {folder} has {free} MB free, and {megabytes} MB are needed at least");
    Ok(())
}

/// The field "Available" of `df -Pk`.
fn free_megabytes(df: &str) -> Option<u64> {
    let kilobytes: u64 = df.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()?;
    Some(kilobytes / 1024)
}

/// Targets without a compiled core library: cargo compiles it from the toolchain's source.
const FROM_SOURCE: [&str; 1] = ["armv4t-none-eabi"];

/// Whether the core library of `target` must be compiled.
pub fn is_from_source(target: &str) -> bool {
    FROM_SOURCE.contains(&target)
}

/// Makes sure that Rust can compile for `target`.
pub fn rust_target(target: &str) -> Result<()> {
    if is_from_source(target) {
        return rust_source();
    }
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let folder = Command::new(rustc).args(["--print", "target-libdir", "--target", target]).output();
    let folder = folder.context("cannot start rustc")?;
    if folder.status.success() && PathBuf::from(String::from_utf8_lossy(&folder.stdout).trim()).is_dir() {
        return Ok(());
    }
    ensure!(
        paths::program("rustup").is_some(),
        "Rust's library for {target} is missing, and there is no rustup to add it: install it with your Rust toolchain"
    );
    eprintln!("adding Rust's library for {target}: rustup target add {target}");
    let status = Command::new("rustup").args(["target", "add", target]).status()?;
    ensure!(status.success(), "`rustup target add {target}` failed: no network, or a toolchain that rustup does not manage");
    Ok(())
}

fn rust_source() -> Result<()> {
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let sysroot = Command::new(rustc).args(["--print", "sysroot"]).output().context("cannot start rustc")?;
    let sysroot = PathBuf::from(String::from_utf8_lossy(&sysroot.stdout).trim());
    if sysroot.join("lib/rustlib/src/rust/library/core").is_dir() {
        return Ok(());
    }
    eprintln!("adding the source of Rust's libraries: rustup component add rust-src");
    let status = Command::new("rustup").args(["component", "add", "rust-src"]).status();
    ensure!(status.is_ok_and(|status| status.success()), "rust-src is missing, and `rustup component add rust-src` failed");
    Ok(())
}

/// Makes sure that cargo has one of the toolchain's components: `rustfmt`, `clippy`.
pub fn component(name: &str) -> Result<()> {
    let command = if name == "rustfmt" { "fmt" } else { name };
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let there = Command::new(cargo).args([command, "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if there.context("cannot start cargo")?.success() {
        return Ok(());
    }
    eprintln!("adding {name}: rustup component add {name}");
    let status = Command::new("rustup").args(["component", "add", name]).status();
    ensure!(status.is_ok_and(|status| status.success()), "{name} is missing, and `rustup component add {name}` failed");
    Ok(())
}

/// An error that says how to install a program of cargo, unless `cargo` with these words succeeds.
pub fn cargo_program(words: &[&str], what: &str, install: &str) -> Result<()> {
    let mut cargo = Command::new("cargo");
    // The cargo that runs this one has named its own toolchain.
    cargo.args(words).env_remove("RUSTUP_TOOLCHAIN").stdout(Stdio::null()).stderr(Stdio::null());
    ensure!(cargo.status().is_ok_and(|status| status.success()), "{what} is missing; install it with: {install}");
    Ok(())
}

/// WebKit's own browser, which comes with the library and not in `PATH`.
pub const WEBKIT: &str = "MiniBrowser";

/// An emulator, Node.js or Chromium, from `PATH`; if it is missing, the error says how to get it.
pub fn emulator(name: &str) -> Result<PathBuf> {
    paths::program(name).ok_or_else(|| anyhow!("{name} is missing; {}", advice(name)))
}

/// Makes sure that it is there: installs it on Debian and Ubuntu as root.
pub fn install_emulator(name: &str) -> Result<PathBuf> {
    if let Some(program) = paths::program(name) {
        return Ok(program);
    }
    if paths::program("apt-get").is_none() || !is_root() {
        return emulator(name);
    }
    install_packages(debian(name)).with_context(|| format!("{name} is missing and could not be installed"))?;
    emulator(name)
}

/// Makes sure that clang has its sanitizers, without which it may have been installed.
pub fn sanitizers() -> Result<()> {
    let there = || -> Result<bool> {
        let output = Command::new(emulator("clang")?).arg("-print-runtime-dir").output()?;
        let folder = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        let files = fs::read_dir(folder).into_iter().flatten().flatten();
        Ok(files.into_iter().any(|file| file.file_name().to_string_lossy().starts_with("libclang_rt.asan")))
    };
    part("clang has no sanitizers", there, debian("clang"), &advice("clang"))
}

/// Makes sure that the compiler for Arm has the library of C++, without which it may have been installed.
pub fn arm_cpp() -> Result<()> {
    let there = || -> Result<bool> {
        let output = Command::new(emulator("arm-none-eabi-gcc")?).arg("-print-file-name=libstdc++.a").output()?;
        // The name alone, if there is none.
        Ok(Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_absolute())
    };
    let package = "libstdc++-arm-none-eabi-newlib";
    part("arm-none-eabi-g++ has no libstdc++", there, package, &format!("install it with: {}", apt_line(package)))
}

/// Makes sure that the library of mGBA, the Game Boy Advance's emulator, can be linked.
pub fn mgba() -> Result<()> {
    ensure!(paths::program("cc").is_some(), "cc is missing, which compiles the program that drives mGBA");
    let there = || -> Result<bool> {
        let mut cc = Command::new("cc");
        cc.args(["-x", "c", "-fsyntax-only", "-include", "mgba/core/core.h", "/dev/null"]);
        let status = cc.stdout(Stdio::null()).stderr(Stdio::null()).status().context("cannot start cc")?;
        Ok(status.success())
    };
    let advice = format!("install it with: {} (or https://mgba.io, with its headers)", apt_line("libmgba-dev"));
    part("the library of mGBA (0.10) is missing", there, "libmgba-dev", &advice)
}

/// Makes sure that what packages of Debian and Ubuntu have is there: installs them as root, else says what is missing and how to get it.
fn part(missing: &str, there: impl Fn() -> Result<bool>, packages: &str, advice: &str) -> Result<()> {
    if there()? {
        return Ok(());
    }
    ensure!(paths::program("apt-get").is_some() && is_root(), "{missing}; {advice}");
    install_packages(packages).with_context(|| format!("{missing}, and it could not be installed"))?;
    ensure!(there()?, "{missing}, though its packages were installed; {advice}");
    Ok(())
}

fn apt_line(packages: &str) -> String {
    format!("sudo apt-get install -y --no-install-recommends {packages}")
}

fn install_packages(packages: &str) -> Result<()> {
    let install: Vec<&str> = ["install", "-y", "--no-install-recommends"].into_iter().chain(packages.split(' ')).collect();
    apt_get(&["update"]).and_then(|()| apt_get(&install))
}

/// Major and minor version of the emulator.
pub fn version(name: &str) -> Result<(u32, u32)> {
    let output = Command::new(emulator(name)?).arg("--version").output()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let number = text.split_whitespace().skip_while(|word| *word != "version").nth(1).unwrap_or_default();
    let mut parts = number.split('.').map(|part| part.parse().ok());
    match (parts.next().flatten(), parts.next().flatten()) {
        (Some(major), Some(minor)) => Ok((major, minor)),
        _ => bail!("{name} --version says {:?}, expected `version` and a number", text.trim()),
    }
}

/// Whether the emulator takes plugins: a build may leave them out.
pub fn takes_plugins(name: &str) -> bool {
    let help = emulator(name).ok().and_then(|program| Command::new(program).arg("-help").output().ok());
    help.is_some_and(|help| String::from_utf8_lossy(&help.stdout).contains("-plugin"))
}

fn apt_get(arguments: &[&str]) -> Result<()> {
    eprintln!("installing what the tests need: apt-get {}", arguments.join(" "));
    let mut command = Command::new("apt-get");
    command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive").stdin(Stdio::null()).stdout(Stdio::null());
    let status = command.status().context("cannot start apt-get")?;
    ensure!(status.success(), "`apt-get {}` failed", arguments.join(" "));
    Ok(())
}

/// The packages of Debian and Ubuntu that have the program, and a compiler's C library.
fn debian(name: &str) -> &str {
    match name {
        "node" => "nodejs",
        "firefox" => "firefox-esr",
        // With the screen in memory that it needs.
        WEBKIT => "libwebkit2gtk-4.1-0 xvfb",
        // Its sanitizers are a package apart.
        "clang" => "clang libclang-rt-dev",
        "qemu-system-riscv32" => "qemu-system-misc",
        "arm-none-eabi-gcc" => "gcc-arm-none-eabi libnewlib-arm-none-eabi",
        "avr-gcc" => "gcc-avr avr-libc",
        "riscv64-unknown-elf-gcc" => "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf",
        "xtensa-lx106-elf-gcc" => "gcc-xtensa-lx106",
        "x86_64-w64-mingw32-gcc" => "gcc-mingw-w64-x86-64",
        // That of the Arm emulators is named as they are.
        other => other,
    }
}

/// How to get it.
pub fn advice(name: &str) -> String {
    let apt = paths::program("apt-get").map(|_| apt_line(debian(name)));
    let emulator = name.starts_with("qemu");
    let package = if name == "node" { "nodejs" } else { name };
    let others = [
        ("dnf", format!("sudo dnf install -y {package}{}", if emulator { "-core" } else { "" })),
        ("pacman", format!("sudo pacman -S --needed {package}")),
        ("apk", format!("sudo apk add {package}")),
        ("brew", format!("brew install {}", if emulator { "qemu" } else { name })),
    ];
    let other =
        || others.into_iter().find(|(tool, _)| name != WEBKIT && paths::program(tool).is_some()).map(|(_, command)| command);
    match apt.or_else(other) {
        Some(command) => format!("install it with: {command}"),
        None if emulator => "install QEMU (https://www.qemu.org/download)".into(),
        None if name == "firefox" => "install Firefox (https://www.mozilla.org/firefox)".into(),
        None if name == WEBKIT => "install WebKitGTK and Xvfb (https://webkitgtk.org)".into(),
        None if name == "chromium" => "install Chromium (https://www.chromium.org)".into(),
        None => "install Node.js (https://nodejs.org)".into(),
    }
}

/// How to get a program that puts images on boards.
pub fn flasher_advice(name: &str) -> String {
    match name {
        "probe-rs" => "cargo install probe-rs-tools --locked (https://probe.rs/docs/getting-started/installation)".into(),
        other => format!("cargo install {other} --locked"),
    }
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output();
    id.is_ok_and(|id| id.stdout.trim_ascii() == b"0")
}

#[cfg(test)]
mod tests {
    use super::free_megabytes;

    #[test]
    fn free_megabytes_are_read_from_df() {
        let df = "Filesystem     1024-blocks      Used Available Capacity Mounted on\n/dev/vda         263174212  12345678  71234560      15% /\n";
        assert_eq!(free_megabytes(df), Some(69_565));
        assert_eq!(free_megabytes("df: no such file\n"), None);
    }
}

//! With `PANTIN_SITE`, the file that `cargo xtask web --program` writes, the program has the web page inside.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(site)");
    println!("cargo::rerun-if-env-changed=PANTIN_SITE");
    if let Some(site) = std::env::var_os("PANTIN_SITE") {
        println!("cargo::rerun-if-changed={}", site.display());
        println!("cargo::rustc-cfg=site");
    }
}

//! Tells the code whether the processor is an Armv8-M, which Rust does not.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(armv8m)");
    if std::env::var("TARGET").is_ok_and(|target| target.starts_with("thumbv8m")) {
        println!("cargo::rustc-cfg=armv8m");
    }
}

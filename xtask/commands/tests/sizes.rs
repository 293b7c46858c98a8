//! Every board's images keep to `tests/sizes.txt`.

use std::process::Command;

#[test]
fn no_image_outgrew_what_the_repository_keeps() {
    let output = Command::new(env!("CARGO_BIN_EXE_xtask-commands")).arg("sizes").output().unwrap();
    let (table, complaints) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    println!("{table}");
    assert!(output.status.success(), "{table}\n{complaints}");
}

//! A program that shares no code with the tool evaluates its clips. `cargo xtask independent` evaluates more, captured clips among them.

use harness::{independent, setup};

/// Random rigs with a motion and a bound each.
const RANDOM: usize = 60;

#[test]
fn no_bound_is_broken_and_every_printed_error_is_right() {
    if setup::host_only("the independent evaluator") {
        return;
    }
    let output = independent::command(RANDOM, 1).unwrap().output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    println!("{said}");
}

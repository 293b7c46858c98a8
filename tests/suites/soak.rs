//! Hours of a clip over a line that damages packets, with restarts and clock drift, at simulated time. `cargo xtask soak` plays 24 hours.

use harness::{paths, soak};
use pantin::Clip;
use pantin_line::sender::{LineSettings, Source};

#[test]
fn an_hour_of_a_clip_over_a_line_that_damages_is_exact_whenever_it_says_so() {
    let bytes = std::fs::read(paths::root().join("motions/greet.ptn")).unwrap();
    let source = Source::new(&Clip::new_checked(&bytes).unwrap()).unwrap();
    let wanted = LineSettings { rate: 3840.0, ahead: 48, share: 1.0, cycle: 12, parity: false, key: None };
    let line = wanted.fitted(&source).expect("the line carries it");
    let seen = soak::run(&source, line, 1.0, 1, |_| {}).unwrap();
    println!("{seen:?}");
    assert_eq!((seen.wrong, seen.late), (0, 0), "{seen:?}");
    assert!(seen.receiver_restarts > 1 && seen.sender_restarts > 1 && seen.stalls > 1 && seen.harmed > 1000, "{seen:?}");
    assert!(seen.exact > seen.frames / 2, "{seen:?}");
}

//! `pantin flash-image` and `pantin update` as a person runs them; the board is a program here, with flash in memory.

#[path = "../../../../firmware/store/tests/suites/mock.rs"]
mod mock;

use pantin_store::header::Header;
use pantin_store::region::REGIONS;
use pantin_store::{ClipInfo, Store, Update};
use std::fs;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::thread::{self, JoinHandle};
use tempfile::TempDir;

fn pantin(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).output().unwrap()
}

fn walk() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../motions/walk.ptn")
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// How a board that is not well behaves.
#[derive(Clone, Copy, PartialEq)]
enum Manner {
    Well,
    /// Pictures between its answers, and every third message is not heard.
    Poor,
    /// No clip is small enough for its memory.
    Small,
    Silent,
}

/// A board behind a port, for one connection; it ends with the clip that it plays.
fn board(manner: Manner) -> (String, JoinHandle<Option<Vec<u8>>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = format!("tcp:{}", listener.local_addr().unwrap());
    let thread = thread::spawn(move || {
        let (mut line, _) = listener.accept().unwrap();
        let (mut store, _) = mock::store::<4, 1024>(4);
        let mut bytes = [0; 512];
        let mut zeros = 0;
        let mut update = Update::open(&mut store).1;
        while let Ok(len @ 1..) = line.read(&mut bytes) {
            for &byte in &bytes[..len] {
                zeros += u32::from(byte == 0);
                // A message has two zeros.
                if manner == Manner::Silent || manner == Manner::Poor && zeros % 6 >= 4 {
                    continue;
                }
                update.receive(byte, |answer| {
                    let picture: &[u8] = if manner == Manner::Poor { b"W\0\x07\0\0\x01\x02\0\0\x03F\x09\0\0\0" } else { b"" };
                    line.write_all(&[picture, answer, picture].concat()).unwrap();
                });
            }
            if update.is_complete() && update.finish(manner != Manner::Small, |answer| line.write_all(answer).unwrap()) {
                break;
            }
        }
        let mut store = Store::new(store.into_slots());
        store.open().0.map(|stored| stored.bytes.to_vec())
    });
    (place, thread)
}

#[test]
fn a_clip_goes_to_a_board_over_a_good_line_and_a_bad_one() {
    for manner in [Manner::Well, Manner::Poor] {
        let (place, board) = board(manner);
        let output = pantin(&["update", walk().to_str().unwrap(), "--to", &place, "--patience", "0.2"]);
        assert!(output.status.success(), "{}", words(&output));
        let bytes = fs::metadata(walk()).unwrap().len();
        assert!(words(&output).contains(&format!("walk: plays; {bytes} bytes in ")), "{}", words(&output));
        assert_eq!(words(&output).contains(" 0 messages sent again"), manner == Manner::Well, "{}", words(&output));
        assert_eq!(board.join().unwrap(), Some(fs::read(walk()).unwrap()));
    }
}

#[test]
fn what_goes_wrong_is_told_in_one_line_and_by_the_exit_code() {
    let told = |place: &str, more: &[&str]| {
        let output = pantin(&[&["update", walk().to_str().unwrap(), "--to", place], more].concat());
        assert!(output.stdout.is_empty());
        (output.status.code(), words(&output))
    };
    let (place, board_) = board(Manner::Small);
    let (code, words) = told(&place, &[]);
    assert_eq!(code, Some(1), "{words}");
    assert!(words.contains("the old clip goes on playing: the board has not the memory"), "{words}");
    assert_eq!(board_.join().unwrap(), None);
    let (place, board_) = board(Manner::Silent);
    let (code, words) = told(&place, &["--patience", "0.05", "--tries", "2"]);
    assert_eq!(code, Some(1), "{words}");
    assert!(words.contains("no answer: is the firmware built with feature `update`"), "{words}");
    board_.join().unwrap();
    let (code, words) = told("serial:/dev/no-such-port", &[]);
    assert_eq!(code, Some(1), "{words}");
    assert!(words.contains("/dev/no-such-port: cannot be opened; serial ports here: "), "{words}");
    let (code, words) = told("/dev/ttyACM0", &[]);
    assert_eq!(code, Some(2), "{words}");
    assert!(words.contains("expected serial:PORT[@BAUD]"), "{words}");
}

#[test]
fn a_flash_image_holds_the_clip_as_a_store_finds_it() {
    let folder = TempDir::new().unwrap();
    let clip = fs::read(walk()).unwrap();
    for region in &REGIONS {
        let path = folder.path().join("clips.bin");
        let to = path.to_str().unwrap();
        let output = pantin(&["flash-image", walk().to_str().unwrap(), "--board", region.board, "-o", to, "--name", "my walk"]);
        assert!(output.status.success(), "{}", words(&output));
        assert!(words(&output).contains(&format!("at {:#010x}", region.address)), "{}", words(&output));
        let image = fs::read(&path).unwrap();
        let info = ClipInfo::of(&clip, "my walk").unwrap();
        assert_eq!(Header::read(&image), Some(Header { info, sequence: 1 }));
        assert_eq!(image[256..][..clip.len()], clip);
        assert!(image[256 + clip.len()..].iter().all(|&byte| byte == 0xff));
    }
}

#[test]
fn what_is_no_image_of_a_board_is_refused_and_nothing_written() {
    let folder = TempDir::new().unwrap();
    let walk = walk();
    let to = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let text = folder.path().join("text.ptn");
    fs::write(&text, "no clip").unwrap();
    let refused = |input: &Path, board: &str, name: &str| {
        let output = pantin(&["flash-image", input.to_str().unwrap(), "--board", board, "-o", &to(name)]);
        assert!(!output.status.success());
        assert!(!folder.path().join(name).exists());
        words(&output)
    };
    assert!(refused(&walk, "microbit", "clips.elf").contains("expected a name that ends in .bin, .hex or .uf2"));
    assert!(refused(&walk, "microbit", "clips.uf2").contains("microbit has no drive that takes UF2 files: use .hex"));
    assert!(refused(&walk, "no-board", "clips.bin").contains("microbit"));
    assert!(refused(&text, "microbit", "clips.bin").contains("text.ptn: a board cannot open it"));
}

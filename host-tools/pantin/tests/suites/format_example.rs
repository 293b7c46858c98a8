//! The worked example of decoder/FORMAT.md is what the encoder writes and what the decoder plays.
//!
//! After a change of the format or its tables, `PANTIN_UPDATE=1 cargo test -p pantin-tools format_example::` regenerates it.

use pantin::codec::layout::*;
use pantin::{ChannelState, Clip, Player};
use pantin_convert::encode::clip::{self, Channel, Coded, Start, position_grid, velocity_grid};
use pantin_convert::encode::entropy::{Alphabet, Sink, stretch};
use pantin_convert::encode::rig;
use pantin_convert::encode::segment::Segment;
use pantin_convert::motion::{Joint, Kind, Rig};
use std::fmt::Write;
use std::path::Path;

const BEGIN: &str = "<!-- example begins: written by host-tools/pantin/tests/suites/format_example.rs -->\n";
const END: &str = "<!-- example ends -->\n";

const STEP: u8 = 43;
const SEGMENTS: [Segment; 2] =
    [Segment { mode: segment_type::W << 4 | 2, w: 8, k: 0 }, Segment { mode: segment_type::K << 4 | 3, w: 0, k: -3 }];

fn figure() -> Rig {
    let joint = |name: &str, parent, y, kinds: &[Kind]| Joint {
        name: name.into(),
        parent,
        offset: [0.0, y, 0.0],
        kinds: kinds.to_vec(),
        end_site: name.is_empty(),
        helper: false,
    };
    let joints = vec![joint("arm", None, 0.0, &[Kind::Xrotation]), joint("", Some(0), -30.0, &[])];
    Rig { joints, scalars: Vec::new(), cm_per_unit: 1.0, ..Rig::default() }
}

fn coded() -> Coded {
    let start = Start::Moving { p: 20, v: -6, step: STEP };
    Coded {
        frames: 8,
        frame_time_ns: 33_333_333,
        length_exponent: 0,
        exponentials: Vec::new(),
        channels: vec![Channel { start, segments: SEGMENTS.to_vec() }],
        events: Vec::new(),
        event_names: Vec::new(),
        looped: false,
    }
}

fn unit(segment: &Segment) -> u32 {
    pantin::codec::segment::step(segment.mode, STEP)
}

/// What the example's symbols and bits mean, in the order in which they are read.
fn meanings() -> [String; 13] {
    let [first, second] = SEGMENTS;
    [
        "it moves".into(),
        format!("from {FIRST_STEP} by -1 to {STEP}: {} raw", pantin::codec::step_size(STEP)),
        "length in bits".into(),
        "below the highest: 16 + 4 = 20".into(),
        format!("positive: p = 20 * {}", position_grid(STEP)),
        "length in bits".into(),
        "below the highest: 4 + 2 = 6".into(),
        format!("negative: v = -6 * {}", velocity_grid(STEP)),
        format!("frame 0: mode {}, W, {} frames", first.mode, first.length()),
        "group of 7 and 8, even".into(),
        format!("8: w = 8 * {}", unit(&first)),
        format!("frame 3: mode {}, K, {} frames", second.mode, second.length()),
        format!("3, odd: k = -3 * {}", unit(&second)),
    ]
}

/// What was read: a symbol of an alphabet, or bits in parts of at most 8.
enum Read {
    Symbol(Alphabet, u32),
    Bits(u32, u32),
}

#[derive(Default)]
struct Reads(Vec<Read>);

impl Sink for Reads {
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32) {
        self.0.push(Read::Symbol(alphabet, symbol));
    }

    fn bits(&mut self, value: u32, count: u32) {
        if count > 0 {
            self.0.push(Read::Bits(value, count));
        }
    }
}

/// The file's bytes, field by field.
fn dump(bytes: &[u8], rig_len: usize) -> String {
    let before_motion = 5 + rig_len;
    let motion = bytes.len() - before_motion - 1;
    let fields: [(usize, String); 22] = [
        (2, "\"Pn\"".into()),
        (1, "version".into()),
        (1, "flags: the rig follows".into()),
        (1, format!("bytes of the rig: {rig_len}")),
        (3, "a unit is 1000000 millionths of a cm".into()),
        (1, "offsets are in 2^-16 units".into()),
        (1, "y is up".into()),
        (1, "joints".into()),
        (1, "scalars".into()),
        (1, "joint 0: 1 channel, no End Site".into()),
        (1, "the root".into()),
        (1, "Xrotation".into()),
        (3, "offset 0, 0, 0".into()),
        (4, "name: 3 bytes, \"arm\"".into()),
        (1, "joint 1: 0 channels, an End Site".into()),
        (1, "its parent is joint 0".into()),
        (6, "offset 0, -30 * 2^16, 0".into()),
        (2, "CRC of the rig".into()),
        (1, format!("bytes of the motion: {motion}")),
        (3, "30 frames a second, 8 frames, positions in 2^0 units".into()),
        (motion - 3 - 2, "symbols".into()),
        (2, "CRC of the only block".into()),
    ];
    let mut out = String::new();
    let mut at = 0;
    for (len, meaning) in fields {
        let hex: Vec<String> = bytes[at..at + len].iter().map(|byte| format!("{byte:02x}")).collect();
        let _ = writeln!(out, "{at:02x}  {:30} {meaning}", hex.join(" "));
        at += len;
    }
    assert_eq!(at, bytes.len());
    out
}

/// The symbols as a decoder meets them: its state before each, and what the state's low digits select.
fn trace(reads: &[Read], symbols: &[u8]) -> String {
    let mut bytes = symbols.iter().copied().chain(std::iter::repeat(0));
    let mut state = (0..3).fold(0, |state, _| state << 8 | u32::from(bytes.next().unwrap()));
    let mut out = String::from("state   low   of               is\n");
    assert_eq!(reads.len(), meanings().len());
    for (read, meaning) in reads.iter().zip(meanings()) {
        match *read {
            Read::Symbol(alphabet, symbol) => {
                let (start, size) = stretch(alphabet.table(), symbol);
                let low = state & 4095;
                assert!((start..start + size).contains(&low), "the bytes hold other symbols than the encoder was given");
                let name = match alphabet {
                    Alphabet::Status(context) => format!("status in {context}"),
                    Alphabet::StepChange => "step change".into(),
                    Alphabet::Position => "position".into(),
                    Alphabet::Velocity => "velocity".into(),
                    Alphabet::Mode(after) => format!("mode after {after}"),
                    Alphabet::Number(context) => format!("number in {context}"),
                    Alphabet::Far => "far".into(),
                };
                let _ = writeln!(out, "{state:06x}  {low:4}  {name:16} {symbol:2}  {meaning}");
                state = size * (state >> 12) + low - start;
            }
            Read::Bits(value, count) => {
                assert_eq!(state & ((1 << count) - 1), value);
                let _ = writeln!(
                    out,
                    "{state:06x}  {value:4}  {:16} {value:2}  {meaning}",
                    format!("{count} bit{}", if count == 1 { "" } else { "s" })
                );
                state >>= count;
            }
        }
        while state < 1 << 16 {
            state = state << 8 | u32::from(bytes.next().unwrap());
        }
    }
    let _ = writeln!(out, "{state:06x}  the encoder's first state");
    assert_eq!(state, 1 << 16);
    out
}

/// The frames, by three additions; positions as the decoder plays them.
fn frames(clip: Clip<'_>) -> String {
    let (mut states, mut pose) = ([ChannelState::default()], [0]);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let (mut p, mut v, mut w, mut k) = (20 * position_grid(STEP), -6 * velocity_grid(STEP), 0i32, 0i32);
    let mut out = String::from("frame          p         v         w        k   degrees\n");
    for frame in 0..8 {
        match frame {
            0 => w = SEGMENTS[0].w * unit(&SEGMENTS[0]) as i32,
            3 => k = SEGMENTS[1].k * unit(&SEGMENTS[1]) as i32,
            _ => {}
        }
        assert_eq!((player.frame(), player.pose().values), (frame, &[p][..]));
        let degrees = f64::from(p) * 360.0 / 4294967296.0;
        let _ = writeln!(out, "{frame:5} {p:10} {v:9} {w:9} {k:8} {degrees:9.4}");
        (p, v, w) = (p + v, v + w, w + k);
        player.step();
    }
    out
}

fn example() -> String {
    let coded = coded();
    let rig = rig::encode(&figure()).unwrap();
    let bytes = clip::encode(&coded, &rig, false).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let mut reads = Reads::default();
    clip::symbols(&coded, &clip.rig(), &mut reads);
    let symbols = &bytes[bytes.len() - clip.motion_len() + clip.head_len()..bytes.len() - 2];
    let parts = [dump(&bytes, rig.len()), trace(&reads.0, symbols), frames(clip)];
    parts.map(|part| format!("```text\n{part}```\n")).join("\n")
}

#[test]
fn the_worked_example_of_the_format_is_what_encoder_and_decoder_do() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decoder/FORMAT.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let begin = text.find(BEGIN).expect("FORMAT.md has lost the line before its example") + BEGIN.len();
    let end = text.find(END).expect("FORMAT.md has lost the line after its example");
    let example = example();
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        std::fs::write(&path, [&text[..begin], &example, &text[end..]].concat()).unwrap();
        return;
    }
    assert!(text[begin..end] == example, "FORMAT.md is stale; set PANTIN_UPDATE=1 to write this into it:\n{example}");
}

#[test]
fn the_text_names_the_numbers_of_the_layout() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decoder/FORMAT.md")).unwrap();
    let list = |numbers: &[u8]| numbers.iter().map(u8::to_string).collect::<Vec<_>>().join(", ");
    for expected in [
        format!("{VERSION} (`VERSION`)"),
        format!("{} (`FRAME_RATES`)", list(&FRAME_RATES)),
        format!("{} (`LENGTHS`)", list(&LENGTHS)),
        format!("{FIRST_STEP} (`FIRST_STEP`)"),
        format!("{STEP_CHANGES} (`STEP_CHANGES`)"),
        format!("{MAX_STEP} (`MAX_STEP`)"),
        format!("{START_MODE} (`START_MODE`)"),
        format!("0 to {DIRECT} (`DIRECT`)"),
        format!("n = 1 to {GROUPS} (`GROUPS`)"),
        format!("{FAR_NUMBER} (`FAR_NUMBER`) | n = a symbol by `FAR`; then {} + 2^n", group(GROUPS + 1) - 1),
    ] {
        assert!(text.contains(&expected), "FORMAT.md does not say: {expected}");
    }
}

//! Speech: the mouth is closed at every p, b and m, and the jaw is open on every open vowel, within 40 ms, as a clip decodes it.

use pantin::{ChannelState, Clip, Player};
use pantin_face::{Binding, Model, Morph, VERTICES, Weights};
use pantin_pictures::face::speak::{self, Spoken};
use pantin_pictures::face::{Face, compact};
use std::process::Command;

/// Milliseconds by which the mouth may be early or late.
const LATE_MS: f64 = 40.0;
/// Distance of the lips in mm below which they are closed, and degrees by which an open jaw has dropped at least.
const CLOSED_MM: f64 = 1.5;
const OPEN_MM: f64 = 6.0;

const SENTENCES: [&str; 3] = [
    "Hello, my name is Pantin. People become a puppet.",
    "Maybe a map of the bottom, a plum and a bubble!",
    "How now brown cow? Papa bought a big apple pie.",
];

/// For each frame the distance between the lips and how far the chin has dropped, in mm, and seconds a frame.
fn mouths(keys: &str) -> (Vec<[f64; 2]>, f64) {
    let folder = tempfile::tempdir().unwrap();
    let (source, clip) = (folder.path().join("talk.keys"), folder.path().join("talk.ptn"));
    std::fs::write(&source, keys).unwrap();
    let out = Command::new(env!("CARGO_BIN_EXE_pantin"))
        .args(["convert", "--max-scalar-error", "2", "-o"])
        .args([&clip, &source])
        .output();
    let out = out.unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let bytes = std::fs::read(&clip).unwrap();
    let clip = Clip::new_checked(&bytes).unwrap();
    let face = Face::new().unwrap();
    let encoded = compact::encode(&face.blueprint).unwrap();
    let model = Model::new_checked(&encoded).unwrap();
    let binding = Binding::new(&clip.rig(), &model);
    let (mut weights, mut morph) = (Weights::new(), Morph::<VERTICES>::new(&model).unwrap());
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let (frames, seconds) = (clip.frames(), f64::from(clip.frame_time_ns()) * 1e-9);
    let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
    let [upper, lower, chin] = ["2.2", "2.3", "2.1"].map(|point| face.head.find(point).unwrap());
    let step = f64::from(model.step_exponent()).exp2();
    let mut at = |frame: u32| {
        player.seek(frame);
        binding.read(player.pose().values, &mut weights);
        morph.apply_unclipped(&model, &weights);
        let height = |index: usize| f64::from(morph.vertices()[index][1]) * step;
        [height(upper) - height(lower), face.head.points[chin][1] - height(chin)]
    };
    ((0..frames).map(&mut at).collect(), seconds)
}

fn checked(spoken: &[Spoken], keys: &str) -> [usize; 2] {
    let (mouths, seconds) = mouths(keys);
    let (mut closed, mut open) = (0, 0);
    for entry in spoken {
        let near: Vec<[f64; 2]> = (0..mouths.len())
            .filter(|&frame| (frame as f64 * seconds * 1000.0 - entry.middle_ms).abs() <= LATE_MS)
            .map(|frame| mouths[frame])
            .collect();
        if entry.closes() {
            assert!(near.iter().any(|mouth| mouth[0] <= CLOSED_MM), "open lips at {} ms: {near:?}", entry.middle_ms);
            closed += 1;
        }
        if entry.opens() {
            assert!(near.iter().any(|mouth| mouth[1] >= OPEN_MM), "a closed jaw at {} ms: {near:?}", entry.middle_ms);
            open += 1;
        }
    }
    [closed, open]
}

#[test]
fn lips_close_at_p_b_m_and_the_jaw_opens_on_open_vowels() {
    let mut counts = [0; 2];
    for sentence in SENTENCES {
        let spoken = speak::of_text(sentence).unwrap();
        let letters = sentence.to_lowercase();
        let written = letters.replace("pp", "p").replace("bb", "b").matches(['p', 'b', 'm']).count();
        assert!(spoken.iter().filter(|entry| entry.closes()).count() + 2 >= written, "{sentence}: lips close too rarely");
        let [closed, open] = checked(&spoken, &speak::keys(&spoken, sentence));
        counts = [counts[0] + closed, counts[1] + open];
    }
    assert!(counts[0] >= 20 && counts[1] >= 20, "{counts:?}");
    // What espeak-ng prints of "Hello, my baby."
    let spoken = speak::of_phonemes("h@l'oU\n maI b'eIbi\n").unwrap();
    let [closed, open] = checked(&spoken, &speak::keys(&spoken, "hello"));
    assert!(closed == 3 && open >= 4, "{closed} {open}");
}

#[test]
fn a_mouth_follows_a_recording() {
    // Half a second of silence, half a second of a tone where open vowels have their first formant, again silence.
    let rate = 8_000u32;
    let tone = |index: u32| if (4_000..8_000).contains(&index) { (f64::from(index) * 0.55).sin() * 12_000.0 } else { 0.0 };
    let samples: Vec<u8> = (0..12_000).flat_map(|index| (tone(index) as i16).to_le_bytes()).collect();
    let mut wav = b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0".to_vec();
    wav.extend(rate.to_le_bytes());
    wav.extend((2 * rate).to_le_bytes());
    wav.extend(*b"\x02\0\x10\0data");
    wav.extend((samples.len() as u32).to_le_bytes());
    wav.extend(samples);
    let (mouths, seconds) = mouths(&speak::of_wav(&wav, "a tone").unwrap());
    let at = |time: f64| mouths[(time / seconds).round() as usize];
    assert!(at(0.25)[0] < CLOSED_MM && at(1.3)[0] < CLOSED_MM, "silence opens the mouth");
    assert!(at(0.55)[1] > OPEN_MM && at(0.95)[1] > OPEN_MM, "a tone does not open it");
    for (bad, wanted) in [(&b"RIFF"[..], "no WAV"), (&wav[..40], "no samples")] {
        let refused = format!("{:#}", speak::of_wav(bad, "").unwrap_err());
        assert!(refused.contains(wanted), "{refused}");
    }
    assert!(speak::of_text("?!").is_err() && speak::of_phonemes("").is_err());
}

/// A WAV of 16 bits at 8,000 Hz whose data chunk claims `claimed` bytes and has `data`.
fn wav(channels: u16, claimed: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0\x01\0".to_vec();
    bytes.extend(channels.to_le_bytes());
    bytes.extend(8000u32.to_le_bytes());
    bytes.extend(16000u32.to_le_bytes());
    bytes.extend([2, 0, 16, 0]);
    bytes.extend(b"data");
    bytes.extend(claimed.to_le_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn damaged_recordings_are_refused() {
    let refused = |channels, claimed, data: &[u8], part: &str| {
        let error = format!("{:#}", speak::of_wav(&wav(channels, claimed, data), "test").expect_err(part));
        assert!(error.contains(part), "no `{part}` in: {error}");
    };
    refused(1, 800, &[1; 400], "claims 800 bytes, but 400 follow");
    refused(0, 400, &[1; 400], "0 channels");
    refused(1, 401, &[1; 401], "401 bytes; expected a multiple of 2");
    speak::of_wav(&wav(1, 400, &[1; 400]), "test").unwrap();
    speak::of_wav(&wav(1, u32::MAX, &[1; 401]), "test").unwrap();
}

#[test]
fn what_the_rules_cannot_speak_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let say = |text: &str| {
        let out = Command::new(env!("CARGO_BIN_EXE_pantin"))
            .args(["face", "speak", text, "--rules", "-o"])
            .arg(folder.path().join("talk.keys"))
            .output();
        let out = out.unwrap();
        assert!(out.status.success());
        String::from_utf8_lossy(&out.stderr).into_owned()
    };
    let said = say("I have 212 dogs, cafés");
    assert!(said.contains("left out") && said.trim_end().lines().any(|line| line.ends_with(": 21é")), "{said}");
    assert!(!say("I have two dogs").contains("left out"));
}

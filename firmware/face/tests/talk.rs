//! Lips for speech: sounds that are made here, noise, strange rates and samples, and visemes with times.

use pantin_face::talk::{Talk, VISEMES, VisemeError, WAITING};
use pantin_face::{FULL_WEIGHT, MODEL, Model, Weights};

/// A voice: pulses at a pitch, or noise, through resonators at the frequencies of formants.
struct Voice {
    rate: f64,
    samples: Vec<i16>,
    random: u32,
}

impl Voice {
    fn new(rate: u32) -> Voice {
        Voice { rate: f64::from(rate), samples: Vec::new(), random: 1 }
    }

    fn noise(&mut self) -> f64 {
        self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.random as i32) / f64::from(1u32 << 31)
    }

    /// Adds a sound of `ms` milliseconds: frequencies and bandwidths of its formants, `pitch` 0 for noise, and its mean magnitude.
    fn add(&mut self, ms: u32, pitch: f64, formants: &[[f64; 2]], loud: f64) {
        let count = (self.rate * f64::from(ms) / 1000.0) as usize;
        let period = (self.rate / pitch.max(1.0)) as usize;
        let mut sound: Vec<f64> =
            (0..count).map(|at| if pitch > 0.0 { f64::from(at % period == 0) } else { self.noise() }).collect();
        for [frequency, width] in formants {
            let radius = (-std::f64::consts::PI * width / self.rate).exp();
            let (turn, decay) = (2.0 * radius * (std::f64::consts::TAU * frequency / self.rate).cos(), radius * radius);
            let mut before = [0.0; 2];
            for x in &mut sound {
                let now = *x * (1.0 - turn + decay) + turn * before[0] - decay * before[1];
                before = [now, before[0]];
                *x = now;
            }
        }
        let mean = sound.iter().map(|x| x.abs()).sum::<f64>() / count as f64;
        // Ten milliseconds at each end rise and fall, as a mouth does.
        let edge = self.rate / 100.0;
        self.samples.extend(sound.iter().enumerate().map(|(at, x)| {
            let near = (at.min(count - 1 - at) as f64 / edge).min(1.0);
            (x / mean * loud * near) as i16
        }));
    }

    fn silence(&mut self, ms: u32) {
        self.samples.resize(self.samples.len() + (self.rate * f64::from(ms) / 1000.0) as usize, 0);
    }

    fn ms(&self) -> usize {
        (self.samples.len() as f64 * 1000.0 / self.rate) as usize
    }

    /// The weights after each 10 ms, pushed in parts of `part` samples.
    fn weights(&self, part: usize) -> Vec<[u16; 14]> {
        let mut talk = Talk::new(self.rate as u32).unwrap();
        let mut weights = Vec::new();
        let mut pushed = 0;
        for part in self.samples.chunks(part) {
            talk.push(part);
            pushed += part.len();
            while (weights.len() + 1) as f64 * self.rate / 100.0 <= pushed as f64 {
                weights.push(*talk.weights());
            }
        }
        weights
    }
}

const AA: &[[f64; 2]] = &[[730.0, 90.0], [1090.0, 110.0], [2440.0, 170.0]];
const E: &[[f64; 2]] = &[[530.0, 60.0], [1840.0, 100.0], [2480.0, 120.0]];
const I: &[[f64; 2]] = &[[270.0, 60.0], [2290.0, 100.0], [3010.0, 120.0]];
const O: &[[f64; 2]] = &[[450.0, 80.0], [790.0, 90.0], [2410.0, 170.0]];
const U: &[[f64; 2]] = &[[300.0, 60.0], [1100.0, 110.0], [2240.0, 170.0]];
const S: &[[f64; 2]] = &[[3700.0, 600.0]];

fn greatest(weights: &[u16; 14]) -> (&'static str, u16) {
    let at = (0..14).max_by_key(|&at| weights[at]).unwrap();
    (VISEMES[at], weights[at])
}

#[test]
fn vowels_and_s_are_told_apart_at_every_rate() {
    for rate in [8000, 11_025, 16_000, 22_050, 44_100, 48_000] {
        for pitch in [110.0, 190.0] {
            let mut voice = Voice::new(rate);
            let mut expected = Vec::new();
            voice.silence(100);
            for (name, formants) in [("viseme_aa", AA), ("viseme_e", E), ("viseme_i", I), ("viseme_o", O), ("viseme_u", U)] {
                voice.add(200, pitch, formants, 3000.0);
                expected.push((voice.ms() - 50, name));
                voice.silence(60);
            }
            // A filter of averages leaves what is above 4 kHz; at 8 kHz s has nothing there.
            voice.add(150, 0.0, S, 1000.0);
            expected.push((voice.ms() - 50, "viseme_ss"));
            let weights = voice.weights(100);
            for (ms, name) in expected {
                let (heard, weight) = greatest(&weights[ms / 10]);
                assert_eq!(heard, name, "{rate} Hz, pitch {pitch}, {ms} ms: {:?}", weights[ms / 10]);
                assert!(i32::from(weight) > FULL_WEIGHT / 4, "{rate} Hz, pitch {pitch}, {name}: {weight}");
            }
        }
    }
}

#[test]
fn the_jaw_follows_within_60_ms_and_closes_in_a_gap_of_60_ms_and_in_silence() {
    let mut voice = Voice::new(16_000);
    voice.silence(200);
    let first = voice.ms();
    voice.add(150, 120.0, AA, 3000.0);
    voice.silence(60);
    let second = voice.ms();
    voice.add(150, 120.0, AA, 3000.0);
    voice.silence(200);
    let weights = voice.weights(77);
    let aa = |ms: usize| i32::from(weights[ms / 10][9]);
    for start in [first, second] {
        assert!(aa(start - 10) < FULL_WEIGHT / 20, "open before the vowel: {}", aa(start - 10));
        assert!(aa(start + 50) > FULL_WEIGHT / 2, "closed 60 ms into the vowel: {}", aa(start + 50));
    }
    let last = weights.last().unwrap();
    assert_eq!(last, &[0; 14]);
}

#[test]
fn m_is_softer_than_vowels_and_closes_the_lips() {
    let mut voice = Voice::new(16_000);
    voice.silence(100);
    voice.add(200, 120.0, AA, 3000.0);
    voice.add(120, 120.0, &[[250.0, 60.0], [250.0, 120.0]], 900.0);
    let middle = voice.ms() - 40;
    voice.add(200, 120.0, AA, 3000.0);
    let weights = voice.weights(160);
    let sum: i32 = weights[middle / 10].iter().map(|&weight| i32::from(weight)).sum();
    assert!(sum < FULL_WEIGHT / 10, "{:?}", weights[middle / 10]);
}

/// Steady noise moves the mouth for 0.9 s at most, and by less than a twentieth after that; speech above it opens it still.
#[test]
fn steady_noise_does_not_move_the_mouth() {
    for loud in [5.0, 50.0, 500.0, 5000.0] {
        for formants in [&[][..], &[[300.0, 400.0]][..], &[[800.0, 600.0]][..]] {
            let mut voice = Voice::new(16_000);
            voice.add(6000, 0.0, formants, loud);
            let weights = voice.weights(160);
            let most = weights[90..].iter().flatten().max().unwrap();
            assert!(i32::from(*most) < FULL_WEIGHT / 20, "noise of {loud} through {formants:?}: {most}");
        }
    }
    let mut voice = Voice::new(16_000);
    voice.add(2000, 0.0, &[], 100.0);
    let noise = voice.samples.len();
    voice.add(300, 120.0, AA, 3000.0);
    let mut speech = Voice::new(16_000);
    speech.add(300, 0.0, &[], 100.0);
    let spoken = voice.samples[noise..].iter_mut().zip(&speech.samples);
    spoken.for_each(|(sample, noise)| *sample += noise);
    assert_eq!(greatest(voice.weights(160).last().unwrap()).0, "viseme_aa");
}

#[test]
fn parts_of_any_length_give_the_same_weights() {
    let mut voice = Voice::new(22_050);
    voice.silence(50);
    voice.add(300, 150.0, E, 4000.0);
    voice.add(300, 150.0, O, 4000.0);
    let one = voice.weights(1);
    for part in [7, 80, 441, 100_000] {
        let other = voice.weights(part);
        // A part may hold several hops: the weights after its last one are known.
        assert_eq!(one.last(), other.last(), "{part}");
    }
}

#[test]
fn samples_at_both_ends_of_their_range_overflow_nothing() {
    for rate in [8000, 12_345, 16_000, 48_000] {
        for period in 2..60 {
            let mut talk = Talk::new(rate).unwrap();
            let samples: Vec<i16> = (0..4000).map(|at| if at % period < period / 2 { i16::MAX } else { i16::MIN }).collect();
            talk.push(&samples);
            talk.push(&[i16::MIN; 4000]);
            talk.push(&samples);
            assert!(talk.weights().iter().all(|&weight| i32::from(weight) <= FULL_WEIGHT));
        }
    }
}

#[test]
fn other_rates_are_refused() {
    for rate in [0, 1, 7999, 48_001, u32::MAX] {
        assert!(Talk::new(rate).is_none(), "{rate}");
    }
}

/// Visemes have their weight 40 ms after their time, none before it, and sound has none meanwhile.
#[test]
fn visemes_come_at_their_time_and_win_over_sound() {
    let mut voice = Voice::new(16_000);
    voice.silence(100);
    voice.add(900, 120.0, AA, 3000.0);
    let mut talk = Talk::new(16_000).unwrap();
    talk.viseme(1, 200).unwrap();
    talk.viseme(13, 400).unwrap();
    talk.viseme(0, 600).unwrap();
    let mut seen = Vec::new();
    for part in voice.samples.chunks(160) {
        talk.push(part);
        talk.step(10);
        seen.push(*talk.weights());
    }
    let at = |ms: usize| seen[ms / 10 - 1];
    assert_eq!(at(190), [0; 14]);
    assert_eq!(greatest(&at(240)).0, "viseme_pp");
    assert!(i32::from(at(240)[0]) > FULL_WEIGHT * 9 / 10);
    assert_eq!(greatest(&at(440)).0, "viseme_o");
    assert!(at(590)[9] == 0 && at(590)[0] == 0);
    assert_eq!(greatest(&at(800)).0, "viseme_aa");
    assert!(at(800)[12] == 0);
}

#[test]
fn the_mouth_closes_when_sound_stops_coming() {
    let mut voice = Voice::new(16_000);
    voice.silence(20);
    voice.add(300, 120.0, AA, 3000.0);
    let mut talk = Talk::new(16_000).unwrap();
    talk.push(&voice.samples[..5000]);
    let open = talk.weights()[9];
    assert!(i32::from(open) > FULL_WEIGHT / 2);
    talk.step(140);
    assert_eq!(talk.weights()[9], open);
    talk.step(200);
    assert_eq!(talk.weights(), &[0; 14]);
}

/// Slow displays push the sound of a whole picture, then step by its time.
#[test]
fn sound_of_a_long_time_opens_the_mouth() {
    let mut voice = Voice::new(16_000);
    voice.silence(400);
    voice.add(1200, 120.0, AA, 3000.0);
    let mut talk = Talk::new(16_000).unwrap();
    for part in voice.samples.chunks(3200) {
        talk.push(part);
        talk.step(200);
    }
    assert!(i32::from(talk.weights()[9]) > FULL_WEIGHT / 2, "{:?}", talk.weights());
    talk.step(200);
    assert_eq!(talk.weights()[9], 0);
}

#[test]
fn wrong_visemes_are_refused_and_change_nothing() {
    let mut talk = Talk::new(16_000).unwrap();
    assert_eq!(talk.viseme(15, 0), Err(VisemeError::Unknown));
    talk.viseme(3, 500).unwrap();
    assert_eq!(talk.viseme(4, 499), Err(VisemeError::Early));
    for _ in 1..WAITING {
        talk.viseme(4, 500).unwrap();
    }
    assert_eq!(talk.viseme(4, 500), Err(VisemeError::Full));
    talk.step(u16::MAX);
    assert_eq!(greatest(talk.weights()), ("viseme_dd", FULL_WEIGHT as u16));
}

#[test]
fn a_face_shows_the_weights() {
    let model = Model::new_checked(MODEL).unwrap();
    let mut talk = Talk::new(8000).unwrap();
    talk.viseme(10, 0).unwrap();
    talk.step(200);
    let (mut weights, mut expected) = (Weights::new(), Weights::new());
    talk.add_to(&mut weights, &model).unwrap();
    expected.add(&model, "viseme_aa", pantin_face::Weight::ONE).unwrap();
    assert!(weights.pairs().eq(expected.pairs()));
}

#[test]
fn the_lips_of_a_face_with_an_open_mouth_meet_while_it_speaks() {
    let model = Model::new_checked(MODEL).unwrap();
    let mut surprised = Weights::new();
    surprised.add(&model, "amazed", pantin_face::Weight::ONE).unwrap();
    let mut talk = Talk::new(8000).unwrap();
    let shown = |talk: &Talk| {
        let mut weights = surprised.clone();
        talk.add_to(&mut weights, &model).unwrap();
        weights
    };
    assert!(shown(&talk).pairs().eq(surprised.pairs()));
    talk.viseme(1, 0).unwrap();
    talk.viseme(0, 500).unwrap();
    talk.step(490);
    let mut closed = surprised.clone();
    closed.fade(&model, &VISEMES, FULL_WEIGHT as u16);
    closed.add(&model, "viseme_pp", pantin_face::Weight::ONE).unwrap();
    assert!(shown(&talk).pairs().eq(closed.pairs()));
    assert!(closed.pairs().ne(surprised.pairs()));
    // It keeps its brows.
    assert!(closed.pairs().zip(surprised.pairs()).any(|(closed, own)| closed == own && own != [0; 2]));
    talk.step(300);
    assert_eq!(talk.speaking(), FULL_WEIGHT as u16);
    talk.step(1200);
    assert_eq!(talk.speaking(), 0);
    assert!(shown(&talk).pairs().eq(surprised.pairs()));
}

//! Lips for speech in C: weights of the module `pantin_face::talk`, as `bindings/c/tests/talk.c` prints them, and how well they follow espeak-ng.

use std::fmt::Write as _;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use pantin_face::talk::Talk;
use tempfile::TempDir;

use super::{compile, home, host_program, output};

/// Rates of sound in Hz, one of which is refused, and rounds of sounds and visemes at each.
const RATES: [u32; 7] = [7_999, 8_000, 11_025, 16_000, 22_050, 44_100, 48_000];
const ROUNDS: u32 = 20_000;

/// Compares the weights in C with those in Rust, to the last bit.
pub fn weights(folder: &TempDir) -> Result<()> {
    for compiler in ["gcc", "clang"] {
        let program = host_program(folder, compiler, "talk")?;
        for rate in RATES {
            let mut command = Command::new(&program);
            command.args([rate, ROUNDS].map(|number| number.to_string()));
            let c = String::from_utf8(output(command)?.stdout)?;
            super::face::same(&format!("{rate} Hz"), &expected(rate)?, &c)?;
        }
    }
    println!("   {} rounds at {} rates", ROUNDS, RATES.len() - 1);
    Ok(())
}

/// What the program prints: see there.
fn expected(rate: u32) -> Result<String> {
    let mut random = 1u32;
    let mut below = |below: u32| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((u64::from(random) * u64::from(below)) >> 32) as u32
    };
    let mut text = String::new();
    let mut talk = Talk::new(rate);
    writeln!(text, "{}", u8::from(talk.is_some()))?;
    let mut now = 0u32;
    let mut rest = 0;
    for _ in 0..ROUNDS {
        if below(3) != 0 {
            let (count, period, loud) = (below(700), below(200) + 2, below(16));
            let samples: Vec<i16> = (0..count)
                .map(|at| {
                    let noise = below(65_536) as i32 - 32_768;
                    ((if at % period < period / 2 { 32_767 - noise / 4 } else { noise }) >> loud) as i16
                })
                .collect();
            talk.iter_mut().for_each(|talk| talk.push(&samples));
        }
        if below(3) != 0 {
            let ms = below(90);
            rest += ms;
            if let Some(talk) = &mut talk {
                talk.step(ms as u16);
                now += rest / 10 * 10;
            }
            rest %= 10;
        }
        if below(9) == 0 {
            let viseme = match below(17) as u8 {
                viseme @ 0..=12 => viseme,
                _ => 0,
            };
            let at = now.wrapping_add(below(300)).wrapping_sub(20);
            let taken = talk.as_mut().is_some_and(|talk| talk.viseme(viseme, at).is_ok());
            writeln!(text, "{}", u8::from(taken))?;
        }
        let weights = talk.as_ref().map_or([0; 14], |talk| *talk.weights());
        weights.iter().for_each(|weight| text += &format!("{weight} "));
        writeln!(text, "{}", talk.as_ref().map_or(0, Talk::speaking))?;
    }
    Ok(text)
}

/// Plays speech of espeak-ng, whose sounds' times are known, and demands what the README says. Without espeak-ng's library it says so and passes.
pub fn speech(folder: &TempDir) -> Result<()> {
    let mut command = Command::new("gcc");
    command.args(["-std=c99", "-O2", "-shared", "-fPIC"]);
    let library = compile(command, &["src/pantin_talk.c"], &folder.path().join("talk.so"))?;
    let mut python = Command::new("python3");
    python.arg(home().join("tests/talk_speech.py")).arg(&library).current_dir(paths::root());
    let printed = String::from_utf8(output(python).context("speech of espeak-ng")?.stdout)?;
    ensure!(!printed.trim().is_empty(), "nothing was printed");
    printed.lines().for_each(|line| println!("   {line}"));
    Ok(())
}

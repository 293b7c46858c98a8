//! The lines of figures: those of the crate pantin-figure, as `bindings/c/tests/figure.c` prints those in C.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use harness::vectors::synthetic::noisy;
use pantin::{Player, Pose};
use pantin_convert::import::{Disk, ImportOptions, import};
use pantin_figure::{CameraTarget, Canvas, FigureRenderer, View};
use tempfile::TempDir;

use super::{files, host_program, output};

/// Bones that a figure has at most.
const BONES: usize = 254;

/// Poses that no clip contains.
const CHAOS: u32 = 40;

/// Displays and views: the same as in the program in C.
fn shots() -> [(Canvas, View); 4] {
    let shot = |width, height, orbit, tilt, track| (Canvas { width, height }, View { orbit, tilt, track, up: None });
    let mut shots = [
        shot(128, 64, -50, 12, CameraTarget::Follow),
        shot(128, 64, 0, 0, CameraTarget::Fixed),
        shot(320, 240, -90, 35, CameraTarget::Follow),
        shot(240, 240, 140, -20, CameraTarget::Fixed),
    ];
    shots[3].1.up = pantin::Up::new(2, true);
    shots
}

/// Compares the lines of all vectors and of our motions, for programs made by two compilers.
pub fn lines(folder: &TempDir) -> Result<()> {
    let programs = ["gcc", "clang"].map(|compiler| host_program(folder, compiler, "figure"));
    let mut clips: Vec<(PathBuf, Option<PathBuf>)> = files()?;
    clips.retain(|(clip, _)| clip.extension().is_some_and(|extension| extension == "ptn"));
    let motions = ["greet", "kneebend", "run", "walk"].map(|name| paths::root().join("motions").join(name).with_extension("ptn"));
    clips.extend(motions.into_iter().map(|clip| (clip, None)));
    // Of which the camera sees the first part alone.
    let long = folder.path().join("long.ptn");
    let walk = import(&Disk::default(), &paths::root().join("motions/walk.keys"), &ImportOptions::new())?;
    std::fs::write(&long, noisy(&walk.motion.rig, 2100)?)?;
    ensure!(pantin::Clip::new_checked(&std::fs::read(&long)?)?.motion_len() > 1 << 14, "the clip is long");
    clips.push((long, None));
    let (mut figures, mut lines) = (0, 0);
    for (clip, rig) in &clips {
        let expected = text(clip, rig.as_deref()).with_context(|| clip.display().to_string())?;
        figures += expected.matches("figure").count();
        lines += expected.lines().count();
        for program in &programs {
            let program = program.as_ref().map_err(|error| anyhow::anyhow!("{error:#}"))?;
            let mut command = Command::new(program);
            command.arg(clip).args(rig);
            let printed = String::from_utf8(output(command).with_context(|| clip.display().to_string())?.stdout)?;
            let differs = expected.lines().zip(printed.lines()).position(|(rust, c)| rust != c);
            if let Some(at) = differs {
                let [rust, c] = [&expected, &printed].map(|text| text.lines().nth(at).unwrap_or_default());
                anyhow::bail!("{}: line {at} is \"{rust}\" in Rust and \"{c}\" in C", clip.display());
            }
            ensure!(expected.len() == printed.len(), "{}: not as many lines", clip.display());
        }
    }
    println!("   {} clips, {figures} figures, {lines} lines and dots", clips.len());
    Ok(())
}

/// What the program in C prints.
fn text(clip: &Path, rig: Option<&Path>) -> Result<String> {
    let bytes = std::fs::read(clip)?;
    let rig = rig.map(std::fs::read).transpose()?;
    let clip = match &rig {
        Some(rig) => pantin::Clip::with_rig(&bytes, rig)?,
        None => pantin::Clip::new_checked(&bytes)?,
    };
    let mut memory = pantin::Room::<1023, 1023>::new();
    let mut player = memory.player(clip)?;
    let mut text = String::new();
    let mut last = None;
    for (canvas, view) in shots() {
        player.rewind();
        match FigureRenderer::<BONES>::of_clip(&mut player, canvas, view) {
            Ok(mut figure) => {
                let bones = &figure.skeleton().bones;
                let lines = bones.iter().filter(|bone| bone.part == pantin_figure::skeleton::Part::Bone && bone.parent.is_some());
                writeln!(text, "figure {} bones {} lines", bones.len(), lines.count())?;
                loop {
                    print(&mut text, &mut figure, player.pose())?;
                    if !step(&mut player) {
                        break;
                    }
                }
                last = Some(figure);
            }
            Err(_) => text += "none\n",
        }
    }
    if let Some(mut figure) =
        last.filter(|figure| figure.skeleton().bones.iter().any(|bone| bone.part == pantin_figure::skeleton::Part::Bone))
    {
        text += "chaos\n";
        let mut x = 1u32;
        for n in 0..CHAOS {
            let mut values = player.pose().values.to_vec();
            for value in &mut values {
                x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                *value = (x & 0xffff_ff00).cast_signed() >> (n % 16);
            }
            print(&mut text, &mut figure, Pose { values: &values, form: player.pose().form })?;
        }
    }
    Ok(text)
}

/// Moves to the next frame; `false` at the last one.
fn step(player: &mut Player) -> bool {
    let next = player.frame() + 1;
    next < player.clip().frames() && {
        player.seek(next);
        true
    }
}

fn print(text: &mut String, figure: &mut FigureRenderer<BONES>, pose: Pose<'_>) -> Result<()> {
    let lines = figure.lines(pose)?;
    for dot in &lines.dots {
        writeln!(text, "d {} {} {}", dot.place[0], dot.place[1], dot.shade)?;
    }
    for line in &lines.ground {
        let ([a, b], [c, d]) = (line.from, line.to);
        writeln!(text, "g {a} {b} {c} {d} {} {}", line.depth, line.shade)?;
    }
    for line in &lines.bones {
        let ([a, b], [c, d]) = (line.from, line.to);
        writeln!(text, "b {a} {b} {c} {d} {} {} {} {}", line.depth, line.shade, line.body_part as u8, line.width)?;
    }
    if let Some(head) = lines.head {
        writeln!(text, "h {} {} {} {}", head.centre[0], head.centre[1], head.radius, head.shade)?;
    }
    Ok(())
}

//! Solid figures and figures of lines in C: pixels of the crate pantin-figure, as `bindings/c/tests/solid.c` draws them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use harness::vectors::faces::{Picture, sum_of};
use pantin::{Angle, Player, Pose};
use pantin_figure::ink::Ink;
use pantin_figure::solid::{Build, Look, SolidFigure, draw_together, look_text};
use pantin_figure::surface::OnTarget;
use pantin_figure::{CameraTarget, Canvas, DrawStyle, Stand, View};
use tempfile::TempDir;

use super::face::same;
use super::{files, host_program, output};

/// Bytes of code that the solid figure may take on a Cortex-M0 or RV32IMC, beside figures: RV32IMC takes a fifth more.
pub const MOST_CODE: u64 = 18 * 1024;

/// Bones that a figure has at most.
const BONES: usize = 254;
/// Poses that no clip contains, and damaged characters.
const CHAOS: u32 = 40;
const MUTANTS: u32 = 600;
/// Every third frame is drawn.
const STEP: u32 = 3;

/// Displays and views: the same as in the program in C.
fn shots() -> [([u16; 2], View); 5] {
    let shot = |size, orbit, tilt, track| (size, View { orbit, tilt, track, up: None });
    let mut shots = [
        shot([128, 64], -50, 12, CameraTarget::Follow),
        shot([240, 240], 0, 0, CameraTarget::Fixed),
        shot([84, 48], -90, 35, CameraTarget::Follow),
        shot([171, 320], 140, -20, CameraTarget::Follow),
        shot([480, 300], 20, 60, CameraTarget::Fixed),
    ];
    shots[4].1.up = pantin::Up::new(2, true);
    shots
}

/// Places near the origin and far, as in the program in C.
fn stand(n: u32) -> Stand {
    let mut x = n.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    let place = [(); 2].map(|()| {
        x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let near = (x & 0xffff_ff00).cast_signed() >> (n % 20);
        i64::from(near) * if n.is_multiple_of(20) { 0x100_0001 } else { 1 }
    });
    let heading = if n.is_multiple_of(5) { 0 } else { (x.wrapping_mul(5) & 0xffff_ff00).cast_signed() };
    Stand { place, heading: Angle::from_bits(heading) }
}

/// A solid figure on a display of a size.
struct Drawn {
    figure: SolidFigure<BONES>,
    /// Another figure in the world of the first.
    other: SolidFigure<BONES>,
    size: [u16; 2],
}

impl Drawn {
    /// The figure of a clip in one of the shots; `None` for a rig without a figure.
    fn new(player: &mut Player, shot: usize, look: Look) -> Option<Drawn> {
        let (size, view) = shots()[shot];
        let canvas = Canvas { width: size[0], height: size[1] };
        player.rewind();
        let figure = SolidFigure::of_clip(player, canvas, view, look).ok()?;
        player.rewind();
        let mut other = SolidFigure::of_clip(player, canvas, view, Look::DEFAULT).ok()?;
        other.share_camera(&figure);
        Some(Drawn { figure, other, size })
    }

    /// Prints the checksums of a pose's pictures: solid, and as lines.
    fn print(&mut self, text: &mut String, pose: Pose<'_>) -> Result<()> {
        self.figure.set_pose(pose)?;
        let [solid, lines] = self.sums();
        writeln!(text, "{solid:08x} {lines:08x}")?;
        Ok(())
    }

    /// Prints the checksums of a pose that stands somewhere in the world.
    fn print_at(&mut self, text: &mut String, pose: Pose<'_>, n: u32) -> Result<()> {
        self.figure.set_pose_at(pose, stand(n))?;
        let [solid, lines] = self.sums();
        writeln!(text, "at {solid:08x} {lines:08x}")?;
        Ok(())
    }

    /// Prints the checksum of a picture with a pose in two places of one world.
    fn print_both(&mut self, text: &mut String, pose: Pose<'_>, n: u32) -> Result<()> {
        self.figure.set_pose_at(pose, stand(n))?;
        self.other.set_pose_at(pose, stand(n + 7))?;
        writeln!(text, "both {:08x}", sum_of(&self.both(), &self.both(), &self.both()))?;
        Ok(())
    }

    fn both<C: Ink>(&mut self) -> Picture<C> {
        let mut picture = Picture::new(self.size);
        draw_together(&mut [&mut self.figure, &mut self.other], &mut OnTarget::new(&mut picture), true);
        picture
    }

    /// Checksums of the picture of the body, and of that of lines.
    fn sums(&mut self) -> [u32; 2] {
        let solid = sum_of(&self.picture(true), &self.picture(true), &self.picture(true));
        let lines = sum_of(&self.picture(false), &self.picture(false), &self.picture(false));
        [solid, lines]
    }

    fn picture<C: Ink>(&mut self, solid: bool) -> Picture<C> {
        let mut picture = Picture::new(self.size);
        let mut surface = OnTarget::new(&mut picture);
        if solid {
            self.figure.draw_on(&mut surface, true);
        } else {
            self.figure.lines().draw_on(&mut surface, DrawStyle::default());
        }
        picture
    }
}

/// Compares pictures of our motions in all characters, of all vectors and of damaged characters, for programs made by two compilers.
pub fn pictures(folder: &TempDir) -> Result<()> {
    let motion = |name: &str| paths::root().join("motions").join(name).with_extension("ptn");
    let mut cases: Vec<(PathBuf, Option<PathBuf>, Option<PathBuf>)> = vec![];
    for name in ["dancer", "ranger", "cat"] {
        let text = std::fs::read_to_string(paths::root().join("motions/looks").join(name).with_extension("look"))?;
        let look = folder.path().join(name).with_extension("bytes");
        std::fs::write(&look, look_text::compile(&text).map_err(|error| anyhow::anyhow!("{error}"))?)?;
        cases.extend(["walk", "run"].map(|clip| (motion(clip), Some(look.clone()), None)));
    }
    cases.extend(["greet", "kneebend", "run", "walk"].map(|name| (motion(name), None, None)));
    let clips = files()?.into_iter().filter(|(clip, _)| clip.extension().is_some_and(|extension| extension == "ptn"));
    cases.extend(clips.map(|(clip, rig)| (clip, None, rig)));
    let programs = ["gcc", "clang"].map(|compiler| host_program(folder, compiler, "solid"));
    let (mut pictures, mut people, mut stands, mut together) = (0, 0, 0, 0);
    for (clip, look, rig) in &cases {
        let expected = text(clip, look.as_deref(), rig.as_deref()).with_context(|| clip.display().to_string())?;
        pictures += expected.lines().filter(|line| line.len() == 17).count();
        stands += expected.matches("at ").count();
        together += expected.matches("both ").count();
        people += expected.matches("build 2").count();
        for program in &programs {
            let mut command = Command::new(program.as_ref().map_err(|error| anyhow::anyhow!("{error:#}"))?);
            command.arg(clip).arg(look.as_deref().unwrap_or(Path::new("-"))).args(rig);
            let printed = output(command).with_context(|| clip.display().to_string())?;
            same(&clip.display().to_string(), &expected, &String::from_utf8(printed.stdout)?)?;
        }
    }
    let dancer = folder.path().join("dancer.bytes");
    let expected = mutants(&motion("walk"), &std::fs::read(&dancer)?)?;
    for program in &programs {
        let mut command = Command::new(program.as_ref().map_err(|error| anyhow::anyhow!("{error:#}"))?);
        command.arg(motion("walk")).arg("mutants").arg(&dancer).arg(MUTANTS.to_string());
        same("damaged characters", &expected, &String::from_utf8(output(command)?.stdout)?)?;
    }
    let refused = expected.lines().filter(|line| *line == "refused").count();
    println!(
        "   {} clips, {people} people, {pictures} poses, {stands} of them also somewhere in the world, {together} with two figures, {MUTANTS} damaged characters ({refused} refused)",
        cases.len()
    );
    ensure!(people > 40 && stands > 1000 && together > 1000, "few people or stands");
    Ok(())
}

/// Each read of a paged source that fails while a figure is set up ends the call, which then can be repeated.
pub fn reads(folder: &TempDir) -> Result<()> {
    for compiler in ["gcc", "clang"] {
        let mut command = Command::new(host_program(folder, compiler, "solid_reads")?);
        command.arg(paths::root().join("motions/walk.ptn"));
        let printed = String::from_utf8(output(command)?.stdout)?;
        if compiler == "gcc" {
            printed.lines().for_each(|line| println!("   {line}"));
        }
    }
    Ok(())
}

/// What the program in C prints.
fn text(clip: &Path, look: Option<&Path>, rig: Option<&Path>) -> Result<String> {
    let bytes = std::fs::read(clip)?;
    let rig = rig.map(std::fs::read).transpose()?;
    let look = match look {
        Some(look) => Look::new(std::fs::read(look)?.leak())?,
        None => Look::DEFAULT,
    };
    let clip = match &rig {
        Some(rig) => pantin::Clip::with_rig(&bytes, rig)?,
        None => pantin::Clip::new_checked(&bytes)?,
    };
    let mut memory = pantin::Room::<1023, 1023>::new();
    let mut player = memory.player(clip)?;
    let mut text = String::new();
    let mut last = None;
    for shot in 0..shots().len() {
        let Some(mut drawn) = Drawn::new(&mut player, shot, look) else {
            text += "none\n";
            continue;
        };
        let number = |build| [Build::Lines, Build::Bones, Build::Person].iter().position(|own| *own == build);
        let build = number(drawn.figure.build()).context("a build")?;
        writeln!(text, "build {build}")?;
        for frame in (0..player.clip().frames()).step_by(STEP as usize) {
            player.seek(frame);
            drawn.print(&mut text, player.pose())?;
            if frame % (4 * STEP) == 0 {
                drawn.print_at(&mut text, player.pose(), frame / STEP)?;
            }
            if frame % (6 * STEP) == 0 {
                drawn.print_both(&mut text, player.pose(), frame / STEP)?;
            }
        }
        last = Some(drawn);
    }
    let mut x = 1u32;
    for n in 0..if last.is_some() { CHAOS } else { 0 } {
        let mut values = player.pose().values.to_vec();
        for value in &mut values {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *value = (x & 0xffff_ff00).cast_signed() >> (n % 16);
        }
        if let Some(drawn) = &mut last {
            let pose = Pose { values: &values, form: player.pose().form };
            drawn.print(&mut text, pose)?;
            drawn.print_at(&mut text, pose, n)?;
            drawn.print_both(&mut text, pose, n)?;
        }
    }
    Ok(text)
}

/// What the program in C prints of damaged characters.
fn mutants(clip: &Path, look: &[u8]) -> Result<String> {
    let bytes = std::fs::read(clip)?;
    let mut memory = pantin::Room::<1023, 1023>::new();
    let mut player = memory.player(pantin::Clip::new_checked(&bytes)?)?;
    let (mut text, mut x) = (String::new(), 1u32);
    for n in 0..MUTANTS {
        let mut mutant = look.to_vec();
        for _ in 0..=n % 3 {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let at = (x >> 8) as usize % mutant.len();
            mutant[at] ^= 1 << (x >> 29);
        }
        let Ok(look) = Look::new(mutant.leak()) else {
            text += "refused\n";
            continue;
        };
        let mut drawn = Drawn::new(&mut player, n as usize % 3, look).context("a figure")?;
        player.seek(n % player.clip().frames());
        drawn.print(&mut text, player.pose())?;
    }
    Ok(text)
}

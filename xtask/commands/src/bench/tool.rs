//! The host tool in its release build, run as its users run it.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use harness::build::{self, Build};
use harness::paths;
use serde_json::Value;

/// The program, and where its clips go.
pub struct Tool {
    program: PathBuf,
    clips: PathBuf,
}

/// A motion turned into a clip.
pub struct Converted {
    /// The clip.
    pub clip: PathBuf,
    /// Wall time that it took; `None` if the clip was there from an earlier run.
    pub seconds: Option<f64>,
    /// Processor time that it took, in seconds to hundredths; `None` where the system does not report it.
    pub processor: Option<f64>,
    /// The most memory that it had, in MB; `None` where the system does not say.
    pub peak_mb: Option<f64>,
    /// What `pantin info` says.
    pub info: Info,
}

/// What `pantin info --json` says of a clip.
pub struct Info {
    /// Frames.
    pub frames: f64,
    /// Frames a second.
    pub fps: f64,
    /// Channels that move.
    pub moving: f64,
    /// The file without its rig.
    pub motion_bytes: f64,
    /// The file.
    pub file_bytes: f64,
}

impl Info {
    /// How long it plays.
    pub fn seconds(&self) -> f64 {
        self.frames / self.fps
    }
}

impl Tool {
    /// Builds it.
    pub fn build(clips: PathBuf) -> Result<Self> {
        let program = build::cargo(&Build {
            workspace: paths::root(),
            arguments: ["--release", "--package", "pantin-tools", "--bin", "pantin"].map(Into::into).into(),
            environment: vec![],
            product: "pantin".into(),
            ..Build::default()
        })?;
        Ok(Self { program, clips })
    }

    /// Where the clip of a name is. Names have points: `walk-0.05degrees`.
    fn clip(&self, name: &str) -> PathBuf {
        self.clips.join(format!("{name}.ptn"))
    }

    /// Converts a motion into the clip `name`.ptn.
    pub fn convert(&self, motion: &Path, name: &str, options: &[String]) -> Result<Converted> {
        let clip = self.clip(name);
        let start = Instant::now();
        let mut command = Command::new(&self.program);
        command.arg("convert").arg(motion).arg("-q").arg("-o").arg(&clip).args(options);
        // What is measured is a kind of clip, not the choice between them.
        if !options.iter().any(|option| option == "--keys") {
            command.arg("--segments");
        }
        let Watched { peak_mb, processor } = self.run_watched(&mut command)?;
        let seconds = Some(start.elapsed().as_secs_f64());
        Ok(Converted { info: self.info(&clip)?, clip, seconds, processor, peak_mb })
    }

    /// As [`Tool::convert`], but takes a clip that is newer than the program and the motion. The name must stand for the options.
    pub fn converted(&self, motion: &Path, name: &str, options: &[String]) -> Result<Converted> {
        let clip = self.clip(name);
        let changed = |path: &Path| path.metadata().and_then(|data| data.modified());
        let newer = |path: &Path| matches!((changed(&clip), changed(path)), (Ok(made), Ok(source)) if made > source);
        if newer(&self.program) && newer(motion) {
            return Ok(Converted { info: self.info(&clip)?, clip, seconds: None, processor: None, peak_mb: None });
        }
        self.convert(motion, name, options)
    }

    /// Converts a motion as if it were captured now, with a delay in seconds: the bytes of its clips without their rig, and how many clips there are.
    pub fn record(&self, motion: &Path, delay: f64, options: &[String]) -> Result<(f64, usize)> {
        let folder = tempfile::tempdir()?;
        let mut command = Command::new(&self.program);
        command.arg("convert").arg(motion).args(["-q", "--stream", "--delay", &delay.to_string(), "-o"]);
        self.run(command.arg(folder.path()).args(options))?;
        let (mut bytes, mut clips) = (0, 0);
        for entry in std::fs::read_dir(folder.path())? {
            let path = entry?.path();
            if path.extension().is_some_and(|extension| extension == "ptn") {
                (bytes, clips) = (bytes + path.metadata()?.len(), clips + 1);
            }
        }
        Ok((bytes as f64, clips))
    }

    /// Turns a clip back into a BVH file.
    pub fn expand(&self, clip: &Path, bvh: &Path) -> Result<()> {
        self.run(Command::new(&self.program).arg("expand").arg(clip).arg("-o").arg(bvh)).map(drop)
    }

    fn info(&self, clip: &Path) -> Result<Info> {
        let text = self.run(Command::new(&self.program).args(["info", "--json"]).arg(clip))?;
        let json: Value = serde_json::from_slice(&text).context("`pantin info --json` prints no JSON")?;
        let number = |key: &str| json[key].as_f64().with_context(|| format!("`pantin info --json` has no number {key}"));
        Ok(Info {
            frames: number("frames")?,
            fps: number("fps")?,
            moving: number("moving")?,
            motion_bytes: number("motion_bytes")?,
            file_bytes: clip.metadata().with_context(|| clip.display().to_string())?.len() as f64,
        })
    }

    /// Runs a command to its end and watches what it takes.
    fn run_watched(&self, command: &mut Command) -> Result<Watched> {
        let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let child = child.with_context(|| format!("cannot start {}", self.program.display()))?;
        let (status, stat) = (format!("/proc/{}/status", child.id()), format!("/proc/{}/stat", child.id()));
        let watch = std::thread::spawn(move || {
            let mut watched = Watched::default();
            // The file is empty of this line once the program has ended.
            while let Some(now) = std::fs::read_to_string(&status).ok().and_then(|text| peak_of(&text)) {
                watched.peak_mb = Some(now);
                watched.processor =
                    std::fs::read_to_string(&stat).ok().and_then(|text| processor_of(&text)).or(watched.processor);
                std::thread::sleep(EVERY);
            }
            watched
        });
        let output = child.wait_with_output()?;
        let watched = watch.join().unwrap_or_default();
        if !output.status.success() {
            bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
        }
        Ok(watched)
    }

    fn run(&self, command: &mut Command) -> Result<Vec<u8>> {
        let output = command.stdin(Stdio::null()).output();
        let output = output.with_context(|| format!("cannot start {}", self.program.display()))?;
        if !output.status.success() {
            bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
        }
        Ok(output.stdout)
    }
}

/// What a program took, where the system reports it.
#[derive(Default)]
struct Watched {
    peak_mb: Option<f64>,
    processor: Option<f64>,
}

/// How often memory and processor time are looked at.
const EVERY: std::time::Duration = std::time::Duration::from_millis(20);

/// The peak in Linux's status of a program, in MB.
fn peak_of(status: &str) -> Option<f64> {
    let kib = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().strip_suffix("kB")?.trim();
    Some(kib.parse::<f64>().ok()? * 1024e-6)
}

/// Linux counts processor time in this many ticks a second on every machine.
const TICKS: f64 = 100.0;

/// The processor time in Linux's statistics of a program: that of its threads, in user and system mode, in seconds.
fn processor_of(stat: &str) -> Option<f64> {
    // The program's name, in brackets, may hold anything.
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(11);
    let [user, system] = [fields.next()?.parse::<f64>().ok()?, fields.next()?.parse::<f64>().ok()?];
    Some((user + system) / TICKS)
}

/// The options of a conversion: the bound, and the unit where it is known.
pub fn options(bound_cm: f64, cm_per_unit: Option<f64>) -> Vec<String> {
    let mut options = vec!["--max-error".to_owned(), format!("{bound_cm}cm")];
    options.extend(unit(cm_per_unit));
    options
}

/// The options of a conversion that bounds the shell as ACL measures it, whatever the figure's height.
pub fn shell_options(bound_cm: f64, cm_per_unit: Option<f64>) -> Vec<String> {
    [options(bound_cm, cm_per_unit), vec!["--shell".to_owned(), format!("{}cm", super::error::SHELL_CM)]].concat()
}

/// The options of a conversion that bounds places alone.
pub fn places_options(bound_cm: f64, cm_per_unit: Option<f64>) -> Vec<String> {
    [options(bound_cm, cm_per_unit), vec!["--places-only".to_owned()]].concat()
}

/// The options of a conversion that keeps a mean error of the same shell.
pub fn mean_options(mean_cm: f64, cm_per_unit: Option<f64>) -> Vec<String> {
    let mut options = vec!["--mean-error".to_owned(), format!("{mean_cm}cm")];
    options.extend(["--shell".to_owned(), format!("{}cm", super::error::SHELL_CM)]);
    options.extend(unit(cm_per_unit));
    options
}

fn unit(cm_per_unit: Option<f64>) -> Vec<String> {
    cm_per_unit.iter().flat_map(|unit| ["--cm-per-unit".to_owned(), unit.to_string()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_read_in_megabytes() {
        assert_eq!(peak_of("VmPeak:\t  9 kB\nVmHWM:\t  125000 kB\n"), Some(128.0));
        assert_eq!(peak_of("State:\tZ (zombie)\n"), None);
    }

    #[test]
    fn processor_time_is_read_in_seconds() {
        assert_eq!(processor_of("7 (a ) b) R 1 7 7 0 -1 0 0 0 0 0 250 50 9 9 20 0"), Some(3.0));
        assert_eq!(processor_of("7 (pantin) R 1"), None);
    }

    #[test]
    fn names_with_points_are_apart() {
        let tool = Tool { program: PathBuf::new(), clips: "clips".into() };
        assert_eq!(tool.clip("walk-0.05degrees"), Path::new("clips/walk-0.05degrees.ptn"));
        assert_ne!(tool.clip("walk-0.05degrees"), tool.clip("walk-0.5cm"));
    }
}

//! The keyword arguments of `pantin.convert`, and the recipe that they ask for.

use pantin_convert::Level;
use pantin_convert::Rotations;
use pantin_convert::edit::{Body, Edits, InPlace, Pace};
use pantin_convert::import::{ImportOptions, up};
use pantin_convert::motion::Up;
use pantin_convert::number::Number;
use pantin_convert::{ChannelBound, Error, Length, Memory, Moment, Options, Problem, Recipe, Setting, UseKeys, parse_size};
use pyo3::prelude::*;
use std::path::PathBuf;

/// The keyword arguments, as the Python half gives them: a dict with all of these keys. `_convert.py` documents them.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    max_error_cm: Option<f64>,
    max_error_percent: Option<f64>,
    mean_error_cm: Option<f64>,
    mean_error_percent: Option<f64>,
    max_scalar_error: Option<f64>,
    max_rotation_error: Option<f64>,
    max_joint_error: Option<f64>,
    shell_cm: Option<f64>,
    shell_percent: Option<f64>,
    places_only: bool,
    max_channel_error: Option<f64>,
    max_accel_error: Option<f64>,
    exact: bool,
    keys: bool,
    segments: bool,
    effort: String,
    rotations: String,
    index: Option<f64>,
    rig_apart: bool,
    #[pyo3(item("loop"))]
    looped: bool,
    footsteps: bool,
    memory: Option<String>,
    source_rate: Option<f64>,
    fps: Option<f64>,
    /// Moments and names.
    events: Vec<(String, String)>,
    first: Option<String>,
    last: Option<String>,
    joints: Vec<String>,
    drop: Vec<String>,
    mirror: bool,
    retarget: Option<String>,
    body: Option<PathBuf>,
    speed: Option<f64>,
    between: Option<(String, String)>,
    rename: Vec<(String, String)>,
    reverse: bool,
    scale: Option<f64>,
    smooth: Option<f64>,
    in_place: Option<String>,
    turn: Option<f64>,
    pace: Option<String>,
    append: Vec<PathBuf>,
    blend: Option<f64>,
    joint_map: Option<PathBuf>,
    with_file: Option<PathBuf>,
    close_loop: bool,
    cm_per_unit: Option<f64>,
    up: Option<String>,
    animation: Option<String>,
    skeleton: Option<PathBuf>,
}

impl Settings {
    /// The recipe; fails for what no motion takes.
    pub fn recipe(&self) -> Result<Recipe, Error> {
        let options = self.options()?;
        options.check()?;
        Ok(Recipe::new().import(self.import()?).edits(self.edits()?).options(options))
    }

    /// The limit of memory.
    pub fn memory(&self) -> Result<Memory, Error> {
        let Some(text) = &self.memory else { return Ok(Memory::default()) };
        let wrong = |reason| Error::Memory(Problem::new(format!("memory={text:?}: {reason}")));
        Ok(Memory::new(parse_size(text).map_err(wrong)?))
    }

    fn import(&self) -> Result<ImportOptions, Error> {
        let mut import = ImportOptions::new().memory(self.memory()?);
        import.cm_per_unit = self.cm_per_unit;
        import.up = self.up.as_deref().map(direction).transpose()?;
        // Frames at a rate of their own are not sampled at another.
        import.fps = self.fps.filter(|_| self.source_rate.is_none());
        import.animation.clone_from(&self.animation);
        import.skeleton.clone_from(&self.skeleton);
        Ok(import)
    }

    fn edits(&self) -> Result<Edits, Error> {
        for (setting, rate) in [(Setting::SourceRate, self.source_rate), (Setting::FrameRate, self.fps)] {
            if rate.is_some_and(|rate| !(rate.is_finite() && rate > 0.0)) {
                return Err(Error::setting(setting, "expected a number above 0"));
            }
        }
        let moment = |setting: Setting, text: &str| {
            text.parse::<Moment>()
                .map_err(|_| Error::setting(setting, "expected a frame's number from 0, or seconds as in '1.5s'"))
        };
        let mut edits = Edits::new().mirror(self.mirror).close_loop(self.close_loop).memory(self.memory()?);
        (edits.rate, edits.fps) = (self.source_rate, self.fps);
        edits.from = self.first.as_deref().map(|text| moment(Setting::From, text)).transpose()?;
        edits.to = self.last.as_deref().map(|text| moment(Setting::To, text)).transpose()?;
        edits.joints.clone_from(&self.joints);
        edits.drop.clone_from(&self.drop);
        edits.map.clone_from(&self.joint_map);
        edits.with.clone_from(&self.with_file);
        for (at, name) in &self.events {
            edits = edits.event(name, moment(Setting::Event, at)?);
        }
        edits.retarget = match self.retarget.as_deref() {
            None => None,
            Some("display") => Some(Body::Display),
            Some(_) => return Err(Error::setting(Setting::Retarget, "expected 'display'")),
        };
        if let Some(body) = &self.body {
            if edits.retarget.is_some() {
                return Err(Error::setting(Setting::Retarget, "expected retarget or body, not both"));
            }
            edits.retarget = Some(Body::Of(body.clone()));
        }
        (edits.speed, edits.scale, edits.smooth, edits.blend) = (self.speed, self.scale, self.smooth, self.blend);
        edits.between.clone_from(&self.between);
        edits.rename.clone_from(&self.rename);
        edits.append.clone_from(&self.append);
        edits.in_place = match self.in_place.as_deref() {
            None => None,
            Some("way") => Some(InPlace::Way),
            Some("way-and-heading") => Some(InPlace::WayAndHeading),
            Some(_) => return Err(Error::setting(Setting::InPlace, "expected 'way' or 'way-and-heading'")),
        };
        edits.turn = self.turn;
        let pace = |text: &str| text.parse::<Pace>().map_err(|expected| Error::setting(Setting::Pace, expected));
        edits.pace = self.pace.as_deref().map(pace).transpose()?;
        edits.reverse = self.reverse;
        if edits.map.is_some() && edits.retarget.is_none() {
            return Err(Error::setting(Setting::Map, "it names joints for retarget='display' or body, which are not set"));
        }
        Ok(edits)
    }

    fn options(&self) -> Result<Options, Error> {
        let length = |setting: Setting, cm: Option<f64>, percent: Option<f64>| match (cm, percent) {
            (Some(_), Some(_)) => Err(Error::setting(setting, "expected cm or percent, not both")),
            (Some(cm), None) => Ok(Some(Length::cm(cm))),
            (None, percent) => Ok(percent.map(Length::percent)),
        };
        let mut options = Options::new().effort(self.effort()?).rotations(self.rotations()?).memory(self.memory()?);
        options.max_error = length(Setting::MaxError, self.max_error_cm, self.max_error_percent)?;
        options.mean_error = length(Setting::MeanError, self.mean_error_cm, self.mean_error_percent)?;
        options.max_scalar_error = self.max_scalar_error;
        options.max_rotation_error = self.max_rotation_error;
        options.max_joint_error = self.max_joint_error;
        options.shell = length(Setting::Shell, self.shell_cm, self.shell_percent)?;
        options.places_only = self.places_only;
        options.channels = self.channels()?;
        options.index = self.index;
        options.keys = match (self.keys, self.segments) {
            (true, true) => return Err(Error::setting(Setting::Keys, "a clip holds keys or segments: leave out segments")),
            (true, false) => UseKeys::Always,
            (false, true) => UseKeys::Never,
            (false, false) => UseKeys::IfSmaller,
        };
        Ok(options.rig_apart(self.rig_apart).looped(self.looped).footsteps(self.footsteps))
    }

    /// Bounds of channels, which are in place of all others.
    fn channels(&self) -> Result<Option<ChannelBound>, Error> {
        let given = [
            self.max_channel_error.map(|bound| (Setting::MaxChannelError, ChannelBound::Error(bound))),
            self.max_accel_error.map(|bound| (Setting::MaxAccelError, ChannelBound::Acceleration(bound))),
            self.exact.then_some((Setting::Exact, ChannelBound::Exact)),
        ];
        let mut given = given.into_iter().flatten();
        let Some((setting, bound)) = given.next() else { return Ok(None) };
        let others = [
            ("max_error_cm", self.max_error_cm),
            ("max_error_percent", self.max_error_percent),
            ("mean_error_cm", self.mean_error_cm),
            ("mean_error_percent", self.mean_error_percent),
            ("max_scalar_error", self.max_scalar_error),
            ("max_rotation_error", self.max_rotation_error),
            ("max_joint_error", self.max_joint_error),
            ("shell_cm", self.shell_cm),
            ("shell_percent", self.shell_percent),
            ("places_only", self.places_only.then_some(1.0)),
        ];
        let other = given
            .next()
            .map(|(setting, _)| self.keyword(setting))
            .or_else(|| others.iter().find(|(_, bound)| bound.is_some()).map(|(name, _)| *name));
        match other {
            Some(other) => Err(Error::setting(setting, format!("it bounds each channel in place of {other}: give one of them"))),
            None => Ok(Some(bound)),
        }
    }

    fn effort(&self) -> Result<Level, Error> {
        self.effort.parse().map_err(|expected| Error::setting(Setting::Effort, expected))
    }

    fn rotations(&self) -> Result<Rotations, Error> {
        match &*self.rotations {
            "by-cost" => Ok(Rotations::ByCost),
            "euler" => Ok(Rotations::Euler),
            "exponential" => Ok(Rotations::Exponential),
            "quaternion" => Ok(Rotations::Quaternion),
            _ => Err(Error::setting(Setting::Rotations, "expected 'by-cost', 'euler', 'exponential' or 'quaternion'")),
        }
    }

    /// The keyword argument of a setting: where there are two, the one that was given.
    pub fn keyword(&self, setting: Setting) -> &'static str {
        match setting {
            Setting::MaxError if self.max_error_percent.is_some() => "max_error_percent",
            Setting::MeanError if self.mean_error_percent.is_some() => "mean_error_percent",
            Setting::Shell if self.shell_percent.is_some() => "shell_percent",
            other => crate::words::keyword(other),
        }
    }

    /// The value of a setting's keyword argument as the library writes it, and as Python does; `None` for one without a value to show.
    pub fn value(&self, setting: Setting) -> Option<(String, String)> {
        let number = |number: Option<f64>| number.map(|number| (Number(number).to_string(), Number(number).to_string()));
        let text = |text: Option<&str>| text.map(|text| (text.to_owned(), format!("{text:?}")));
        // A frame's number has no quotes.
        let moment = |moment: Option<&str>| match moment {
            Some(frame) if frame.parse::<u32>().is_ok() => Some((frame.to_owned(), frame.to_owned())),
            other => text(other),
        };
        let path = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
        let list = |list: &[String]| (!list.is_empty()).then(|| (String::new(), format!("{list:?}")));
        let flag = |flag: bool| flag.then(|| (String::new(), "True".to_owned()));
        match setting {
            Setting::MaxError => number(self.max_error_percent.or(self.max_error_cm)),
            Setting::MeanError => number(self.mean_error_percent.or(self.mean_error_cm)),
            Setting::MaxScalarError => number(self.max_scalar_error),
            Setting::MaxRotationError => number(self.max_rotation_error),
            Setting::MaxJointError => number(self.max_joint_error),
            Setting::Shell => number(self.shell_percent.or(self.shell_cm)),
            Setting::MaxChannelError => number(self.max_channel_error),
            Setting::MaxAccelError => number(self.max_accel_error),
            Setting::FrameRate => number(self.fps),
            Setting::SourceRate => number(self.source_rate),
            Setting::Unit => number(self.cm_per_unit),
            Setting::Index => number(self.index),
            Setting::Up => text(self.up.as_deref()),
            Setting::Animation => text(self.animation.as_deref()),
            Setting::Effort => text(Some(&self.effort)),
            Setting::Rotations => text(Some(&self.rotations)),
            Setting::Retarget => text(self.retarget.as_deref()),
            Setting::InPlace => text(self.in_place.as_deref()),
            Setting::Body => text(path(&self.body).as_deref()),
            Setting::Turn => number(self.turn),
            Setting::Pace => text(self.pace.as_deref()),
            Setting::Speed => number(self.speed),
            Setting::Scale => number(self.scale),
            Setting::Smooth => number(self.smooth),
            Setting::Blend => number(self.blend),
            Setting::Reverse => flag(self.reverse),
            Setting::From => moment(self.first.as_deref()),
            Setting::To => moment(self.last.as_deref()),
            Setting::Skeleton => text(path(&self.skeleton).as_deref()),
            Setting::Map => text(path(&self.joint_map).as_deref()),
            Setting::With => text(path(&self.with_file).as_deref()),
            Setting::Joints => list(&self.joints),
            Setting::Drop => list(&self.drop),
            Setting::Mirror => flag(self.mirror),
            Setting::Footsteps => flag(self.footsteps),
            Setting::Loop => flag(self.looped),
            Setting::CloseLoop => flag(self.close_loop),
            Setting::Exact => flag(self.exact),
            Setting::Keys => flag(self.keys),
            Setting::PlacesOnly => flag(self.places_only),
            _ => None,
        }
    }
}

/// The direction that is vertical, as text.
pub fn direction(text: &str) -> Result<Up, Error> {
    up::parse(text).ok_or_else(|| Error::setting(Setting::Up, "expected x, y, z, -x, -y or -z"))
}
